// The importing child process of these tests is this very executable. Files with the endings below stand for importers
// that go wrong in each way a process can.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/import/import.h"
#include "io/reading/guarded_child.h"
#include "io/reading/reading_step.h"

namespace {

bool misbehave(const std::string& in, const char* out) {
  const auto at_a_mesh = [&] {
    ft::keep_reading_steps(std::string(out) + ".step");
    ft::reading_step("the nodes, with the test's reader");
    ft::reading_step("mesh \"Body\", with the test's reader");
  };
  if (in.ends_with(".aborts_on_a_mesh")) at_a_mesh(), std::abort();
  if (in.ends_with(".spins_on_a_mesh"))
    for (at_a_mesh();;) static_cast<void>(::getpid());
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
    if (argc > 3 && std::string(argv[2]).ends_with(".throws"))
      return ft::child_exit_code(argv[3], []() -> ft::Status {
        ft::reading_step("a test");
        throw std::runtime_error("too odd");
      });
    return ft::import_child_main(argc, argv);
  }
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
