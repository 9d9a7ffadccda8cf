#include "bags/recording.h"

#include <filesystem>

#include "bags/bag_recording.h"
#include "bags/sequence_recording.h"

namespace rotrocc {

std::unique_ptr<Recording> openRecording(const std::string& path, const RecordingOptions& options) {
  if (!std::filesystem::is_directory(path)) {
    return std::make_unique<BagRecording>(path, options);
  }
  const SequenceOptions sequence = {
      options.max_stamp_difference_s, options.baseline_m, options.being_written};
  return std::make_unique<SequenceRecording>(
      path, SequenceRecording::Options{std::nullopt, true, sequence});
}

}  // namespace rotrocc
