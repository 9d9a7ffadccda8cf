// times.txt, calib.txt and poses.txt of a sequence of two pairs, in one input and separated by
// lines "---".

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "input_file.h"
#include "require.h"
#include "rotrocc/kitti.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

/// A file that may be missing. It is not rewritten if unchanged, as most parts of most inputs are.
class Part {
 public:
  explicit Part(const std::string& path) : path_(path) {}

  void write(const std::optional<std::string_view>& text) {
    if (text == text_) return;
    text_ = text;
    if (text) {
      if (!file_) file_ = std::make_unique<InputFile>(path_);
      file_->write(*text);
    } else {
      file_.reset();
      std::filesystem::remove(path_);
    }
  }

 private:
  std::string path_;
  std::unique_ptr<InputFile> file_;
  std::optional<std::string> text_;
};

class Sequence {
 public:
  Sequence() {
    // PGM is faster to read than PNG, and OpenCV identifies it by its content.
    const std::string image = "P5 6 4 255\n" + std::string(24, '\x80');
    for (const char* folder : {"image_0", "image_1"}) {
      std::filesystem::create_directory(directory_ / folder);
      directory_.write(folder + std::string("/000000.png"), image);
      directory_.write(folder + std::string("/000001.png"), image);
    }
  }

  /// If a part is missing, so is its file.
  void write(std::string_view text) {
    constexpr std::string_view kSeparator = "---\n";
    for (Part& part : parts_) {
      if (text.empty()) {
        part.write(std::nullopt);
        continue;
      }
      const std::size_t end = std::min(text.find(kSeparator), text.size());
      part.write(text.substr(0, end));
      text.remove_prefix(std::min(end + kSeparator.size(), text.size()));
    }
  }

  std::string path() const { return directory_ / ""; }

 private:
  TemporaryDirectory directory_;
  std::array<Part, 3> parts_{Part(directory_ / "times.txt"),
                             Part(directory_ / "calib.txt"),
                             Part(directory_ / "poses.txt")};
};

}  // namespace
}  // namespace rotrocc

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rotrocc;
  static Sequence files;
  files.write(asText(data, size));
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
