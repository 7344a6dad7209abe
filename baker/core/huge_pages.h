// Memory for lists of many megabytes that come and go: mapped by themselves, in huge pages where the system has them. A
// matrix that is freed and filled anew in every iteration otherwise costs a page fault for every 4 KB of it, on a
// virtual machine some 8 us each: a sixth of the time at 40,000 vertices.
#pragma once

#include <cstddef>

namespace ft {

/// Of so many bytes and more lists are mapped.
constexpr std::size_t k_huge_page = std::size_t{2} << 20;

/// Room for that many bytes, at least k_huge_page; throws std::bad_alloc. Elsewhere than on Linux from the heap.
void* map_huge_pages(std::size_t bytes);
void unmap_huge_pages(void* memory, std::size_t bytes) noexcept;

/// For std::vector; what is smaller than a huge page comes from the heap.
template <class T>
struct HugePages {
  using value_type = T;

  HugePages() = default;
  template <class U>
  HugePages(const HugePages<U>&) {}  // NOLINT(google-explicit-constructor)
  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    return static_cast<T*>(bytes < k_huge_page ? ::operator new(bytes) : map_huge_pages(bytes));
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    const std::size_t bytes = count * sizeof(T);
    bytes < k_huge_page ? ::operator delete(memory) : unmap_huge_pages(memory, bytes);
  }
  bool operator==(const HugePages&) const = default;
};

}  // namespace ft
