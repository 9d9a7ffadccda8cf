#include "tools/flow_pictures.h"

#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "evaluation/image_file.h"

namespace rotrocc {

FlowPictures::FlowPictures(const std::string& folder, FlowView view)
    : folder_(folder), view_(view) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw std::runtime_error("cannot create the folder " + folder + ": " + error.message());
  }
}

void FlowPictures::write(const StereoPair& pair,
                         const StereoCamera& camera,
                         const VisualOdometry& odometry,
                         const OdometryResult& result) {
  drawFlowPicture({pair.left,
                   camera,
                   odometry.correspondences(),
                   odometry.rotationInliers(),
                   odometry.translationInliers(),
                   result},
                  view_,
                  picture_);
  char name[32];
  std::snprintf(name, sizeof(name), "/%06d.png", pairs_++);
  writeImage(folder_ + name, picture_);
}

}  // namespace rotrocc
