#pragma once

#include <stdexcept>
#include <string>

#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>
#include <rosbag/view.h>
#include <boost/shared_ptr.hpp>

namespace rotrocc {

/// Opens a bag for reading. Throws std::runtime_error if it is missing or incomplete.
rosbag::Bag openBag(const std::string& path);

/// Returns a message of a bag. Throws std::runtime_error if it has another type or an old version
/// of it.
template <typename Message>
boost::shared_ptr<Message> readMessage(const rosbag::MessageInstance& instance) {
  const auto message = instance.instantiate<Message>();
  if (!message) {
    throw std::runtime_error("a message of " + instance.getTopic() + " is not a " +
                             ros::message_traits::DataType<Message>::value() +
                             " of this version of ROS");
  }
  return message;
}

/// Returns the first message of a topic; null if there is none.
template <typename Message>
boost::shared_ptr<Message> firstMessage(const rosbag::Bag& bag, const std::string& topic) {
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  return view.size() == 0 ? nullptr : readMessage<Message>(*view.begin());
}

}  // namespace rotrocc
