#include "check/pair_check.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

#include "common/median.h"
#include "features/image_noise.h"
#include "input/to_text.h"
#include "motion/feature_errors.h"

namespace rotrocc {
namespace {

constexpr std::size_t kPerPair = 150, kLeast = 30;
constexpr int kPatch = 4;  // radius of the patches whose means are compared [px]

/// Of pairs: gray levels hardly differ between two that follow each other, and sharpness, which
/// takes longer, changes slowly.
constexpr int kStep = 2;
constexpr std::size_t kSharpnessStep = 2;  // of these
constexpr int kSharpnessPatch = 24;

/// Matching by correlation takes any gain, but one of a quarter is another exposure time, and
/// another motion blur.
constexpr double kAcceptableGain = 0.1;
constexpr double kFixGain = 0.25;

constexpr int kWhite = 255;
constexpr int kBlack = kWhite / 50;

cv::Rect around(const Eigen::Vector2d& px, int radius) {
  return {cvRound(px.x()) - radius, cvRound(px.y()) - radius, 2 * radius + 1, 2 * radius + 1};
}

/// The same part of the world in both images.
struct Patch {
  cv::Rect left, right;
};

/// Around features that agree with the motion, about `most` of them, where both images show them.
std::vector<Patch> patchesOf(const CheckedPair& pair, int radius, std::size_t most) {
  std::vector<Patch> patches;
  const cv::Rect image({}, pair.images.left.size());
  const double rows_px = pair.result.row_offset.median_px;
  const std::size_t step = std::max<std::size_t>(1, pair.features.size() / most);
  for (std::size_t i = 0; i < pair.features.size(); i += step) {
    if (pair.inliers[i] == 0) continue;
    const Correspondence& feature = pair.features[i];
    const Eigen::Vector2d right_px =
        feature.cur_px + Eigen::Vector2d(-feature.disparity_px, rows_px);
    const Patch patch = {around(feature.cur_px, radius), around(right_px, radius)};
    if (((patch.left | patch.right) & image) == (patch.left | patch.right)) {
      patches.push_back(patch);
    }
  }
  return patches;
}

/// Mean gray levels of patches, left and right, and r^2 from the middle, 1 in the corners.
std::vector<Eigen::Array3d> patchMeans(const CheckedPair& pair) {
  const cv::Point2d corner(0.5 * pair.camera.width, 0.5 * pair.camera.height);
  std::vector<Eigen::Array3d> means;
  for (const Patch& patch : patchesOf(pair, kPatch, kPerPair)) {
    const cv::Mat left = pair.images.left(patch.left), right = pair.images.right(patch.right);
    if (std::max(cv::norm(left, cv::NORM_INF), cv::norm(right, cv::NORM_INF)) >= kWhite) continue;
    const cv::Point2d at = 0.5 * cv::Point2d(patch.left.tl() + patch.left.br()) - corner;
    means.emplace_back(cv::mean(left)[0], cv::mean(right)[0], at.dot(at) / corner.dot(corner));
  }
  return means;
}

/// to = c0 from + c1 + c2 from r^2, with Cauchy weights: at edges of depth the images differ.
Eigen::Vector3d fitLevels(const Eigen::ArrayXd& from,
                          const Eigen::ArrayXd& to,
                          const Eigen::ArrayXd& r2) {
  // 2.3 standard deviations, for 95 % efficiency; cauchyWeights() expects lengths of errors.
  constexpr double kRobust = 4.0;
  constexpr int kIterations = 10;
  Eigen::MatrixX3d rows(from.size(), 3);
  rows << from.matrix(), Eigen::VectorXd::Ones(from.size()), (from * r2).matrix();
  const auto count = static_cast<std::size_t>(from.size());
  std::vector<double> errors(count), weights(count, 1.0);
  Eigen::Vector3d levels;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Eigen::MatrixX3d weighted =
        Eigen::VectorXd::Map(weights.data(), from.size()).asDiagonal() * rows;
    levels = (weighted.transpose() * rows).ldlt().solve(weighted.transpose() * to.matrix());
    Eigen::VectorXd::Map(errors.data(), from.size()) = (to.matrix() - rows * levels).cwiseAbs();
    cauchyWeights(kRobust, errors, weights);
  }
  return levels;
}

/// Power spectrum of windowed patches, minus the white noise of their image.
struct Spectrum {
  cv::Mat_<float> power;
  double noise;  ///< that was subtracted
};

Spectrum spectrumOf(const cv::Mat& image,
                    double noise_gray,
                    const std::vector<Patch>& patches,
                    cv::Rect Patch::*side) {
  const cv::Size size = (patches.front().*side).size();
  cv::Mat window;
  cv::createHanningWindow(window, size, CV_32F);
  cv::Mat_<float> power = cv::Mat_<float>::zeros(size);
  for (const Patch& patch : patches) {
    cv::Mat grays, parts[2];
    image(patch.*side).convertTo(grays, CV_32F);
    cv::dft(window.mul(grays - cv::mean(grays)), grays, cv::DFT_COMPLEX_OUTPUT);
    cv::split(grays, parts);
    power += parts[0].mul(parts[0]) + parts[1].mul(parts[1]);
  }
  const double noise =
      noise_gray * noise_gray * window.dot(window) * static_cast<double>(patches.size());
  return {power - noise, noise};
}

/// Variance of the Gaussian by which the right image is more blurred than the left one [px^2], up
/// to 16; negative if the left one is, nan if noise hides it. Gains and noise of the images do not
/// matter.
double blurOfRight_px2(const Spectrum& of_left, const Spectrum& of_right) {
  constexpr double kMost_px2 = 16.0;
  constexpr double kOverNoise = 10.0;  // the noise is known by some percent
  const int count = of_left.power.cols;
  // Sums over rings of about equal frequencies: of both powers, of w^2, and the number of bins.
  std::vector<cv::Vec4d> rings(static_cast<std::size_t>(count / 2 + 1), cv::Vec4d());
  for (int row = 0; row < count; ++row) {
    for (int column = 0; column < count; ++column) {
      const double radius =
          std::hypot(std::min(row, count - row), std::min(column, count - column));
      const auto ring = static_cast<std::size_t>(std::lround(radius));
      if (ring >= rings.size()) continue;
      const double w = 2.0 * CV_PI / count * radius;
      rings[ring] += cv::Vec4d(of_left.power(row, column), of_right.power(row, column), w * w, 1.0);
    }
  }
  // A Gaussian of variance v multiplies the power by exp(-v w^2): the slope over w^2. The window
  // spreads over the lowest frequencies.
  constexpr std::size_t kLeast = 2;
  const double least = kOverNoise * std::max(of_left.noise, of_right.noise);  // of a bin
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d weighted = Eigen::Vector2d::Zero();
  for (std::size_t ring = kLeast; ring < rings.size(); ++ring) {
    const auto& [l, r, w2, bins] = rings[ring].val;
    if (std::min(l, r) < least * bins) break;
    const Eigen::Vector2d line(1.0, w2 / bins);
    information += bins * line * line.transpose();
    weighted += bins * std::log(r / l) * line;
  }
  const double slope = (information.inverse() * weighted)[1];
  return std::clamp(-slope, -kMost_px2, kMost_px2);
}

class PhotometryCheck : public PairCheck {
 public:
  void observe(const CheckedPair& pair) override {
    if (pairs_++ % kStep != 0) return;
    Row row;
    row.time_s = pair.time_s;
    row.left = levelsOf(pair.images.left);
    row.right = levelsOf(pair.images.right);
    if (pair.result.hasMotion()) {
      compare(pair, row);
      if (rows_.size() % kSharpnessStep == 0) compareSharpness(pair, row);
    }
    rows_.push_back(row);
  }

  void report(const Windows& windows, RigReport& report) const override {
    if (rows_.empty()) return;
    addExposure(windows, report);
    addLevels(windows, report);
    ReportTable table = {"photometry",
                         "time_s,gain,offset_gray,mean_left,mean_right,saturated_left,"
                         "saturated_right,dark_left,dark_right",
                         {}};
    for (const Row& row : rows_) {
      table.rows.push_back({row.time_s,
                            row.gain,
                            row.offset_gray,
                            row.left.mean,
                            row.right.mean,
                            row.left.saturated,
                            row.right.saturated,
                            row.left.dark,
                            row.right.dark});
    }
    report.tables.push_back(std::move(table));
  }

 private:
  struct Levels {
    double mean, noise;      ///< gray levels; noise is a standard deviation
    double noise_share;      ///< of the contrast
    double saturated, dark;  ///< share of the pixels
  };
  /// Of one pair; nan if not measured.
  struct Row {
    double time_s = NAN;
    double gain = NAN, offset_gray = NAN, vignetting = NAN;
    double blur_px2 = NAN;  ///< variance of the Gaussian; negative if the left image is blurred
    Levels left = {}, right = {};
  };

  static Levels levelsOf(const cv::Mat& image) {
    const auto pixels = static_cast<double>(image.total());
    cv::Scalar mean, deviation;
    cv::meanStdDev(image, mean, deviation);
    const double noise = std::sqrt(noiseVariance(image));
    return {mean[0],
            noise,
            noise / std::max(deviation[0], 1e-9),
            cv::countNonZero(image >= kWhite) / pixels,
            cv::countNonZero(image <= kBlack) / pixels};
  }

  /// Robust means of patches: right = gain left (1 + vignetting r^2) + offset, r = 1 in the
  /// corners. Both sides have errors, so that each is fitted to the other.
  static void compare(const CheckedPair& pair, Row& row) {
    const std::vector<Eigen::Array3d> means = patchMeans(pair);
    if (means.size() < kLeast) return;
    const auto count = static_cast<Eigen::Index>(means.size());
    const Eigen::Map<const Eigen::Array3Xd> rows(means.front().data(), 3, count);
    const Eigen::ArrayXd left = rows.row(0), right = rows.row(1), r2 = rows.row(2);
    const Eigen::Vector3d of_right = fitLevels(left, right, r2);
    const Eigen::Vector3d of_left = fitLevels(right, left, r2);
    row.gain = std::sqrt(of_right[0] / of_left[0]);
    row.vignetting = 0.5 * (of_right[2] / of_right[0] - of_left[2] / of_left[0]);
    std::vector<double> offsets(means.size());
    Eigen::ArrayXd::Map(offsets.data(), count) =
        right - row.gain * left * (1.0 + row.vignetting * r2);
    row.offset_gray = median(offsets);
  }

  static void compareSharpness(const CheckedPair& pair, Row& row) {
    constexpr std::size_t kPatches = 40, kLeastPatches = 5;
    const std::vector<Patch> patches = patchesOf(pair, kSharpnessPatch, kPatches);
    if (patches.size() < kLeastPatches) return;
    row.blur_px2 =
        blurOfRight_px2(spectrumOf(pair.images.left, row.left.noise, patches, &Patch::left),
                        spectrumOf(pair.images.right, row.right.noise, patches, &Patch::right));
  }

  void addExposure(const Windows& windows, RigReport& report) const {
    const auto estimate = [&](double Row::*member) {
      std::vector<TimedValue> values;
      for (const Row& row : rows_) values.push_back({row.time_s, row.*member});
      return overWindows(values, windows);
    };
    const Estimate gain = estimate(&Row::gain);
    const Estimate offset = estimate(&Row::offset_gray);
    const Estimate vignetting = estimate(&Row::vignetting);
    // Variances of Gaussians add; the blur itself would change its sign by chance.
    const Estimate blur_px2 = estimate(&Row::blur_px2);
    report.add({"photometry",
                "gain of the right image relative to the left",
                toText(gain, ""),
                "nothing by itself, because matching uses correlation; but the darker image has "
                "less contrast above its noise, and a longer exposure more motion blur",
                "give both cameras the same exposure time and gain, or couple them"},
               {{std::log(gain.value), gain.sigma / gain.value}, kAcceptableGain, kFixGain});
    const double changes = gainScatter();
    report.add(
        {"photometry",
         "gain over time",
         std::isfinite(changes) ? "varies by " + fixedText(100.0 * changes, 1) + " %" : "unknown",
         "separate auto-exposures differ most where the light changes",
         "couple the exposures of the cameras"},
        {{changes}, kAcceptableGain, kFixGain});
    report.add({"photometry",
                "black level, right minus left",
                toText(offset, "of 255"),
                "the brighter image loses that part of its gray levels",
                "set the same black level in both cameras, and look for stray light"},
               {offset * (1.0 / kWhite), 0.02, 0.06});
    report.add({"photometry",
                "vignetting of the right image relative to the left",
                toText(vignetting * 100.0, "% in the corners"),
                "the darker corners lose features",
                "use the same lens and aperture on both cameras, and check that nothing is in "
                "front of one"},
               {vignetting, 0.15, 0.4});
    const std::string side = blur_px2.value > 0.0 ? "right" : "left";
    const double blur_px = std::sqrt(std::abs(blur_px2.value));
    const double sigma_px = blur_px2.sigma / std::max(2.0 * blur_px, std::sqrt(blur_px2.sigma));
    report.add(
        {"photometry",
         "sharpness of the right image relative to the left",
         toText(Estimate{blur_px, sigma_px}, "px") + " more blur (Gaussian sigma) on the " + side,
         "features on fine texture are lost, and disparities get noisier",
         "focus and clean the " + side + " lens"},
        {blur_px2, 0.4 * 0.4, 0.8 * 0.8});
  }

  /// Relative standard deviation of the gain over the pairs, as eight of ten have it, or nan.
  double gainScatter() const {
    constexpr double kOverDeviation = 2.563;  // of normal values
    std::vector<double> gains;
    for (const Row& row : rows_) {
      if (std::isfinite(row.gain)) gains.push_back(row.gain);
    }
    if (gains.empty()) return NAN;
    const double range = quantile(gains, 0.9) - quantile(gains, 0.1);
    return range / kOverDeviation / median(gains);
  }

  void addLevels(const Windows& windows, RigReport& report) const {
    struct Property {
      std::string subject, unit, cost, remedy;
      double acceptable;
      double Levels::*share;
    };
    const std::string kEmpty = "no features there", kNoisy = "positions get noisier";
    const Property kProperties[] = {
        {"saturated pixels", "%", kEmpty, "reduce the exposure", 0.1, &Levels::saturated},
        {"black pixels", "%", kEmpty, "add light, exposure or gain", 0.1, &Levels::dark},
        {"noise", "% of contrast", kNoisy, "more light, less gain", 0.15, &Levels::noise_share}};
    for (const auto& [side, levels] : {std::pair(", left", &Row::left), {", right", &Row::right}}) {
      for (const Property& p : kProperties) {
        std::vector<TimedValue> shares;
        for (const Row& row : rows_) shares.push_back({row.time_s, row.*levels.*p.share});
        const Estimate share = overWindows(shares, windows);
        const std::string measured = toText(share * 100.0, p.unit);
        report.add({"photometry", p.subject + side, measured, p.cost, p.remedy},
                   {share, p.acceptable, 0.3});
      }
    }
  }

  std::vector<Row> rows_;
  int pairs_ = 0;
};

}  // namespace

std::unique_ptr<PairCheck> makePhotometryCheck() {
  return std::make_unique<PhotometryCheck>();
}

}  // namespace rotrocc
