#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "motion/reprojection_error.h"
#include "rotrocc/kitti.h"
#include "rotrocc/visual_odometry.h"
#include "tools/program.h"

namespace {

namespace po = boost::program_options;
using namespace rotrocc;

const char* const kUsage =
    "Computes the errors of features under wrong motions: Fig. 4 and 5 of the paper.\n\n"
    "example: error_characteristics dataset/sequences/06 --output figures\n"
    "usage:   error_characteristics SEQUENCE_DIR --output DIR\n\n"
    "The errors are reprojection error, normalized and decoupled normalized "
    "reprojection error of the\nfeatures in the first two pairs of a sequence.\n\n";

struct Options {
  std::string sequence;
  std::string output;
};

/// Returns false after printing the help; throws po::error on bad usage.
bool parse(int argc, char** argv, Options& options) {
  po::options_description visible("Options");
  auto add = visible.add_options();
  add("help,h", "show this help");
  add("output", po::value(&options.output)->required(), "output folder for fig4.csv and fig5.csv");
  PositionalArguments sequence;
  sequence.options.add_options()("sequence", po::value(&options.sequence)->required());
  sequence.order.add("sequence", 1);
  po::variables_map variables;
  return parseCommandLine(argc, argv, kUsage, visible, sequence, variables);
}

/// A true motion and a wrong hypothesis of it.
struct AssumedMotion {
  std::string name;
  Eigen::Isometry3d T_keyframe_cur_true;
  Eigen::Isometry3d T_keyframe_cur_assumed;
};

/// `amounts` are pitch, yaw, roll [rad] and t_x, t_y, t_z [m]; R_z R_y R_x as above Eq. 4.
Eigen::Isometry3d motion(const Eigen::Matrix<double, 6, 1>& amounts) {
  Eigen::Isometry3d T(Eigen::Translation3d(amounts.tail<3>()));
  T.rotate(Eigen::AngleAxisd(amounts[2], Eigen::Vector3d::UnitZ()));
  T.rotate(Eigen::AngleAxisd(amounts[1], Eigen::Vector3d::UnitY()));
  T.rotate(Eigen::AngleAxisd(amounts[0], Eigen::Vector3d::UnitX()));
  return T;
}

constexpr double kDegree = M_PI / 180.0;

/// Fig. 4: pitch, yaw and roll of 3 deg, and 1 m along x, y and z, each overestimated by 10 %.
std::vector<AssumedMotion> singleAxisMotions() {
  constexpr double kExcess = 1.1;
  const char* const names[6] = {"pitch", "yaw", "roll", "t_x", "t_y", "t_z"};
  std::vector<AssumedMotion> hypotheses;
  for (int axis = 0; axis < 6; ++axis) {
    Eigen::Matrix<double, 6, 1> amounts = Eigen::Matrix<double, 6, 1>::Zero();
    amounts[axis] = axis < 3 ? 3.0 * kDegree : 1.0;
    hypotheses.push_back({names[axis], motion(amounts), motion(kExcess * amounts)});
  }
  return hypotheses;
}

/// Fig. 5: a turn of 50 deg/s with 10 deg/s of pitch and 5 deg/s of roll at 50 km/h, seen at 10 Hz;
/// the assumed rotation is right, the assumed translation 5 % too long.
AssumedMotion turnMotion() {
  constexpr double kFrame_s = 0.1;
  constexpr double kExcess = 1.05;
  Eigen::Matrix<double, 6, 1> amounts;
  amounts << 10.0 * kDegree, 50.0 * kDegree, 5.0 * kDegree, 0.0, 0.0, 50.0 / 3.6;
  AssumedMotion turn = {"turn", motion(kFrame_s * amounts), motion(kFrame_s * amounts)};
  turn.T_keyframe_cur_assumed.translation() *= kExcess;
  return turn;
}

/// Features of the odometry in the first two pairs, sorted by row.
std::vector<Eigen::Vector3d> featurePoints(const KittiSequence& sequence) {
  if (sequence.size() < 2) throw std::runtime_error("the sequence has fewer than two pairs");
  VisualOdometry odometry{VisualOdometry::Config{}};
  for (int i = 0; i < 2; ++i) {
    odometry.process({sequence.stamp_ns(i), sequence.readLeft(i), sequence.readRight(i)},
                     sequence.camera());
  }
  Correspondences features = odometry.correspondences();
  if (features.empty()) throw std::runtime_error("the first two pairs have no features in common");
  std::sort(features.begin(), features.end(), [](const auto& a, const auto& b) {
    return a.cur_px.y() < b.cur_px.y();
  });
  std::vector<Eigen::Vector3d> points;
  for (const Correspondence& feature : features) points.push_back(feature.point_cur);
  return points;
}

/// Five features, evenly spread, get too small a depth, as in Fig. 5.
std::vector<double> depthFactors(std::size_t size) {
  constexpr std::size_t kWrong = 5;
  std::vector<double> factors(size, 1.0);
  for (std::size_t i = 1; i <= kWrong; ++i) factors[i * size / (kWrong + 1)] = 0.95;
  return factors;
}

/// Writes the three errors of the paper for noise-free flow of points [m, camera frame at t]: the
/// reprojection error (Eq. 2), and that over the flow (Eq. 8) and over the flow without rotation
/// (Eq. 24). The assumed depth of a point is its true depth times its factor.
void writeRows(const StereoCamera& camera,
               const std::vector<Eigen::Vector3d>& points,
               const AssumedMotion& hypothesis,
               const std::vector<double>& depth_factors,
               std::ofstream& file) {
  Correspondences features(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    features[i].keyframe_px = camera.project(hypothesis.T_keyframe_cur_true * points[i]);
    features[i].cur_px = camera.project(points[i]);
    features[i].disparity_px = camera.disparity(points[i].z());
    features[i].point_cur = depth_factors[i] * points[i];
  }
  std::vector<double> reprojection_px, flow_px, translation_flow_px;
  reprojectionErrors(camera, features, hypothesis.T_keyframe_cur_assumed, reprojection_px);
  coupledFlow(features, flow_px);
  decoupledFlow(camera, features, hypothesis.T_keyframe_cur_assumed.linear(), translation_flow_px);
  for (std::size_t i = 0; i < points.size(); ++i) {
    file << hypothesis.name << ',' << i << ',' << features[i].cur_px.x() << ','
         << features[i].cur_px.y() << ',' << points[i].z() << ',' << depth_factors[i] << ','
         << reprojection_px[i] << ',' << reprojection_px[i] / flow_px[i] << ','
         << reprojection_px[i] / translation_flow_px[i] << '\n';
  }
}

std::ofstream create(const std::string& path) {
  std::ofstream file(path);
  file.exceptions(std::ios::failbit | std::ios::badbit);
  if (!file.is_open()) throw std::runtime_error(path + " cannot be written");
  file << "motion,feature,x_px,y_px,depth_m,depth_factor,re_px,nre,dnre\n";
  return file;
}

void run(const Options& options) {
  const KittiSequence sequence(options.sequence);
  const std::vector<Eigen::Vector3d> points = featurePoints(sequence);
  const std::vector<double> right_depths(points.size(), 1.0);

  std::ofstream fig4 = create(options.output + "/fig4.csv");
  for (const AssumedMotion& hypothesis : singleAxisMotions()) {
    writeRows(sequence.camera(), points, hypothesis, right_depths, fig4);
  }
  std::ofstream fig5 = create(options.output + "/fig5.csv");
  writeRows(sequence.camera(), points, turnMotion(), depthFactors(points.size()), fig5);
  std::cout << points.size() << " features of " << options.sequence << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("error_characteristics", argc, argv, parse, run);
}
