#include "sequences/image_pairs.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

/// Images with stamps in milliseconds, whose files exist.
class ImagePairsTest : public ::testing::Test {
 protected:
  std::vector<StampedImage> images(const std::string& side,
                                   const std::vector<double>& stamps_ms) const {
    std::vector<StampedImage> images;
    for (const double stamp_ms : stamps_ms) {
      const std::string name = side + std::to_string(images.size());
      images.push_back({static_cast<std::int64_t>(1e6 * stamp_ms), directory_.write(name, "")});
    }
    return images;
  }

  ImagePairs match(const std::vector<double>& left_ms,
                   const std::vector<double>& right_ms,
                   double max_difference_s = 0.01) const {
    return {images("left", left_ms), images("right", right_ms), max_difference_s};
  }

  TemporaryDirectory directory_;
};

TEST_F(ImagePairsTest, MatchesTheNearest) {
  const ImagePairs pairs = match({0, 50, 100, 150}, {1, 49, 98, 152});
  EXPECT_EQ(pairs.size(), 4);
  EXPECT_EQ(pairs.stamp_ns(2), 100'000'000);
  EXPECT_EQ(pairs.leftOut(), "");
}

TEST_F(ImagePairsTest, LostImagesDoNotShiftTheOthers) {
  const ImagePairs pairs = match({0, 50, 150, 200}, {0, 100, 150, 200, 250});
  EXPECT_EQ(pairs.stamps_ns(), (std::vector<std::int64_t>{0, 150'000'000, 200'000'000}));
  EXPECT_EQ(pairs.leftOut(), "1 left image and 2 right images without a partner");
}

TEST_F(ImagePairsTest, ImagesHalfAPeriodApartAreNoPair) {
  EXPECT_EQ(match({0, 10, 20, 30}, {0, 10, 15, 30}, 0.01).size(), 3);
  EXPECT_EQ(match({0, 10, 20, 30}, {0, 10, 16, 30}, 0.01).size(), 4);
  EXPECT_EQ(match({0, 10, 20, 30}, {4, 14, 24, 34}, 0.01).size(), 4);
  expectError<std::runtime_error>(
      [&] {
        match({0, 10, 20, 30}, {4, 14, 24, 34}, 0.003);
      },
      "none have stamps within 0.003 s (max_stamp_difference_s)");
}

TEST_F(ImagePairsTest, AnImageHasOnePartner) {
  const ImagePairs pairs = match({0, 4, 100, 200}, {3}, 0.01);
  ASSERT_EQ(pairs.size(), 1);
  EXPECT_EQ(pairs.stamp_ns(0), 4'000'000) << "the nearer one";
}

}  // namespace
}  // namespace rotrocc
