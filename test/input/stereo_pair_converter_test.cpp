#include "input/stereo_pair_converter.h"

#include <string>

#include <gtest/gtest.h>
#include <sensor_msgs/image_encodings.h>
#include <opencv2/imgcodecs.hpp>

#include "input/input_error.h"
#include "input/to_text.h"
#include "support/expect_error.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

constexpr int kWidth = 24;
constexpr int kHeight = 18;

/// An image of `bytes_per_pixel` whose bytes are a pattern, with `padding` more bytes at each row's
/// end.
sensor_msgs::Image makeImage(const std::string& encoding, int bytes_per_pixel, int padding = 0) {
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(12, 345);
  image.encoding = encoding;
  image.width = kWidth;
  image.height = kHeight;
  image.step = static_cast<std::uint32_t>(kWidth * bytes_per_pixel + padding);
  image.data.assign(std::size_t{image.step} * image.height, 255);
  for (int y = 0; y < kHeight; ++y) {
    for (int i = 0; i < kWidth * bytes_per_pixel; ++i) {
      image.data[y * image.step + i] = static_cast<unsigned char>(7 * y + 3 * i);
    }
  }
  return image;
}

/// An image of one colour.
sensor_msgs::Image makePlainImage(const std::string& encoding, const std::vector<int>& pixel) {
  sensor_msgs::Image image = makeImage(encoding, static_cast<int>(pixel.size()));
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = static_cast<unsigned char>(pixel[i % pixel.size()]);
  }
  return image;
}

/// A scene of one colour through a Bayer filter, named by the colours of the first two rows.
sensor_msgs::Image makeBayerImage(const std::string& filter, int red, int green, int blue) {
  sensor_msgs::Image image = makeImage("bayer_" + filter + "8", 1);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const char colour = filter[static_cast<std::size_t>(2 * (y % 2) + x % 2)];
      image.data[y * image.step + x] = static_cast<unsigned char>(colour == 'r'   ? red
                                                                  : colour == 'g' ? green
                                                                                  : blue);
    }
  }
  return image;
}

sensor_msgs::Image makeImage16(const std::vector<int>& values, bool big_endian) {
  sensor_msgs::Image image = makeImage(sensor_msgs::image_encodings::MONO16, 2);
  image.is_bigendian = big_endian;
  for (std::size_t i = 0; i < image.data.size() / 2; ++i) {
    const int value = values[i % values.size()];
    image.data[2 * i + (big_endian ? 0 : 1)] = static_cast<unsigned char>(value >> 8);
    image.data[2 * i + (big_endian ? 1 : 0)] = static_cast<unsigned char>(value & 255);
  }
  return image;
}

/// Two bytes for each pixel, in padded rows: its level in an image with one, and another one.
sensor_msgs::Image widen(const sensor_msgs::Image& narrow,
                         const std::string& encoding,
                         bool level_first) {
  sensor_msgs::Image image = narrow;
  image.encoding = encoding;
  image.is_bigendian = level_first;
  image.step = 2 * narrow.step + 6;
  image.data.assign(std::size_t{image.step} * image.height, 255);
  for (std::size_t y = 0; y < image.height; ++y) {
    for (std::size_t x = 0; x < image.width; ++x) {
      unsigned char* pixel = &image.data[y * image.step + 2 * x];
      pixel[level_first ? 0 : 1] = narrow.data[y * narrow.step + x];
      pixel[level_first ? 1 : 0] = static_cast<unsigned char>(90 * (x + y));
    }
  }
  return image;
}

bool equal(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

TEST(StereoPairConverterTest, GreyImagesAreNotCopied) {
  const sensor_msgs::Image left = makeImage("mono8", 1);
  const sensor_msgs::Image right = makeImage("8UC1", 1);
  const StereoPair pair = StereoPairConverter().convert(left, right);
  EXPECT_EQ(pair.left.data, left.data.data());
  EXPECT_EQ(pair.right.data, right.data.data());
  EXPECT_EQ(pair.left.size(), cv::Size(kWidth, kHeight));
  EXPECT_EQ(pair.left.type(), CV_8UC1);
  EXPECT_EQ(pair.stamp_ns, 12'000'000'345);
}

TEST(StereoPairConverterTest, PairsHaveTheMasksOfTheirSides) {
  const TemporaryDirectory directory;
  cv::Mat grey(kHeight, kWidth, CV_8UC1, cv::Scalar(0));
  grey.at<uchar>(3, 5) = 1;
  cv::Mat colour(kHeight, kWidth, CV_16UC4, cv::Scalar(0, 0, 0, 65535));
  colour.at<cv::Vec4w>(2, 1)[0] = 65535;
  cv::imwrite(directory / "left.png", grey);
  cv::imwrite(directory / "right.png", colour);
  const auto convert = [&](const std::string& mask) {
    StereoPairConverter converter(0, directory / mask);
    return converter.convert(makeImage("mono8", 1), makeImage("bgr8", 3));
  };
  const StereoPair pair = convert("%s.png");
  EXPECT_TRUE(equal(pair.left_mask, grey > 0));
  EXPECT_EQ(cv::countNonZero(pair.right_mask), 1);
  EXPECT_EQ(pair.right_mask.at<uchar>(2, 1), 255);
  EXPECT_TRUE(equal(convert("left.png").right_mask, grey > 0)) << "one for both";

  cv::imwrite(directory / "right.png", grey.colRange(0, kWidth - 1));
  expectError<InputError>([&] { convert("%s.png"); },
                          "right.png is " + sizeText(kWidth - 1, kHeight));
  expectError<std::runtime_error>([&] { convert("other_%s.png"); }, "other_left.png cannot be");
}

TEST(StereoPairConverterTest, PaddingOfRowsAndDataIsIgnored) {
  for (const auto& [encoding, bytes] : {std::pair{"mono8", 1}, {"bgr8", 3}, {"mono16", 2}}) {
    StereoPairConverter converter;
    sensor_msgs::Image padded = makeImage(encoding, bytes, 5);
    padded.data.resize(padded.data.size() + 99);
    const sensor_msgs::Image plain = makeImage(encoding, bytes);
    const StereoPair pair = converter.convert(padded, plain);
    EXPECT_TRUE(equal(pair.left, pair.right)) << encoding;
  }
}

TEST(StereoPairConverterTest, ColourBecomesLuma) {
  // ITU-R BT.601: 0.299 * 200 + 0.587 * 100 + 0.114 * 50 = 124.2
  constexpr int kRed = 200, kGreen = 100, kBlue = 50, kLuma = 124;
  const std::vector<sensor_msgs::Image> images = {makePlainImage("rgb8", {kRed, kGreen, kBlue}),
                                                  makePlainImage("bgr8", {kBlue, kGreen, kRed}),
                                                  makePlainImage("rgba8", {kRed, kGreen, kBlue, 7}),
                                                  makePlainImage("bgra8", {kBlue, kGreen, kRed, 7}),
                                                  makeBayerImage("rggb", kRed, kGreen, kBlue),
                                                  makeBayerImage("bggr", kRed, kGreen, kBlue),
                                                  makeBayerImage("gbrg", kRed, kGreen, kBlue),
                                                  makeBayerImage("grbg", kRed, kGreen, kBlue)};
  const sensor_msgs::Image grey = makePlainImage("mono8", {kLuma});
  for (const sensor_msgs::Image& image : images) {
    StereoPairConverter converter;
    const StereoPair pair = converter.convert(image, grey);
    // Demosaicing rounds once more.
    EXPECT_LE(cv::norm(pair.left, pair.right, cv::NORM_INF), 1.0) << image.encoding;
  }
}

TEST(StereoPairConverterTest, GreyLevelsOfYuvAreThoseOfItsLuma) {
  const sensor_msgs::Image grey = makeImage("mono8", 1);
  for (const auto& [encoding, grey_first] : {std::pair{"yuv422", false}, {"yuv422_yuy2", true}}) {
    StereoPairConverter converter;
    const StereoPair pair = converter.convert(widen(grey, encoding, grey_first), grey);
    EXPECT_TRUE(equal(pair.left, pair.right)) << encoding;
  }
}

TEST(StereoPairConverterTest, BayerPatternsOfSixteenBitsAreThoseOfEight) {
  for (const char* filter : {"rggb", "bggr", "gbrg", "grbg"}) {
    const sensor_msgs::Image bayer8 = makeBayerImage(filter, 255, 100, 50);
    const std::string encoding = "bayer_" + std::string(filter) + "16";
    StereoPairConverter converter(16);
    const cv::Mat grey = converter.convert(bayer8, bayer8).left.clone();
    const StereoPair pair =
        converter.convert(widen(bayer8, encoding, false), widen(bayer8, encoding, true));
    EXPECT_TRUE(equal(pair.left, grey)) << filter;
    EXPECT_TRUE(equal(pair.right, grey)) << filter;
  }
}

TEST(StereoPairConverterTest, SixteenBitsAreScaledInBothByteOrders) {
  const std::vector<int> values = {0, 255, 256, 40000, 65535};
  const sensor_msgs::Image little = makeImage16(values, false);
  const sensor_msgs::Image big = makeImage16(values, true);
  StereoPairConverter converter;
  const StereoPair pair = converter.convert(little, big);
  EXPECT_TRUE(equal(pair.left, pair.right));
  EXPECT_EQ(pair.left.at<unsigned char>(0, 1), 0);
  EXPECT_EQ(pair.left.at<unsigned char>(0, 2), 1);
  EXPECT_EQ(pair.left.at<unsigned char>(0, 3), 156);
  EXPECT_EQ(pair.left.at<unsigned char>(0, 4), 255);
}

TEST(StereoPairConverterTest, TwelveBitsKeepTheirContrast) {
  StereoPairConverter converter;
  const sensor_msgs::Image dark = makeImage16({0, 1023}, false);
  const sensor_msgs::Image bright = makeImage16({0, 1023, 4095}, false);
  // The scale of a pair is that of its brighter image ...
  StereoPair pair = converter.convert(dark, bright);
  EXPECT_EQ(pair.left.at<unsigned char>(0, 1), 63);
  EXPECT_EQ(pair.right.at<unsigned char>(0, 1), 63);
  EXPECT_EQ(pair.right.at<unsigned char>(0, 2), 255);
  // ... stays when it gets dark for a moment ...
  for (std::size_t i = 1; i < StereoPairConverter::kShrinkPairs; ++i) {
    pair = converter.convert(dark, dark);
    EXPECT_EQ(pair.left.at<unsigned char>(0, 1), 63);
  }
  // ... and then has all levels for the dark image.
  EXPECT_EQ(converter.convert(dark, dark).left.at<unsigned char>(0, 1), 255);
  EXPECT_EQ(converter.significantBits(), 10);
  // The range of the brighter image is back after two pairs; before, it is white.
  EXPECT_EQ(converter.convert(bright, bright).left.at<unsigned char>(0, 2), 255);
  EXPECT_EQ(converter.convert(bright, bright).left.at<unsigned char>(0, 1), 63);
}

TEST(StereoPairConverterTest, ABadImageOrAFewBadPixelsDoNotBlindIt) {
  const sensor_msgs::Image good = makeImage16({0, 300, 1023}, false);
  sensor_msgs::Image hot = good;
  for (std::size_t x = 0; x < kWidth * kHeight / 100; ++x) hot.data[2 * x + 1] = 255;
  StereoPairConverter converter;
  for (const sensor_msgs::Image& image : {good, hot, makeImage16({65535}, false), good, hot}) {
    const StereoPair pair = converter.convert(image, good);
    EXPECT_EQ(pair.right.at<unsigned char>(0, 1), 75);
    EXPECT_EQ(converter.significantBits(), 10);
  }
}

TEST(StereoPairConverterTest, ImagesOf8BitsSayNothingOfThe16BitsOfOthers) {
  StereoPairConverter converter;
  const sensor_msgs::Image narrow = makeImage("mono8", 1);
  const sensor_msgs::Image wide = makeImage16({0, 300, 1023}, false);
  converter.convert(narrow, narrow);
  EXPECT_EQ(converter.convert(wide, wide).left.at<unsigned char>(0, 1), 75);
  converter.convert(narrow, narrow);
  EXPECT_EQ(converter.significantBits(), 8);
}

TEST(StereoPairConverterTest, KnownBitsAreKept) {
  StereoPairConverter converter(12);
  const sensor_msgs::Image dark = makeImage16({0, 300, 1023}, false);
  EXPECT_EQ(converter.convert(dark, dark).left.at<unsigned char>(0, 2), 63);
}

TEST(StereoPairConverterTest, MemoryIsUsedAgain) {
  StereoPairConverter converter;
  const sensor_msgs::Image image = makeImage("bgr8", 3);
  const unsigned char* memory = converter.convert(image, image).left.data;
  EXPECT_EQ(converter.convert(image, image).left.data, memory);
}

/// Other malformed images are rows of BadInputsTest.
TEST(StereoPairConverterTest, RefusesMalformedImagesOfEitherSide) {
  const sensor_msgs::Image good = makeImage("mono8", 1);
  const auto expectRefused = [&](const sensor_msgs::Image& image, const std::string& part) {
    expectError<InputError>([&] { StereoPairConverter().convert(image, good); }, part);
    expectError<InputError>([&] { StereoPairConverter().convert(good, image); }, part);
  };
  sensor_msgs::Image image = good;
  image.width = image.height = image.step = 8;
  expectRefused(image, "image is 8x8 px");
  image = good;
  image.data.pop_back();
  expectRefused(image, "431 bytes of data, but 18 rows of 24 bytes take 432");
  image = good;
  for (const char* encoding : {"yuv422", "bayer_rggb16"}) {
    image.encoding = encoding;
    expectRefused(image, "step of 24 bytes, but 24 px of " + image.encoding + " take 48");
  }
  image = good;
  image.width = image.step = 5000;
  image.height = 4001;
  expectRefused(image, "5000x4001 px, more than 20000000 pixels");
}

TEST(StereoPairConverterTest, TextOfStrangersIsFitForALog) {
  sensor_msgs::Image image = makeImage("mono8", 1);
  image.encoding = "\x1b[2J\n" + std::string(1000, 'x');
  try {
    StereoPairConverter().convert(image, image);
    ADD_FAILURE();
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("encoding \"?[2J?xxx"), std::string::npos) << text;
    EXPECT_LT(text.size(), 300u);
  }
}

}  // namespace
}  // namespace rotrocc
