#pragma once

#include <cmath>
#include <vector>

#include "check/checked_pair.h"
#include "check/rig_report.h"
#include "check/windows.h"

namespace rotrocc {

/// Compares the grey levels and the sharpness of the images where both show the same.
class PhotometryCheck {
 public:
  void observe(const CheckedPair& pair);

  /// Adds the section photometry, and gains, grey levels and sharpness over time.
  void report(const Windows& windows, RigReport& report) const;

 private:
  struct Levels {
    double mean, contrast, noise;  ///< grey levels; contrast and noise are standard deviations
    double saturated, dark;        ///< share of the pixels
  };
  /// Of one pair; nan if not measured.
  struct Row {
    double time_s = NAN;
    double gain = NAN, offset_grey = NAN, vignetting = NAN;
    double blur_px2 = NAN;  ///< variance of the Gaussian; negative if the left image is blurred
    Levels left = {}, right = {};
  };

  static Levels levelsOf(const cv::Mat& image);
  static void compare(const CheckedPair& pair, Row& row);
  static void compareSharpness(const CheckedPair& pair, Row& row);
  void addExposure(const Windows& windows, RigReport& report) const;
  void addLevels(const Windows& windows, RigReport& report) const;
  std::vector<TimedValue> course(double Row::*member) const;

  std::vector<Row> rows_;
};

}  // namespace rotrocc
