// times.txt, calib.txt and poses.txt of a sequence of two pairs, in one input with a line "---"
// between them.

#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <opencv2/imgcodecs.hpp>

#include "../test/temporary_directory.h"
#include "require.h"
#include "rotrocc/kitti.h"

namespace rotrocc {
namespace {

class Sequence {
 public:
  Sequence() {
    const cv::Mat image(4, 6, CV_8UC1, cv::Scalar(128));
    for (const char* folder : {"image_0", "image_1"}) {
      std::filesystem::create_directory(directory_ / folder);
      cv::imwrite(directory_ / folder + "/000000.png", image);
      cv::imwrite(directory_ / folder + "/000001.png", image);
    }
  }

  /// Without a part, its file is missing.
  void write(std::string text) const {
    const std::string separator = "---\n";
    for (const char* name : {"times.txt", "calib.txt", "poses.txt"}) {
      std::filesystem::remove(directory_ / name);
      if (text.empty()) continue;
      const auto end = text.find(separator);
      directory_.write(name, text.substr(0, end));
      text.erase(0, end == std::string::npos ? end : end + separator.size());
    }
  }

  std::string path() const { return directory_ / ""; }

 private:
  TemporaryDirectory directory_;
};

}  // namespace
}  // namespace rotrocc

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rotrocc;
  static const Sequence files;
  files.write(std::string(data, data + size));
  try {
    const KittiSequence sequence(files.path());
    sequence.camera().check();
    require(sequence.size() == 2, "a time for each pair");
    require(!sequence.hasGroundTruth() || sequence.groundTruth().size() == 2, "and a pose");
    require(sequence.stamp_ns(0) < sequence.stamp_ns(1), "times increase");
  } catch (const std::runtime_error&) {
  }
  return 0;
}
