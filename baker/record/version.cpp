#include "baker/record/version.h"

#include "baker/core/file.h"
#include "baker/core/hash.h"

namespace ft::inline baker {

std::string program_version() {
  return FT_VERSION;
}

const std::string& program_build() {
  static const std::string build = [] {
    std::error_code error;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) return std::string("unknown");
    const auto content = hash_file(program);
    return content ? content->hash.hex() : std::string("unknown");
  }();
  return build;
}

}  // namespace ft::inline baker
