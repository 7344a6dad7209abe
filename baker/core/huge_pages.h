// Memory for lists of many megabytes that come and go: in huge pages where the system has them. A matrix that is freed
// and filled anew in every iteration otherwise costs a page fault for every 4 KB of it, on a virtual machine some 8 us
// each: a sixth of the time at 40,000 vertices. See "Transparent Hugepage Support" in the Linux kernel's documentation.
#pragma once

#include <cstddef>
#include <new>

namespace ft {

/// Lists of so many bytes and more are in huge pages, each of which begins at a multiple of its size.
constexpr std::size_t k_huge_page = std::size_t{2} << 20;
constexpr std::align_val_t k_huge_alignment{k_huge_page};

/// Room for that many bytes, to be freed with k_huge_alignment; throws std::bad_alloc.
void* new_huge_pages(std::size_t bytes);

/// For std::vector.
template <class T>
struct HugePages {
  using value_type = T;

  HugePages() = default;
  template <class U>
  HugePages(const HugePages<U>&) {}  // NOLINT(google-explicit-constructor)
  T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    return static_cast<T*>(bytes < k_huge_page ? ::operator new(bytes) : new_huge_pages(bytes));
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    if (count * sizeof(T) < k_huge_page)
      ::operator delete(memory);
    else
      ::operator delete(memory, k_huge_alignment);
  }
  bool operator==(const HugePages&) const = default;
};

}  // namespace ft
