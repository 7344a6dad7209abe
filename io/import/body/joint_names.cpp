#include "io/import/body/joint_names.h"

#include <cctype>
#include <vector>

namespace ft::inline io {
namespace {

struct Word {
  const char* text;
  Limb limb;
};
/// First match wins; "upleg" stands before "leg", "forearm" before "arm".
// clang-format off
constexpr Word k_words[] = {
    {"hipjoint", Limb::k_hip_joint}, {"upleg", Limb::k_thigh},       {"upperleg", Limb::k_thigh},    {"thigh", Limb::k_thigh},
    {"femur", Limb::k_thigh},       {"shin", Limb::k_shin},         {"knee", Limb::k_shin},         {"calf", Limb::k_shin},
    {"lowleg", Limb::k_shin},       {"lowerleg", Limb::k_shin},     {"tibia", Limb::k_shin},        {"leg", Limb::k_shin},
    {"toe", Limb::k_toe},           {"foot", Limb::k_foot},         {"ankle", Limb::k_foot},        {"thumb", Limb::k_finger},
    {"finger", Limb::k_finger},     {"index", Limb::k_finger},      {"middle", Limb::k_finger},     {"ring", Limb::k_finger},
    {"pinky", Limb::k_finger},      {"handend", Limb::k_finger},    {"hand", Limb::k_hand},         {"wrist", Limb::k_hand},
    {"forearm", Limb::k_forearm},   {"lowerarm", Limb::k_forearm},  {"lowarm", Limb::k_forearm},    {"elbow", Limb::k_forearm},
    {"radius", Limb::k_forearm},    {"collar", Limb::k_collar},     {"clavicle", Limb::k_collar},   {"uparm", Limb::k_upper_arm},
    {"upperarm", Limb::k_upper_arm}, {"humerus", Limb::k_upper_arm}, {"shldr", Limb::k_upper_arm},  {"shoulder", Limb::k_collar},
    {"arm", Limb::k_upper_arm},     {"head", Limb::k_head},         {"neck", Limb::k_neck},         {"spine", Limb::k_torso},
    {"chest", Limb::k_torso},       {"back", Limb::k_torso},        {"abdomen", Limb::k_torso},     {"torso", Limb::k_torso},
    {"thorax", Limb::k_torso},      {"waist", Limb::k_torso},       {"hip", Limb::k_hips},          {"pelvis", Limb::k_hips},
    {"root", Limb::k_hips},
};
/// Words of these have a limb's name within, and are none: they are taken out before one is looked for.
constexpr const char* k_no_limbs[] = {"armature", "armor", "armour", "string", "spring", "footstep", "backpack", "necklace", "skirt",
                                      "tail"};
/// Whole names, without a side: too short to be looked for within others.
constexpr Word k_short[] = {{"uarm", Limb::k_upper_arm}, {"farm", Limb::k_forearm}, {"ball", Limb::k_toe}, {"ab", Limb::k_torso},
                            {"sternum", Limb::k_torso},  {"pinkie", Limb::k_finger}, {"little", Limb::k_finger}};
// clang-format on

std::string_view without_namespace(std::string_view name) {
  const auto at = name.find_last_of(":|");
  return at == std::string_view::npos || at + 1 == name.size() ? name : name.substr(at + 1);
}

bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}
bool is_large(char c) {
  return std::isupper(static_cast<unsigned char>(c)) != 0;
}
char small(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// "LHipJoint" and "l_hip_joint" are l, hip, joint.
std::vector<std::string> parts_of(std::string_view name) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (!is_letter(name[i])) continue;
    const bool first = i == 0 || !is_letter(name[i - 1]);
    const bool hump =
        is_large(name[i]) && !first &&
        (!is_large(name[i - 1]) || (i + 1 < name.size() && is_letter(name[i + 1]) && !is_large(name[i + 1])));
    if (first || hump) out.emplace_back();
    out.back().push_back(small(name[i]));
  }
  return out;
}

std::string letters_of(std::string_view name) {
  std::string out;
  for (const char c : name)
    if (is_letter(c)) out.push_back(small(c));
  for (const char* word : k_no_limbs)
    for (std::size_t at = out.find(word); at != std::string::npos; at = out.find(word))
      out.erase(at, std::string_view(word).size());
  return out;
}

/// Vertebrae of Xsens: L5, L3, T12, T8, C7.
bool is_vertebra(std::string_view name) {
  if (name.size() < 2 || name.size() > 3) return false;
  for (const char digit : name.substr(1))
    if (digit < '0' || digit > '9') return false;
  return name[0] == 'L' || name[0] == 'T' || name[0] == 'C';
}

}  // namespace

Limb limb_by_name(std::string_view name) {
  name = without_namespace(name);
  if (is_vertebra(name)) return Limb::k_torso;
  std::string rest;  // without a side that stands alone
  for (const std::string& part : parts_of(name))
    if (part != "l" && part != "r" && part != "left" && part != "right") rest += part;
  for (const Word& w : k_short)
    if (rest == w.text || rest == std::string("l") + w.text || rest == std::string("r") + w.text) return w.limb;
  const std::string word = letters_of(name);
  for (const Word& w : k_words)
    if (word.find(w.text) != std::string::npos) return w.limb;
  return Limb::k_other;
}

Side side_by_name(std::string_view name) {
  name = without_namespace(name);
  if (is_vertebra(name)) return Side::k_none;
  const std::vector<std::string> parts = parts_of(name);
  for (const std::string& part : parts) {
    if (part == "l" || part.starts_with("left")) return Side::k_left;
    if (part == "r" || part.starts_with("right")) return Side::k_right;
  }
  // "lfemur", "rHumerus" in small letters: a limb's name behind the first letter.
  const std::string word = letters_of(name);
  if (word.size() > 3 && (word[0] == 'l' || word[0] == 'r'))
    for (const Word& w : k_words)
      if (std::string_view(word).substr(1).starts_with(w.text)) return word[0] == 'l' ? Side::k_left : Side::k_right;
  for (const std::string& part : parts)
    if (part.ends_with("left") || part.ends_with("right")) return part.ends_with("left") ? Side::k_left : Side::k_right;
  return Side::k_none;
}

}  // namespace ft::inline io
