#pragma once

#include <opencv2/core/utility.hpp>

#include "common/workers.h"

namespace rotrocc {

/// Calls body(row) for each row, in any order, on OpenCV's number of threads. (Not
/// cv::parallel_for_, because ThreadSanitizer cannot see the threads of TBB.)
template <class Body>
void forEachRow(int rows, Body&& body) {
  Workers(cv::getNumThreads()).run(rows, body);
}

}  // namespace rotrocc
