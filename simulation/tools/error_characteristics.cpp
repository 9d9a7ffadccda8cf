#include <algorithm>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "rotrocc/kitti.h"
#include "rotrocc/visual_odometry.h"
#include "simulation/tools/feature_errors.h"
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

/// Features of the odometry in the first two pairs, sorted by row and column.
std::vector<Eigen::Vector3d> featurePoints(const KittiSequence& sequence) {
  if (sequence.size() < 2) throw std::runtime_error("the sequence has fewer than two pairs");
  VisualOdometry odometry{VisualOdometry::Config{}};
  for (int i = 0; i < 2; ++i) {
    odometry.process({sequence.stamp_ns(i), sequence.readLeft(i), sequence.readRight(i)},
                     sequence.camera());
  }
  Correspondences features = odometry.correspondences();
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

void writeRows(const StereoCamera& camera,
               const std::vector<Eigen::Vector3d>& points,
               const AssumedMotion& hypothesis,
               const std::vector<double>& depth_factors,
               std::ofstream& file) {
  const auto errors = judgeFeatures(camera, points, hypothesis, depth_factors);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d pixel = camera.project(points[i]);
    file << hypothesis.name << ',' << i << ',' << pixel.x() << ',' << pixel.y() << ','
         << points[i].z() << ',' << depth_factors[i] << ',' << errors[i].reprojection_px << ','
         << errors[i].normalized << ',' << errors[i].decoupled << '\n';
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
