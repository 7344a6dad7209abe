#include "baker/heap.h"

#include <cstdlib>  // says whether it is glibc

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace ft {
namespace {

/// Lists that come and go with every search are larger than this [bytes] and shall not leave holes behind. Left to
/// itself the allocator takes more and more of them from its heap: 5 % of the memory at 40,000 vertices.
[[maybe_unused]] constexpr int k_mapped_from = 1 << 20;
/// Smaller ones come and go with every Newton iteration: what they leave at the end of the heap, up to so much [bytes],
/// is theirs again a moment later, and costs more to return than to keep.
[[maybe_unused]] constexpr int k_kept_at_end = 2 << 20;

}  // namespace

void set_up_heap() {
#if defined(__GLIBC__)
  mallopt(M_MMAP_THRESHOLD, k_mapped_from);
  mallopt(M_TRIM_THRESHOLD, k_kept_at_end);
#endif
}

void trim_heap() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace ft
