#include "baker/core/huge_pages.h"

#include <cstdint>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace ft {

#if defined(__linux__)

void* map_huge_pages(std::size_t bytes) {
  // Huge pages begin at multiples of their size: map one more, and give back what is before and behind.
  const std::size_t mapped = bytes + k_huge_page;
  void* const all = mmap(nullptr, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (all == MAP_FAILED) throw std::bad_alloc();
  const auto begin = reinterpret_cast<std::uintptr_t>(all);
  const std::uintptr_t first = (begin + k_huge_page - 1) / k_huge_page * k_huge_page;
  constexpr std::uintptr_t k_page = 4096;
  const std::uintptr_t last = (first + bytes + k_page - 1) / k_page * k_page, end = begin + mapped;
  if (first > begin) munmap(all, first - begin);
  if (end > last) munmap(reinterpret_cast<void*>(last), end - last);
  void* const memory = reinterpret_cast<void*>(first);
  madvise(memory, bytes, MADV_HUGEPAGE);  // where there are none it is small pages
  return memory;
}

void unmap_huge_pages(void* memory, std::size_t bytes) noexcept {
  munmap(memory, bytes);
}

#else

void* map_huge_pages(std::size_t bytes) {
  return ::operator new(bytes);
}

void unmap_huge_pages(void* memory, std::size_t) noexcept {
  ::operator delete(memory);
}

#endif

}  // namespace ft
