// A bake that is interrupted, killed or runs out of disk goes on as if nothing had happened: the same bytes.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <thread>

#include "baker/core/file.h"
#include "baker/core/parallel.h"
#include "baker/core/random.h"
#include "baker/run/lock_file.h"
#include "io/cache/cache.h"
#include "tests/baker/fake_bake.h"

namespace ft::test {
namespace {

/// With cloth alone, with instances beside it, and with curves.
class Resume : public testing::TestWithParam<Beside> {
 protected:
  /// Caches of the scene.
  static std::vector<std::string> caches(std::vector<std::string> of_meshes) {
    if (GetParam() == Beside::k_swarm) of_meshes.emplace_back("tokens.abc");
    if (GetParam() == Beside::k_tress) of_meshes.insert(of_meshes.end(), {"locks.abc", "locks.pc2"});
    return of_meshes;
  }
};

std::map<std::string, std::string> undisturbed(const FakeScene& scene) {
  BakeOptions options = scene.options();
  options.folder = scene.file("undisturbed");
  EXPECT_EQ(scene.run(options).exit_code, 0);
  return scene.products(options.folder);
}

BakeResult interrupted_after(const FakeScene& scene, int frame, int signal = SIGINT, bool resume = false) {
  RecordedProgress progress;
  progress.on_frame = [&](int f) { f == frame ? void(std::raise(signal)) : void(); };
  BakeOptions options = scene.options();
  options.resume = resume;
  return bake(options, scene.services(), progress);
}

TEST_P(Resume, Interrupted_after_every_frame_it_goes_on_to_the_same_bytes_slow) {
  FakeScene scene(GetParam());
  const auto expected = undisturbed(scene);
  for (int frame = -1; frame < 10; ++frame) {
    const BakeResult stopped = interrupted_after(scene, frame);
    ASSERT_EQ(stopped.exit_code, 130) << frame << text(stopped);
    EXPECT_NE(text(stopped).find("interrupted after frame " + std::to_string(frame)), std::string::npos)
        << text(stopped);
    EXPECT_NE(text(stopped).find("--resume"), std::string::npos);
    BakeOptions options = scene.options();
    options.resume = true;
    RecordedProgress progress;
    ASSERT_EQ(bake(options, scene.services(), progress).exit_code, 0);
    EXPECT_EQ(progress.start.from_frame, frame + 1);
    EXPECT_EQ(progress.frames.size(), static_cast<std::size_t>(10 - frame));
    EXPECT_EQ(scene.products(), expected) << frame;
    std::filesystem::remove_all(scene.folder().path);
  }
}

TEST_P(Resume, Interrupted_again_and_again_it_gives_the_same_bytes_slow) {
  FakeScene scene(GetParam());
  const auto expected = undisturbed(scene);
  for (int frame = 0; frame < 10; frame += 2) {
    ASSERT_EQ(interrupted_after(scene, frame, SIGTERM, true).exit_code, 143);
  }
  BakeOptions options = scene.options();
  options.resume = true;
  ASSERT_EQ(scene.run(options).exit_code, 0);
  EXPECT_EQ(scene.products(), expected);
}

TEST_P(Resume, Finished_frames_of_an_interrupted_bake_can_be_read) {
  FakeScene scene(GetParam());
  ASSERT_EQ(interrupted_after(scene, 4).exit_code, 130);
  for (const std::string& name : caches({"sheet.abc", "sheet.pc2", "box.abc", "box.collider.abc"})) {
    auto cache = open_cache_of_any_shape(scene.folder().path / name);
    ASSERT_TRUE(cache) << cache.error().text();
    EXPECT_EQ((*cache)->info().frame_count, 4) << name;
  }
}

TEST_P(Resume, No_bake_is_complete_without_its_report) {
  FakeScene scene(GetParam());
  const auto expected = undisturbed(scene);
  const auto report = scene.folder().report();
  // No file takes the place of a folder with something in it.
  std::filesystem::create_directories(report / "in_the_way");
  EXPECT_EQ(scene.run(scene.options()).exit_code, 6);
  std::filesystem::remove_all(report);
  BakeOptions options = scene.options();
  options.resume = true;
  EXPECT_EQ(scene.run(options).exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_regular_file(report));
  EXPECT_EQ(scene.products(), expected);
}

TEST_P(Resume, Without_resume_an_unfinished_bake_starts_anew) {
  FakeScene scene(GetParam());
  const auto expected = undisturbed(scene);
  ASSERT_EQ(interrupted_after(scene, 4).exit_code, 130);
  RecordedProgress progress;
  ASSERT_EQ(bake(scene.options(), scene.services(), progress).exit_code, 0);
  EXPECT_EQ(progress.frames.size(), 12u);
  EXPECT_NE(progress.notes.find("--resume goes on with it"), std::string::npos);
  EXPECT_EQ(scene.products(), expected);
}

TEST_P(Resume, Changed_settings_are_refused_with_the_reason) {
  FakeScene scene(GetParam());
  ASSERT_EQ(interrupted_after(scene, 4).exit_code, 130);
  BakeOptions options = scene.options();
  options.resume = true;
  options.overrides = {"cloth.sheet.fabric=denim"};
  const BakeResult refused = scene.run(options);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(text(refused).find("cannot be resumed: cloth.sheet.fabric changed from \"cotton\" to \"denim\""),
            std::string::npos)
      << text(refused);
  options.overrides.clear();
  EXPECT_EQ(scene.run(options).exit_code, 0);  // nothing was lost by the refusal
  EXPECT_EQ(scene.products(), undisturbed(scene));
}

TEST(ResumedBake, With_nothing_to_resume_it_bakes) {
  FakeScene scene;
  BakeOptions options = scene.options();
  options.resume = true;
  EXPECT_EQ(scene.run(options).exit_code, 0);
  EXPECT_NE(text(scene.run(options)).find("up to date"), std::string::npos);
}

TEST_P(Resume, Damaged_checkpoint_starts_anew_and_says_so) {
  FakeScene scene(GetParam());
  const auto expected = undisturbed(scene);
  ASSERT_EQ(interrupted_after(scene, 4).exit_code, 130);
  std::filesystem::resize_file(scene.folder().checkpoint(), 40);
  BakeOptions options = scene.options();
  options.resume = true;
  RecordedProgress progress;
  const BakeResult result = bake(options, scene.services(), progress);
  EXPECT_EQ(result.exit_code, 0) << text(result);
  EXPECT_NE(progress.notes.find("starting anew"), std::string::npos) << progress.notes;
  EXPECT_EQ(scene.products(), expected);
}

TEST_P(Resume, Damaged_or_lost_cache_is_not_continued_and_the_way_out_is_named_slow) {
  FakeScene scene(GetParam());
  const auto expected = undisturbed(scene);
  for (const std::string& name : caches({"sheet.pc2", "sheet.abc", "box.collider.abc"}))
    for (const bool lost : {false, true}) {
      ASSERT_EQ(interrupted_after(scene, 4).exit_code, 130);
      if (lost)
        std::filesystem::remove(scene.folder().path / name);
      else
        std::filesystem::resize_file(scene.folder().path / name, 40);
      BakeOptions options = scene.options();
      options.resume = true;
      const BakeResult result = scene.run(options);
      EXPECT_EQ(result.exit_code, 6) << name << text(result);
      EXPECT_NE(text(result).find(name), std::string::npos) << text(result);
      EXPECT_EQ(scene.run().exit_code, 0);
      EXPECT_EQ(scene.products(), expected) << name;
      std::filesystem::remove_all(scene.folder().path);
    }
}

/// The bake as a child process, because kill -9 and resource limits are for whole processes.
pid_t bake_in_child(const FakeScene& scene, bool resume, int frame_milliseconds,
                    const std::function<void()>& prepare = {}) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  const ThreadLimit one(1);
  if (prepare) prepare();
  BakeOptions options = scene.options();
  options.resume = resume;
  const auto result = scene.run(
      options, {[&](int) { std::this_thread::sleep_for(std::chrono::milliseconds(frame_milliseconds)); }, {}});
  ::_exit(result.exit_code);
}

int wait_for(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST_P(Resume, Killed_at_25_random_instants_it_gives_the_same_bytes_slow) {
  FakeScene scene(GetParam());
  scene.write_shot(30);
  const auto expected = undisturbed(scene);
  // The instants lie within the bake, however fast the machine is now.
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(wait_for(bake_in_child(scene, true, 3)), 0);
  const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - start;
  int killed = 0;
  for (std::uint64_t i = 0; i < 25; ++i) {
    std::filesystem::remove_all(scene.folder().path);
    for (std::uint64_t attempt = 0; attempt < 3; ++attempt) {
      const pid_t child = bake_in_child(scene, true, 3);
      std::this_thread::sleep_for(whole * (0.02 + 0.35 * random_uniform({20, 1, i, attempt})));
      ::kill(child, SIGKILL);
      killed += wait_for(child) == 128 + SIGKILL;
    }
    BakeOptions options = scene.options();
    options.resume = true;
    const BakeResult result = scene.run(options);
    ASSERT_EQ(result.exit_code, 0) << text(result);
    ASSERT_EQ(scene.products(), expected) << i;
  }
  EXPECT_GE(killed, 25);  // else the instants were after the end, and nothing was tested
}

TEST_P(Resume, File_size_limit_gives_exit_code_6_and_resume_gives_the_same_bytes_slow) {
  FakeScene scene(GetParam());
  scene.write_shot(40);
  const auto expected = undisturbed(scene);
  const rlim_t whole = std::filesystem::file_size(scene.file("undisturbed/sheet.abc"));
  for (const rlim_t limit : {whole / 4, whole / 2, whole - 100}) {
    const auto with_limit = [&] {
      const rlimit small{limit, limit};
      ::setrlimit(RLIMIT_FSIZE, &small);
    };
    EXPECT_EQ(wait_for(bake_in_child(scene, false, 0, with_limit)), 6);
    BakeOptions options = scene.options();
    options.resume = true;
    const BakeResult result = scene.run(options);
    ASSERT_EQ(result.exit_code, 0) << text(result);
    EXPECT_EQ(scene.products(), expected);
    std::filesystem::remove_all(scene.folder().path);
  }
}

TEST(ResumedBake, Second_signal_ends_the_program_at_once) {
  FakeScene scene;
  const pid_t child = ::fork();
  if (child == 0) {
    const ThreadLimit one(1);
    scene.run(scene.options(), {[](int frame) {
                                  if (frame != 3) return;
                                  std::raise(SIGINT);
                                  std::raise(SIGINT);
                                  std::this_thread::sleep_for(std::chrono::seconds(20));
                                },
                                {}});
    ::_exit(0);
  }
  EXPECT_EQ(wait_for(child), 130);
  BakeOptions options = scene.options();
  options.resume = true;
  EXPECT_EQ(scene.run(options).exit_code, 0);
  EXPECT_EQ(scene.products(), undisturbed(scene));
}

TEST(ResumedBake, Two_bakes_do_not_write_one_folder) {
  FakeScene scene;
  ASSERT_TRUE(make_folders(scene.folder().state()));
  {
    auto lock = LockFile::acquire(scene.folder().lock());
    ASSERT_TRUE(lock);
    const BakeResult second = scene.run();
    EXPECT_EQ(second.exit_code, 6);
    EXPECT_NE(text(second).find("another bake is writing this folder: process " + std::to_string(::getpid())),
              std::string::npos)
        << text(second);
  }
  EXPECT_EQ(scene.run().exit_code, 0);  // the lock went with its holder; the file alone locks nothing
  EXPECT_TRUE(std::filesystem::exists(scene.folder().lock()));
}

INSTANTIATE_TEST_SUITE_P(All, Resume, testing::Values(Beside::k_nothing, Beside::k_swarm, Beside::k_tress),
                         [](const auto& beside) {
                           return beside.param == Beside::k_swarm   ? "swarm"
                                  : beside.param == Beside::k_tress ? "tress"
                                                                    : "cloth";
                         });

}  // namespace
}  // namespace ft::test
