// Two serialized sensor_msgs/Image: validation and conversion to grey.

#include "input/image_validation.h"
#include "input/input_error.h"
#include "input/stereo_pair_converter.h"
#include "message_reader.h"
#include "require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rotrocc;
  constexpr std::int64_t kMaxPixels = 10'000;
  MessageReader reader(data, size);
  const auto left = reader.image();
  if (!left) return -1;  // not added to the corpus
  const auto right = reader.image();
  try {
    cameraFrameOf(*left, "");
    StereoPairConverter converter(kMaxPixels);
    const StereoPair pair = converter.convert(*left, right.value_or(*left));
    for (const cv::Mat* image : {&pair.left, &pair.right}) {
      require(image->type() == CV_8UC1, "images are grey");
      require(image->rows == static_cast<int>(left->height), "images are as high as they say");
      require(image->cols == static_cast<int>(left->width), "images are as wide as they say");
      require(image->rows * image->cols <= kMaxPixels, "images are no larger than allowed");
      cv::sum(*image);  // reads each pixel
    }
  } catch (const InputError&) {
  }
  return 0;
}
