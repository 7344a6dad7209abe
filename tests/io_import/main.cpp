// The importing child process of these tests is this very executable. Files with the endings below stand for importers
// that go wrong in each way a process can.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "io/import/import.h"

namespace {

bool misbehave(const std::string& in, const char* out) {
  if (in.ends_with(".aborts")) std::abort();
  if (in.ends_with(".crashes")) ::raise(SIGSEGV);
  if (in.ends_with(".spins"))
    for (;;) static_cast<void>(::getpid());
  if (in.ends_with(".sleeps"))
    for (;;) ::sleep(1);
  if (in.ends_with(".leaves_nothing")) ::_exit(0);
  if (in.ends_with(".exits_with_9")) ::_exit(9);
  if (in.ends_with(".writes_garbage")) {
    std::ofstream(out) << "this is no character, but it is longer than the head of one would have to be";
    ::_exit(0);
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--import-child") == 0) {
    if (argc > 3) misbehave(argv[2], argv[3]);
    return ft::import_child_main(argc, argv);
  }
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
