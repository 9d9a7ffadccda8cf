#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>
#include <rosbag/view.h>
#include <boost/shared_ptr.hpp>

namespace rotrocc {

/// Opens a bag for reading. Throws std::runtime_error if it is missing or incomplete.
inline rosbag::Bag openBag(const std::string& path) {
  try {
    return rosbag::Bag(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw std::runtime_error(path +
                             " was not closed when it was written: run 'rosbag reindex' on it");
  } catch (const rosbag::BagException& error) {
    // Programs of a launch file have their own working directory, so print the absolute path.
    throw std::runtime_error(std::filesystem::absolute(path).string() +
                             " is not readable as a bag: " + error.what());
  }
}

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
