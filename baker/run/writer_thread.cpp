#include "baker/run/writer_thread.h"

#include <utility>

namespace ft::inline baker {

WriterThread::WriterThread(std::size_t capacity) : capacity_(capacity), thread_([this] { run(); }) {
  CHECK(capacity_ > 0);
}

WriterThread::~WriterThread() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

Status WriterThread::status() const {
  return failure_ ? Status(*failure_) : Status();
}

Status WriterThread::submit(Job job) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return failure_ || jobs_.size() < capacity_; });
  if (!failure_) jobs_.push_back(std::move(job));
  changed_.notify_all();
  return status();
}

Status WriterThread::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return jobs_.empty() && !busy_; });
  return status();
}

void WriterThread::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return stop_ || !jobs_.empty(); });
    if (jobs_.empty()) return;  // stopped, and everything handed in was written
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    busy_ = true;
    if (!failure_) {
      lock.unlock();
      const Status done = job();
      job = nullptr;  // and what it has
      lock.lock();
      if (!done) failure_ = done.error();
    }
    busy_ = false;
    changed_.notify_all();
  }
}

}  // namespace ft::inline baker
