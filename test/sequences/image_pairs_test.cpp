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

TEST_F(ImagePairsTest, PairsAreLessThanHalfAPeriodApart) {
  const struct {
    std::vector<double> left_ms, right_ms;
    std::vector<std::int64_t> pairs_ms;
    const char* left_out;
  } rows[] = {
      {{0, 10, 20, 30}, {4, 14, 24, 34}, {0, 10, 20, 30}, ""},
      {{0, 10, 20, 30},  // half a period apart
       {0, 10, 15, 30},
       {0, 10, 30},
       "1 left image and 1 right image without a partner"},
      {{0, 10, 20, 30}, {0, 10, 16, 30}, {0, 10, 20, 30}, ""},
  };
  for (const auto& row : rows) {
    const ImagePairs pairs = match(row.left_ms, row.right_ms);
    std::vector<std::int64_t> stamps_ms = pairs.stamps_ns();
    for (std::int64_t& stamp : stamps_ms) stamp /= 1'000'000;
    EXPECT_EQ(stamps_ms, row.pairs_ms);
    EXPECT_EQ(pairs.leftOut(), row.left_out);
  }
  expectError<std::runtime_error>(
      [&] {
        match({0, 10, 20, 30}, {4, 14, 24, 34}, 0.003);
      },
      "none have stamps within 0.003 s (max_stamp_difference_s)");
}

}  // namespace
}  // namespace rotrocc
