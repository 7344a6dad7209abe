#include "io/import/character/clips.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "io/import/character/match_nodes.h"
#include "io/import/character/name_list.h"

namespace ft::inline io {
namespace {

std::size_t letters_changed(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row.back();
}

std::string some_of(const std::vector<std::string>& names, std::size_t most) {
  std::string out;
  for (std::size_t i = 0; i < names.size() && i < most; ++i) out += (i > 0 ? ", " : "") + names[i];
  if (names.size() > most) out += ", and " + std::to_string(names.size() - most) + " more";
  return out;
}

std::string seconds(double s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", s);
  return text;
}

}  // namespace

std::string nearest_name(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 2) + 1;
  for (const std::string& c : candidates) {
    const std::string a = small_letters(word), b = small_letters(c);
    std::size_t changed = letters_changed(a, b);
    if (!a.empty() && (b.find(a) != std::string::npos || (!b.empty() && a.find(b) != std::string::npos)))
      changed = std::min<std::size_t>(changed, 1);
    if (changed < least) least = changed, best = c;
  }
  return best;
}

Result<int> select_clip(const Character& character, const std::string& name, const std::string& file,
                        std::vector<std::string>& notes) {
  if (name.empty()) {
    if (character.clips.empty()) {
      notes.emplace_back("has no clips: it stands still");
      return -1;
    }
    if (character.clips.size() > 1)
      notes.push_back("has " + std::to_string(character.clips.size()) + " clips and none was asked for; \"" +
                      character.clips.front().name + "\" is taken");
    return 0;
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < character.clips.size(); ++i) {
    if (character.clips[i].name == name) return static_cast<int>(i);
    names.push_back(character.clips[i].name);
  }
  if (names.empty()) return usage_error("clip \"" + name + "\" does not exist: the file has no clips", file, "");
  std::string hint = "there are: " + some_of(names, 60);
  if (const std::string guess = nearest_name(name, names); !guess.empty())
    hint = "did you mean \"" + guess + "\"? " + hint;
  return usage_error("clip \"" + name + "\" does not exist", file, hint);
}

double unit_ratio(const Character& source, const Character& target) {
  return source.file_unit > 0 && target.file_unit > 0 ? source.file_unit / target.file_unit : 1;
}

Result<std::vector<Clip>> retarget_clips(const Character& source, const Character& target,
                                         const std::string& source_file, std::vector<std::string>& notes) {
  const NodeMatch match = match_nodes(source, target);
  const std::vector<int>& to = match.to;
  const double scale = unit_ratio(source, target);
  std::vector<Clip> out;
  std::vector<char> is_missing(source.nodes.size(), 0);
  std::set<std::string> other_shapes, guessed;
  std::size_t matched = 0;
  for (const Clip& clip : source.clips) {
    Clip moved = clip;
    moved.channels.clear(), moved.stacks.clear(), moved.shapes.clear();
    for (Channel channel : clip.channels) {
      const auto node = static_cast<std::size_t>(channel.node);
      if (to[node] < 0) {
        is_missing[node] = 1;
        continue;
      }
      ++matched;
      if (match.in_order[node]) guessed.insert(source.nodes[node].name);
      channel.node = to[node];
      for (double& v : channel.translation.values) v *= scale;
      if (!channel.weights.empty() && static_cast<std::size_t>(channel.weights.width) !=
                                          target.nodes[static_cast<std::size_t>(channel.node)].morph_weights.size())
        channel.weights = {}, other_shapes.insert(source.nodes[node].name);
      moved.channels.push_back(std::move(channel));
    }
    for (TransformStack stack : clip.stacks) {
      const auto node = static_cast<std::size_t>(stack.node);
      if (to[node] < 0) {
        is_missing[node] = 1;
        continue;
      }
      ++matched;
      if (match.in_order[node]) guessed.insert(source.nodes[node].name);
      stack.node = to[node];
      for (ElementaryTransform& e : stack.elements) {
        e.unit *= scale;
        e.matrix.topRightCorner<3, 1>() *= scale;
      }
      moved.stacks.push_back(std::move(stack));
    }
    for (ShapeChannel channel : clip.shapes) {
      const auto node = static_cast<std::size_t>(channel.node);
      if (to[node] < 0) {
        is_missing[node] = 1;
        continue;
      }
      ++matched;
      if (match.in_order[node]) guessed.insert(source.nodes[node].name);
      if (source.nodes[node].morph_weights.size() !=
          target.nodes[static_cast<std::size_t>(to[node])].morph_weights.size()) {
        other_shapes.insert(source.nodes[node].name);
        continue;
      }
      channel.node = to[node];
      moved.shapes.push_back(std::move(channel));
    }
    if (moved.moved_count() > 0) moved.find_range();  // cameras and lights of the other file may be longer
    out.push_back(std::move(moved));
  }
  if (source.clips.empty()) return input_error("has no animation", source_file);
  if (matched == 0)
    return input_error("animates no node of the character: no name is in both files", source_file,
                       "export both from the same skeleton");
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < is_missing.size(); ++i)
    if (is_missing[i]) missing.push_back(source.nodes[i].name);
  if (!missing.empty())
    notes.push_back(std::to_string(missing.size()) +
                    " animated nodes are not in the character: " + some_of(missing, 8));
  if (!guessed.empty())
    notes.push_back(
        "joints that share a name and the names above them were matched in their order, which is a guess: " +
        name_list(guessed));
  if (!other_shapes.empty())
    notes.push_back("blend shapes of these nodes are not those of the character, and their keys were left out: " +
                    name_list(other_shapes));
  return out;
}

Status check_clip_range(const Clip& clip, const ImportRequest& request, const std::string& file) {
  if (clip.duration() <= 0) return {};
  const double frame = request.speed / request.shot_fps;
  const double end = request.clip_start + request.duration * request.speed;
  const bool starts = request.clip_start >= -frame;
  if (starts && (request.loop || end <= clip.duration() + frame * (1 + 1e-6))) return {};
  const double frames = clip.duration() / frame;
  return usage_error(
      "the shot plays " + seconds(request.clip_start) + " s to " + seconds(end) + " s of clip \"" + clip.name +
          "\", which is " + seconds(clip.duration()) + " s long (" +
          std::to_string(static_cast<long>(std::floor(frames + 1e-6)) + 1) + " frames of this shot)",
      file,
      starts ? "bake fewer frames, start earlier in the clip, or repeat it: loop = true" : "start within the clip");
}

}  // namespace ft::inline io
