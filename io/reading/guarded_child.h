// Files that can corrupt the memory of who reads them are read by a child process, under limits on CPU time, memory and
// wall-clock time, and its result comes back as bytes. However the child ends, the parent gets them or one clear Error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "baker/core/bytes.h"
#include "baker/core/result.h"

namespace ft::inline io {

struct ChildLimits {
  double seconds = 60;                                  ///< CPU time of the child
  std::uint64_t memory_bytes = std::uint64_t{4} << 30;  ///< its address space, and the size of its result
};

/// The command line of a child: program, `first`, the file that it reads, the file that it writes, `last`.
struct ChildTask {
  std::filesystem::path program = "/proc/self/exe";
  std::filesystem::path file;  ///< also what errors name
  std::vector<std::string> first, last;
};

/// What the child wrote. Input errors: it refused the file, and why; it crashed, took too long, or too much memory, and
/// what it was reading then (reading_step.h).
Result<Bytes> read_in_child(const ChildTask& task, const ChildLimits& limits);

/// The child's side: `work` writes `result`, or returns the reason why not. Gives the exit code of the process.
int child_exit_code(const std::filesystem::path& result, const std::function<Status()>& work);

/// Whose bytes came back and are not what they should be, for the parent: names the file.
Error damaged_child_result(const ChildTask& task, const std::string& what);

}  // namespace ft::inline io
