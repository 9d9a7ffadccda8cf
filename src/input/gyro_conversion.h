#pragma once

#include <sensor_msgs/Imu.h>

#include "inertial/gyro_sample.h"
#include "input/message_conversion.h"

namespace rotrocc {

inline GyroSample toGyroSample(const sensor_msgs::Imu& message) {
  const geometry_msgs::Vector3& rate = message.angular_velocity;
  return {toNanoseconds(message.header.stamp), {rate.x, rate.y, rate.z}};
}

}  // namespace rotrocc
