#pragma once

#include <functional>
#include <memory>

#include <tf2/buffer_core.h>

namespace rotrocc {

/// Starts to fill a buffer with tf. It is filled, by another thread, while the returned object
/// exists.
using TfFeed = std::function<std::shared_ptr<void>(tf2::BufferCore& buffer)>;

/// From the topics /tf and /tf_static.
std::shared_ptr<void> listenToTf(tf2::BufferCore& buffer);

}  // namespace rotrocc
