// followthrough. The order matters: first the machine (a program built for AVX2 dies without a word elsewhere), then
// the import child (it must not touch anything else), then the command line.
#include <unistd.h>

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

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--import-child") == 0) return ft::import_child_main(argc, argv);
  return ft::run_command_line(argc, argv);
}
