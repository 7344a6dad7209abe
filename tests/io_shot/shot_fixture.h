// A good shot file, the words it may use and a folder with the files it names: for all tests of the shot file.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "baker/core/file.h"
#include "baker/plan/inputs.h"
#include "baker/systems/cloth/cloth_keys.h"
#include "baker/systems/cords/cords_keys.h"
#include "io/shot/shot.h"
#include "tests/support/assets.h"

namespace ft {

inline ShotVocabulary words() {
  ShotVocabulary v = shot_vocabulary();
  v.lists["@formats"] = {"abc", "pc2", "mdd"};
  return v;
}

/// A shot's cloths, and its cords, in the order of the file.
inline const ClothSpec& cloth_of(const Result<Shot>& shot, std::size_t index) {
  return *specs_of<ClothSpec>(shot->secondaries).at(index);
}
inline std::size_t cloth_count(const Result<Shot>& shot) {
  return specs_of<ClothSpec>(shot->secondaries).size();
}
inline const CordsSpec& cords_of(const Result<Shot>& shot, std::size_t index) {
  return *specs_of<CordsSpec>(shot->secondaries).at(index);
}

inline const char* const k_good = R"([shot]
frames = "1001-1121"
fps = 25
preroll = 24

[primary.mannequin]
file = "mannequin.glb"
clip = "Rumba"

[cloth.dress]
mesh = "dress.obj"
fabric = "cotton"
on = "mannequin"
mass_per_area = 0.2
pins = [ { group = "waist" }, { within = 0.02, stiffness = 1e5, max_pull = 100 }, { vertices = "0-199, 250" }, { vertices = [3, 1, 2] } ]

[cloth.cape]
mesh = "dress.obj"
pin = "neck"

[cache]
formats = ["abc", "pc2"]
)";

class ShotFile : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"mannequin.glb", "dress.obj", "walk.fbx"})
      ASSERT_TRUE(write_text_durably(folder_ / name, "x").ok());
  }
  Result<Shot> parse(std::string_view text, const std::vector<std::string>& overrides = {}) {
    return parse_shot(text, folder_ / "shot.toml", words(), overrides, faults_);
  }
  /// Messages without the folder, which differs from run to run.
  std::vector<std::string> faults_of(std::string_view text, const std::vector<std::string>& overrides = {}) {
    const auto shot = parse(text, overrides);
    EXPECT_EQ(shot.ok(), faults_.messages.empty());
    std::vector<std::string> out;
    for (std::string message : faults_.messages) {
      const std::string prefix = folder_.path().string() + "/";
      if (message.starts_with(prefix)) message.erase(0, prefix.size());
      out.push_back(message);
    }
    return out;
  }
  /// The one fault of a good shot with one line put in place of another.
  std::string fault_with(const std::string& old_line, const std::string& new_line) {
    std::string text = k_good;
    const std::size_t at = text.find(old_line);
    EXPECT_NE(at, std::string::npos) << old_line;
    text.replace(at, old_line.size(), new_line);
    const auto faults = faults_of(text);
    EXPECT_EQ(faults.size(), 1u) << new_line;
    return faults.empty() ? "" : faults.front();
  }
  test::ScratchFolder folder_;
  ShotFaults faults_;
};

}  // namespace ft
