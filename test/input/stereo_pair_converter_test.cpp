#include "input/stereo_pair_converter.h"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>
#include <opencv2/imgcodecs.hpp>

#include "input/input_error.h"
#include "support/expect_error.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

using sensor_msgs::Image;

constexpr int kWidth = 24;
constexpr int kHeight = 18;

/// Bytes at each row's end that are no pixels.
constexpr int kPadding = 6;

/// An image whose pixels have these bytes, or of those of `bytes` in turn.
Image makeImage(const std::string& encoding, int bytes_per_pixel, const std::vector<int>& bytes) {
  Image image;
  image.header.stamp = ros::Time(12, 345);
  image.encoding = encoding;
  image.width = kWidth;
  image.height = kHeight;
  image.step = static_cast<std::uint32_t>(kWidth * bytes_per_pixel + kPadding);
  image.data.assign(std::size_t{image.step} * image.height, 255);
  std::size_t next = 0;
  for (std::size_t y = 0; y < image.height; ++y) {
    for (int i = 0; i < kWidth * bytes_per_pixel; ++i) {
      const int byte = bytes[next++ % bytes.size()];
      image.data[y * image.step + static_cast<std::size_t>(i)] = static_cast<unsigned char>(byte);
    }
  }
  return image;
}

Image makeGrayImage(const std::vector<int>& levels = {7, 100, 200, 33, 255}) {
  return makeImage("mono8", 1, levels);
}

Image makeImage16(const std::vector<int>& values, bool big_endian = false) {
  std::vector<int> bytes;
  for (const int value : values) {
    bytes.push_back(big_endian ? value >> 8 : value & 255);
    bytes.push_back(big_endian ? value & 255 : value >> 8);
  }
  Image image = makeImage("mono16", 2, bytes);
  image.is_bigendian = big_endian;
  return image;
}

/// A scene of one color through a Bayer filter, named by the colors of the first two rows.
Image makeBayerImage(const std::string& filter, int red, int green, int blue) {
  std::vector<int> bytes;
  for (int i = 0; i < 2 * kWidth; ++i) {
    const char color = filter[static_cast<std::size_t>(2 * (i / kWidth) + i % 2)];
    bytes.push_back(color == 'r' ? red : color == 'g' ? green : blue);
  }
  return makeImage("bayer_" + filter + "8", 1, bytes);
}

StereoPair convert(StereoPairConverter& converter, const Image& left, const Image& right) {
  ReceivedPair received;
  received.images = {boost::make_shared<Image>(left), boost::make_shared<Image>(right)};
  received.camera.width = kWidth;
  received.camera.height = kHeight;
  StereoPair pair = converter.convert(received);
  pair.left = pair.left.clone();  // the messages are gone
  pair.right = pair.right.clone();
  return pair;
}

StereoPair convert(const Image& left, const Image& right) {
  StereoPairConverter converter;
  return convert(converter, left, right);
}

double difference(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() ? cv::norm(a, b, cv::NORM_INF) : 1e9;
}

TEST(StereoPairConverterTest, GrayImagesAreNotCopied) {
  ReceivedPair received;
  received.camera.width = kWidth;
  received.camera.height = kHeight;
  Image right = makeGrayImage();
  right.encoding = "8UC1";
  received.images = {boost::make_shared<Image>(makeGrayImage()), boost::make_shared<Image>(right)};
  const StereoPair pair = StereoPairConverter().convert(received);
  EXPECT_EQ(pair.left.data, received.images.left->data.data());
  EXPECT_EQ(pair.right.data, received.images.right->data.data());
  EXPECT_EQ(pair.left.size(), cv::Size(kWidth, kHeight));
  EXPECT_EQ(pair.left.type(), CV_8UC1);
  EXPECT_EQ(pair.left.at<uchar>(1, 0), received.images.left->data[kWidth + kPadding]);
  EXPECT_EQ(pair.stamp_ns, 12'000'000'345);
}

TEST(StereoPairConverterTest, PairsHaveTheMasksOfTheirSides) {
  const TemporaryDirectory directory;
  cv::Mat gray(kHeight, kWidth, CV_8UC1, cv::Scalar(0));
  gray.at<uchar>(3, 5) = 1;
  cv::Mat color(kHeight, kWidth, CV_16UC4, cv::Scalar(0, 0, 0, 65535));
  color.at<cv::Vec4w>(2, 1)[0] = 65535;
  cv::imwrite(directory / "left.png", gray);
  cv::imwrite(directory / "right.png", color);
  const auto convertWith = [&](const std::string& mask) {
    StereoPairConverter converter(0, directory / mask);
    return convert(converter, makeGrayImage(), makeGrayImage());
  };
  const StereoPair pair = convertWith("%s.png");
  EXPECT_EQ(difference(pair.left_mask, gray > 0), 0.0);
  EXPECT_EQ(cv::countNonZero(pair.right_mask), 1);
  EXPECT_EQ(pair.right_mask.at<uchar>(2, 1), 255);
  EXPECT_EQ(difference(convertWith("left.png").right_mask, gray > 0), 0.0) << "one for both";

  cv::imwrite(directory / "right.png", gray.colRange(0, kWidth - 1));
  expectError<InputError>([&] { convertWith("%s.png"); }, "right.png is 23x18 px");
  expectError<std::runtime_error>([&] { convertWith("other_%s.png"); },
                                  "other_left.png is missing; check the parameter mask");
}

TEST(StereoPairConverterTest, ColorsBecomeLuma) {
  // ITU-R BT.601: 0.299 * 200 + 0.587 * 100 + 0.114 * 50 = 124.2
  constexpr int kRed = 200, kGreen = 100, kBlue = 50, kLuma = 124;
  const Image images[] = {makeImage("rgb8", 3, {kRed, kGreen, kBlue}),
                          makeImage("bgra8", 4, {kBlue, kGreen, kRed, 7}),
                          makeImage("8UC3", 3, {kBlue, kGreen, kRed}),
                          makeImage("8UC4", 4, {kBlue, kGreen, kRed, 7}),
                          makeImage("yuv422", 2, {90, kLuma, 180, kLuma}),
                          makeImage("yuv422_yuy2", 2, {kLuma, 90, kLuma, 180}),
                          makeBayerImage("rggb", kRed, kGreen, kBlue),
                          makeBayerImage("gbrg", kRed, kGreen, kBlue)};
  for (const Image& image : images) {
    const StereoPair pair = convert(image, makeGrayImage({kLuma}));
    EXPECT_LE(difference(pair.left, pair.right), 1.0) << image.encoding << ": rounded twice";
  }
}

TEST(StereoPairConverterTest, BayerPatternsOfSixteenBitsAreThoseOfEight) {
  const Image narrow = makeBayerImage("grbg", 255, 100, 50);
  Image wide = narrow;
  wide.encoding = "bayer_grbg16";
  wide.step = 2 * narrow.step;
  wide.data.clear();
  for (const unsigned char level : narrow.data) wide.data.insert(wide.data.end(), {17, level});
  StereoPairConverter converter(16);
  const StereoPair pair = convert(converter, wide, narrow);
  EXPECT_EQ(difference(pair.left, pair.right), 0.0);
}

TEST(StereoPairConverterTest, DataAfterTheLastRowAreIgnored) {
  for (Image image : {makeGrayImage(), makeImage("bgr8", 3, {1, 2, 3, 50}), makeImage16({700})}) {
    const Image plain = image;
    image.data.resize(image.data.size() + 99);
    const StereoPair pair = convert(image, plain);
    EXPECT_EQ(difference(pair.left, pair.right), 0.0) << image.encoding;
  }
}

TEST(StereoPairConverterTest, SixteenBitsAreScaledInBothByteOrders) {
  const std::vector<int> values = {0, 255, 256, 40000, 65535};
  const StereoPair pair = convert(makeImage16(values), makeImage16(values, true));
  EXPECT_EQ(difference(pair.left, pair.right), 0.0);
  const std::vector<uchar> row(pair.left.ptr(0), pair.left.ptr(0) + values.size());
  EXPECT_EQ(row, (std::vector<uchar>{0, 0, 1, 156, 255}));
}

TEST(StereoPairConverterTest, TwelveBitsKeepTheirContrast) {
  StereoPairConverter converter;
  const Image dark = makeImage16({0, 1023});
  const Image bright = makeImage16({0, 1023, 4095});
  // The scale of a pair is that of its brighter image ...
  StereoPair pair = convert(converter, dark, bright);
  EXPECT_EQ(pair.left.at<uchar>(0, 1), 63);
  EXPECT_EQ(pair.right.at<uchar>(0, 1), 63);
  EXPECT_EQ(pair.right.at<uchar>(0, 2), 255);
  // ... stays when it gets dark for a moment ...
  for (std::size_t i = 1; i < StereoPairConverter::kShrinkPairs; ++i) {
    EXPECT_EQ(convert(converter, dark, dark).left.at<uchar>(0, 1), 63);
  }
  // ... and then has all levels for the dark image.
  EXPECT_EQ(convert(converter, dark, dark).left.at<uchar>(0, 1), 255);
  EXPECT_EQ(converter.grayRange().bits, 10);
  // The range of the brighter image is back after two pairs; before, it is white.
  EXPECT_EQ(convert(converter, bright, bright).left.at<uchar>(0, 2), 255);
  EXPECT_EQ(convert(converter, bright, bright).left.at<uchar>(0, 1), 63);
  StereoPairConverter known(12);
  EXPECT_EQ(convert(known, dark, dark).left.at<uchar>(0, 1), 63);
}

TEST(StereoPairConverterTest, AThermalImageKeepsItsContrast) {
  const Image cold = makeImage16({7000, 7100, 7200});
  const Image warm = makeImage16({7040, 7140, 7240});
  StereoPairConverter converter;
  const StereoPair pair = convert(converter, cold, warm);
  EXPECT_EQ(pair.left.at<uchar>(0, 1) - pair.left.at<uchar>(0, 0), 50);
  EXPECT_EQ(pair.right.at<uchar>(0, 0) - pair.left.at<uchar>(0, 0), 20) << "both have one scale";
  EXPECT_EQ(converter.grayRange().black, 6940);
  EXPECT_EQ(converter.grayRange().bits, 9);
  // A shutter before the sensor does not change it, nor does a slow drift.
  convert(converter, makeImage16({9000}), makeImage16({9000}));
  EXPECT_EQ(converter.grayRange().black, 6940);
  for (int i = 0; i < 40; ++i) {
    const int drift = 10 * i;
    const StereoPair later = convert(converter,
                                     makeImage16({7000 + drift, 7100 + drift, 7200 + drift}),
                                     makeImage16({7040 + drift, 7140 + drift, 7240 + drift}));
    EXPECT_GE(later.left.at<uchar>(0, 1) - later.left.at<uchar>(0, 0), 50);
    EXPECT_LT(later.right.at<uchar>(0, 2), 255);
  }
  StereoPairConverter known(16);
  convert(known, cold, cold);
  EXPECT_EQ(known.grayRange().black, 0);
}

TEST(StereoPairConverterTest, ABadImageOrAFewBadPixelsDoNotBlindIt) {
  const Image good = makeImage16({0, 300, 1023});
  Image hot = good;
  for (std::size_t x = 0; x < kWidth * kHeight / 100; ++x) hot.data[2 * x + 1] = 255;
  StereoPairConverter converter;
  convert(converter, makeGrayImage(), makeGrayImage());  // says nothing of 16 bits
  for (const Image& image : {good, hot, makeImage16({65535}), good, hot}) {
    EXPECT_EQ(convert(converter, image, good).right.at<uchar>(0, 1), 75);
    EXPECT_EQ(converter.grayRange().bits, 10);
  }
  convert(converter, makeGrayImage(), makeGrayImage());
  EXPECT_EQ(converter.grayRange().bits, 8);
}

/// Other malformed images are rows of BadInputsTest.
TEST(StereoPairConverterTest, RejectsImagesOfEitherSide) {
  const struct {
    std::function<void(Image&)> change;
    const char* part;
  } kCases[] = {
      {[](Image& i) { i.height = 8; }, "image is 24x8 px, but each side"},
      {[](Image& i) { i.data.pop_back(); }, "539 bytes of data, but 18 rows of 30 bytes take 540"},
      {[](Image& i) { i.encoding = "bayer_rggb16"; },
       "step of 30 bytes, but 24 px of bayer_rggb16"},
      {[](Image& i) { i.encoding = "yuv422_yuy2"; }, "24 px of yuv422_yuy2 take 48"},
      {[](Image& i) { i.encoding = "8UC0"; }, "\"8UC0\", but must be one of"},
      {[](Image& i) { i.encoding = "8SC1"; }, "\"8SC1\", but must be one of"},
      {[](Image& i) { i.encoding = "\x1b[2J\n" + std::string(1000, 'x'); }, "\"?[2J?xxx"}};
  const Image good = makeGrayImage();
  for (const auto& row : kCases) {
    Image bad = good;
    row.change(bad);
    expectError<InputError>([&] { convert(bad, good); }, row.part);
    expectError<InputError>([&] { convert(good, bad); }, row.part);
  }
}

}  // namespace
}  // namespace rotrocc
