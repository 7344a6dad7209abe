#include "baker/core/large_blocks.h"

#include <algorithm>
#include <iterator>

#if defined(__unix__)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace ft {
namespace {

#if defined(__unix__)
std::size_t in_pages(std::size_t bytes) {
  static const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  return (std::max<std::size_t>(bytes, 1) + page - 1) / page * page;
}

std::byte* map_pages(std::size_t bytes) {
  void* const memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return memory == MAP_FAILED ? nullptr : static_cast<std::byte*>(memory);
}

bool unmap_pages(std::byte* begin, std::size_t bytes) {
  return ::munmap(begin, bytes) == 0;
}
#else
std::size_t in_pages(std::size_t bytes) {
  return bytes;
}
std::byte* map_pages(std::size_t) {
  return nullptr;
}
bool unmap_pages(std::byte*, std::size_t) {
  return true;
}
#endif

}  // namespace

LargeBlocks::~LargeBlocks() {
  used_ = 0;
  return_beyond(0);
}

void* LargeBlocks::take(std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  const std::size_t size = in_pages(bytes);
  if (size < bytes) return nullptr;  // there are not so many
  auto best = free_.end();
  for (auto run = free_.begin(); run != free_.end(); ++run)
    if (run->second.bytes >= size && (best == free_.end() || run->second.bytes < best->second.bytes)) best = run;
  std::byte* block = nullptr;
  if (best != free_.end()) {
    block = best->first;
    if (Run& run = best->second; run.bytes > size) {
      free_.emplace(block + size, Run{run.bytes - size, run.since});
      run.bytes = size;
    }
    used_blocks_.insert(free_.extract(best));
    kept_ -= size;
  } else {
    return_beyond(std::max(most_, used_ + size) - size);
    block = map_pages(size);
    if (block == nullptr) {
      return_beyond(0);
      block = map_pages(size);
    }
    if (block == nullptr) return nullptr;
    used_blocks_.emplace(block, Run{size, 0});
  }
  used_ += size;
  most_of_now_ = std::max(most_of_now_, used_);
  most_ = std::max(most_, used_);
  return block;
}

bool LargeBlocks::give_back(void* block) {
  const std::lock_guard lock(mutex_);
  const auto found = used_blocks_.find(static_cast<std::byte*>(block));
  if (found == used_blocks_.end()) return false;
  used_ -= found->second.bytes;
  add_free(used_blocks_.extract(found));
  return true;
}

void LargeBlocks::trim() {
  const std::lock_guard lock(mutex_);
  most_ = most_of_now_;
  most_of_now_ = used_;
  return_beyond(most_);
}

std::size_t LargeBlocks::used() const {
  const std::lock_guard lock(mutex_);
  return used_;
}

std::size_t LargeBlocks::kept() const {
  const std::lock_guard lock(mutex_);
  return kept_;
}

void LargeBlocks::add_free(Runs::node_type run) {
  kept_ += run.mapped().bytes;
  run.mapped().since = gives_++;
  const auto here = free_.insert(std::move(run)).position;
  const auto join = [&](Runs::iterator first, Runs::iterator second) {
    if (first->first + first->second.bytes != second->first) return;
    first->second = {first->second.bytes + second->second.bytes, here->second.since};  // the latest
    free_.erase(second);
  };
  if (const auto next = std::next(here); next != free_.end()) join(here, next);
  if (here != free_.begin()) join(std::prev(here), here);
}

/// Until no more than `most` are used and kept, as far as that goes: what has been free for longest.
void LargeBlocks::return_beyond(std::size_t most) {
  while (kept_ > 0 && used_ + kept_ > most) {
    const auto oldest = std::min_element(free_.begin(), free_.end(),
                                         [](const auto& a, const auto& b) { return a.second.since < b.second.since; });
    Run& run = oldest->second;
    const std::size_t bytes = std::min(run.bytes, in_pages(used_ + kept_ - most));
    if (!unmap_pages(oldest->first + (run.bytes - bytes), bytes)) return;
    kept_ -= bytes;
    run.bytes -= bytes;
    if (run.bytes == 0) free_.erase(oldest);
  }
}

}  // namespace ft
