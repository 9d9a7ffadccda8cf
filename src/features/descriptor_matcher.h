#pragma once

#include "features/stereo_frame.h"
#include "features/stereo_matcher.h"
#include "rotrocc/correspondence.h"
#include "rotrocc/stereo_camera.h"

namespace rotrocc {

/// Finds correspondences without a prediction, anywhere in the image: oriented binary descriptors
/// (ORB, Rublee et al. 2011) that are each other's nearest neighbor. They are exact to a pixel or
/// two, and many are wrong. It takes about 40 ms.
///
/// Returns what is seen in the left images of both frames and has a depth in the current one.
Correspondences matchDescriptors(const StereoCamera& camera,
                                 const Keyframe& keyframe,
                                 const StereoFrame& current,
                                 const StereoMatcher& depths);

}  // namespace rotrocc
