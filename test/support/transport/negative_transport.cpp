// An image transport for tests: sends negatives on TOPIC/negative.

#include <cstdint>
#include <string>

#include <image_transport/simple_publisher_plugin.h>
#include <image_transport/simple_subscriber_plugin.h>
#include <sensor_msgs/Image.h>
#include <boost/make_shared.hpp>
#include <pluginlib/class_list_macros.hpp>

namespace rotrocc {
namespace {

sensor_msgs::ImagePtr invert(const sensor_msgs::Image& image) {
  auto inverted = boost::make_shared<sensor_msgs::Image>(image);
  for (std::uint8_t& level : inverted->data) level = static_cast<std::uint8_t>(255 - level);
  return inverted;
}

}  // namespace

class NegativePublisher : public image_transport::SimplePublisherPlugin<sensor_msgs::Image> {
 public:
  std::string getTransportName() const override { return "negative"; }

 protected:
  void publish(const sensor_msgs::Image& image, const PublishFn& send) const override {
    send(*invert(image));
  }
};

class NegativeSubscriber : public image_transport::SimpleSubscriberPlugin<sensor_msgs::Image> {
 public:
  std::string getTransportName() const override { return "negative"; }

 protected:
  void internalCallback(const sensor_msgs::Image::ConstPtr& image,
                        const Callback& callback) override {
    callback(invert(*image));
  }
};

}  // namespace rotrocc

PLUGINLIB_EXPORT_CLASS(rotrocc::NegativePublisher, image_transport::PublisherPlugin)
PLUGINLIB_EXPORT_CLASS(rotrocc::NegativeSubscriber, image_transport::SubscriberPlugin)
