// The progress lines are what the farm managers' own patterns find.
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "baker/core/file.h"
#include "baker/run/writer_thread.h"
#include "tests/baker/fake_bake.h"

namespace ft::test {
namespace {

/// Bakes with a mode and returns what it printed.
std::vector<std::string> printed(const std::string& mode, int* exit_code = nullptr, FakeBehaviour behaviour = {}) {
  FakeScene scene;
  const auto path = scene.file("printed.txt");
  std::FILE* out = std::fopen(path.c_str(), "w");
  {
    auto progress = make_progress(mode, out);
    EXPECT_TRUE(progress);
    const BakeResult result = bake(scene.options(), scene.services(std::move(behaviour)), **progress);
    if (exit_code) *exit_code = result.exit_code;
  }
  std::fclose(out);
  std::ifstream in(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// First groups of all lines that match, as numbers; they must ascend to 100.
void expect_percentages(const std::vector<std::string>& lines, const std::string& pattern) {
  double last = 0;
  int count = 0;
  for (const std::string& line : lines) {
    std::smatch match;
    if (!std::regex_search(line, match, std::regex(pattern))) continue;
    const double value = std::stod(match[1]);
    EXPECT_GE(value, last) << line;
    last = value;
    ++count;
  }
  EXPECT_EQ(count, 12);
  EXPECT_EQ(last, 100);
}

TEST(Progress, Tractor_finds_its_percentages) {
  expect_percentages(printed("tractor"), "^TR_PROGRESS ([0-9]{3})%$");
}
TEST(Progress, Deadline_finds_its_percentages) {
  expect_percentages(printed("deadline"), "^Progress: ([0-9]+)%$");
}
TEST(Progress, Open_job_description_finds_its_percentages) {
  const auto lines = printed("openjd");
  expect_percentages(lines, "^openjd_progress: ([0-9]+\\.[0-9])$");
  for (const std::string& line : lines)
    EXPECT_TRUE(std::regex_search(line, std::regex("^openjd_(progress|status): "))) << line;
}

TEST(Progress, Failure_is_told_to_the_farm) {
  int exit_code = 0;
  const FakeBehaviour bad{{}, [](int frame, FrameReport& r, State&) { r.finite = frame != 7; }};
  EXPECT_EQ(printed("openjd", &exit_code, bad).back().rfind("openjd_fail: frame 7", 0), 0u);
  EXPECT_EQ(exit_code, 5);
  EXPECT_EQ(printed("deadline", nullptr, bad).back().rfind("Error: frame 7", 0), 0u);
}

TEST(Progress, Json_lines_parse_and_tell_begin_frames_end) {
  const auto lines = printed("json");
  ASSERT_EQ(lines.size(), 14u);
  for (const std::string& line : lines) EXPECT_TRUE(nlohmann::json::parse(line, nullptr, false).is_object()) << line;
  EXPECT_EQ(nlohmann::json::parse(lines.front())["event"], "begin");
  const auto frame = nlohmann::json::parse(lines[5]);
  EXPECT_EQ(frame["event"], "frame");
  EXPECT_EQ(frame["report"]["frame"], 3);
  EXPECT_EQ(nlohmann::json::parse(lines.back())["exit_code"], 0);
}

TEST(Progress, None_prints_nothing) {
  EXPECT_TRUE(printed("none").empty());
}

TEST(Progress, Plain_is_the_default_away_from_a_terminal) {
  const auto lines = printed("");
  EXPECT_EQ(lines.front().rfind("baking shot.toml: frames 1-10 after 3 of pre-roll, 9 vertices", 0), 0u)
      << lines.front();
  EXPECT_NE(lines[1].find("frame -1 (pre-roll)"), std::string::npos) << lines[1];
  EXPECT_EQ(lines.back().rfind("done: 10 frames in ", 0), 0u);
}

TEST(Progress, Bar_redraws_one_line) {
  const auto lines = printed("bar");
  ASSERT_EQ(lines.size(), 2u);  // the opening, and all frames with the closing sentence
  EXPECT_NE(lines[1].find("frame 10"), std::string::npos);
  EXPECT_NE(lines[1].find("left"), std::string::npos);
}

TEST(Progress, Unknown_mode_lists_those_that_exist) {
  const auto result = make_progress("farm", stdout);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().hint, "there are: bar, plain, json, tractor, deadline, openjd, none");
  EXPECT_EQ(result.error().kind, ErrorKind::k_usage);
}

TEST(Progress, Log_has_one_object_per_event_with_the_time) {
  FakeScene scene;
  {
    auto log = make_json_log(scene.file("log.jsonl"));
    ASSERT_TRUE(log);
    EXPECT_EQ(bake(scene.options(), scene.services(), **log).exit_code, 0);
  }
  std::ifstream in(scene.file("log.jsonl"));
  int count = 0;
  for (std::string line; std::getline(in, line); ++count) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    ASSERT_TRUE(json.is_object()) << line;
    EXPECT_TRUE(std::regex_match(json["time"].get<std::string>(), std::regex("....-..-..T..:..:..Z")));
  }
  EXPECT_EQ(count, 14);
  EXPECT_FALSE(make_json_log("/proc/no_such_folder/log"));
}

TEST(WriterThread, Runs_jobs_in_order_and_reports_the_first_failure) {
  std::vector<int> done;
  WriterThread writer(1);
  for (int i = 0; i < 50; ++i)
    (void)writer.submit([&done, i]() -> Status {
      if (i == 20) return output_error("disk full at " + std::to_string(i));
      done.push_back(i);
      return {};
    });
  const Status status = writer.finish();
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().what, "disk full at 20");
  ASSERT_EQ(done.size(), 20u);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(done[static_cast<std::size_t>(i)], i);
  EXPECT_FALSE(writer.submit([] { return Status(); }));
}

TEST(WriterThread, Destructor_writes_what_was_handed_in) {
  int done = 0;
  {
    WriterThread writer(4);
    for (int i = 0; i < 4; ++i)
      EXPECT_TRUE(writer.submit([&done] {
        ++done;
        return Status();
      }));
  }
  EXPECT_EQ(done, 4);
}

}  // namespace
}  // namespace ft::test
