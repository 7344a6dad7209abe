#include "tests/io_shot/shot_fixture.h"
#include "tests/support/damage.h"

namespace ft {
namespace {

using namespace std::string_view_literals;

TEST_F(ShotFile, Cut_at_any_byte_is_a_shot_or_faults) {
  const std::string_view text = k_good;
  for (std::size_t n = 0; n <= text.size(); ++n) {
    const auto shot = parse(text.substr(0, n));
    EXPECT_EQ(shot.ok(), faults_.messages.empty());
  }
}

TEST_F(ShotFile, Mutations_are_shots_or_faults) {
  const std::string good = k_good;
  const test::TextDamage damage{"[]{}=\"'.,-0159eE\n #_\\+:\x00\xff\xc3zinfNaT"sv, 4, 30};
  int accepted = 0;
  for (std::uint64_t round = 0; round < 3'000; ++round) {
    const auto shot = parse(test::damaged(good, damage, round));
    ASSERT_EQ(shot.ok(), faults_.messages.empty());
    ASSERT_TRUE(shot.ok() ? !canonical(*shot).empty() : !shot.error().what.empty());
    accepted += shot.ok() ? 1 : 0;
  }
  EXPECT_GT(accepted, 30);
}

TEST_F(ShotFile, Mutated_overrides_are_taken_or_refused) {
  const test::TextDamage damage{"[]{}=\"'.,-019e# \\\n\x00\xff"sv, 3, 1};
  int accepted = 0;
  for (std::uint64_t round = 0; round < 2'000; ++round) {
    const std::string good = round % 2 == 0 ? "cloth.dress.fabric=denim" : "cloth.cape.pins=[{within=0.02}]";
    const std::string text = test::damaged(good, damage, round);
    const auto shot = parse(k_good, {text});
    ASSERT_EQ(shot.ok(), faults_.messages.empty()) << text;
    for (const std::string& message : faults_.messages) ASSERT_TRUE(message.starts_with("--set ")) << message;
    accepted += shot.ok() ? 1 : 0;
  }
  EXPECT_GT(accepted, 20);
  EXPECT_LT(accepted, 1'900);
}

TEST_F(ShotFile, Hostile_files_end_soon) {
  faults_of(std::string(100'000, '['));
  faults_of("a" + std::string(100'000, '.') + "b = 1");
  faults_of("x = " + std::string(100'000, '{'));
  faults_of(std::string("[shot]\nframes = \"") + std::string(1'000'000, '9') + "\"");
  std::string many = "[shot]\n";
  for (int i = 0; i < 5'000; ++i) many += "key_" + std::to_string(i) + " = 1\n";
  EXPECT_EQ(faults_of(many).size(), 201u);
  EXPECT_NE(fault_with("\"0-199, 250\"", "\"0-1999999999\"").find("more than 20 million"), std::string::npos);
}

}  // namespace
}  // namespace ft
