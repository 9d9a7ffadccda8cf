#include "simulation/sequence_writer.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <stdexcept>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "common/to_seconds.h"
#include "evaluation/image_file.h"
#include "inertial/gyro_file.h"
#include "rotrocc/trajectory.h"
#include "simulation/rows.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

/// Creates empty folders in a directory, and returns it.
std::string makeDirectories(const std::string& directory, const std::vector<std::string>& folders) {
  for (const std::string& folder : folders) {
    const fs::path path = fs::path(directory) / folder;
    std::error_code error;
    fs::create_directories(path, error);
    if (error) throw std::runtime_error("cannot create " + path.string() + ": " + error.message());
    if (!fs::is_empty(path)) {
      throw std::runtime_error(path.string() + " is not empty: choose a new directory");
    }
  }
  return directory;
}

std::vector<std::string> foldersOf(bool with_truth) {
  if (with_truth) return {"image_0", "image_1", "depth", "flow"};
  return {"image_0", "image_1"};
}

void writeCalibration(const fs::path& path, const StereoCamera& camera) {
  std::ofstream file(path);
  file << std::scientific << std::setprecision(12);
  for (const bool right : {false, true}) {
    const double cx = right ? camera.cx_right : camera.cx;
    const double shift = right ? -camera.fx * camera.baseline_m : 0.0;
    file << (right ? "P1: " : "P0: ") << camera.fx << " 0 " << cx << ' ' << shift << " 0 "
         << camera.fy << ' ' << camera.cy << " 0 0 0 1 0\n";
  }
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

void writeTimes(const fs::path& path, const Simulator& simulator) {
  std::ofstream file(path);
  file << std::fixed << std::setprecision(9);
  for (int i = 0; i < simulator.size(); ++i) {
    file << toSeconds(simulator.stamp_ns(i)) << '\n';
  }
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

void writePoses(const fs::path& path, const Simulator& simulator) {
  TrajectoryWriter poses(path.string(), TrajectoryFormat::kKitti);
  for (int i = 0; i < simulator.size(); ++i) {
    poses.write({simulator.stamp_ns(i), simulator.pose(i)});
  }
}

std::vector<uchar> encode(const std::string& extension, const cv::Mat& image) {
  std::vector<uchar> bytes;
  cv::imencode(extension, image, bytes);
  return bytes;
}

/// The file has its name when it is complete.
void writeFile(const fs::path& path, const std::vector<uchar>& bytes) {
  const fs::path unfinished = path.string() + ".part";
  std::ofstream file(unfinished, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string() + ": is the disk full?");
  fs::rename(unfinished, path);
}

cv::Mat storableDepth(const cv::Mat& depth) {
  cv::Mat stored;
  depth.convertTo(stored, CV_32F);
  stored.setTo(0.0F, depth > 1e30);
  return stored;
}

cv::Mat storableFlow(const cv::Mat& flow) {
  cv::Mat stored(flow.size(), CV_16UC3, cv::Scalar::all(0));
  for (int y = 0; y < flow.rows; ++y) {
    for (int x = 0; x < flow.cols; ++x) {
      const cv::Vec2d& shift = flow.at<cv::Vec2d>(y, x);
      if (!(std::abs(shift[0]) < 511.0 && std::abs(shift[1]) < 511.0)) continue;  // also not NaN
      const auto code = [](double value) {
        return static_cast<ushort>(std::lround(64.0 * value) + 32768);
      };
      stored.at<cv::Vec3w>(y, x) = {1, code(shift[1]), code(shift[0])};  // blue, green, red
    }
  }
  return stored;
}

constexpr std::int64_t kAslStart_ns = 1'317'600'000'000'000'000;
const std::string kAslTruth = "/state_groundtruth_estimate0";

/// Forward, left, up: the axes of a car, at its IMU.
Eigen::Isometry3d bodyMount() {
  Eigen::Isometry3d T_body_left = Eigen::Isometry3d::Identity();
  T_body_left.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T_body_left.translation() << 0.07, 0.03, -0.02;
  return T_body_left;
}

std::ofstream startTable(const std::string& path, const std::string& header) {
  std::ofstream file(path);
  file << header << '\n' << std::setprecision(12);
  if (!file) throw std::runtime_error("cannot write " + path);
  return file;
}

template <class Values>
void writeList(std::ostream& out, const std::string& key, const Values& values) {
  out << key << ": [";
  const char* separator = "";
  for (const double value : values) {
    out << separator << value;
    separator = ", ";
  }
  out << "]\n";
}

void writeSensor(const std::string& path,
                 const Eigen::Isometry3d& T_body_sensor,
                 const RawCamera* camera) {
  std::ofstream file(path);
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix = T_body_sensor.matrix();
  file << std::setprecision(15)
       << "# Pose of the sensor on the body.\nT_BS:\n  cols: 4\n  rows: 4\n";
  writeList(file, "  data", std::vector<double>(matrix.data(), matrix.data() + 16));
  if (camera != nullptr) {
    file << "resolution: [" << camera->width << ", " << camera->height << "]\n"
         << "camera_model: pinhole\n";
    writeList(
        file, "intrinsics", std::vector<double>{camera->fx, camera->fy, camera->cx, camera->cy});
    const bool is_radtan = camera->distortion.name() == std::string("plumb_bob");
    file << "distortion_model: " << (is_radtan ? "radial-tangential" : "equidistant") << '\n';
    std::vector<double> coefficients = camera->distortion.coefficients();
    coefficients.resize(4);  // the format has no k3
    writeList(file, "distortion_coefficients", coefficients);
  }
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

}  // namespace

SequenceWriter::SequenceWriter(const std::string& directory,
                               const Simulator& simulator,
                               bool with_truth)
    : directory_(makeDirectories(directory, foldersOf(with_truth))), with_truth_(with_truth) {
  const fs::path root(directory);
  writeCalibration(root / "calib.txt", simulator.camera());
  writeTimes(root / "times.txt", simulator);
  writePoses(root / "poses.txt", simulator);
}

std::string SequenceWriter::path(const char* folder, const char* extension) const {
  return (fs::path(directory_) / folder / cv::format("%06d%s", count_, extension)).string();
}

void SequenceWriter::write(const SimulatedFrame& frame) {
  const std::string names[] = {path("image_0", ".png"), path("image_1", ".png")};
  std::vector<uchar> images[2];
  forEachRow(2, [&](int side) {
    images[side] = encode(".png", side == 0 ? frame.pair.left : frame.pair.right);
  });
  for (const int side : {0, 1}) writeFile(names[side], images[side]);
  if (with_truth_) {
    writeFile(path("depth", ".tiff"), encode(".tiff", storableDepth(frame.depth)));
    if (!frame.flow.empty())
      writeFile(path("flow", ".png"), encode(".png", storableFlow(frame.flow)));
  }
  ++count_;
}

AslWriter::AslWriter(const std::string& directory, const UnrectifiedRig& rig, double baseline_m)
    : root_(makeDirectories(directory + "/mav0", {"cam0/data", "cam1/data", kAslTruth.substr(1)})),
      left_list_(startTable(root_ + "/cam0/data.csv", "#timestamp [ns],filename")),
      right_list_(startTable(root_ + "/cam1/data.csv", "#timestamp [ns],filename")),
      poses_(startTable(root_ + kAslTruth + "/data.csv",
                        "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], "
                        "q_RS_x [], q_RS_y [], q_RS_z []")) {
  const Eigen::Isometry3d T_body_right = bodyMount() * Eigen::Translation3d(baseline_m, 0.0, 0.0);
  writeSensor(root_ + "/cam0/sensor.yaml",
              bodyMount() * Eigen::Quaterniond(rig.left.camera.R_rectified_raw),
              &rig.left.camera);
  writeSensor(root_ + "/cam1/sensor.yaml",
              T_body_right * Eigen::Quaterniond(rig.right.camera.R_rectified_raw),
              &rig.right.camera);
  writeSensor(root_ + kAslTruth + "/sensor.yaml", Eigen::Isometry3d::Identity(), nullptr);
}

void AslWriter::writeGyroscope(std::vector<GyroSample> samples) {
  fs::create_directories(root_ + "/imu0");
  for (GyroSample& sample : samples) sample.stamp_ns += kAslStart_ns;
  writeGyroFile(root_ + "/imu0/data.csv", samples);
  writeSensor(root_ + "/imu0/sensor.yaml", bodyMount(), nullptr);
}

void AslWriter::writeImage(const std::string& camera,
                           std::ofstream& list,
                           std::int64_t stamp_ns,
                           const cv::Mat& image) {
  const std::string name = std::to_string(stamp_ns) + ".png";
  const std::string path = root_ + "/" + camera + "/data/" + name;
  list << stamp_ns << ',' << name << '\n';
  if (!list.flush()) throw std::runtime_error("cannot write the list of " + path);
  rotrocc::writeImage(path, image);
}

void AslWriter::write(const SimulatedFrame& frame, const Eigen::Isometry3d& T_first_left) {
  const std::int64_t stamp_ns = kAslStart_ns + frame.pair.stamp_ns;
  writeImage("cam0", left_list_, stamp_ns, frame.pair.left);
  writeImage("cam1", right_list_, stamp_ns, frame.pair.right);
  const Eigen::Isometry3d T_world_body = T_first_left * bodyMount().inverse();
  const Eigen::Vector3d& p = T_world_body.translation();
  const Eigen::Quaterniond q(T_world_body.linear());
  poses_ << stamp_ns << ',' << p.x() << ',' << p.y() << ',' << p.z() << ',' << q.w() << ',' << q.x()
         << ',' << q.y() << ',' << q.z() << '\n';
  if (!poses_.flush()) throw std::runtime_error("cannot write the poses: is the disk full?");
}

}  // namespace rotrocc
