#pragma once

#include <filesystem>
#include <list>
#include <stdexcept>
#include <string>
#include <vector>

#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>
#include <rosbag/view.h>
#include <boost/shared_ptr.hpp>

namespace rotrocc {

/// A recording in one bag, or split into several. A list, as bags cannot be read once they are
/// moved.
using Bags = std::list<rosbag::Bag>;

/// Opens bags for reading. Throws std::runtime_error if one is missing or incomplete.
inline Bags openBags(const std::vector<std::string>& paths) {
  Bags bags;
  for (const std::string& path : paths) {
    try {
      bags.emplace_back(path, rosbag::bagmode::Read);
    } catch (const rosbag::BagUnindexedException&) {
      throw std::runtime_error(path +
                               " was not closed when it was written: run 'rosbag reindex' on it");
    } catch (const rosbag::BagException& error) {
      // Programs of a launch file have their own working directory, so print the absolute path.
      throw std::runtime_error(std::filesystem::absolute(path).string() +
                               " is not readable as a bag: " + error.what());
    }
  }
  return bags;
}

/// The messages of some topics, or of all if none are named, in the order of their time.
class BagView : public rosbag::View {
 public:
  explicit BagView(const Bags& bags,
                   const std::vector<std::string>& topics = {},
                   const ros::Time& from = ros::TIME_MIN,
                   const ros::Time& to = ros::TIME_MAX) {
    for (const rosbag::Bag& bag : bags) {
      if (topics.empty()) {
        addQuery(bag, from, to);
      } else {
        addQuery(bag, rosbag::TopicQuery(topics), from, to);
      }
    }
  }
};

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
boost::shared_ptr<Message> firstMessage(const Bags& bags, const std::string& topic) {
  BagView view(bags, {topic});
  return view.size() == 0 ? nullptr : readMessage<Message>(*view.begin());
}

}  // namespace rotrocc
