#include "evaluation/pose_text.h"

#include <cstdlib>
#include <iomanip>
#include <locale>

namespace rotrocc {
namespace {

void writeKitti(const Eigen::Isometry3d& pose, std::ostream& out) {
  out << std::scientific;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 4; ++col) {
      out << (row + col == 0 ? "" : " ") << pose(row, col);
    }
  }
}

void writeSeconds(std::int64_t stamp_ns, std::ostream& out) {
  const std::lldiv_t parts = std::lldiv(stamp_ns, 1'000'000'000);
  out << (stamp_ns < 0 ? "-" : "") << std::llabs(parts.quot) << '.' << std::setw(9)
      << std::setfill('0') << std::llabs(parts.rem);
}

void writeTum(const StampedPose& pose, std::ostream& out) {
  Eigen::Quaterniond quaternion(pose.T_world_body.linear());
  quaternion.normalize();
  if (quaternion.w() < 0.0) quaternion.coeffs() *= -1.0;
  writeSeconds(pose.stamp_ns, out);
  out << std::fixed;
  for (int i = 0; i < 3; ++i) out << ' ' << pose.T_world_body.translation()[i];
  for (int i = 0; i < 4; ++i) out << ' ' << quaternion.coeffs()[i];  // x y z w
}

}  // namespace

void preparePoseText(std::ostream& out) {
  out.imbue(std::locale::classic());
  out.precision(9);
}

void writePose(const StampedPose& pose, TrajectoryFormat format, std::ostream& out) {
  if (format == TrajectoryFormat::kKitti) {
    writeKitti(pose.T_world_body, out);
  } else {
    writeTum(pose, out);
  }
  out << '\n';
}

}  // namespace rotrocc
