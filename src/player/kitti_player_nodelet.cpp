#include <exception>
#include <memory>

#include <nodelet/nodelet.h>
#include <ros/init.h>
#include <pluginlib/class_list_macros.hpp>

#include "input/callback_thread.h"
#include "player/kitti_player.h"

namespace rotrocc {

/// Passes images to nodelets of the same manager without a copy. With the private parameter
/// shutdown_at_end the manager shuts down at the end of the recording.
class KittiPlayerNodelet : public nodelet::Nodelet {
 public:
  ~KittiPlayerNodelet() override { callbacks_.stop(); }

 private:
  void onInit() override {
    const bool shutdown_at_end = getPrivateNodeHandle().param("shutdown_at_end", false);
    const auto on_end = [shutdown_at_end] {
      if (shutdown_at_end) ros::requestShutdown();
    };
    try {
      ros::NodeHandle nh = callbacks_.attach(getNodeHandle());
      ros::NodeHandle private_nh = callbacks_.attach(getPrivateNodeHandle());
      player_ = std::make_unique<KittiPlayer>(nh, private_nh, on_end);
      callbacks_.start();
    } catch (const std::exception& error) {
      NODELET_FATAL("%s", error.what());
      throw;  // the loader reports the failure, so the launch ends
    }
  }

  CallbackThread callbacks_;
  std::unique_ptr<KittiPlayer> player_;
};

}  // namespace rotrocc

PLUGINLIB_EXPORT_CLASS(rotrocc::KittiPlayerNodelet, nodelet::Nodelet)
