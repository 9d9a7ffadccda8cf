#pragma once

#include <opencv2/core/utility.hpp>

#include "common/workers.h"

namespace rotrocc {

/// Calls body(row) for each row, in any order, on as many threads as OpenCV is to use.
/// (cv::parallel_for_ would do, but that ThreadSanitizer sees nothing of the threads of TBB.)
template <class Body>
void forEachRow(int rows, Body&& body) {
  Workers(cv::getNumThreads()).run(rows, body);
}

}  // namespace rotrocc
