#include "evaluation/grey_image.h"

#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <png.h>
#include <opencv2/imgcodecs.hpp>

#include "evaluation/png.h"
#include "support/expect_error.h"
#include "support/read_file.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr int kAnyGrey = cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH;

/// Noise on a slope, so that each row differs and filters of PNG have work.
cv::Mat makeImage(int type, const cv::Size& size = {61, 40}) {
  const int channels = CV_MAT_CN(type);
  const double range = CV_MAT_DEPTH(type) == CV_16U ? 65535.0 : 255.0;
  cv::Mat values(size, CV_64FC(channels));
  cv::RNG(7).fill(values, cv::RNG::UNIFORM, 0.0, 0.3 * range);
  for (int y = 0; y < size.height; ++y) {
    values.row(y) += cv::Scalar::all(0.7 * range * y / size.height);
  }
  cv::Mat image;
  values.convertTo(image, type);
  return image;
}

void expectSame(const cv::Mat& image, const cv::Mat& expected) {
  ASSERT_FALSE(expected.empty());
  ASSERT_EQ(image.type(), expected.type());
  ASSERT_EQ(image.size(), expected.size());
  EXPECT_EQ(cv::norm(image, expected, cv::NORM_INF), 0.0);
}

/// What cv::imwrite() does not write: a PNG of any colour type, depth and interlacing.
struct PngKind {
  int colour_type;
  int bits;
  int interlacing;
};

void writePngOf(const PngKind& kind, const std::string& path) {
  constexpr png_uint_32 kWidth = 37;
  constexpr png_uint_32 kHeight = 23;
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, kWidth, kHeight, kind.bits, kind.colour_type, kind.interlacing, 0, 0);
  if (kind.colour_type == PNG_COLOR_TYPE_PALETTE) {
    png_color palette[256];
    for (int i = 0; i < 256; ++i) {
      const auto level = static_cast<png_byte>(i);
      palette[i] = {level, static_cast<png_byte>(7 * i), static_cast<png_byte>(255 - i)};
    }
    const png_byte half_transparent[] = {128, 0};
    png_set_PLTE(png, info, palette, 1 << kind.bits);
    png_set_tRNS(png, info, half_transparent, 2, nullptr);
  }
  png_set_gAMA(png, info, 1.0);
  png_write_info(png, info);
  cv::Mat bytes(static_cast<int>(kHeight), 8 * static_cast<int>(kWidth), CV_8UC1);
  cv::RNG(3).fill(bytes, cv::RNG::UNIFORM, 0, 256);
  std::vector<png_bytep> rows;
  for (int y = 0; y < bytes.rows; ++y) rows.push_back(bytes.ptr(y));
  png_write_image(png, rows.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

class GreyImageTest : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const cv::Mat& image) const {
    EXPECT_TRUE(cv::imwrite(directory_ / name, image));
    return directory_ / name;
  }

  TemporaryDirectory directory_;
};

TEST_F(GreyImageTest, ReadsThePixelsOfOpenCvFromItsPngs) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3, CV_16UC4}) {
    SCOPED_TRACE(type);
    const std::string path = write("image.png", makeImage(type));
    expectSame(readGreyPng(path), cv::imread(path, kAnyGrey));
    expectSame(readGreyImage(path), cv::imread(path, cv::IMREAD_GRAYSCALE));
  }
}

TEST_F(GreyImageTest, ReadsThePixelsOfOpenCvFromPngsOfAnyKind) {
  for (const int interlacing : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
    for (const int colour_type : {PNG_COLOR_TYPE_GRAY,
                                  PNG_COLOR_TYPE_GRAY_ALPHA,
                                  PNG_COLOR_TYPE_PALETTE,
                                  PNG_COLOR_TYPE_RGB,
                                  PNG_COLOR_TYPE_RGB_ALPHA}) {
      for (const int bits : {1, 2, 4, 8, 16}) {
        const bool is_palette = colour_type == PNG_COLOR_TYPE_PALETTE;
        if (bits < 8 && !is_palette && colour_type != PNG_COLOR_TYPE_GRAY) continue;
        if (bits == 16 && is_palette) continue;
        SCOPED_TRACE(testing::Message() << "colour type " << colour_type << ", " << bits
                                        << " bits, interlacing " << interlacing);
        writePngOf({colour_type, bits, interlacing}, directory_ / "image.png");
        expectSame(readGreyPng(directory_ / "image.png"),
                   cv::imread(directory_ / "image.png", kAnyGrey));
      }
    }
  }
}

TEST_F(GreyImageTest, ReadsTheOtherFormatsOfOpenCv) {
  for (const std::string name :
       {"a.pgm", "a.jpg", "a.bmp", "a.tiff", "a.png_by_another_name.jpg"}) {
    SCOPED_TRACE(name);
    const std::string path = write(name, makeImage(CV_8UC1));
    expectSame(readGreyImage(path), cv::imread(path, cv::IMREAD_GRAYSCALE));
    expectSame(GreyImageReader().read(path), cv::imread(path, cv::IMREAD_GRAYSCALE));
  }
  const std::string colours = write("a.ppm", makeImage(CV_8UC3));
  expectSame(readGreyImage(colours), cv::imread(colours, cv::IMREAD_GRAYSCALE));
  std::filesystem::rename(directory_ / "a.pgm", directory_ / "b.png");
  expectSame(readGreyImage(directory_ / "b.png"), makeImage(CV_8UC1));
}

TEST_F(GreyImageTest, TakesTheUpperBitsOf16) {
  const cv::Mat image = makeImage(CV_16UC1);
  for (const std::string name : {"a.png", "a.tiff", "a.pgm"}) {
    const cv::Mat read = readGreyImage(write(name, image));
    ASSERT_EQ(read.size(), image.size()) << name;
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        ASSERT_EQ(read.at<uchar>(y, x), image.at<ushort>(y, x) >> 8) << name;
      }
    }
  }
}

TEST_F(GreyImageTest, RefusesATruncatedPng) {
  const std::string bytes = readFile(write("image.png", makeImage(CV_8UC1)));
  for (std::size_t size = 0; size < bytes.size(); size += 5) {
    directory_.write("image.png", bytes.substr(0, size));
    expectError<std::runtime_error>([&] { readGreyImage(directory_ / "image.png"); },
                                    directory_ / "image.png is not a readable image");
  }
  directory_.write("image.png", bytes.substr(0, bytes.size() / 2));
  expectError<std::runtime_error>([&] { readGreyImage(directory_ / "image.png"); },
                                  "(Read Error): is it incomplete or damaged? Copy it again");
}

TEST_F(GreyImageTest, ReadsOrRefusesADamagedPng) {
  const std::string bytes = readFile(write("image.png", makeImage(CV_16UC3, {16, 12})));
  for (std::size_t i = 8; i < bytes.size(); ++i) {  // behind the signature
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << i % 8));
    directory_.write("image.png", damaged);
    try {
      readGreyImage(directory_ / "image.png");
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("image.png is not a readable image ("),
                std::string::npos)
          << error.what();
    }
  }
}

TEST_F(GreyImageTest, NamesWhatIsNoImage) {
  const auto expectRefused = [&](const std::string& name, const std::string& part) {
    expectError<std::runtime_error>([&] { readGreyImage(directory_ / name); }, name + part);
  };
  expectRefused("none.png", " is missing");
  directory_.write("empty.png", "");
  expectRefused("empty.png", " is not a readable image: is it damaged, or no image? Copy it again");
  directory_.write("text.png", "no image");
  expectRefused("text.png", " is not a readable image");
  std::filesystem::create_directory(directory_ / "folder.png");
  expectRefused("folder.png", " is not a readable image");
}

TEST_F(GreyImageTest, RefusesMorePixelsThanOpenCv) {
  const std::string header(
      "\x89PNG\r\n\x1a\n"
      "\0\0\0\rIHDR\0\1\0\0\0\1\0\0\1\0\0\0\0\x44\xff\x0d\x4e"
      "\0\0\0\1IDAT",
      41);
  directory_.write("huge.png", header);
  expectError<std::runtime_error>(
      [&] { readGreyImage(directory_ / "huge.png"); },
      "huge.png is not a readable image (65536 x 65536 px are more than 2^30)");
}

TEST_F(GreyImageTest, WritesPngsThatOpenCvReads) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3}) {
    SCOPED_TRACE(type);
    const cv::Mat image = makeImage(type);
    const cv::Mat part = image(cv::Rect(3, 5, 20, 30));
    writePng(directory_ / "part.png", part);
    expectSame(cv::imread(directory_ / "part.png", cv::IMREAD_UNCHANGED), part);
  }
}

TEST_F(GreyImageTest, ReportsWhatItCannotWrite) {
  const cv::Mat image = makeImage(CV_8UC1);
  expectError<std::runtime_error>([&] { writePng("/dev/full", image); },
                                  "cannot write /dev/full: is the disk full?");
  expectError<std::runtime_error>([&] { writePng(directory_ / "none/a.png", image); },
                                  "none/a.png");
}

}  // namespace
}  // namespace rotrocc
