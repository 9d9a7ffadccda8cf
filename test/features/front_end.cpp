#include "features/front_end.h"

#include "features/correspondence_finder.h"

namespace rotrocc {

std::vector<double> runFrontEnd(const cv::Mat& prev_left,
                                const cv::Mat& prev_right,
                                const cv::Mat& cur_left,
                                const cv::Mat& cur_right,
                                double focal_px,
                                double ahead_m) {
  StereoCamera camera;
  camera.width = prev_left.cols;
  camera.height = prev_left.rows;
  camera.fx = camera.fy = focal_px;
  camera.cx = camera.cx_right = 0.5 * camera.width;
  camera.cy = 0.5 * camera.height;
  camera.baseline_m = 0.537;
  CorrespondenceFinder finder({}, 1);
  Keyframe keyframe;
  keyframe.frame = finder.makeFrame({0, prev_left, prev_right});
  const FramePtr current = finder.makeFrame({1, cur_left, cur_right});
  finder.findCorners(keyframe);
  finder.findDepths(camera, keyframe);
  Eigen::Isometry3d T_prev_cur = Eigen::Isometry3d::Identity();
  T_prev_cur.translation().z() = ahead_m;
  Correspondences features;
  const int tracked = finder.find(camera, keyframe, *current, T_prev_cur, features);
  std::vector<double> all = {static_cast<double>(keyframe.corners.size()),
                             static_cast<double>(keyframe.points.size()),
                             static_cast<double>(tracked)};
  for (const Correspondence& feature : features) {
    all.insert(all.end(),
               {feature.keyframe_px.x(),
                feature.keyframe_px.y(),
                feature.cur_px.x(),
                feature.cur_px.y(),
                feature.disparity_px});
  }
  return all;
}

}  // namespace rotrocc
