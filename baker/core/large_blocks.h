// Memory for large lists that come and go, of all threads: in whole pages straight from the system, and what is freed
// is kept for the next list only as far as the program then holds no more than it lately used at most. glibc's heap
// held 11 to 15 MB in holes where 40,000 vertices took 106: a hole between two lists that stay is of no use to a larger
// one, and each thread has holes of its own. Returning every hole at once costs a page fault for each of its pages when
// it is wanted again, 2 to 8 us on the virtual machines that this was measured on.
//
// Best fit; neighbours are joined. Nothing depends on the addresses. Where there is no mmap it has no memory to give.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <map>
#include <mutex>
#include <new>
#include <utility>

namespace ft {

/// malloc() for containers: operator new may stand on LargeBlocks itself.
template <class T>
struct PlainMalloc {
  using value_type = T;

  PlainMalloc() = default;
  template <class U>
  PlainMalloc(const PlainMalloc<U>&) {}  // NOLINT(google-explicit-constructor)
  T* allocate(std::size_t count) {
    void* const memory = std::malloc(count * sizeof(T));
    if (memory == nullptr) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) noexcept { std::free(memory); }
  bool operator==(const PlainMalloc&) const = default;
};

class LargeBlocks {
 public:
  LargeBlocks() = default;
  ~LargeBlocks();  ///< returns what is kept, not what is used
  LargeBlocks(const LargeBlocks&) = delete;
  LargeBlocks& operator=(const LargeBlocks&) = delete;

  /// A block that begins at a page, or null where the system has none.
  void* take(std::size_t bytes);
  /// False, and nothing done, where it is none of its blocks. Needs no memory.
  bool give_back(void* block);
  /// From now on what was used since the last trim() is what was lately used: returns to the system what is kept beyond
  /// that.
  void trim();

  std::size_t used() const;  ///< bytes, in whole pages
  std::size_t kept() const;  ///< freed and not returned [bytes]

 private:
  struct Run {
    std::size_t bytes;
    std::uint64_t since;  ///< of a free one: gives that were before
  };
  using Runs = std::map<std::byte*, Run, std::less<>, PlainMalloc<std::pair<std::byte* const, Run>>>;
  void add_free(Runs::node_type run);
  void return_beyond(std::size_t most);

  mutable std::mutex mutex_;
  Runs used_blocks_, free_;
  std::size_t used_ = 0, kept_ = 0;
  std::size_t most_ = 0;         ///< that were lately used
  std::size_t most_of_now_ = 0;  ///< since the last trim()
  std::uint64_t gives_ = 0;
};

}  // namespace ft
