// Loops whose result never depends on the number of threads: blocks are fixed by size, sums run over blocks in order.
// Everything parallel in the program goes through here (TBB underneath).
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace ft {

/// Caps the worker threads for as long as it lives; main() and tests own one. 0 means all cores.
class ThreadLimit {
 public:
  explicit ThreadLimit(int thread_count);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Number of threads that loops may use now.
int thread_count();

inline std::size_t block_count(std::size_t count, std::size_t block_size) {
  return (count + block_size - 1) / block_size;
}

namespace detail {
void run_blocks(std::size_t blocks, const std::function<void(std::size_t)>& body);
}

/// Calls body(begin, end) for consecutive ranges of block_size (the last may be shorter). Blocks may run in any order
/// and at the same time: body writes only what belongs to its range.
template <class Body>
void parallel_for(std::size_t count, std::size_t block_size, Body&& body) {
  const std::size_t blocks = block_count(count, block_size);
  if (blocks <= 1) {
    if (count > 0) body(std::size_t{0}, count);
    return;
  }
  detail::run_blocks(blocks, [&](std::size_t b) {
    const std::size_t begin = b * block_size;
    body(begin, begin + block_size < count ? begin + block_size : count);
  });
}

/// Sum over blocks: partial = body(begin, end) per block, partials added in block order. The same bits for any thread
/// count.
template <class T, class Body>
T parallel_sum(std::size_t count, std::size_t block_size, T zero, Body&& body) {
  const std::size_t blocks = block_count(count, block_size);
  if (blocks == 0) return zero;
  if (blocks == 1) return zero + body(std::size_t{0}, count);
  std::vector<T> partial(blocks, zero);
  parallel_for(count, block_size,
               [&](std::size_t begin, std::size_t end) { partial[begin / block_size] = body(begin, end); });
  T total = zero;
  for (const T& p : partial) total = total + p;
  return total;
}

/// Largest of zero and of body(begin, end) per block.
template <class T, class Body>
T parallel_max(std::size_t count, std::size_t block_size, T zero, Body&& body) {
  std::vector<T> partial(block_count(count, block_size), zero);
  parallel_for(count, block_size,
               [&](std::size_t begin, std::size_t end) { partial[begin / block_size] = body(begin, end); });
  for (const T& p : partial) zero = std::max(zero, p);
  return zero;
}

/// Runs independent tasks, task(i) for i in [0, count).
template <class Task>
void parallel_tasks(std::size_t count, Task&& task) {
  detail::run_blocks(count, [&](std::size_t i) { task(i); });
}

}  // namespace ft
