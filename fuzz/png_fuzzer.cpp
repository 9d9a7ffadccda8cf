// A PNG file.

#include <filesystem>
#include <stdexcept>

#include "evaluation/png.h"
#include "input_file.h"
#include "require.h"
#include "support/temporary_directory.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rotrocc;
  static const TemporaryDirectory directory;
  static const InputFile file(directory / "image.png");
  file.write(asText(data, size));
  try {
    const cv::Mat image = readGreyPng(file.path());
    require(!image.empty(), "an image has pixels");
    require(image.type() == CV_8UC1 || image.type() == CV_16UC1, "images are grey");
    cv::sum(image);  // reads each pixel
  } catch (const std::runtime_error&) {
  }
  return 0;
}
