#include "common/workers.h"

#include <array>
#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace rotrocc {
namespace {

TEST(WorkersTest, DoEveryPartOnceAndAllBeforeTheyReturn) {
  for (const int threads : {1, 2, 4}) {
    Workers workers(threads);
    for (int parts = 0; parts < 40; ++parts) {
      // Not atomic: the caller must see the results of all parts, and a part that runs twice is a
      // data race.
      std::vector<int> done(static_cast<std::size_t>(parts));
      workers.run(parts, [&](int i) { ++done[static_cast<std::size_t>(i)]; });
      EXPECT_EQ(done, std::vector<int>(static_cast<std::size_t>(parts), 1)) << threads;
    }
  }
}

TEST(WorkersTest, DoEachOfAListOnceInPartsThatNoTwoThreadsShare) {
  for (const int threads : {1, 2, 4}) {
    Workers workers(threads);
    for (const std::size_t count : {0U, 1U, 7U, 8U, 1000U}) {
      std::vector<int> done(count);
      std::array<std::size_t, Workers::kListParts> of_part = {};  // not atomic either
      workers.forEach(count, [&](std::size_t i, std::size_t part) {
        ++done[i];
        ++of_part.at(part);
      });
      EXPECT_EQ(done, std::vector<int>(count, 1)) << threads;
      for (const std::size_t of_one : of_part) EXPECT_LE(of_one, count / of_part.size() + 1);
    }
  }
}

TEST(WorkersTest, GoFromJobToJobWithoutLosingOne) {
  Workers workers(2);
  std::array<long, 2> sums = {};
  constexpr int kJobs = 20000;
  for (int job = 0; job < kJobs; ++job) {
    workers.run(2, [&](int i) { sums[static_cast<std::size_t>(i)] += job; });
  }
  EXPECT_EQ(sums[0], static_cast<long>(kJobs) * (kJobs - 1) / 2);
  EXPECT_EQ(sums[1], sums[0]);
}

TEST(WorkersTest, ThrowWhatAPartThrowsAndWorkOn) {
  for (const int threads : {1, 2}) {
    Workers workers(threads);
    std::atomic<int> done{0};
    try {
      workers.run(1000, [&](int i) {
        if (i == 10) throw std::runtime_error("part 10");
        ++done;
      });
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()), "part 10");
    }
    EXPECT_LT(done, 1000);
    done = 0;
    workers.run(8, [&](int) { ++done; });
    EXPECT_EQ(done, 8) << threads;
  }
}

TEST(WorkersTest, GoWithTheirOwner) {
  Workers workers(2);
  Workers moved = std::move(workers);
  moved = Workers(2);
  std::atomic<int> done{0};
  moved.run(8, [&](int) { ++done; });
  EXPECT_EQ(done, 8);
}

}  // namespace
}  // namespace rotrocc
