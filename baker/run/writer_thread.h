// The one thread that writes. Jobs run in the order in which they were handed in, so a checkpoint handed in after a
// frame's caches is never older than them. The queue is bounded: a slow disk slows the bake instead of filling the
// memory. After the first failure nothing
// more is written; the failure comes back from the next submit() or finish().
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "baker/core/result.h"

namespace ft::inline baker {

class WriterThread {
 public:
  using Job = std::function<Status()>;

  /// capacity: jobs that may wait before submit() blocks, >= 1.
  explicit WriterThread(std::size_t capacity = 2);
  ~WriterThread();
  WriterThread(const WriterThread&) = delete;
  WriterThread& operator=(const WriterThread&) = delete;

  /// Takes the job, or says what went wrong before; then the job is dropped.
  Status submit(Job job);
  /// Waits until all jobs have run; the first failure, if any.
  Status finish();

 private:
  void run();
  Status status() const;

  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  bool busy_ = false, stop_ = false;
  std::optional<Error> failure_;
  std::thread thread_;
};

}  // namespace ft::inline baker
