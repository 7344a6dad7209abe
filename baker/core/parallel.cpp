#include "baker/core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <thread>

namespace ft {

struct ThreadLimit::Impl {
  tbb::global_control control;
};

namespace {
std::size_t wanted(int thread_count) {
  if (thread_count > 0) return static_cast<std::size_t>(thread_count);
  return std::max(1u, std::thread::hardware_concurrency());
}
}  // namespace

ThreadLimit::ThreadLimit(int thread_count)
    : impl_(new Impl{tbb::global_control(tbb::global_control::max_allowed_parallelism, wanted(thread_count))}) {}
ThreadLimit::~ThreadLimit() = default;

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

namespace detail {

void run_blocks(std::size_t blocks, const std::function<void(std::size_t)>& body) {
  if (blocks <= 1 || thread_count() == 1) {
    for (std::size_t b = 0; b < blocks; ++b) body(b);
    return;
  }
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) { body(b); });
}

}  // namespace detail
}  // namespace ft
