#include "simulation/asl_writer.h"

#include <filesystem>
#include <iomanip>
#include <stdexcept>

#include "evaluation/image_file.h"
#include "inertial/gyro_file.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kStart_ns = 1'317'600'000'000'000'000;
const char* const kTruth = "/state_groundtruth_estimate0";

/// Forward, left, up: the axes of a car, at its IMU.
Eigen::Isometry3d bodyMount() {
  Eigen::Isometry3d T_body_left = Eigen::Isometry3d::Identity();
  T_body_left.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T_body_left.translation() << 0.07, 0.03, -0.02;
  return T_body_left;
}

std::string makeDirectories(const std::string& directory) {
  const std::string root = directory + "/mav0";
  for (const std::string& folder :
       {std::string("/cam0/data"), std::string("/cam1/data"), std::string(kTruth)}) {
    std::error_code error;
    fs::create_directories(root + folder, error);
    if (error) throw std::runtime_error("cannot create " + root + folder + ": " + error.message());
    if (!fs::is_empty(root + folder)) {
      throw std::runtime_error(root + folder + " is not empty: choose a new directory");
    }
  }
  return root;
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

AslWriter::AslWriter(const std::string& directory, const UnrectifiedRig& rig, double baseline_m)
    : root_(makeDirectories(directory)),
      left_list_(startTable(root_ + "/cam0/data.csv", "#timestamp [ns],filename")),
      right_list_(startTable(root_ + "/cam1/data.csv", "#timestamp [ns],filename")),
      poses_(startTable(root_ + kTruth + "/data.csv",
                        "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], "
                        "q_RS_x [], q_RS_y [], q_RS_z []")) {
  const Eigen::Isometry3d T_body_right = bodyMount() * Eigen::Translation3d(baseline_m, 0.0, 0.0);
  writeSensor(root_ + "/cam0/sensor.yaml",
              bodyMount() * Eigen::Quaterniond(rig.left.R_nominal_raw),
              &rig.left.camera);
  writeSensor(root_ + "/cam1/sensor.yaml",
              T_body_right * Eigen::Quaterniond(rig.right.R_nominal_raw),
              &rig.right.camera);
  writeSensor(root_ + kTruth + "/sensor.yaml", Eigen::Isometry3d::Identity(), nullptr);
}

void AslWriter::writeGyroscope(std::vector<GyroSample> samples) {
  fs::create_directories(root_ + "/imu0");
  for (GyroSample& sample : samples) sample.stamp_ns += kStart_ns;
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
  const std::int64_t stamp_ns = kStart_ns + frame.pair.stamp_ns;
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
