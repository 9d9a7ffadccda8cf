#pragma once

#include <opencv2/core/utility.hpp>

namespace rotrocc {

/// Calls of(row) for each row below `rows`, each once, on all threads of OpenCV.
template <class Of>
void eachRow(int rows, const Of& of) {
  cv::parallel_for_({0, rows}, [&](const cv::Range& range) {
    for (int row = range.start; row < range.end; ++row) of(row);
  });
}

}  // namespace rotrocc
