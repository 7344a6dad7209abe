#include "baker/heap.h"

#include <cstdint>
#include <cstdlib>  // says whether it is glibc
#include <new>

#include "baker/core/large_blocks.h"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

// Sanitizers watch over what operator new gives, which has to be theirs.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FT_OWN_LARGE_BLOCKS 1
#endif
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#undef FT_OWN_LARGE_BLOCKS
#endif
#endif

namespace ft {
namespace {

/// Lists of so many bytes and more come and go with every search and every Newton iteration.
[[maybe_unused]] constexpr std::size_t k_large = 128 << 10;
/// Blocks begin at a multiple of this [bytes]; hardly anything else does.
[[maybe_unused]] constexpr std::uintptr_t k_least_page = 4096;
/// Other large memory, that of C libraries [bytes].
[[maybe_unused]] constexpr int k_mapped_from = 1 << 20;
/// Smaller ones: what they leave at the end of the heap, up to so much [bytes], is theirs again a moment later, and
/// costs more to return than to keep.
[[maybe_unused]] constexpr int k_kept_at_end = 2 << 20;

/// As long as the process lives: what is destroyed at its end frees lists, too.
[[maybe_unused]] LargeBlocks& large_blocks() {
  alignas(LargeBlocks) static std::byte room[sizeof(LargeBlocks)];
  static LargeBlocks* const blocks = new (room) LargeBlocks;
  return *blocks;
}

}  // namespace

void set_up_heap() {
#if defined(__GLIBC__)
  mallopt(M_MMAP_THRESHOLD, k_mapped_from);
  mallopt(M_TRIM_THRESHOLD, k_kept_at_end);
#endif
}

void trim_heap() {
#if defined(FT_OWN_LARGE_BLOCKS)
  large_blocks().trim();
#endif
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

void empty_heap() {
  trim_heap();
  trim_heap();  // of what was in use between the two
}

}  // namespace ft

#if defined(FT_OWN_LARGE_BLOCKS)
// All other forms of new and delete but the over-aligned ones come to these.
void* operator new(std::size_t bytes) {
  for (;;) {
    if (bytes >= ft::k_large)
      if (void* const block = ft::large_blocks().take(bytes)) return block;
    if (void* const memory = std::malloc(bytes > 0 ? bytes : 1)) return memory;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

void operator delete(void* memory) noexcept {
  if (memory == nullptr) return;
  if (reinterpret_cast<std::uintptr_t>(memory) % ft::k_least_page == 0 && ft::large_blocks().give_back(memory)) return;
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  operator delete(memory);
}
#endif
