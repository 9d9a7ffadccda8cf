#include "node/trajectory/bounded_queue.h"

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

TEST(BoundedQueueTest, LeavesOutWhatIsTooMuchForASlowConsumer) {
  BoundedQueue<int> queue(3);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(queue.put(i));
  EXPECT_FALSE(queue.put(3)) << "it must not wait";
  EXPECT_EQ(queue.takeAll(), (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(queue.put(4));
  queue.close();
  EXPECT_EQ(queue.takeAll(), std::vector<int>{4}) << "what waits at the end is not lost";
  EXPECT_TRUE(queue.takeAll().empty());
}

}  // namespace
}  // namespace rotrocc
