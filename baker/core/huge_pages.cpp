#include "baker/core/huge_pages.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace ft {

void* new_huge_pages(std::size_t bytes) {
  void* const memory = ::operator new(bytes, k_huge_alignment);
#if defined(__linux__)
  madvise(memory, bytes, MADV_HUGEPAGE);  // where there are none it is small pages
#endif
  return memory;
}

}  // namespace ft
