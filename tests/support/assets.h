// Outside data is looked for by path; when it is absent the test skips and says what is missing.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace ft::test {

/// $FOLLOWTHROUGH_ASSETS, else ../shared/assets beside the project.
std::filesystem::path assets_root();
/// Debian's assimp-testmodels.
std::filesystem::path assimp_models_root();
/// A fresh folder below the system's temporary folder, removed at the end.
class ScratchFolder {
 public:
  enum Place { k_temporary, k_in_memory };  ///< in memory where the system has such a place: for tests that sync a lot
  explicit ScratchFolder(Place place = k_temporary);
  ~ScratchFolder();
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace ft::test

#define FT_REQUIRE_FILE(path)                                                                    \
  do {                                                                                           \
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "skipped: " << (path) << " not present"; \
  } while (false)
