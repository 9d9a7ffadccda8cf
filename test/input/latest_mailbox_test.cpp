#include "input/latest_mailbox.h"

#include <thread>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;

TEST(LatestMailboxTest, LatestItemWins) {
  LatestMailbox<int> mailbox;
  EXPECT_EQ(mailbox.put(1), 0u);
  EXPECT_EQ(mailbox.put(2), 1u);
  EXPECT_EQ(mailbox.put(3), 1u);
  EXPECT_EQ(mailbox.take(milliseconds(0)), 3);
  EXPECT_FALSE(mailbox.take(milliseconds(0)).has_value());
}

TEST(LatestMailboxTest, WhatComesTogetherStaysTogether) {
  LatestMailbox<int> mailbox;
  mailbox.put(1);
  EXPECT_EQ(mailbox.put(2), 1u);
  EXPECT_EQ(mailbox.put(3, true), 0u);
  EXPECT_EQ(mailbox.take(milliseconds(0)), 2);
  EXPECT_EQ(mailbox.take(milliseconds(0)), 3);
  mailbox.put(4);
  mailbox.put(5, true);
  EXPECT_EQ(mailbox.put(6), 2u);
  EXPECT_EQ(mailbox.take(milliseconds(0)), 6);
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
  for (int i = 0; i < kItems; ++i) replaced += static_cast<int>(mailbox.put(i));
  consumer.join();
  EXPECT_EQ(taken + replaced, kItems);
}

}  // namespace
}  // namespace rotrocc
