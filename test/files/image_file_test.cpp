#include "files/image_file.h"

#include <filesystem>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "support/expect_error.h"
#include "support/read_file.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

/// Noise.
cv::Mat makeImage(int type, const cv::Size& size = {61, 40}) {
  cv::Mat image(size, type);
  cv::RNG(7).fill(image, cv::RNG::UNIFORM, 0.0, CV_MAT_DEPTH(type) == CV_16U ? 65535.0 : 255.0);
  return image;
}

class ImageFileTest : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const cv::Mat& image) const {
    EXPECT_TRUE(cv::imwrite(directory_ / name, image));
    return directory_ / name;
  }

  TemporaryDirectory directory_;
};

TEST_F(ImageFileTest, ConvertsColorsToGray) {
  const std::string path = write("image.png", makeImage(CV_8UC3));
  const cv::Mat gray = readGrayImage(path);
  ASSERT_EQ(gray.type(), CV_8UC1);
  EXPECT_EQ(cv::norm(gray, cv::imread(path, cv::IMREAD_GRAYSCALE), cv::NORM_INF), 0.0);
}

TEST_F(ImageFileTest, TakesTheUpperBitsOf16) {
  const cv::Mat image = makeImage(CV_16UC1);
  for (const std::string name : {"a.png", "a.tiff", "a.pgm"}) {
    const cv::Mat read = readGrayImage(write(name, image));
    ASSERT_EQ(read.size(), image.size()) << name;
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        ASSERT_EQ(read.at<uchar>(y, x), image.at<ushort>(y, x) >> 8) << name;
      }
    }
  }
}

TEST_F(ImageFileTest, NamesWhatIsNoImage) {
  const std::string image = readFile(write("image.png", makeImage(CV_8UC1)));
  const std::string header_of_too_many_pixels(
      "\x89PNG\r\n\x1a\n"
      "\0\0\0\rIHDR\0\1\0\0\0\1\0\0\1\0\0\0\0\x44\xff\x0d\x4e"
      "\0\0\0\1IDAT",
      41);
  const auto expectRejected = [&](const std::string& name, const std::string& part) {
    expectError<std::runtime_error>([&] { readGrayImage(directory_ / name); }, name + part);
  };
  for (const std::string& bytes : {std::string(),
                                   std::string("no image"),
                                   image.substr(0, 30),
                                   image.substr(0, image.size() / 2),
                                   header_of_too_many_pixels}) {
    directory_.write("a.png", bytes);
    expectRejected("a.png", " is not a readable image: is it damaged, or no image? Copy it again");
  }
  std::filesystem::create_directory(directory_ / "folder.png");
  expectRejected("folder.png", " is not a readable image");
  expectRejected("none.png", " is missing");
}

TEST_F(ImageFileTest, ReportsWhatItCannotWrite) {
  const cv::Mat image = makeImage(CV_8UC1, {300, 200});
  std::filesystem::create_symlink("/dev/full", directory_ / "full.png");
  expectError<std::runtime_error>([&] { writeImage(directory_ / "full.png", image); },
                                  "full.png: is the disk full?");
  expectError<std::runtime_error>([&] { writeImage(directory_ / "none/a.png", image); },
                                  "none/a.png");
}

}  // namespace
}  // namespace rotrocc
