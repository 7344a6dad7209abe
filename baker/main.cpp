// followthrough. The order matters: first the machine (a program built for AVX2 dies without a word elsewhere), then
// the import child (it must not touch anything else), then the command line.
#include <unistd.h>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <cstdlib>
#include <cstring>

#include "baker/commands/command_line.h"
#include "io/import/import.h"

namespace {

// Runs before other initialisers; they may already use what the machine does not have.
__attribute__((constructor(101))) void check_machine() {
#if defined(__AVX2__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return;
  constexpr char k_text[] =
      "followthrough: this build needs a processor with AVX2 and FMA, and this one has none "
      "(build with -DFOLLOWTHROUGH_MARCH=x86-64 for it)\n";
  if (::write(2, k_text, sizeof k_text - 1) < 0) ::_exit(2);
  ::_exit(2);
#endif
}

/// Lists that come and go with every search are larger than this [bytes] and shall not leave holes behind. Left to
/// itself the allocator takes more and more of them from its heap: 5 % of the memory at 40,000 vertices.
constexpr int k_mapped_from = 1 << 20;
/// Smaller ones come and go with every Newton iteration: what they leave at the end of the heap, up to so much [bytes],
/// is theirs again a moment later, and costs more to return than to keep.
constexpr int k_kept_at_end = 2 << 20;

void give_memory_back() {
#if defined(M_MMAP_THRESHOLD)
  mallopt(M_MMAP_THRESHOLD, k_mapped_from);
  mallopt(M_TRIM_THRESHOLD, k_kept_at_end);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  give_memory_back();
  if (argc > 1 && std::strcmp(argv[1], "--import-child") == 0) return ft::import_child_main(argc, argv);
  return ft::run_command_line(argc, argv);
}
