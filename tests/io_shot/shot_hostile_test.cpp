#include "baker/core/random.h"
#include "tests/io_shot/shot_fixture.h"

namespace ft {
namespace {

TEST_F(ShotFile, Cut_at_any_byte_is_a_shot_or_faults) {
  const std::string_view text = k_good;
  for (std::size_t n = 0; n <= text.size(); ++n) {
    const auto shot = parse(text.substr(0, n));
    EXPECT_EQ(shot.ok(), faults_.messages.empty());
  }
}

TEST_F(ShotFile, Mutations_are_shots_or_faults) {
  const std::string good = k_good;
  const std::string_view alphabet = "[]{}=\"'.,-0159eE\n #_\\+:\x00\xff\xc3zinfNaT";
  int accepted = 0;
  for (std::uint64_t round = 0; round < 3'000; ++round) {
    std::string text = good;
    const RandomKey key{.seed = 11, .frame = round};
    const int edits = 1 + static_cast<int>(random_uniform(key, 0) * 4);
    for (int e = 0; e < edits; ++e) {
      const std::uint64_t draw = 10 + 4 * static_cast<std::uint64_t>(e);
      const std::size_t at = static_cast<std::size_t>(random_uniform(key, draw) * static_cast<double>(text.size()));
      const char c =
          alphabet[static_cast<std::size_t>(random_uniform(key, draw + 1) * static_cast<double>(alphabet.size()))];
      const double kind = random_uniform(key, draw + 2);
      if (kind < 0.4)
        text[at] = c;
      else if (kind < 0.7)
        text.insert(text.begin() + static_cast<std::ptrdiff_t>(at), c);
      else
        text.erase(at, 1 + static_cast<std::size_t>(random_uniform(key, draw + 3) * 30));
    }
    const auto shot = parse(text);
    ASSERT_EQ(shot.ok(), faults_.messages.empty());
    ASSERT_TRUE(shot.ok() ? !canonical(*shot).empty() : !shot.error().what.empty());
    accepted += shot.ok() ? 1 : 0;
  }
  EXPECT_GT(accepted, 30);
}

TEST_F(ShotFile, Mutated_overrides_are_taken_or_refused) {
  const std::string_view alphabet = "[]{}=\"'.,-019e# \\\n\x00\xff";
  int accepted = 0;
  for (std::uint64_t round = 0; round < 2'000; ++round) {
    std::string text = round % 2 == 0 ? "cloth.dress.fabric=denim" : "cloth.cape.pins=[{within=0.02}]";
    const RandomKey key{.seed = 5, .frame = round};
    for (std::uint64_t e = 0; e < 1 + round % 3; ++e) {
      const std::size_t at = static_cast<std::size_t>(random_uniform(key, 3 * e) * static_cast<double>(text.size()));
      const char c =
          alphabet[static_cast<std::size_t>(random_uniform(key, 3 * e + 1) * static_cast<double>(alphabet.size()))];
      if (random_uniform(key, 3 * e + 2) < 0.5)
        text[at] = c;
      else
        text.erase(at, 1);
    }
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
