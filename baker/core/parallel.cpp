#include "baker/core/parallel.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <thread>
#include <vector>

// Debian's TBB is built without the thread sanitizer, which therefore sees neither the fork nor the join of a TBB loop
// and reports every loop as a race. Under that sanitizer our loops run on plain threads instead: the same blocks, and
// what it reports is ours.
#if defined(__SANITIZE_THREAD__)
#define FT_PLAIN_THREADS 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define FT_PLAIN_THREADS 1
#endif
#endif

#ifdef FT_PLAIN_THREADS
#include <exception>
#else
#include <tbb/parallel_for.h>
#endif

namespace ft {

struct ThreadLimit::Impl {
  tbb::global_control control;
};

namespace {
std::size_t wanted(int thread_count) {
  if (thread_count > 0) return static_cast<std::size_t>(thread_count);
  return std::max(1u, std::thread::hardware_concurrency());
}

#ifdef FT_PLAIN_THREADS
/// Thread w runs blocks w, w + n, ... whatever the others do: nothing orders the threads between start and end, so two
/// blocks of different threads that touch the same datum are seen in every run. The first exception is thrown again
/// here.
void run_on_threads(std::size_t blocks, const std::function<void(std::size_t)>& body) {
  const std::size_t n = std::min(blocks, static_cast<std::size_t>(thread_count()));
  std::vector<std::exception_ptr> caught(n);
  const auto work = [&](std::size_t w) {
    try {
      for (std::size_t b = w; b < blocks; b += n) body(b);
    } catch (...) {
      caught[w] = std::current_exception();
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t w = 1; w < n; ++w) threads.emplace_back(work, w);
  work(0);
  for (std::thread& t : threads) t.join();
  for (const std::exception_ptr& e : caught) {
    if (e) std::rethrow_exception(e);
  }
}
#else
void run_on_threads(std::size_t blocks, const std::function<void(std::size_t)>& body) {
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) { body(b); });
}
#endif
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
  run_on_threads(blocks, body);
}

}  // namespace detail
}  // namespace ft
