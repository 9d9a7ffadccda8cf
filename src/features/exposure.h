#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

/// Differences in exposure between two images: of two cameras, or of one camera over time.
namespace rotrocc {

/// A grey level of one image as a function of that of another: gain * level + offset.
struct Exposure {
  double gain = 1.0;
  double offset = 0.0;  ///< [grey levels]
};

/// The exposure of `to` relative to `from`, from pixels at the same positions. Both images are
/// CV_8UC1, of the same size, and show about the same scene. On KITTI, the gain is accurate to 3 %.
Exposure compareExposures(const cv::Mat& from, const cv::Mat& to);

/// The gain from one image to another, from windows that show the same.
class WindowGain {
 public:
  /// Number of windows that suffice.
  static constexpr std::size_t kSample = 64;

  /// Noise of the logarithm of the gain, 2 sigma on real clips: of two cameras, and of one camera
  /// over time at a low rate, where what comes nearer changes its contrast.
  static constexpr double kStereoNoise = 0.05;
  static constexpr double kTemporalNoise = 0.2;

  WindowGain() { gains_.reserve(2 * kSample); }

  /// The step through a list of this size that gives a sample: all of a short list, and fewer than
  /// 2 kSample of a long one.
  static std::size_t step(std::size_t count) { return count < kSample ? 1 : count / kSample; }

  void clear() { gains_.clear(); }

  /// Compares the windows around two points. Does nothing if a window leaves its image.
  void add(const cv::Mat& from,
           const cv::Point2f& from_px,
           const cv::Mat& to,
           const cv::Point2f& to_px);

  /// `otherwise` if there are too few windows.
  double median(double otherwise);

 private:
  std::vector<float> gains_;
};

/// The gain, or 1 if its logarithm is below `noise`: equal exposures remain equal.
double beyondNoise(double gain, double noise);

}  // namespace rotrocc
