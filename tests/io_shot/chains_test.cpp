// Secondaries on secondaries: the references say what is baked first, and what cannot be is refused with its place.
#include "io/shot/chains.h"

#include <gtest/gtest.h>

#include "tests/io_shot/shot_fixture.h"

namespace ft {
namespace {

const std::string k_head = "[shot]\nframes = \"1-10\"\n[primary.ann]\nfile = \"mannequin.glb\"\n";

std::string cloth(const std::string& name, const std::string& on, const std::string& more = "") {
  return "[cloth." + name + "]\nmesh = \"dress.obj\"\non = \"" + on + "\"\n" + more + "\n";
}

class Chains : public ShotFile {
 protected:
  /// "robe:0 badge:1", in the order of the file.
  std::string stages(const std::string& text) {
    const auto shot = parse(k_head + text);
    if (!shot) return shot.error().text();
    const std::vector<int> stages = stages_of(shot->secondaries);
    std::string out;
    for (std::size_t i = 0; i < stages.size(); ++i)
      out += (i > 0 ? " " : "") + shot->secondaries[i]->name + ":" + std::to_string(stages[i]);
    return out;
  }
};

TEST_F(Chains, Order_comes_from_the_references_wherever_the_sections_stand) {
  EXPECT_EQ(stages(cloth("robe", "ann") + cloth("badge", "cloth.robe")), "robe:0 badge:1");
  EXPECT_EQ(stages(cloth("badge", "cloth.robe") + cloth("robe", "ann")), "badge:1 robe:0");
  EXPECT_EQ(stages(cloth("ribbon", "cloth.badge") + cloth("badge", "cloth.robe") + cloth("robe", "ann")),
            "ribbon:2 badge:1 robe:0");
  EXPECT_EQ(stages(cloth("skirt", "ann") + cloth("robe", "ann")), "skirt:0 robe:0");
}

TEST_F(Chains, What_is_met_by_name_is_baked_before_and_a_pattern_orders_nothing) {
  EXPECT_EQ(stages(cloth("scarf", "ann", "meets = [\"cloth.robe\"]") + cloth("robe", "ann")), "scarf:1 robe:0");
  EXPECT_EQ(stages(cloth("scarf", "ann", "meets = [\"*\"]") + cloth("robe", "ann")), "scarf:0 robe:0");
}

TEST_F(Chains, What_is_held_to_a_cloth_is_baked_with_it) {
  const std::string pin = "pins = [{ group = \"waist\", to = \"scarf\" }]";
  EXPECT_EQ(stages(cloth("bow", "ann", pin) + cloth("scarf", "ann", "meets = [\"cloth.robe\"]") + cloth("robe", "ann")),
            "bow:1 scarf:1 robe:0");
}

TEST_F(Chains, A_circle_is_refused_with_its_members) {
  EXPECT_EQ(faults_of(k_head + cloth("lead", "cloth.c") + cloth("a", "cloth.b") + cloth("b", "cloth.c") +
                      cloth("c", "ann", "meets = [\"cloth.a\"]")),
            std::vector<std::string>{"shot.toml:11:6: cloth \"a\": what it refers to leads back to itself: cloth.a -> "
                                     "cloth.b -> cloth.c -> cloth.a; each has to be baked before the one that refers "
                                     "to it"});
}

TEST_F(Chains, What_is_on_itself_is_refused) {
  EXPECT_EQ(faults_of(k_head + cloth("a", "cloth.a")),
            std::vector<std::string>{"shot.toml:7:6: cloth \"a\": is on itself"});
}

TEST_F(Chains, An_unknown_reference_is_refused_with_what_may_have_been_meant) {
  EXPECT_EQ(faults_of(k_head + cloth("robe", "ann") + cloth("badge", "cloth.rob")),
            std::vector<std::string>{"shot.toml:11:6: cloth \"badge\": on = \"cloth.rob\" names no primary (did you "
                                     "mean \"cloth.robe\"?)"});
  EXPECT_EQ(faults_of(k_head + cloth("robe", "ann") + cloth("badge", "robe")),
            std::vector<std::string>{"shot.toml:11:6: cloth \"badge\": on = \"robe\" names no primary (did you mean "
                                     "\"cloth.robe\"?)"});
}

TEST_F(Chains, What_needs_another_kind_of_primary_is_refused_with_the_reason) {
  const std::string robe = cloth("robe", "ann");
  const auto fault = [&](const std::string& text) {
    const auto faults = faults_of(k_head + robe + text);
    return faults.empty() ? std::string() : faults.front();
  };
  EXPECT_NE(fault("[cords.tassel]\nshape = \"rope\"\nto = [0, 1, 0]\nmass = 1\non = \"cloth.robe\"\n")
                .find("bends, and cords need"),
            std::string::npos)
      << fault("[cords.tassel]\nshape = \"rope\"\nto = [0, 1, 0]\nmass = 1\non = \"cloth.robe\"\n");
  EXPECT_NE(fault("[follow.hem]\nbones = [\"a\"]\non = \"cloth.robe\"\n").find("no joints"), std::string::npos);
  EXPECT_NE(fault(cloth("badge", "cloth.robe", "coupling = \"hybrid\"") +
                  "[standin.s]\nkind = \"weight\"\nmass = 1\nfor = \"badge\"\n")
                .find("feels nothing of it"),
            std::string::npos);
  EXPECT_NE(fault("[water.pond]\nposition = [0, 0, 0]\nsize = [2, 0, 2]\ndepth = 1\n" + cloth("raft", "water.pond"))
                .find("is a liquid, and cloth does not float"),
            std::string::npos)
      << fault("[water.pond]\nposition = [0, 0, 0]\nsize = [2, 0, 2]\ndepth = 1\n" + cloth("raft", "water.pond"));
  EXPECT_NE(fault("[follow.ears]\nbones = [\"a\"]\n" + cloth("cap", "follow.ears")).find("would meet both"),
            std::string::npos);
}

TEST_F(Chains, A_pin_to_what_it_is_on_says_that_it_needs_no_to) {
  const auto faults = faults_of(k_head + cloth("robe", "ann") +
                                cloth("badge", "cloth.robe", "pins = [{ group = \"waist\", to = \"robe\" }]"));
  ASSERT_EQ(faults.size(), 1u) << (faults.empty() ? "" : faults.back());
  EXPECT_NE(faults[0].find("a pin without to holds to that"), std::string::npos) << faults[0];
}

}  // namespace
}  // namespace ft
