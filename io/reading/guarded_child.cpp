// Source: fork and exec as in "Advanced Programming in the UNIX Environment" 8; between them only calls that are safe
// after fork in a program with threads. RLIMIT_AS is left out under sanitizers, whose shadow memory would not fit.
#include "io/reading/guarded_child.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <new>
#include <thread>

#include "baker/core/file.h"
#include "io/reading/reading_step.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FT_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define FT_SANITIZED 1
#endif
#endif

namespace ft::inline io {
namespace {

constexpr int k_exit_refused = 3;  // the result file holds the reason and, in its last line, what to do
constexpr int k_exit_out_of_memory = 9;
constexpr int k_exit_threw = 10;  // not 1: with that a sanitizer ends the process

/// A folder that only this child uses; removed with all in it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::error_code ignored;
    auto base = std::filesystem::temp_directory_path(ignored);
    std::string pattern = (base / "followthrough_import_XXXXXX").string();
    if (::mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void limit(decltype(RLIMIT_CPU) what, rlim_t soft, rlim_t hard) {
  rlimit r{};
  if (::getrlimit(what, &r) == 0 && r.rlim_max != RLIM_INFINITY)
    hard = std::min(hard, r.rlim_max), soft = std::min(soft, hard);
  r.rlim_cur = soft, r.rlim_max = hard;
  ::setrlimit(what, &r);
}

/// In the child, between fork and exec.
[[noreturn]] void become_reader(char* const* command, rlim_t seconds, rlim_t bytes, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  const int null = ::open("/dev/null", O_RDWR);
  if (null >= 0) ::dup2(null, 0), ::dup2(null, 1);
#ifndef FT_SANITIZED  // whose report should be seen
  if (null >= 0) ::dup2(null, 2);
#endif
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::setpgid(0, 0);  // Ctrl-C at the terminal is the parent's business
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_CPU, seconds, seconds + 1);
#ifndef FT_SANITIZED
  limit(RLIMIT_AS, bytes, bytes);
#endif
  limit(RLIMIT_FSIZE, bytes, bytes);
  ::execv(command[0], command);
  ::_exit(127);
}

/// Waits for the child, at most until the deadline; then kills it. False when it had to.
bool wait_for(pid_t child, double seconds, int& status) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  const int handle = static_cast<int>(::syscall(SYS_pidfd_open, child, 0));
  bool in_time = true;
  for (;;) {
    const pid_t got = ::waitpid(child, &status, in_time ? WNOHANG : 0);
    if (got == child || (got < 0 && errno != EINTR)) break;
    const double left = std::chrono::duration<double>(deadline - std::chrono::steady_clock::now()).count();
    if (left <= 0) {
      if (in_time) ::kill(child, SIGKILL);
      in_time = false;
      continue;
    }
    if (handle >= 0) {
      pollfd wait{handle, POLLIN, 0};
      ::poll(&wait, 1, static_cast<int>(std::min(left * 1000 + 1, 1000.0)));
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  if (handle >= 0) ::close(handle);
  return in_time;
}

/// The child's words may hold bytes of the damaged file.
std::string printable(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) c = '?';
  if (text.size() > 500) text.resize(500);
  return text;
}

std::string seconds_text(double s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g s", s);
  return text;
}

constexpr const char* k_hint = "the file is damaged, or of a kind that the importer cannot read; export it again";

std::filesystem::path steps_of(const std::filesystem::path& result) {
  return result.parent_path() / (result.filename().string() + ".step");
}

/// Of a child that ended: nothing when it left a result.
Status judge(int status, bool in_time, const std::string& name, const std::filesystem::path& out,
             const ChildLimits& limits) {
  const std::string step = last_reading_step(steps_of(out));
  const std::string on = step.empty() ? " before it read anything" : " while reading " + step;
  if (!in_time) return input_error("import took too long and was stopped" + on, name, k_hint);
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU || signal == SIGKILL)
      return input_error(
          "import took more than " + seconds_text(limits.seconds) + " of CPU time, or was killed, and was stopped" + on,
          name, k_hint);
    if (signal == SIGXFSZ) return input_error("import result is larger than the memory limit", name, k_hint);
    return input_error("the importer crashed" + on + " (" + ::strsignal(signal) + "); nothing of it was used", name,
                       k_hint);
  }
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == k_exit_refused) {
    const auto reason = read_text(out, 1 << 16);
    const std::string words = reason ? *reason : "cannot be read\n";
    const std::size_t line = std::min(words.rfind('\n'), words.size());
    return input_error(printable(words.substr(0, line)), name,
                       line < words.size() ? printable(words.substr(line + 1)) : std::string());
  }
  if (code == k_exit_out_of_memory)
    return input_error("import needs more than " + std::to_string(limits.memory_bytes >> 20) + " MiB of memory" + on,
                       name, k_hint);
  if (code == k_exit_threw) {
    const auto reason = read_text(out, 1 << 16);
    return input_error("the importer gave up" + on + (reason ? ": " + printable(*reason) : std::string()), name,
                       k_hint);
  }
  if (code != 0)
    return input_error("the importing process ended with code " + std::to_string(code) + on, name,
                       "it may have had too little memory to start");
  return {};
}

}  // namespace

Result<Bytes> read_in_child(const ChildTask& task, const ChildLimits& limits) {
  const std::string name = task.file.string();
  const ScratchFolder scratch;
  if (scratch.path().empty())
    return output_error("cannot make a temporary folder for the import", name, std::strerror(errno));
  const auto out = scratch.path() / "result";
  std::vector<std::string> words{task.program.string()};
  words.insert(words.end(), task.first.begin(), task.first.end());
  words.insert(words.end(), {std::filesystem::absolute(task.file).string(), out.string()});
  words.insert(words.end(), task.last.begin(), task.last.end());
  std::vector<char*> command;
  for (std::string& word : words) command.push_back(word.data());
  command.push_back(nullptr);

  const auto seconds = static_cast<rlim_t>(std::ceil(std::max(limits.seconds, 0.0)));
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) return output_error(std::string("cannot start the importing process: ") + std::strerror(errno), name);
  if (child == 0) become_reader(command.data(), seconds, limits.memory_bytes, parent);

  int status = 0;
  // A busy machine may give the child little of its time: the wall-clock limit is only there for one that sleeps.
  const bool in_time = wait_for(child, 4 * limits.seconds + 5, status);
  if (Status ended = judge(status, in_time, name, out, limits); !ended) return ended.error();
  auto bytes = read_file(out);
  if (!bytes) return input_error("the importing process left no result", name, k_hint);
  return bytes;
}

int child_exit_code(const std::filesystem::path& result, const std::function<Status()>& work) {
  keep_reading_steps(steps_of(result));
  try {
    const Status done = work();
    if (done) return 0;
    if (done.error().kind == ErrorKind::k_output) return exit_code(ErrorKind::k_output);
    const Error& e = done.error();
    const Status told = write_text_durably(result, (e.where.empty() ? "" : e.where + ": ") + e.what + '\n' + e.hint);
    return told ? k_exit_refused : exit_code(ErrorKind::k_output);
  } catch (const std::bad_alloc&) {
    return k_exit_out_of_memory;
  } catch (const std::exception& e) {
    static_cast<void>(write_text_durably(result, e.what()));
    return k_exit_threw;
  }
}

Error damaged_child_result(const ChildTask& task, const std::string& what) {
  return input_error(what, task.file.string(), k_hint);
}

}  // namespace ft::inline io
