#include "player/recording.h"

#include <filesystem>

#include "player/bag_recording.h"
#include "player/sequence_recording.h"

namespace rotrocc {

std::unique_ptr<Recording> openRecording(const PlayerOptions& options) {
  if (std::filesystem::is_directory(options.bag)) {
    return std::make_unique<SequenceRecording>(options);
  }
  return std::make_unique<BagRecording>(options);
}

}  // namespace rotrocc
