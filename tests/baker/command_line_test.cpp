// The program as a user meets it: exit codes, messages, signals, on real files (Debian's assimp-testmodels).
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "baker/core/file.h"
#include "baker/record/manifest.h"
#include "io/shot/mesh_file.h"
#include "tests/support/assets.h"

namespace ft::test {
namespace {

std::filesystem::path program() {
  return std::filesystem::path(FT_BINARY_DIR) / "bin" / "followthrough";
}
std::filesystem::path jumper() {
  return assimp_models_root() / "BVH" / "01_01.bvh";
}

struct Answer {
  int exit_code = 0;
  std::string out, err;
};

/// The running program; its output goes to files.
class Process {
 public:
  Process(const ScratchFolder& scratch, std::vector<std::string> arguments)
      : out_(scratch / "out.txt"), err_(scratch / "err.txt") {
    for (const auto& path : {out_, err_}) std::ofstream(path) << "";
    arguments.insert(arguments.begin(), program().string());
    child_ = ::fork();
    if (child_ != 0) return;
    ::dup2(::open(out_.c_str(), O_WRONLY), 1);
    ::dup2(::open(err_.c_str(), O_WRONLY), 2);
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  /// Waits until the words were printed; false after 60 s or when the program ended without them.
  bool prints(const std::string& words) {
    for (int i = 0; i < 6000; ++i) {
      if (read_text(out_).value().find(words) != std::string::npos) return true;
      int status = 0;
      if (::waitpid(child_, &status, WNOHANG) == child_) {
        ended_ = true, status_ = status;
        return read_text(out_).value().find(words) != std::string::npos;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  void signal(int number) const { ::kill(child_, number); }
  Answer wait() {
    if (!ended_) ::waitpid(child_, &status_, 0);
    const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
    return {code, read_text(out_).value(), read_text(err_).value()};
  }

 private:
  std::filesystem::path out_, err_;
  pid_t child_ = -1;
  bool ended_ = false;
  int status_ = 0;
};

class CommandLine : public ::testing::Test {
 protected:
  void SetUp() override {
    FT_REQUIRE_FILE(program());
    FT_REQUIRE_FILE(jumper());
  }
  Answer run(std::vector<std::string> arguments) { return Process(scratch_, std::move(arguments)).wait(); }

  /// A small sheet that falls past the jumper of 01_01.bvh.
  std::string shot(const std::string& frames, const std::string& primary_lines = "",
                   const std::string& cloth_lines = "") {
    std::vector<Vec3> x;
    std::vector<Triangle> t;
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        x.emplace_back(0.02 * i - 0.05, 1.2, 0.02 * j - 0.05);
        if (i < 5 && j < 5)
          t.push_back({6 * j + i, 6 * j + 6 + i, 6 * j + 7 + i}),
              t.push_back({6 * j + i, 6 * j + 7 + i, 6 * j + i + 1});
      }
    EXPECT_TRUE(write_obj(scratch_ / "sheet.obj", make_triangle_mesh("sheet", x, t)).ok());
    std::ofstream(scratch_ / "shot.toml")
        << "[shot]\nframes = \"" << frames << "\"\nfps = 24\npreroll = 2\n[primary.jumper]\nfile = \""
        << jumper().string() << "\"\n"
        << primary_lines << "\n[cloth.sheet]\nmesh = \"sheet.obj\"\nfabric = \"cotton\"\non = \"jumper\"\n"
        << cloth_lines << "\n[cache]\nformats = [\"pc2\"]\n";
    return (scratch_ / "shot.toml").string();
  }
  std::string out() const { return (scratch_ / "bake").string(); }

  ScratchFolder scratch_;
};

TEST_F(CommandLine, Wrong_usage_is_exit_code_2) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
                                                    {"bake"},
                                                    {"boil"},
                                                    {"bake", "a.toml", "--colour"},
                                                    {"bake", "a.toml", "--threads", "-3"},
                                                    {"bake", "a.toml", "--resume", "--force"},
                                                    {"compare", "one"},
                                                    {"check"},
                                                    {"info"}}) {
    const Answer a = run(arguments);
    EXPECT_EQ(a.exit_code, 2);
    EXPECT_EQ(a.err.rfind("followthrough: ", 0), 0u) << a.err;
  }
  EXPECT_EQ(run({"bake", shot("1-3"), "--progress", "farm"}).exit_code, 2);
  EXPECT_EQ(run({"bake", shot("1-3"), "--frames", "9-3"}).exit_code, 2);
}

TEST_F(CommandLine, A_slip_of_the_pen_in_a_command_or_an_option_gets_a_guess) {
  const auto guess = [&](std::vector<std::string> arguments, const std::string& words) {
    const Answer a = run(std::move(arguments));
    EXPECT_EQ(a.exit_code, 2);
    EXPECT_NE(a.err.find(words), std::string::npos) << a.err;
  };
  guess({"bakee", "a.toml"}, "there is no command \"bakee\" (did you mean \"bake\"?)");
  guess({"previw"}, "did you mean \"preview\"?");
  guess({"boil"}, "there is no command \"boil\" (known: bake, info, ");
  guess({"bake", "a.toml", "--frame=1-3"}, "bake has no option --frame (did you mean \"--frames\"?)");
  guess({"bake", "a.toml", "--ouT", "x"}, "did you mean \"--out\"?");
}

TEST_F(CommandLine, A_mat_that_is_added_to_the_floor_of_the_clip_is_refused_with_the_reason) {
  const std::string mat = "[standin.mat]\nkind = \"mat\"\non = \"jumper\"\nstiffness = 66e3\n";
  const Answer a = run({"bake", shot("1-3", "mass = 64", mat), "--out", out()});
  EXPECT_EQ(a.exit_code, 2);
  EXPECT_NE(a.err.find("shot.toml: primary \"jumper\": mat: a stand-in of kind \"mat\" holds the body up, and so does "
                       "the ground that the clip was made on"),
            std::string::npos)
      << a.err;
  EXPECT_NE(a.err.find("(support = \"replace\")"), std::string::npos) << a.err;
  const Answer replaced = run({"bake", shot("1-3", "mass = 64", mat + "support = \"replace\"\n"), "--out", out()});
  EXPECT_EQ(replaced.exit_code, 0) << replaced.err;
  for (const char* file : {"jumper_hybrid.glb", "jumper_hybrid.bvh", "jumper_hybrid.json"})
    EXPECT_TRUE(std::filesystem::exists(scratch_ / "bake" / file)) << file;
}

TEST_F(CommandLine, Help_and_version_are_exit_code_0) {
  EXPECT_EQ(run({"--version"}).out.rfind("followthrough 0.", 0), 0u);
  const Answer help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command : {"bake", "info", "compare", "check", "preview", "validate", "advise"})
    EXPECT_NE(help.out.find(command), std::string::npos) << command;
  EXPECT_EQ(run({"bake", "--help"}).exit_code, 0);
}

TEST_F(CommandLine, Missing_files_are_exit_code_3) {
  EXPECT_EQ(run({"bake", "/nowhere/shot.toml"}).exit_code, 3);
  EXPECT_EQ(run({"info", "/nowhere/body.glb"}).exit_code, 3);
  EXPECT_EQ(run({"check", "/nowhere"}).exit_code, 3);
  EXPECT_EQ(run({"compare", "/nowhere/a.abc", "/nowhere/b.abc"}).exit_code, 3);
}

TEST_F(CommandLine, Clip_that_does_not_exist_lists_those_that_do) {
  const Answer a = run({"bake", shot("1-3", "clip = \"Rumba\""), "--out", out()});
  EXPECT_TRUE(a.exit_code == 2 || a.exit_code == 3) << a.err;
  EXPECT_NE(a.err.find("Rumba"), std::string::npos) << a.err;
  EXPECT_NE(a.err.find("Motion"), std::string::npos) << a.err;
}

TEST_F(CommandLine, Frames_outside_the_clip_are_refused_before_anything_is_baked) {
  const Answer a = run({"bake", shot("1-5000"), "--out", out()});
  EXPECT_TRUE(a.exit_code == 2 || a.exit_code == 3) << a.err;
  EXPECT_NE(a.err.find("clip"), std::string::npos) << a.err;
  EXPECT_FALSE(std::filesystem::exists(out() + "/sheet.pc2"));
}

TEST_F(CommandLine, Frames_that_are_not_within_the_shot_are_refused) {
  for (const char* frames : {"50-60", "105-111", "99-101", "111"}) {
    const Answer a = run({"bake", shot("100-110"), "--frames", frames, "--out", out()});
    EXPECT_EQ(a.exit_code, 2) << a.err;
    EXPECT_NE(a.err.find(std::string("--frames ") + frames + " is not within the shot, which has 100-110"),
              std::string::npos)
        << a.err;
  }
  EXPECT_EQ(run({"bake", shot("100-110"), "--frames", "100-110", "--out", out(), "--dry-run"}).exit_code, 0);
  EXPECT_EQ(run({"bake", shot("100-110"), "--frames", "104", "--out", out(), "--dry-run"}).exit_code, 0);
}

TEST_F(CommandLine, Info_and_bake_doubt_a_garment_in_centimetres_that_is_read_in_metres) {
  const std::string file = shot("1-3", "", "offset = [0, 1, 0]");
  auto mesh = read_obj(scratch_ / "sheet.obj");
  ASSERT_TRUE(mesh);
  EXPECT_NE(run({"info", (scratch_ / "sheet.obj").string()}).out.find("as a garment: good\n"), std::string::npos);
  for (Vec3& p : mesh->positions) p *= 580;  // 0.1 m -> 58 m
  ASSERT_TRUE(write_obj(scratch_ / "sheet.obj", *mesh).ok());
  const std::string words =
      "is 58 m in size, which no garment is: with unit_scale = 0.01 (a file in centimetres) it would be 0.58 m";
  const Answer info = run({"info", (scratch_ / "sheet.obj").string()});
  EXPECT_EQ(info.exit_code, 0);
  EXPECT_NE(info.out.find("note: the mesh " + words), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("as a garment: good but for its size"), std::string::npos) << info.out;
  const Answer plan = run({"bake", file, "--dry-run", "--out", out()});
  EXPECT_NE(plan.out.find("cloth \"sheet\" " + words), std::string::npos) << plan.out << plan.err;
}

TEST_F(CommandLine, Check_fails_a_bake_that_is_not_finished_and_says_how_many_frames_are_missing) {
  ASSERT_EQ(run({"bake", shot("1-2"), "--out", out()}).exit_code, 0);
  auto manifest = read_manifest(out());
  ASSERT_TRUE(manifest);
  manifest->complete = false;
  ASSERT_TRUE(write_text_durably(out() + "/manifest.json", to_text(*manifest)).ok());
  const Answer whole = run({"check", out()});
  EXPECT_EQ(whole.exit_code, 4);
  EXPECT_NE(whole.err.find("not finished: it stopped after its last frame"), std::string::npos) << whole.err;
  manifest->last_frame = 9;
  ASSERT_TRUE(write_text_durably(out() + "/manifest.json", to_text(*manifest)).ok());
  const Answer part = run({"check", out()});
  EXPECT_EQ(part.exit_code, 4);
  EXPECT_NE(part.err.find("the bake is not finished: 7 of 9 frames are missing"), std::string::npos) << part.err;
  EXPECT_NE(part.out.find("FAILED: 2 frames"), std::string::npos) << part.out;
}

TEST_F(CommandLine, Folder_that_cannot_be_written_is_exit_code_6) {
  EXPECT_EQ(run({"bake", shot("1-3"), "--out", "/proc/bake"}).exit_code, 6);
  EXPECT_EQ(run({"bake", shot("1-3"), "--out", (scratch_ / "sheet.obj").string() + "/bake"}).exit_code, 6);
  EXPECT_EQ(run({"bake", shot("1-3"), "--out", out(), "--log-json", "/proc/log"}).exit_code, 6);
}

TEST_F(CommandLine, Bake_check_info_and_compare_work_together) {
  const Answer bake = run({"bake", shot("1-4"), "--out", out(), "--profile"});
  ASSERT_EQ(bake.exit_code, 0) << bake.err;
  EXPECT_NE(bake.out.find("linear solves"), std::string::npos);
  const Answer again = run({"bake", shot("1-4"), "--out", out()});
  EXPECT_EQ(again.out.rfind("up to date", 0), 0u) << again.out;
  const Answer check = run({"check", out(), "--json", (scratch_ / "check.json").string()});
  EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
  EXPECT_NE(check.out.find("passed: 4 frames"), std::string::npos) << check.out;
  EXPECT_EQ(run({"check", out(), "--max-p99-strain", "1e-9"}).exit_code, 4);
  EXPECT_NE(run({"info", out()}).out.find("4"), std::string::npos);
  EXPECT_NE(run({"info", out() + "/sheet.pc2"}).out.find("4 frames"), std::string::npos);
  EXPECT_NE(run({"info", "--shot-keys"}).out.find("[cloth.NAME]"), std::string::npos);
  EXPECT_EQ(run({"compare", out() + "/sheet.pc2", out() + "/sheet.pc2"}).exit_code, 0);
}

TEST_F(CommandLine, Terminate_and_interrupt_leave_a_bake_that_resumes_to_the_same_bytes_slow) {
  const std::string file = shot("1-12");
  ASSERT_EQ(run({"bake", file, "--out", (scratch_ / "whole").string()}).exit_code, 0);
  const std::string whole = read_text(scratch_ / "whole/sheet.pc2").value(),
                    manifest = read_text(scratch_ / "whole/manifest.json").value();
  for (const auto& [number, code] : {std::pair{SIGINT, 130}, {SIGTERM, 143}, {SIGKILL, 137}}) {
    std::filesystem::remove_all(out());
    Process first(scratch_, {"bake", file, "--out", out()});
    ASSERT_TRUE(first.prints("frame 4 "));
    first.signal(number);
    const Answer stopped = first.wait();
    ASSERT_EQ(stopped.exit_code, code) << stopped.out << stopped.err;
    if (number != SIGKILL) {
      EXPECT_NE(stopped.err.find("--resume"), std::string::npos) << stopped.err;
    }
    const Answer resumed = run({"bake", file, "--out", out(), "--resume"});
    ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_NE(resumed.out.find("resuming at frame"), std::string::npos) << resumed.out;
    EXPECT_EQ(read_text(out() + "/sheet.pc2").value(), whole);
    EXPECT_EQ(read_text(out() + "/manifest.json").value(), manifest);
  }
}

}  // namespace
}  // namespace ft::test
