#include "simulation/sequence_writer.h"

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <stdexcept>

#include <opencv2/imgcodecs.hpp>

#include "files/csv_file.h"
#include "rotrocc/trajectory.h"

namespace rotrocc {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kAslStart_ns = 1'317'600'000'000'000'000;

void makeEmptyFolder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw std::runtime_error("cannot create " + path + ": " + error.message());
  if (!fs::is_empty(path)) throw std::runtime_error(path + " is not empty: choose a new directory");
}

/// A text file that is complete, or std::runtime_error.
template <class Write>
void writeText(const std::string& path, const Write& write) {
  std::ofstream file(path);
  write(file);
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

void writeCalibration(std::ostream& file, const StereoCamera& camera) {
  file << std::scientific << std::setprecision(12);
  for (const bool right : {false, true}) {
    const double cx = right ? camera.cx_right : camera.cx;
    const double shift = right ? -camera.fx * camera.baseline_m : 0.0;
    file << (right ? "P1: " : "P0: ") << camera.fx << " 0 " << cx << ' ' << shift << " 0 "
         << camera.fy << ' ' << camera.cy << " 0 0 0 1 0\n";
  }
}

/// The file has its name when it is complete.
void writeImage(const std::string& path, const std::string& extension, const cv::Mat& image) {
  std::vector<uchar> bytes;
  cv::imencode(extension, image, bytes);
  const std::string unfinished = path + ".part";
  std::ofstream file(unfinished, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path + ": is the disk full?");
  fs::rename(unfinished, path);
}

/// Forward, left, up: the axes of a car, at its IMU.
Eigen::Isometry3d bodyMount() {
  Eigen::Isometry3d T_body_left = Eigen::Isometry3d::Identity();
  T_body_left.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T_body_left.translation() << 0.07, 0.03, -0.02;
  return T_body_left;
}

void writeList(std::ostream& out, const std::string& key, const std::vector<double>& values) {
  const char* separator = ": [";
  out << key;
  for (const double value : values) {
    out << separator << value;
    separator = ", ";
  }
  out << "]\n";
}

/// sensor.yaml of a folder.
void writeSensor(const std::string& folder,
                 const Eigen::Isometry3d& T_body_sensor,
                 const RawCamera* camera) {
  writeText(folder + "/sensor.yaml", [&](std::ostream& file) {
    const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> matrix = T_body_sensor.matrix();
    file << std::setprecision(15)
         << "# Pose of the sensor on the body.\nT_BS:\n  cols: 4\n  rows: 4\n";
    writeList(file, "  data", {matrix.data(), matrix.data() + 16});
    if (camera == nullptr) return;
    file << "resolution: [" << camera->width << ", " << camera->height << "]\n"
         << "camera_model: pinhole\n";
    writeList(file, "intrinsics", {camera->fx, camera->fy, camera->cx, camera->cy});
    const bool is_radtan = camera->distortion.name() == std::string("plumb_bob");
    file << "distortion_model: " << (is_radtan ? "radial-tangential" : "equidistant") << '\n';
    std::vector<double> coefficients = camera->distortion.coefficients();
    coefficients.resize(4);  // the format has no k3
    writeList(file, "distortion_coefficients", coefficients);
  });
}

void writeAslPoses(const std::string& folder, const Simulator& simulator) {
  writeText(folder + "/data.csv", [&](std::ostream& file) {
    file << "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
            "q_RS_y [], q_RS_z []\n"
         << std::setprecision(12);
    for (int i = 0; i < simulator.size(); ++i) {
      const Eigen::Isometry3d T_world_body = simulator.pose(i) * bodyMount().inverse();
      const Eigen::Vector3d& p = T_world_body.translation();
      const Eigen::Quaterniond q(T_world_body.linear());
      file << kAslStart_ns + simulator.stamp_ns(i);
      for (const double value : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}) {
        file << ',' << value;
      }
      file << '\n';
    }
  });
}

}  // namespace

void writeGyroscope(const std::string& path, const std::vector<GyroSample>& samples) {
  CsvFile file(path,
               "#timestamp [ns],w_x [rad s^-1],w_y [rad s^-1],w_z [rad s^-1],a_x [m s^-2],"
               "a_y [m s^-2],a_z [m s^-2]");
  for (const GyroSample& sample : samples) {
    const Eigen::Vector3d& rate = sample.rate_rps;
    file << sample.stamp_ns;
    file.row({rate.x(), rate.y(), rate.z(), 0.0, 0.0, 0.0});
  }
}

SequenceWriter::SequenceWriter(const std::string& directory,
                               const Simulator& simulator,
                               const Extras& extras)
    : directory_(directory), with_depth_(extras.depth), images_(simulator.size()) {
  if (with_depth_) makeEmptyFolder(directory_ + "/depth");
  if (simulator.unrectifiedRig()) {
    startAsl(simulator, extras.imu);
  } else {
    startKitti(simulator, extras.imu);
  }
}

void SequenceWriter::startKitti(const Simulator& simulator, bool with_imu) {
  for (const int side : {0, 1}) {
    const std::string folder = directory_ + "/image_" + std::to_string(side);
    makeEmptyFolder(folder);
    for (std::size_t i = 0; i < images_.size(); ++i) {
      images_[i][side] = folder + cv::format("/%06d.png", static_cast<int>(i));
    }
  }
  writeText(directory_ + "/calib.txt",
            [&](std::ostream& file) { writeCalibration(file, simulator.camera()); });
  writeText(directory_ + "/times.txt", [&](std::ostream& file) {
    file << std::fixed << std::setprecision(9);
    for (int i = 0; i < simulator.size(); ++i) file << toSeconds(simulator.stamp_ns(i)) << '\n';
  });
  TrajectoryWriter poses(directory_ + "/poses.txt", TrajectoryFormat::kKitti);
  for (int i = 0; i < simulator.size(); ++i) {
    poses.write({simulator.stamp_ns(i), simulator.pose(i)});
  }
  if (with_imu) writeGyroscope(directory_ + "/imu.csv", simulator.gyroscope());
}

void SequenceWriter::startAsl(const Simulator& simulator, bool with_imu) {
  const std::string root = directory_ + "/mav0/";
  for (const int side : {0, 1}) {
    const std::string folder = root + "cam" + std::to_string(side);
    makeEmptyFolder(folder + "/data");
    const RawCamera& camera = simulator.unrectifiedRig()->at(side).camera;
    const Eigen::Translation3d to_side(side * simulator.camera().baseline_m, 0.0, 0.0);
    writeSensor(
        folder, bodyMount() * to_side * Eigen::Quaterniond(camera.R_rectified_raw), &camera);
    writeText(folder + "/data.csv", [&](std::ostream& file) {
      file << "#timestamp [ns],filename\n";
      for (std::size_t i = 0; i < images_.size(); ++i) {
        const std::string stamp =
            std::to_string(kAslStart_ns + simulator.stamp_ns(static_cast<int>(i)));
        file << stamp << ',' << stamp << ".png\n";
        images_[i][side] = folder + "/data/" + stamp + ".png";
      }
    });
  }
  const std::string truth = root + "state_groundtruth_estimate0";
  makeEmptyFolder(truth);
  writeSensor(truth, Eigen::Isometry3d::Identity(), nullptr);
  writeAslPoses(truth, simulator);
  if (!with_imu) return;
  makeEmptyFolder(root + "imu0");
  writeSensor(root + "imu0", bodyMount(), nullptr);
  std::vector<GyroSample> samples = simulator.gyroscope();
  for (GyroSample& sample : samples) sample.stamp_ns += kAslStart_ns;
  writeGyroscope(root + "imu0/data.csv", samples);
}

void SequenceWriter::write(const SimulatedFrame& frame) {
  const std::array<std::string, 2>& paths = images_.at(count_);
  writeImage(paths[0], ".png", frame.pair.left);
  writeImage(paths[1], ".png", frame.pair.right);
  if (with_depth_) {
    cv::Mat depth;
    frame.depth.convertTo(depth, CV_32F);
    depth.setTo(0.0F, frame.depth > 1e30);
    writeImage(
        directory_ + cv::format("/depth/%06d.tiff", static_cast<int>(count_)), ".tiff", depth);
  }
  ++count_;
}

}  // namespace rotrocc
