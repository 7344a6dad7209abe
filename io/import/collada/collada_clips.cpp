#include "io/import/collada/collada_clips.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "io/import/character/name_list.h"
#include "io/import/character/pose.h"
#include "io/import/collada/collada_stack.h"

namespace ft::inline io {
namespace {

/// "node/sid.MEMBER", "node/sid(1)(2)" or "node/sid": the way to an element, and which number of it.
struct Target {
  std::vector<std::string> path;
  std::string member;        ///< "X", "ANGLE", ...; empty: all numbers
  std::vector<int> indices;  ///< (row)(column), or (number)
};

Target parse_target(std::string text) {
  Target out;
  if (const auto slash = text.rfind('/'); slash != std::string::npos) {
    std::string tail = text.substr(slash + 1);
    if (const auto bracket = tail.find('('); bracket != std::string::npos) {
      for (std::size_t p = bracket; p != std::string::npos && out.indices.size() < 2; p = tail.find('(', p + 1))
        out.indices.push_back(std::atoi(tail.c_str() + p + 1));
      tail.resize(bracket);
    } else if (const auto dot = tail.find('.'); dot != std::string::npos) {
      out.member = tail.substr(dot + 1);
      tail.resize(dot);
    }
    text = text.substr(0, slash + 1) + tail;
  }
  for (std::size_t p = 0; p <= text.size();) {
    const std::size_t slash = std::min(text.find('/', p), text.size());
    out.path.push_back(text.substr(p, slash - p));
    p = slash + 1;
  }
  return out;
}

class ClipReader {
 public:
  ClipReader(const ColladaFile& file, Character& character, const std::vector<ColladaNode>& nodes)
      : file_(file), character_(character) {
    for (const auto& [element, node] : nodes) uses_[element].push_back(node);
  }

  Status read(std::vector<Clip>& out) {
    const auto by_clip = file_.root().child("library_animation_clips").children("animation_clip");
    for (const pugi::xml_node chosen : by_clip) {
      Clip clip;
      clip.name = chosen.attribute("name") ? chosen.attribute("name").value() : chosen.attribute("id").value();
      if (clip.name.empty()) clip.name = "animation_" + std::to_string(out.size());
      std::vector<pugi::xml_node> animations;
      for (const pugi::xml_node instance : chosen.children("instance_animation"))
        if (const pugi::xml_node found = file_.find(instance.attribute("url").value())) animations.push_back(found);
      if (Status s = read_clip(animations, clip); !s) return s;
      const double start = chosen.attribute("start").as_double(0), end = chosen.attribute("end").as_double(0);
      clip.find_range();
      if (end > start && std::isfinite(end)) clip.start = start, clip.end = end, clip.has_own_range = true;
      if (clip.moved_count() > 0) out.push_back(std::move(clip));
    }
    if (out.empty()) {
      Clip clip;
      clip.name = character_.clips.size() == 1 ? character_.clips.front().name : "animation";
      std::vector<pugi::xml_node> animations;
      for (const pugi::xml_node library : file_.root().children("library_animations"))
        for (const pugi::xml_node animation : library.children("animation")) animations.push_back(animation);
      if (Status s = read_clip(animations, clip); !s) return s;
      clip.find_range();
      if (clip.moved_count() > 0) out.push_back(std::move(clip));
    }
    return {};
  }

  void describe(std::vector<std::string>& notes) const {
    if (!missed_.empty()) notes.push_back("animation of what is not evaluated was left out: " + name_list(missed_));
    if (unknown_)
      notes.emplace_back(
          "keys of an interpolation that is none of STEP, LINEAR, BEZIER and HERMITE, or without the tangents that it "
          "needs, are joined by straight lines");
    if (!skewed_.empty()) notes.push_back("a skew is left out on " + name_list(skewed_));
  }

  void add_skewed(const pugi::xml_node& element) { skewed_.insert(name_of(element)); }

 private:
  struct Moved {
    ColladaTransform transform;
    std::vector<Curve> matrix;  ///< 16 where the whole of a single <matrix> is animated
  };

  Status read_clip(std::vector<pugi::xml_node> animations, Clip& clip) {
    clip.curves.layers.assign(1, {});
    std::map<pugi::xml_node, Moved> moved;
    for (std::size_t a = 0; a < animations.size(); ++a) {  // grows by those that are nested
      if (animations.size() > 10'000'000) return input_error("has too many animations");
      const pugi::xml_node animation = animations[a];
      for (const pugi::xml_node child : animation.children("animation")) animations.push_back(child);
      for (const pugi::xml_node channel : animation.children("channel"))
        if (Status s = read_channel(channel, clip, moved); !s) return s;
    }
    for (auto& [element, m] : moved) {
      std::vector<std::int32_t> used;
      add_curves(m.transform.stack, used);
      if (used.empty() && m.matrix.empty()) continue;
      for (const int node : uses_.at(element)) {
        if (m.matrix.size() == 16) {
          clip.channels.push_back(matrix_channel(m.matrix, node));
          continue;
        }
        TransformStack stack = m.transform.stack;
        stack.node = node;
        clip.stacks.push_back(std::move(stack));
      }
    }
    const auto by_node = [](const auto& x, const auto& y) { return x.node < y.node; };
    std::sort(clip.stacks.begin(), clip.stacks.end(), by_node);
    std::sort(clip.channels.begin(), clip.channels.end(), by_node);
    return {};
  }

  static std::string name_of(const pugi::xml_node& node) {
    return node.attribute("name") ? node.attribute("name").value() : node.attribute("id").value();
  }

  /// The <node> that a target's element belongs to; empty when it is none of the scene.
  pugi::xml_node node_of(const Target& target) const {
    pugi::xml_node node = file_.find(target.path.front());
    for (std::size_t k = 1; node && k + 1 < target.path.size(); ++k)
      node = node.find_child([&](const pugi::xml_node& c) {
        return std::string(c.name()) == "node" && target.path[k] == c.attribute("sid").value();
      });
    return node && uses_.contains(node) ? node : pugi::xml_node();
  }

  Status read_channel(const pugi::xml_node& channel, Clip& clip, std::map<pugi::xml_node, Moved>& moved) {
    const std::string text = channel.attribute("target").value();
    const Target target = parse_target(text);
    const pugi::xml_node node = node_of(target);
    const pugi::xml_node sampler = file_.find(channel.attribute("source").value());
    if (!node || !sampler || target.path.size() < 2) {
      missed_.insert(text);
      return {};
    }
    const auto found = moved.find(node);
    Moved& m = found != moved.end() ? found->second : moved[node];
    if (found == moved.end()) m.transform = collada_transform(node, -1);
    auto curves = collada_curves(file_, sampler, unknown_);
    if (!curves) return curves.error();
    const auto& sids = m.transform.sids;
    const auto at = static_cast<std::size_t>(std::find(sids.begin(), sids.end(), target.path.back()) - sids.begin());
    if (at == sids.size() || !put(target, at, *curves, m, clip)) missed_.insert(text);
    return {};
  }

  bool put(const Target& target, std::size_t at, std::vector<Curve>& curves, Moved& m, Clip& clip) {
    ElementaryTransform& e = m.transform.stack.elements[at];
    const std::string& kind = m.transform.kinds[at];
    const std::string& member = target.member;
    if (kind == "matrix") {
      const bool whole = target.indices.empty() && (member.empty() || member == "TRANSFORM");
      if (m.transform.stack.elements.size() != 1 || !whole || curves.size() != 16) return false;
      m.matrix = std::move(curves);
      return true;
    }
    const int number = !target.indices.empty()              ? target.indices[0]
                       : member == "X" || member == "R"     ? 0
                       : member == "Y" || member == "G"     ? 1
                       : member == "Z" || member == "B"     ? 2
                       : member == "ANGLE" || member == "W" ? 3
                                                            : -1;
    if (kind == "rotate") {
      // The angle alone, or axis and angle with an axis that stays.
      if (number == 3 && curves.size() == 1) return bind(e, 0, curves[0], clip);
      if (number != -1 || !member.empty() || curves.size() != 4) return false;
      for (std::size_t k = 0; k < 3; ++k)
        for (const double v : curves[k].values)
          if (std::abs(v - e.axis[static_cast<Eigen::Index>(k)]) > 1e-9) return false;
      return bind(e, 0, curves[3], clip);
    }
    if (kind != "translate" && kind != "scale") return false;
    if (number >= 0 && number < 3 && curves.size() == 1)
      return bind(e, static_cast<std::size_t>(number), curves[0], clip);
    if (number != -1 || !member.empty() || curves.size() != 3) return false;
    for (std::size_t k = 0; k < 3; ++k) bind(e, k, curves[k], clip);
    return true;
  }

  static bool bind(ElementaryTransform& e, std::size_t number, Curve& curve, Clip& clip) {
    if (e.numbers.layers.empty()) {
      e.numbers.layers.emplace_back();
      e.numbers.layers.back().fixed = e.numbers.rest;
    }
    e.numbers.layers.back().curves[number] = static_cast<std::int32_t>(clip.curves.curves.size());
    clip.curves.curves.push_back(std::move(curve));
    return true;
  }

  /// Keys of a matrix: its parts are joined, not its numbers, which would shrink what turns.
  static Channel matrix_channel(const std::vector<Curve>& curves, int node) {
    Channel out;
    out.node = node;
    const Curve& first = curves.front();
    const bool steps = std::all_of(first.interpolation.begin(), first.interpolation.end(),
                                   [](CurveInterpolation how) { return how == CurveInterpolation::k_constant; });
    for (Track* track : {&out.translation, &out.rotation, &out.scale}) {
      track->width = track == &out.rotation ? 4 : 3;
      if (steps && !first.interpolation.empty()) track->interpolation = KeyInterpolation::k_step;
    }
    for (std::size_t i = 0; i < first.times.size(); ++i) {
      if (i + 1 < first.times.size() && !(first.times[i + 1] > first.times[i])) continue;
      Mat4 m;
      for (std::size_t k = 0; k < 16; ++k)
        m(static_cast<Eigen::Index>(k / 4), static_cast<Eigen::Index>(k % 4)) = curves[k].values[i];
      const NodeTransform parts = decompose(m);
      for (Track* track : {&out.translation, &out.rotation, &out.scale}) track->times.push_back(first.times[i]);
      for (int k = 0; k < 3; ++k) out.translation.values.push_back(parts.translation[k]);
      for (int k = 0; k < 4; ++k) out.rotation.values.push_back(parts.rotation.coeffs()[k]);
      for (int k = 0; k < 3; ++k) out.scale.values.push_back(parts.stretch(k, k));
    }
    return out;
  }

  const ColladaFile& file_;
  Character& character_;
  std::map<pugi::xml_node, std::vector<int>> uses_;
  std::set<std::string> missed_, skewed_;
  bool unknown_ = false;
};

}  // namespace

Mat4 collada_rest(const pugi::xml_node& node) {
  return stack_pose(collada_transform(node, 0).stack, {}, 0).matrix;
}

Status read_collada_clips(const ColladaFile& file, Character& character) {
  const std::vector<ColladaNode> nodes = match_collada_nodes(file, character);
  if (nodes.empty()) return input_error("node trees differ");
  std::vector<Clip> clips;
  ClipReader reader(file, character, nodes);
  if (Status s = reader.read(clips); !s) return s;
  for (const auto& [element, node] : nodes) {
    const ColladaTransform transform = collada_transform(element, 0);
    if (transform.skewed) reader.add_skewed(element);
    const Mat4 rest = stack_pose(transform.stack, {}, 0).matrix;
    if (rest.allFinite()) character.nodes[static_cast<std::size_t>(node)].local = rest;
  }
  reader.describe(character.notes);
  character.clips = std::move(clips);
  return {};
}

void note_collada_contents(const ColladaFile& file, Character& character) {
  std::set<std::string> driven, physics, morphs;
  std::int64_t driven_count = 0;
  for (pugi::xml_node n = file.root(); n; n = next_element(n, file.root())) {
    std::string kind = n.name();
    std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return std::tolower(c); });
    const std::string own = n.attribute("name") ? n.attribute("name").value() : n.attribute("id").value();
    if (kind == "morph") {
      const pugi::xml_node controller = n.parent();
      morphs.insert(controller.attribute("name") ? controller.attribute("name").value()
                                                 : controller.attribute("id").value());
    } else if (kind == "rigid_body" || kind == "physics_model" || kind == "force_field" || kind == "rigid_constraint") {
      physics.insert(own.empty() ? n.attribute("sid").value() : own);
    } else if (kind.find("constraint") != std::string::npos || kind.starts_with("ik_") || kind == "ik" ||
               kind.find("ikhandle") != std::string::npos || kind.starts_with("kinematics_") ||
               kind.find("expression") != std::string::npos) {
      pugi::xml_node owner = n;
      while (owner && std::string(owner.name()) != "node") owner = owner.parent();
      driven.insert(owner         ? owner.attribute("name").as_string(owner.attribute("id").value())
                    : own.empty() ? n.name()
                                  : own);
      ++driven_count;
    }
  }
  if (!driven.empty()) {
    character.notes.push_back(
        "constraints, inverse kinematics or expressions are not evaluated (bake the animation to keys): " +
        name_list(driven));
    character.contents.push_back({"constraints", driven_count, "not used: only keys move nodes"});
  }
  if (!physics.empty()) {
    character.notes.push_back("physics in the file is not simulated: " + name_list(physics));
    character.contents.push_back({"physics bodies", static_cast<std::int64_t>(physics.size()), "not used"});
  }
  if (!morphs.empty()) {
    character.notes.push_back(
        "shapes of morph controllers stay at their rest weights; keys of them are not evaluated: " + name_list(morphs));
    character.contents.push_back(
        {"morph controllers", static_cast<std::int64_t>(morphs.size()), "used at their rest weights"});
  }
}

}  // namespace ft::inline io
