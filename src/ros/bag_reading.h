#pragma once

#include <string>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <boost/shared_ptr.hpp>

namespace rotrocc {

/// Opens a bag to read it. Throws std::runtime_error if it is missing or no complete bag.
rosbag::Bag openBag(const std::string& path);

/// The first message of a topic; null if there is none, or it is of another type.
template <typename Message>
boost::shared_ptr<Message> firstMessage(const rosbag::Bag& bag, const std::string& topic) {
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  return view.size() == 0 ? nullptr : view.begin()->instantiate<Message>();
}

}  // namespace rotrocc
