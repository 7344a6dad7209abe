// A full disk, a failed write, a killed process loses no finished frame: every call of a ten-frame write that changes a
// file fails in turn, alone, for good, after half of its bytes, or is the moment at which the process is killed; the
// same while a cache is continued.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>

#include "baker/core/file.h"
#include "tests/support/assets.h"
#include "tests/support/cache_samples.h"

namespace ft::test {
namespace {

constexpr int k_frames = 10;

class FailingWrites : public testing::TestWithParam<CacheFormat> {
 protected:
  FailingWrites() {
    // A real disk would be synced some thousand times; what is tested is which calls come in which order.
    folder_ = std::filesystem::canonical(scratch_.path()) / "out";
    path_ = folder_ / ("cache" + std::string(GetParam().extension));
    std::filesystem::create_directories(folder_);
    write_undisturbed(k_frames, 0);
    whole_ = read_file(path_).value();
  }

  void write_undisturbed(int frames, int keep) const {
    CacheSample sample = waving_patch(3, 2, frames);
    sample.info.frame_count = k_frames;  // as tests/support/tools/write_cache.cpp announces
    const Status status = write_cache(GetParam(), path_, sample, frames, keep);
    EXPECT_TRUE(status) << status.error().text();
  }

  struct Run {
    int code = -1;     ///< exit code; 128 + signal
    int finished = 0;  ///< frames that were durable
    long calls = 0;    ///< that changed files
  };

  Run run(int frames, int keep, std::vector<std::string> environment) const {
    const auto output = scratch_ / "output", count = scratch_ / "count";
    std::filesystem::remove(count);
    environment.push_back("LD_PRELOAD=" FT_BINARY_DIR "/lib/libfailing_write.so");
    environment.push_back("FT_FAIL_FOLDER=" + folder_.string());
    environment.push_back("FT_COUNT_FILE=" + count.string());
    environment.push_back("ASAN_OPTIONS=verify_asan_link_order=0:detect_leaks=0");
    std::vector<std::string> arguments = {FT_BINARY_DIR "/bin/write_cache", path_.string(), std::to_string(frames),
                                          std::to_string(keep)};
    std::vector<char*> argv, envp;
    for (auto& a : arguments) argv.push_back(a.data());
    for (auto& e : environment) envp.push_back(e.data());
    argv.push_back(nullptr);
    envp.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    EXPECT_EQ(::posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), envp.data()), 0);
    posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    ::waitpid(child, &status, 0);
    Run r;
    r.code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    r.finished = keep;
    std::ifstream lines(output);
    for (int n; lines >> n;) r.finished = n;
    std::ifstream(count) >> r.calls;
    return r;
  }

  /// All finished frames and at most one more are there, and going on from the finished ones gives the undisturbed
  /// bytes.
  void expect_nothing_lost(int finished) const {
    const CacheSample sample = waving_patch(3, 2, k_frames);
    const bool exists = std::filesystem::exists(path_);
    ASSERT_TRUE(exists || finished == 0);
    if (exists) {
      auto reader = open_cache(path_);
      ASSERT_TRUE(reader) << reader.error().text();
      ASSERT_GE((*reader)->info().frame_count, finished);
      std::vector<Vec3f> points;
      for (int f = 0; f < finished; ++f) {
        ASSERT_TRUE((*reader)->read_frame(f, points));
        for (std::size_t i = 0; i < points.size(); ++i)
          ASSERT_EQ(points[i], sample.positions[static_cast<std::size_t>(f)][i].cast<float>());
      }
    }
    write_undisturbed(k_frames, finished);
    ASSERT_TRUE(read_file(path_).value() == whole_) << "continued after frame " << finished;
  }

  ScratchFolder scratch_{ScratchFolder::k_in_memory};
  std::filesystem::path folder_, path_;
  Bytes whole_;
};

const std::vector<std::vector<std::string>> k_modes = {
    {"FT_FAIL_ONCE=1"}, {"FT_FAIL_SHORT=1", "FT_FAIL_KEEP=1"}, {"FT_FAIL_KILL=1"}};

std::vector<std::string> failing(std::vector<std::string> mode, long call) {
  mode.push_back("FT_FAIL_AT=" + std::to_string(call));
  return mode;
}

TEST_P(FailingWrites, Every_failing_call_of_a_bake_loses_no_finished_frame) {
  const Run undisturbed = run(k_frames, 0, {});
  ASSERT_GE(undisturbed.calls, 2 * k_frames);
  ASSERT_EQ(undisturbed.finished, k_frames);
  for (const auto& mode : k_modes)
    for (long n = 1; n <= undisturbed.calls; ++n) {
      SCOPED_TRACE(mode[0] + " at call " + std::to_string(n));
      std::filesystem::remove_all(folder_);
      std::filesystem::create_directories(folder_);
      const Run failed = run(k_frames, 0, failing(mode, n));
      ASSERT_EQ(failed.code, &mode == &k_modes.back() ? 128 + SIGKILL : 6);
      expect_nothing_lost(failed.finished);
      if (HasFatalFailure()) return;
    }
}

TEST_P(FailingWrites, Every_failing_call_of_a_resume_loses_no_kept_frame) {
  for (const int written : {7, 8}) {  // the tail of the kept frames has the place of the last one, or the other place
    write_undisturbed(written, 0);
    const int kept = 5;
    const Run undisturbed = run(k_frames, kept, {});
    ASSERT_EQ(undisturbed.code, 0);
    for (const auto& mode : k_modes)
      for (long n = 1; n <= undisturbed.calls; ++n) {
        SCOPED_TRACE(mode[0] + " at call " + std::to_string(n) + " of a resume after " + std::to_string(written));
        write_undisturbed(written, 0);
        const Run failed = run(k_frames, kept, failing(mode, n));
        ASSERT_EQ(failed.code, &mode == &k_modes.back() ? 128 + SIGKILL : 6);
        expect_nothing_lost(failed.finished);
        if (HasFatalFailure()) return;
      }
  }
}

INSTANTIATE_TEST_SUITE_P(All, FailingWrites, testing::ValuesIn(cache_formats().begin(), cache_formats().end()),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace ft::test
