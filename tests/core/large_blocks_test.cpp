// Large blocks are what a program needs of them, no page is in two, and no more of them stay than were lately used.
#include "baker/core/large_blocks.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <thread>
#include <vector>

#include "baker/core/random.h"

namespace ft {
namespace {

constexpr std::size_t k_page = 4096;

/// A block with a number in all of its bytes.
struct Held {
  unsigned char* block = nullptr;
  std::size_t bytes = 0;
  unsigned char number = 0;

  Held(LargeBlocks& blocks, std::size_t size, unsigned char n)
      : block(static_cast<unsigned char*>(blocks.take(size))), bytes(size), number(n) {
    if (block != nullptr) std::memset(block, n, bytes);
  }
  bool is_whole() const {
    if (block == nullptr) return false;
    for (std::size_t i = 0; i < bytes; ++i)
      if (block[i] != number) return false;
    return true;
  }
};

TEST(LargeBlocks, A_block_holds_what_is_put_in_it_beside_all_others) {
  LargeBlocks blocks;
  std::vector<Held> held;
  std::size_t in_use = 0;
  for (std::uint64_t round = 0; round < 3000; ++round) {
    const auto dice = [&](std::uint64_t k) { return random_uniform({round, 0, 0, 0}, k); };
    if (held.size() < 40 && dice(0) < 0.55) {
      held.emplace_back(blocks, static_cast<std::size_t>(1 + dice(1) * 60 * k_page), static_cast<unsigned char>(round));
      ASSERT_EQ(reinterpret_cast<std::uintptr_t>(held.back().block) % k_page, 0u);
      in_use += (held.back().bytes + k_page - 1) / k_page * k_page;
    } else if (!held.empty()) {
      std::swap(held[static_cast<std::size_t>(dice(1) * static_cast<double>(held.size()))], held.back());
      ASSERT_TRUE(held.back().is_whole());
      ASSERT_TRUE(blocks.give_back(held.back().block));
      in_use -= (held.back().bytes + k_page - 1) / k_page * k_page;
      held.pop_back();
    }
    if (round % 100 == 99) blocks.trim();
    ASSERT_EQ(blocks.used(), in_use);
  }
  for (const Held& h : held) ASSERT_TRUE(h.is_whole() && blocks.give_back(h.block));
  EXPECT_EQ(blocks.used(), 0u);
}

TEST(LargeBlocks, What_is_used_and_kept_is_no_more_than_was_lately_used_at_most) {
  LargeBlocks blocks;
  std::size_t most = 0;
  std::vector<void*> held;
  for (std::uint64_t round = 0; round < 2000; ++round) {
    const auto dice = [&](std::uint64_t k) { return random_uniform({round, 1, 0, 0}, k); };
    if (dice(0) < 0.5 && held.size() < 30) {
      held.push_back(blocks.take(static_cast<std::size_t>(1 + dice(1) * 100 * k_page)));
    } else if (!held.empty()) {
      std::swap(held[static_cast<std::size_t>(dice(1) * static_cast<double>(held.size()))], held.back());
      blocks.give_back(held.back());
      held.pop_back();
    }
    most = std::max(most, blocks.used());
    ASSERT_LE(blocks.used() + blocks.kept(), most);
  }
  EXPECT_GT(blocks.kept(), 0u);
  for (void* block : held) blocks.give_back(block);
  EXPECT_EQ(blocks.kept(), most) << "for the next ones";
  blocks.trim();
  blocks.trim();
  EXPECT_EQ(blocks.kept(), 0u);
}

TEST(LargeBlocks, Neighbours_that_are_free_make_one_block) {
  LargeBlocks blocks;
  void* const whole = blocks.take(12 * k_page);
  blocks.give_back(whole);
  std::vector<void*> parts;
  for (int k = 0; k < 4; ++k) parts.push_back(blocks.take(3 * k_page));
  EXPECT_EQ(parts[0], whole);
  EXPECT_EQ(blocks.kept(), 0u);
  for (const std::size_t k : {1u, 3u, 0u, 2u}) blocks.give_back(parts[k]);
  EXPECT_EQ(blocks.take(12 * k_page), whole);
  blocks.give_back(whole);
}

TEST(LargeBlocks, The_smallest_run_that_is_large_enough_is_taken) {
  LargeBlocks blocks;
  std::vector<void*> held;
  for (const std::size_t pages : {9u, 1u, 5u, 1u, 7u, 1u}) held.push_back(blocks.take(pages * k_page));
  for (const std::size_t k : {0u, 2u, 4u}) blocks.give_back(held[k]);
  EXPECT_EQ(blocks.take(4 * k_page), held[2]);
  EXPECT_EQ(blocks.take(6 * k_page), held[4]);
}

TEST(LargeBlocks, What_cannot_be_had_or_is_of_others_is_refused) {
  LargeBlocks blocks;
  EXPECT_EQ(blocks.take(std::numeric_limits<std::size_t>::max()), nullptr);
  EXPECT_EQ(blocks.take(std::numeric_limits<std::size_t>::max() / 4), nullptr);
  EXPECT_EQ(blocks.used(), 0u);
  int other = 0;
  EXPECT_FALSE(blocks.give_back(&other));
  void* const block = blocks.take(2 * k_page);
  EXPECT_FALSE(blocks.give_back(static_cast<std::byte*>(block) + k_page));
  EXPECT_TRUE(blocks.give_back(block));
  EXPECT_FALSE(blocks.give_back(block)) << "again";
}

TEST(LargeBlocks, Threads_take_and_give_at_the_same_time) {
  LargeBlocks blocks;
  std::vector<std::thread> threads;
  std::vector<int> spoilt(4, 0);
  for (std::size_t t = 0; t < spoilt.size(); ++t)
    threads.emplace_back([&, t] {
      for (std::uint64_t round = 0; round < 500; ++round) {
        const auto bytes = static_cast<std::size_t>(1 + random_uniform({round, t, 0, 0}, 0) * 30 * k_page);
        const Held a(blocks, bytes, static_cast<unsigned char>(t)), b(blocks, k_page, static_cast<unsigned char>(9));
        spoilt[t] += a.is_whole() && b.is_whole() ? 0 : 1;
        blocks.give_back(b.block);
        blocks.give_back(a.block);
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(spoilt, std::vector<int>(4, 0));
  EXPECT_EQ(blocks.used(), 0u);
}

}  // namespace
}  // namespace ft
