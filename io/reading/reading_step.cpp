// One positioned write of a fixed size a step: no buffer that a crash could lose, and the kernel keeps what is written.
#include "io/reading/reading_step.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>

namespace ft::inline io {
namespace {

constexpr std::size_t k_length = 200;

/// Of the process, as its exit is.
int& steps_file() {
  static int file = -1;
  return file;
}

}  // namespace

void keep_reading_steps(const std::filesystem::path& file) {
  steps_file() = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
}

void reading_step(std::string_view what) {
  if (steps_file() < 0) return;
  std::array<char, k_length> line;
  line.fill(' ');
  std::copy_n(what.begin(), std::min(what.size(), k_length), line.begin());
  const ssize_t told = ::pwrite(steps_file(), line.data(), line.size(), 0);
  static_cast<void>(told);  // a step that cannot be told is no reason to stop
}

std::string last_reading_step(const std::filesystem::path& file) {
  std::array<char, k_length> line{};
  const int in = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (in < 0) return {};
  const ssize_t size = ::pread(in, line.data(), line.size(), 0);
  ::close(in);
  std::string out(line.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

}  // namespace ft::inline io
