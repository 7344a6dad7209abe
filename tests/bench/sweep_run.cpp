#include "tests/bench/sweep_run.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fstream>
#include <sstream>

#include "baker/core/file.h"

namespace ft::bench {
namespace {

constexpr int k_look_milliseconds = 500;

/// CPU time of a process so far [s]; 0 once it is gone.
double cpu_of(pid_t process) {
  clockid_t clock = 0;
  timespec time{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0;
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Writes what it is given to the log and keeps the time of each line about a frame.
class Listener {
 public:
  Listener(const std::filesystem::path& log, pid_t process) : log_(log, std::ios::binary), process_(process) {}

  void take(const char* text, std::size_t size) {
    log_.write(text, static_cast<std::streamsize>(size));
    log_.flush();
    for (std::size_t i = 0; i < size; ++i) {
      if (text[i] != '\n') {
        line_ += text[i];
        continue;
      }
      // "frame 12  36/72 ...", and no line of the preamble.
      if (line_.starts_with("frame ")) {
        const double now = cpu_of(process_);
        frames.push_back(now - last_);
        last_ = now;
      }
      line_.clear();
    }
  }

  std::vector<double> frames;

 private:
  std::ofstream log_;
  pid_t process_;
  std::string line_;
  double last_ = 0;
};

pid_t start(const std::vector<std::string>& command, int output) {
  const pid_t process = fork();
  if (process != 0) return process;
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  execvp(words[0], words.data());
  _exit(127);
}

}  // namespace

Result<MeasuredRun> run_measured(const std::vector<std::string>& command, double limit,
                                 const std::filesystem::path& log) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return output_error("no pipe", std::strerror(errno));
  const pid_t process = start(command, ends[1]);
  close(ends[1]);
  if (process < 0) return output_error("no process", std::strerror(errno));
  Listener listener(log, process);
  bool asked = false, made = false;
  char buffer[4096];
  for (;;) {
    pollfd waiting{ends[0], POLLIN, 0};
    if (poll(&waiting, 1, k_look_milliseconds) > 0) {
      const ssize_t size = read(ends[0], buffer, sizeof buffer);
      if (size == 0 || (size < 0 && errno != EINTR)) break;
      if (size > 0) listener.take(buffer, static_cast<std::size_t>(size));
    }
    const double cpu = cpu_of(process);
    if (cpu > limit && !asked) asked = kill(process, SIGTERM) == 0;
    if (cpu > 1.1 * limit && !made) made = kill(process, SIGKILL) == 0;
  }
  close(ends[0]);
  MeasuredRun out;
  int status = 0;
  rusage usage{};
  while (wait4(process, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  out.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  out.exit_code = asked ? k_took_too_long : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  out.frame_cpu_seconds = std::move(listener.frames);
  return out;
}

Status write_run(const std::filesystem::path& file, const MeasuredRun& run) {
  std::string text = fmt::format("{}\n{:.3f}\n", run.exit_code, run.cpu_seconds);
  for (const double seconds : run.frame_cpu_seconds) text += fmt::format("{:.4f}\n", seconds);
  return write_text_durably(file, text);
}

Result<MeasuredRun> read_run(const std::filesystem::path& file) {
  auto text = read_text(file);
  if (!text) return text.error();
  MeasuredRun out;
  std::istringstream in(*text);
  if (!(in >> out.exit_code >> out.cpu_seconds)) return input_error("is not of a measured run", file.string());
  for (double seconds; in >> seconds;) out.frame_cpu_seconds.push_back(seconds);
  return out;
}

}  // namespace ft::bench
