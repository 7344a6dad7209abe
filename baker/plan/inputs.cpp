#include "baker/plan/inputs.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "baker/core/file.h"
#include "baker/record/version.h"
#include "baker/systems/interface/system.h"
#include "io/cache/cache.h"
#include "io/volume/vdb_read.h"

namespace ft::inline baker {
namespace {

/// Names of the files that a glTF refers to for its geometry; empty for anything else.
std::vector<std::string> gltf_buffers(const std::filesystem::path& file) {
  std::vector<std::string> out;
  if (file.extension() != ".gltf") return out;
  const auto text = read_text(file);
  if (!text) return out;
  const auto json = nlohmann::json::parse(*text, nullptr, false);
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return out;
  for (const auto& buffer : json["buffers"]) {
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
    const auto uri = buffer["uri"].get<std::string>();
    if (uri.rfind("data:", 0) != 0) out.push_back(uri);
  }
  return out;
}

Status add_file(BakeInputs& inputs, const std::string& role, const std::filesystem::path& path) {
  if (path.empty()) return {};
  const auto content = hash_file(path);
  if (!content) return content.error();
  InputRecord file{role, path, content->hash};
  const auto buffers = gltf_buffers(path);
  if (!buffers.empty()) {
    Hasher all;
    all.number(file.content.low).number(file.content.high);
    for (const auto& name : buffers) {
      const auto part = hash_file(path.parent_path() / name);
      all.text(name).text(part ? part->hash.hex() : "absent");
    }
    file.content = all.digest();
  }
  inputs.files.push_back(std::move(file));
  return {};
}

/// A path is no setting: what counts is the bytes behind it, and they are in `files`. Nor is a gate: it judges a bake
/// and changes nothing of it.
bool shapes_the_bake(const std::string& key) {
  if (key.starts_with("gate.")) return false;
  for (const char* end : {".file", ".mesh", ".animation", ".topology", ".weights"})
    if (key.ends_with(end)) return false;
  return true;
}

/// The feasible collider of a primary has a cache of its own.
Status judge_cache_name(const Shot& shot, const SecondarySpec& secondary) {
  for (const PrimarySpec& primary : shot.primaries)
    if (primary.name + ".collider" == secondary.name)
      return usage_error(secondary.owner() + " has the name of a cache of primary \"" + primary.name + "\"",
                         shot.file.string(), "give it another name");
  return {};
}

}  // namespace

ShotVocabulary shot_vocabulary() {
  ShotVocabulary words;
  for (const SystemKind* kind : system_kinds()) {
    words.sections.push_back(&kind->section());
    for (auto& [name, list] : kind->section().lists()) words.lists.emplace(std::move(name), std::move(list));
  }
  for (const std::span<const Metric> metrics : {frame_metrics(), declared_metrics()})
    for (const Metric& metric : metrics) words.lists["@metrics"].emplace_back(metric.key);
  for (const CacheFormat& format : cache_formats()) words.lists["@formats"].emplace_back(format.name);
  return words;
}

Hash128 fingerprint(const BakeInputs& inputs) {
  Hasher all;
  all.text(program_version()).text(program_build());
  for (const InputRecord& file : inputs.files) all.text(file.role).number(file.content.low).number(file.content.high);
  for (const auto& [key, value] : inputs.settings) all.text(key).text(value);
  return all.digest();
}

Result<BakeInputs> read_inputs(const std::filesystem::path& shot_file, const std::vector<std::string>& overrides,
                               std::optional<FrameRange> frames, ShotFaults& faults) {
  auto shot = read_shot(shot_file, shot_vocabulary(), overrides, faults);
  if (!shot) return shot.error();
  BakeInputs inputs;
  inputs.shot = std::move(*shot);
  Shot& s = inputs.shot;
  if (frames) {
    if (frames->first < s.first_frame || frames->last > s.last_frame)
      return usage_error(fmt::format("--frames {} is not within the shot, which has {}", frames_text(*frames),
                                     frames_text({s.first_frame, s.last_frame})),
                         shot_file.string(),
                         fmt::format("--set shot.frames={} makes it another shot, which starts at frame {}",
                                     frames_text(*frames), frames->first));
    const double later = (frames->first - s.first_frame) / s.fps;
    for (PrimarySpec& primary : s.primaries) {
      if (later != 0 && primary.repeat > 1)
        return usage_error(fmt::format("--frames {} starts within the shot, and the clip of \"{}\" is repeated",
                                       frames_text(*frames), primary.name),
                           shot_file.string(),
                           fmt::format("a part of it has to start at the shot's first frame, {}", s.first_frame));
      if (later != 0) primary.clip_bind = primary.clip_start;
      primary.clip_start += later * primary.speed;
    }
    s.first_frame = frames->first;
    s.last_frame = frames->last;
  }
  for (const PrimarySpec& primary : s.primaries) {
    const std::string role = "primary." + primary.name;
    for (const auto& [key, path] :
         {std::pair{".file", primary.file}, {".animation", primary.animation}, {".topology", primary.topology}})
      if (const Status added = add_file(inputs, role + key, path); !added) return added.error();
  }
  for (const auto& secondary : s.secondaries) {
    const std::string role = std::string(secondary->kind()) + "." + secondary->name + ".";
    for (const auto& [key, path] : secondary->section->files(*secondary))
      if (const Status added = add_file(inputs, role + key, path); !added) return added.error();
    if (const Status free = judge_cache_name(s, *secondary); !free) return free.error();
  }
  for (const StandInKeys& standin : s.standins)
    if (const Status added = add_file(inputs, "standin." + standin.name + ".mesh", standin.mesh); !added)
      return added.error();
  for (const WindKeys& wind : s.winds) {
    if (wind.file.empty()) continue;
    const auto found = find_vdb_sequence(wind.file);
    if (!found) return found.error();
    for (const auto& path : found->files)
      if (const Status added = add_file(inputs, "wind." + wind.name + ".file", path); !added) return added.error();
  }
  for (auto& [key, value] : settings(s))
    if (shapes_the_bake(key)) inputs.settings.emplace_back(key, value);
  for (const PrimarySpec& primary : s.primaries)
    if (primary.clip_bind)
      inputs.settings.emplace_back("primary." + primary.name + ".clip_bind", fmt::format("{}", *primary.clip_bind));
  inputs.fingerprint = fingerprint(inputs);
  return inputs;
}

}  // namespace ft::inline baker
