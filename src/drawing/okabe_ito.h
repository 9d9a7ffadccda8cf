#pragma once

#include <opencv2/core.hpp>

/// Colors (BGR) distinguishable with color blindness: Okabe and Ito, "Color universal design"
/// (2002).
namespace rotrocc::okabe_ito {

const cv::Scalar kOrange(0, 159, 230);
const cv::Scalar kSkyBlue(233, 180, 86);
const cv::Scalar kGreen(115, 158, 0);
const cv::Scalar kVermillion(0, 94, 213);
const cv::Scalar kBlack(0, 0, 0);

}  // namespace rotrocc::okabe_ito
