#include <immintrin.h>

#include "kernels/sad_kernels.h"

namespace rotrocc::avx2 {
namespace {

constexpr int kWindow = SadSearch::kWindow;
static_assert(kWindow == 11 && SadSearch::kGroup == 16);

__m128i load16(const std::uint8_t* pixels) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(pixels));
}

/// The pixels of eight consecutive windows that start here, and of the next eight.
__m256i loadGroup(const std::uint8_t* pixels) {
  return _mm256_inserti128_si256(_mm256_castsi128_si256(load16(pixels)), load16(pixels + 8), 1);
}

/// Sums of differences over four pixels, for 16 windows each: the pixels from `kFrom` (0 or 4) on
/// and block `kBlock` of four left pixels.
template <int kFrom, int kBlock>
__m256i sumsOfFour(__m256i group, __m256i left) {
  constexpr int kOfEight = (kFrom == 4 ? 4 : 0) + kBlock;
  return _mm256_mpsadbw_epu8(group, left, 9 * kOfEight);
}

/// Whether each value is at most the limit: -1 or 0.
__m256i atMost(__m256i a, __m256i limit) {
  return _mm256_cmpeq_epi16(_mm256_min_epi16(a, limit), a);
}

int leastOf(__m256i a) {
  const __m128i eight = _mm_min_epi16(_mm256_castsi256_si128(a), _mm256_extracti128_si256(a, 1));
  return _mm_extract_epi16(_mm_minpos_epu16(eight), 0);  // no value is negative
}

/// The part that is compared first: four rows of eight pixels.
class PartOfWindow {
 public:
  explicit PartOfWindow(const SadSearch& search) : step_(search.right_step) {
    for (int i = 0; i < 4; ++i) {
      rows_[i] = _mm256_broadcastsi128_si256(
          load16(search.left + kPartRows[i] * search.left_step + kPartEdge));
    }
  }

  __m256i costs(const std::uint8_t* right) const {
    __m256i sum = _mm256_setzero_si256();
    for (int i = 0; i < 4; ++i) {
      const __m256i group = loadGroup(right + kPartRows[i] * step_ + kPartEdge);
      sum = _mm256_add_epi16(sum, sumsOfFour<0, 0>(group, rows_[i]));
      sum = _mm256_add_epi16(sum, sumsOfFour<4, 1>(group, rows_[i]));
    }
    return sum;
  }

 private:
  std::ptrdiff_t step_;
  __m256i rows_[4];
};

/// Eleven pixels of a row are computed as three blocks of four. The eighth pixel is counted twice
/// and subtracted once.
class WholeWindow {
 public:
  explicit WholeWindow(const SadSearch& search) : step_(search.right_step) {
    const __m128i thrice_four = _mm_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 7, 8, 9, 10, -1, -1, -1, -1);
    const std::uint8_t* left = search.left;
    for (int i = 0; i < kWindow; ++i, left += search.left_step) {
      rows_[i] = _mm256_broadcastsi128_si256(_mm_shuffle_epi8(load16(left), thrice_four));
      eighths_[i] = _mm256_set1_epi16(left[7]);
    }
  }

  __m256i costs(const std::uint8_t* right) const {
    __m256i sum = _mm256_setzero_si256();
    for (int i = 0; i < kWindow; ++i, right += step_) {
      const __m256i group = loadGroup(right);
      sum = _mm256_add_epi16(sum, sumsOfFour<0, 0>(group, rows_[i]));
      sum = _mm256_add_epi16(sum, sumsOfFour<4, 1>(group, rows_[i]));
      sum = _mm256_add_epi16(sum, sumsOfFour<4, 2>(loadGroup(right + 3), rows_[i]));
      const __m256i eighth = _mm256_cvtepu8_epi16(load16(right + 7));
      sum = _mm256_sub_epi16(sum, _mm256_abs_epi16(_mm256_sub_epi16(eighth, eighths_[i])));
    }
    return sum;
  }

 private:
  std::ptrdiff_t step_;
  __m256i rows_[kWindow];
  __m256i eighths_[kWindow];
};

}  // namespace

void sadCosts(const SadSearch& search, std::int16_t* costs) {
  const auto groupOf = [&](int k) { return reinterpret_cast<__m256i*>(costs + k); };
  const __m256i high = _mm256_set1_epi16(SadSearch::kHigh);
  const __m256i order = _mm256_setr_epi16(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const PartOfWindow part(search);
  __m256i least = high;
  for (int k = 0; k < search.count; k += SadSearch::kGroup) {
    const __m256i beyond =
        _mm256_cmpgt_epi16(order, _mm256_set1_epi16(static_cast<short>(search.count - 1 - k)));
    const __m256i sums = _mm256_blendv_epi8(part.costs(search.right + k), high, beyond);
    least = _mm256_min_epi16(least, sums);
    _mm256_storeu_si256(groupOf(k), sums);
  }
  const int limit = partLimit(leastOf(least));
  const __m256i limits = _mm256_set1_epi16(static_cast<short>(limit));
  const WholeWindow whole(search);
  for (int k = 0; k < search.count; k += SadSearch::kGroup) {
    const __m256i wanted = atMost(_mm256_loadu_si256(groupOf(k)), limits);
    __m256i sums = high;
    if (_mm256_movemask_epi8(wanted) != 0) {
      sums = _mm256_blendv_epi8(high, whole.costs(search.right + k), wanted);
    }
    _mm256_storeu_si256(groupOf(k), sums);
  }
}

int sadCost(const SadSearch& search, int k) {
  return _mm_extract_epi16(_mm256_castsi256_si128(WholeWindow(search).costs(search.right + k)), 0);
}

}  // namespace rotrocc::avx2
