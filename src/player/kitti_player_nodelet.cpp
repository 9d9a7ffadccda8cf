#include <exception>
#include <memory>

#include <nodelet/nodelet.h>
#include <ros/init.h>
#include <pluginlib/class_list_macros.hpp>

#include "player/kitti_player.h"

namespace rotrocc {

/// KittiPlayer as a nodelet: passes images to nodelets of the same manager without a copy. With the
/// private parameter shutdown_at_end the manager shuts down at the end of the
/// recording.
/// Throws std::exception, after a fatal log, on an unusable recording.
class KittiPlayerNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    const bool shutdown_at_end = getPrivateNodeHandle().param("shutdown_at_end", false);
    const auto on_end = [shutdown_at_end] {
      if (shutdown_at_end) ros::requestShutdown();
    };
    try {
      player_ = std::make_unique<KittiPlayer>(getNodeHandle(), getPrivateNodeHandle(), on_end);
    } catch (const std::exception& error) {
      NODELET_FATAL("%s", error.what());
      throw;  // the loader reports the failure, so the launch ends
    }
  }

  std::unique_ptr<KittiPlayer> player_;
};

}  // namespace rotrocc

PLUGINLIB_EXPORT_CLASS(rotrocc::KittiPlayerNodelet, nodelet::Nodelet)
