#include "sequences/image_folders.h"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

/// Folders of images that are not read.
class ImageFoldersTest : public ::testing::Test {
 protected:
  using Names = std::vector<std::string>;

  void write(const char* side, const Names& names) {
    std::filesystem::create_directory(directory_ / side);
    for (const std::string& name : names) directory_.write(side + ("/" + name), "");
  }

  ImagePairs pairs() const {
    return pairFolders(directory_ / "left", directory_ / "right", directory_ / "times.txt", 0.01);
  }

  /// "LEFT RIGHT STAMP_NS" of all pairs.
  Names described() const {
    Names lines;
    const ImagePairs pairs = this->pairs();
    for (int i = 0; i < pairs.size(); ++i) {
      const auto name = [](const std::string& path) {
        return std::filesystem::path(path).filename().string();
      };
      lines.push_back(name(pairs.pair(i).left.path) + " " + name(pairs.pair(i).right.path) + " " +
                      std::to_string(pairs.stamp_ns(i)));
    }
    return lines;
  }

  TemporaryDirectory directory_;
};

TEST_F(ImageFoldersTest, NumbersInNamesCountAsNumbers) {
  write("left", {"10.PNG", "9.png", "._9.png", "1.jpeg", "notes.txt"});
  write("right", {"r009.webp", "r001.webp", "r010.webp"});
  directory_.write("times.txt", "0\n0.1\n0.2\n");
  EXPECT_EQ(
      described(),
      (Names{"1.jpeg r001.webp 0", "9.png r009.webp 100000000", "10.PNG r010.webp 200000000"}));
}

TEST_F(ImageFoldersTest, ImagesOfTheSameNameAreAPair) {
  write("left", {"000.png", "001.png", "003.png"});
  write("right", {"000.png", "002.png", "003.png"});
  const Names of_numbers = {"000.png 000.png 0", "003.png 003.png 300000000"};
  directory_.write("times.txt", "0\n0.1\n0.2\n0.3\n");
  EXPECT_EQ(described(), of_numbers);
  EXPECT_EQ(pairs().leftOut(), "1 left image and 1 right image without a partner");
  directory_.write("times.txt", "0\n0.1\n0.3\n");
  EXPECT_EQ(described(), of_numbers) << "a time for each left image";
  directory_.write("times.txt", "0\n0.3\n");
  EXPECT_EQ(described(), of_numbers) << "a time for each pair";
  directory_.write("times.txt", "0\n0.1\n0.2\n0.3\n0.4\n");
  EXPECT_EQ(described(), of_numbers) << "a time for each number, and for one that is lost";
  directory_.write("times.txt", "0\n");
  expectError<std::runtime_error>(
      [this] { pairs(); },
      "times.txt has 1 times, but there are 3 left and 3 right images, 2 with the same name");
}

TEST_F(ImageFoldersTest, ImagesWithoutSharedNamesArePairedInOrder) {
  write("left", {"a.png", "b.png"});
  write("right", {"c.png", "d.png"});
  directory_.write("times.txt", "0\n0.1\n");
  EXPECT_EQ(described(), (Names{"a.png c.png 0", "b.png d.png 100000000"}));
  write("right", {"e.png"});
  expectError<std::runtime_error>([this] { pairs(); },
                                  "begin 2 left and 3 right images that share no names");
}

TEST_F(ImageFoldersTest, DigitsOfANameTellTheUnitOfItsTime) {
  const struct {
    Names names;
    std::int64_t first_ns, step_ns;
  } kCases[] = {
      {{"1403636579763555584.png", "1403636579813555456.png"}, 1403636579763555584, 49999872},
      {{"1403636579763555.png", "1403636579813555.png"}, 1403636579763555000, 50'000'000},
      {{"1403636579763.png", "1403636579813.png"}, 1403636579763'000000, 50'000'000},
      {{"1403636579.763.png", "1403636579.813.png"}, 1403636579763'000000, 50'000'000},
      {{"1403636579.png", "1403636580.png"}, 1403636579'000000000, 1'000'000'000},
      {{"12.5.png", "13.5.png"}, 12'500'000'000, 1'000'000'000},
      // Nanoseconds of a camera that runs for five days.
      {{"432000000000000.png", "432000050000000.png"}, 432000000000000, 50'000'000}};
  for (const auto& row : kCases) {
    for (const char* side : {"left", "right"}) {
      std::filesystem::remove_all(directory_ / side);
      write(side, row.names);
    }
    const ImagePairs pairs = this->pairs();
    EXPECT_EQ(pairs.stamp_ns(0), row.first_ns) << row.names[0];
    EXPECT_EQ(pairs.stamp_ns(1) - pairs.stamp_ns(0), row.step_ns) << row.names[0];
  }
}

TEST_F(ImageFoldersTest, RejectsNamesThatAreNoTimesOfACamera) {
  write("left", {"12000000000.png", "12000000050.png"});
  write("right", {"12000000000.png", "12000000050.png"});
  expectError<std::runtime_error>(
      [this] { pairs(); },
      "by their times in ns, images are 5e-08 s apart, which is not the "
      "rate of a camera: they look like times in ms, with 0.05 s");
  write("left", {"1.png"});
  expectError<std::runtime_error>([this] { pairs(); }, "1.png is not named by its time");
}

}  // namespace
}  // namespace rotrocc
