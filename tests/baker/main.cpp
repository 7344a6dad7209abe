// The importing child process of these tests is this very executable.
#include <gtest/gtest.h>

#include <cstring>

#include "io/import/import.h"

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--import-child") == 0) return ft::import_child_main(argc, argv);
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
