#include "tests/support/assets.h"

#include <unistd.h>

#include <cstdlib>

namespace ft::test {

std::filesystem::path assets_root() {
  if (const char* env = std::getenv("FOLLOWTHROUGH_ASSETS")) return env;
  return std::filesystem::path(FT_SOURCE_DIR).parent_path() / "shared" / "assets";
}

std::filesystem::path assimp_models_root() {
  return "/usr/share/assimp/models";
}

ScratchFolder::ScratchFolder(Place place) {
  const bool in_memory = place == k_in_memory && ::access("/dev/shm", W_OK) == 0;
  const auto base = in_memory ? std::filesystem::path("/dev/shm") : std::filesystem::temp_directory_path();
  std::string pattern = (base / "followthrough_test_XXXXXX").string();
  path_ = ::mkdtemp(pattern.data());
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace ft::test
