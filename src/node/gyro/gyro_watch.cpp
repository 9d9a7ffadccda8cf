#include "node/gyro/gyro_watch.h"

namespace rotrocc {

GyroWatch::Message GyroWatch::onPair(const std::string& why_not) {
  if (why_not.empty()) {
    ++used_;
    patience_.onAnswer();
    if (used_ < kPairs || told_used_) return {};
    told_used_ = true;
    told_missed_ = false;
    return {false, "the gyroscope predicts rotations"};
  }
  patience_.onMiss();
  used_ = 0;
  if (!patience_.hasEnded() || told_missed_) return {};
  told_missed_ = true;
  told_used_ = false;
  return {true, "the gyroscope is not used: " + why_not};
}

}  // namespace rotrocc
