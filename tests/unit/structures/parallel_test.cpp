#include "lacon/structures/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "lacon/catalog/messages.hpp"

using namespace lacon;

namespace {

struct Parallel : testing::Test {
  void TearDown() override { unsetenv("LACON_THREADS"); }
  static void set_threads(const std::string& count) { setenv("LACON_THREADS", count.c_str(), 1); }
};

double value(std::size_t i) { return std::sin(1e3 * static_cast<double>(i)) * std::exp(static_cast<double>(i % 40)); }

TEST_F(Parallel, TheBitsDoNotDependOnTheNumberOfThreads) {
  constexpr std::size_t size = 100;
  for (const std::size_t n : {0, 1, 99, 100, 101, 12345}) {
    std::vector<double> expected(n),
        expected_sums(n_loop_blocks(n, size));  // rounding makes every other order of a sum visible
    for (std::size_t i = 0; i < n; ++i) expected_sums[i / size] += expected[i] = value(i);
    for (const char* threads : {"1", "2", "3", "5"}) {
      set_threads(threads);
      std::vector<double> values(n), sums(n_loop_blocks(n, size));
      parallel_for(n, size, [&](const LoopBlock& block) {
        for (std::size_t i = block.first; i < block.last; ++i) sums[block.index] += values[i] = value(i);
      });
      EXPECT_EQ(values, expected) << threads << " threads, " << n << " items";
      EXPECT_EQ(sums, expected_sums) << threads << " threads, " << n << " items";
    }
  }
}

TEST_F(Parallel, SeveralThreadsWorkAtOnce) {
  set_threads("3");
  std::atomic<int> there = 0;  // nobody goes on before all three are there
  parallel_for(3, 1, [&](const LoopBlock&) {
    ++there;
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (there < 3) {
      if (std::chrono::steady_clock::now() > give_up) throw std::runtime_error("alone");
      std::this_thread::yield();
    }
  });
  EXPECT_EQ(there, 3);
}

TEST_F(Parallel, TheErrorOfTheFirstBlockThatThrowsReachesTheCaller) {
  for (const char* threads : {"1", "2", "3", "5"}) {
    set_threads(threads);
    for (int repetition = 0; repetition < 20; ++repetition) {
      std::vector<int> done(40, 0);
      const auto work = [&](const LoopBlock& block) {
        // the first block that throws takes longer than the later ones
        if (block.index == 7) std::this_thread::sleep_for(std::chrono::microseconds(200));
        if (block.index >= 7) throw std::runtime_error("block " + std::to_string(block.index));
        done[block.index] = 1;
      };
      try {
        parallel_for(40, 1, work);
        FAIL() << "nothing was thrown";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "block 7");
      }
      EXPECT_EQ(std::accumulate(done.begin(), done.end(), 0), 7);  // all blocks before it were worked on
    }
  }
}

TEST_F(Parallel, WhatIsDoneInTurnIsDoneInTheOrderOfBlocks) {
  constexpr std::size_t n = 1000, size = 7;
  for (const char* threads : {"1", "2", "3", "5"}) {
    set_threads(threads);
    std::vector<std::size_t> seen;  // no lock: one at a time
    std::atomic<int> workers = 0;
    parallel_in_turn(n, size, [&] {
      ++workers;
      const auto own = std::make_shared<std::vector<std::size_t>>();  // of one thread, from work to turn
      return LoopWorker{[own](const LoopBlock& block) {
                          own->clear();
                          for (std::size_t i = block.first; i < block.last; ++i) own->push_back(i);
                          if (block.index % 5 == 0) std::this_thread::sleep_for(std::chrono::microseconds(50));
                        },
                        [own, &seen](const LoopBlock&) { seen.insert(seen.end(), own->begin(), own->end()); }};
    });
    std::vector<std::size_t> all(n);
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(seen, all) << threads << " threads";
    EXPECT_LE(workers, 2 * std::stoi(threads));
  }
}

TEST_F(Parallel, AfterAnErrorNoLaterBlockHasItsTurn) {
  for (const char* threads : {"1", "2", "3", "5"}) {
    for (const bool in_turn : {false, true}) {
      set_threads(threads);
      std::vector<std::size_t> seen;
      const auto fail_from = [](const LoopBlock& block) {
        if (block.index == 11) std::this_thread::sleep_for(std::chrono::microseconds(200));
        if (block.index >= 11) throw std::runtime_error("block " + std::to_string(block.index));
      };
      const auto worker = [&] {
        return LoopWorker{[&](const LoopBlock& block) {
                            if (!in_turn) fail_from(block);
                          },
                          [&](const LoopBlock& block) {
                            if (in_turn) fail_from(block);
                            seen.push_back(block.index);
                          }};
      };
      try {
        parallel_in_turn(50, 1, worker);
        FAIL() << "nothing was thrown";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "block 11");
      }
      EXPECT_EQ(seen.size(), 11u) << threads << " threads";
    }
  }
}

TEST_F(Parallel, ALoopInALoopStaysInItsThread) {
  set_threads("2");
  std::vector<int> own(4 * 50, 0);
  parallel_for(4, 1, [&](const LoopBlock& outer) {
    const auto thread = std::this_thread::get_id();
    parallel_for(50, 7, [&](const LoopBlock& inner) {
      for (std::size_t i = inner.first; i < inner.last; ++i) own[outer.index * 50 + i] = std::this_thread::get_id() == thread;
    });
  });
  EXPECT_EQ(std::accumulate(own.begin(), own.end(), 0), 200);
}

TEST_F(Parallel, TheNumberOfThreadsIsThatOfTheEnvironment) {
  EXPECT_EQ(n_threads(), 1u);
  set_threads("12");
  EXPECT_EQ(n_threads(), 12u);
  for (const char* wrong : {"", "0", "-1", "two", "2 ", "1.5", "99999999999999999999999"}) {
    set_threads(wrong);
    try {
      n_threads();
      ADD_FAILURE() << "accepted: '" << wrong << "'";
    } catch (const Error& error) {
      EXPECT_EQ(error.message().id, "THREADS_1");
      EXPECT_NE(error.message().text.find("'" + std::string(wrong) + "'"), std::string::npos);
    }
  }
}

}  // namespace
