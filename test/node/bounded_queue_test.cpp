#include "node/trajectory/bounded_queue.h"

#include <thread>

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

TEST(BoundedQueueTest, PassesAllInOrderToAnotherThread) {
  constexpr int kItems = 10000;
  BoundedQueue<int> queue(kItems);
  std::vector<int> taken;
  std::thread consumer([&] {
    for (;;) {
      const std::vector<int> items = queue.takeAll();
      if (items.empty()) return;
      taken.insert(taken.end(), items.begin(), items.end());
    }
  });
  for (int i = 0; i < kItems; ++i) EXPECT_TRUE(queue.put(i));
  queue.close();
  consumer.join();
  ASSERT_EQ(taken.size(), static_cast<std::size_t>(kItems));
  for (int i = 0; i < kItems; ++i) ASSERT_EQ(taken[static_cast<std::size_t>(i)], i);
}

}  // namespace
}  // namespace rotrocc
