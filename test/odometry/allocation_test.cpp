// Counts the heap allocations of the estimator: malloc() and related functions are replaced for the
// whole program.

#include <malloc.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "rotrocc/visual_odometry.h"
#include "support/simulated_features.h"
#include "support/synthetic_scene.h"

// Sanitizers already replace them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ROTROCC_COUNTS_ALLOCATIONS 0
#else
#define ROTROCC_COUNTS_ALLOCATIONS 1
#endif

namespace {

std::atomic<bool> counting{false};
std::atomic<int> allocations{0};

void note() {
  if (counting) ++allocations;
}

}  // namespace

#if ROTROCC_COUNTS_ALLOCATIONS
extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  note();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  note();
  return __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) {
  note();
  return __libc_realloc(memory, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  note();
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  note();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  note();
  *memory = __libc_memalign(alignment, size);
  return *memory != nullptr ? 0 : ENOMEM;
}

}  // extern "C"
#endif

namespace rotrocc {
namespace {

constexpr int kPairs = 8;

/// Pairs along a bend, with camera noise.
std::vector<StereoPair> renderDrive(const SyntheticScene& scene) {
  std::vector<StereoPair> pairs;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  for (int i = 0; i < kPairs; ++i) {
    pairs.push_back(scene.render(T_world_camera, i * 100'000'000LL));
    SyntheticScene::addNoise(pairs.back(), 1.5, static_cast<std::uint64_t>(i));
    T_world_camera = T_world_camera * motion({0.006, 0.0, 0.6}, {0.0, 0.02, 0.0});
  }
  return pairs;
}

/// Number of allocations when the drive is repeated. The first motion of a drive is not counted: it
/// is searched without a prediction, by functions of OpenCV that allocate.
int countOfARepeatedDrive(const VisualOdometry::Config& config) {
  const SyntheticScene scene;
  std::vector<StereoPair> pairs = renderDrive(scene);
  VisualOdometry odometry(config);
  // Hypotheses change places, so it takes some drives until all their buffers are large enough.
  constexpr int kDrives = 12;
  for (int drive = 0; drive < kDrives; ++drive) {
    odometry.reset();
    int done = 0;
    for (StereoPair& pair : pairs) {
      counting = drive == kDrives - 1 && done++ > 1;
      const OdometryResult result = odometry.process(pair, scene.camera());
      EXPECT_NE(result.state, State::kLost) << result.reason;
      pair.stamp_ns += kPairs * 100'000'000LL;
    }
    if (drive == kDrives - 2) allocations = 0;
  }
  counting = false;
  return allocations;
}

class AllocationTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!ROTROCC_COUNTS_ALLOCATIONS) GTEST_SKIP() << "a sanitizer counts its own allocations";
  }
};

TEST_F(AllocationTest, AreSeen) {
  allocations = 0;
  counting = true;
  std::vector<int> numbers(1000);
  cv::Mat image(100, 100, CV_8UC1);
  const std::string text(100, ' ');
  counting = false;
  EXPECT_GE(allocations, 3) << numbers.size() << image.rows << text;
}

TEST_F(AllocationTest, AreNoneInTheSteadyState) {
  EXPECT_EQ(countOfARepeatedDrive({}), 0);
}

}  // namespace
}  // namespace rotrocc
