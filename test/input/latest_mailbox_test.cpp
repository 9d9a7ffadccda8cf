#include "input/latest_mailbox.h"

#include <thread>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

TEST(LatestMailboxTest, LatestItemWins) {
  LatestMailbox<int> mailbox;
  EXPECT_FALSE(mailbox.put(1));
  EXPECT_TRUE(mailbox.put(2));
  EXPECT_TRUE(mailbox.put(3));
  EXPECT_EQ(mailbox.take(milliseconds(0)), 3);
  EXPECT_FALSE(mailbox.take(milliseconds(0)).has_value());
}

TEST(LatestMailboxTest, ClosingEndsTheWait) {
  LatestMailbox<int> mailbox;
  std::thread closer([&] {
    std::this_thread::sleep_for(milliseconds(20));
    mailbox.close();
  });
  EXPECT_FALSE(mailbox.take(hours(1)).has_value());
  closer.join();
  EXPECT_TRUE(mailbox.closed());
  mailbox.put(1);
  EXPECT_FALSE(mailbox.take(milliseconds(0)).has_value());
}

TEST(LatestMailboxTest, EveryItemIsTakenOrReplaced) {
  LatestMailbox<int> mailbox;
  constexpr int kItems = 20000;
  int taken = 0;
  int last = -1;
  std::thread consumer([&] {
    while (last != kItems - 1) {
      const auto item = mailbox.take(hours(1));
      if (!item) break;
      EXPECT_GT(*item, last);
      last = *item;
      ++taken;
    }
  });
  int replaced = 0;
  for (int i = 0; i < kItems; ++i) replaced += mailbox.put(i) ? 1 : 0;
  consumer.join();
  EXPECT_EQ(taken + replaced, kItems);
}

}  // namespace
}  // namespace rotrocc
