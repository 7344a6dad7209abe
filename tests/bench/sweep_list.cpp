#include "tests/bench/sweep_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "baker/core/file.h"
#include "baker/core/hash.h"
#include "io/import/character/clips.h"
#include "io/import/import_cache.h"
#include "tests/bench/sweep_retarget.h"

namespace ft::bench {
namespace {

namespace fs = std::filesystem;

/// Frames of a clip without motion.
constexpr int k_still_frames = 24;
/// What a file does not say of itself.
struct Remark {
  const char* folder;
  std::vector<std::string> meshes;  ///< without the clothes and hair that the file has of its own
  double height = 0;                ///< m; 0: as it is
};
Remark remark_on(const std::string& folder) {
  for (Remark& r : std::vector<Remark>{{"mh_adult_cmu_dressed", {"Body"}, 0}, {"robot_expressive", {}, 1.8}})
    if (folder == r.folder) return r;
  return {};
}

struct Source {
  std::string folder, name;  ///< name: of the character, or of the file with the motion
  fs::path file;
  Character character;
  Remark remark;
  bool is_body() const { return !character.meshes.empty() || character.format == "BVH"; }
};

/// A clip with the body that it was made for.
struct Play {
  const Source *body = nullptr, *motion = nullptr;  ///< one and the same where the clip is in the body's file
  Clip clip;
  std::string label;
};

std::string lower_extension(const fs::path& file) {
  std::string out = file.extension().string();
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

std::string folder_name(const std::string& text) {
  std::string out = text;
  for (char& c : out)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
  return out;
}

std::uint64_t lot(std::uint64_t seed, const std::string& what, const std::string& name) {
  return Hasher().number(seed).text(what).text(name).digest().low;
}

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<Source> read_sources(const SweepSettings& settings, std::vector<std::string>& notes) {
  static const std::set<std::string> extensions = {".fbx", ".glb", ".gltf", ".dae", ".bvh"};
  std::vector<Source> out;
  for (const char* kind : {"characters", "mocap"})
    for (const fs::path& folder : sorted_entries(settings.assets / kind)) {
      const std::size_t before = out.size();
      for (const fs::path& file : sorted_entries(folder)) {
        if (!extensions.contains(lower_extension(file))) continue;
        auto loaded = load_character(file, settings.import_cache, {});
        if (!loaded) {
          notes.push_back("left out: " + loaded.error().text());
          continue;
        }
        const std::string name = folder.filename().string();
        out.push_back({name, file.stem().string(), file, std::move(loaded->character), remark_on(name)});
      }
      const auto bodies = std::count_if(out.begin() + static_cast<std::ptrdiff_t>(before), out.end(),
                                        [](const Source& s) { return s.is_body(); });
      std::set<std::string> stems;
      for (std::size_t i = before; i < out.size(); ++i) {
        Source& s = out[i];
        if (!s.is_body()) continue;
        const bool seen = !stems.insert(s.name).second;
        s.name = folder_name(bodies == 1 ? s.folder : s.folder + "." + (seen ? s.file.filename().string() : s.name));
      }
    }
  return out;
}

/// Whose clips a file without a body holds: those of the folder's body of the same format, else of its only one.
const Source* body_of(const Source& motion, const std::vector<Source>& sources) {
  const Source *same = nullptr, *any = nullptr;
  int count = 0;
  for (const Source& s : sources) {
    if (s.folder != motion.folder || !s.is_body()) continue;
    any = &s, ++count;
    if (lower_extension(s.file) == lower_extension(motion.file)) same = &s;
  }
  return same ? same : count == 1 ? any : nullptr;
}

std::vector<Play> all_plays(const std::vector<Source>& sources, std::vector<std::string>& notes) {
  std::vector<Play> out;
  for (const Source& motion : sources) {
    const Source* body = motion.is_body() ? &motion : body_of(motion, sources);
    if (body == nullptr) {
      notes.push_back(fmt::format("left out: {} has no mesh, and its folder no body for it", motion.file.string()));
      continue;
    }
    std::vector<Clip> clips = motion.character.clips;
    if (body != &motion) {
      std::vector<std::string> ignored;
      auto matched = retarget_clips(motion.character, body->character, motion.file.string(), ignored);
      if (!matched) {
        notes.push_back("left out: " + matched.error().text());
        continue;
      }
      clips = std::move(*matched);
    }
    for (const Clip& clip : clips) {
      const std::string label = clips.size() > 1 ? clip.name : motion.file.stem().string();
      Play play{body, &motion, clip, folder_name(label)};
      const auto same = [&](const Play& p) { return p.body == body && p.label == play.label; };
      if (std::any_of(out.begin(), out.end(), same)) {
        if (clips.size() > 1) {
          notes.push_back(fmt::format("left out: another clip \"{}\" in {}", clip.name, motion.file.string()));
          continue;
        }
        play.label = folder_name(motion.file.filename().string());
      }
      out.push_back(std::move(play));
    }
  }
  return out;
}

/// Keys a second of the track that has most; 0: none.
double own_rate(const Clip& clip) {
  const Track* most = nullptr;
  for (const Channel& channel : clip.channels)
    for (const Track* t : {&channel.translation, &channel.rotation, &channel.scale})
      if (most == nullptr || t->times.size() > most->times.size()) most = t;
  if (most == nullptr || most->times.size() < 3) return 0;
  std::vector<double> steps;
  for (std::size_t i = 1; i < most->times.size(); ++i) steps.push_back(most->times[i] - most->times[i - 1]);
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return 1 / steps[steps.size() / 2];
}

double shot_rate(const Clip& clip) {
  const double own = own_rate(clip);
  for (int divisor = 1; own / divisor > 23.9; ++divisor)
    if (own / divisor < 30.1) {
      const double rate = own / divisor;
      return std::abs(rate - std::round(rate)) < 0.02 ? std::round(rate) : std::round(1e3 * rate) / 1e3;
    }
  return 24;
}

std::string full_name(const Play& play) {
  return play.body->name + "." + play.label;
}

SweepBake make_bake(const SweepSettings& settings, const Play& play, const Source& body, std::string name) {
  SweepBake out;
  out.name = std::move(name);
  out.character = body.name;
  out.file = body.file;
  if (play.motion != &body) out.animation = play.motion->file;
  out.clip = play.clip.name;
  out.meshes = body.remark.meshes, out.height = body.remark.height;
  out.fps = shot_rate(play.clip);
  const double duration = play.clip.duration();
  const int frames = duration > 0 ? static_cast<int>(std::floor(duration * out.fps + 1e-6)) + 1 : k_still_frames;
  out.frame_count = std::min(frames, settings.most_frames);
  if (frames > out.frame_count) {
    const auto starts = static_cast<std::uint64_t>(frames - out.frame_count + 1);
    out.clip_start = static_cast<double>(lot(settings.seed, "start", out.name) % starts) / out.fps;
  }
  return out;
}

/// The clip on one of the other characters with joints as its own, drawn by lot; none: it fits none.
std::vector<std::pair<const Play*, const Source*>> on_others(const SweepSettings& settings,
                                                             const std::vector<Play>& plays,
                                                             const std::vector<Source>& sources) {
  std::vector<std::pair<const Play*, const Source*>> out;
  for (const Play& play : plays) {
    if (!find_joints(play.motion->character).complete) continue;
    const std::string name = full_name(play);
    const auto ticket = [&](const Source& s) {  // folders have even chances, whatever they hold
      return std::pair(lot(settings.seed, name, s.folder), lot(settings.seed, name, s.name));
    };
    const Source* chosen = nullptr;
    for (const Source& s : sources)
      if (s.is_body() && s.folder != play.body->folder && find_joints(s.character).complete &&
          (chosen == nullptr || ticket(s) < ticket(*chosen)))
        chosen = &s;
    if (chosen != nullptr) out.emplace_back(&play, chosen);
  }
  return out;
}

/// Writes the motion that the other character plays.
Result<SweepBake> on_another(const SweepSettings& settings, const Play& play, const Source& other) {
  SweepBake bake = make_bake(settings, play, other, other.name + "--" + full_name(play));
  bake.animation = settings.motions / (bake.name + ".glb");
  // Channels of a motion without a body were put onto its body's nodes: the file's own are asked for.
  for (const Clip& clip : play.motion->character.clips)
    if (clip.name == play.clip.name) {
      const Status written = write_retargeted(
          play.motion->character, clip, {bake.clip_start, bake.fps, bake.frame_count}, other.character, bake.animation);
      if (!written) return written.error();
      break;
    }
  bake.clip_start = 0;
  return bake;
}

std::string or_dash(const std::string& text) {
  return text.empty() ? "-" : text;
}
std::string not_dash(const std::string& text) {
  return text == "-" ? "" : text;
}

}  // namespace

Result<std::vector<SweepBake>> list_sweep(const SweepSettings& settings, std::vector<std::string>& notes) {
  const std::vector<Source> sources = read_sources(settings, notes);
  if (sources.empty()) return input_error("has no characters", settings.assets.string());
  if (Status status = make_folders(settings.motions); !status) return status.error();
  const std::vector<Play> plays = all_plays(sources, notes);
  std::vector<SweepBake> out;
  for (const Play& play : plays) out.push_back(make_bake(settings, play, *play.body, full_name(play)));
  auto others = on_others(settings, plays, sources);
  notes.push_back(fmt::format("{} clips, {} of them fit a character of another folder", plays.size(), others.size()));
  std::sort(others.begin(), others.end(), [&](const auto& a, const auto& b) {
    return lot(settings.seed, "other", full_name(*a.first)) < lot(settings.seed, "other", full_name(*b.first));
  });
  others.resize(std::min(others.size(), (plays.size() + 1) / 2));
  for (const auto& [play, other] : others) {
    auto bake = on_another(settings, *play, *other);
    if (!bake) return bake.error();
    out.push_back(std::move(*bake));
  }
  std::map<std::string, int> uses;
  for (SweepBake& bake : out)
    if (const int n = ++uses[bake.name]; n > 1) bake.name += fmt::format("_{}", n);
  std::sort(out.begin(), out.end(), [&](const SweepBake& a, const SweepBake& b) {
    return lot(settings.seed, "order", a.name) < lot(settings.seed, "order", b.name);
  });
  return out;
}

std::string to_lines(const std::vector<SweepBake>& bakes) {
  std::string out = "name\tcharacter\tfile\tanimation\tclip\tclip_start\tfps\tframes\tmeshes\theight\n";
  for (const SweepBake& b : bakes) {
    std::string meshes;
    for (const std::string& m : b.meshes) meshes += (meshes.empty() ? "" : ",") + m;
    out += fmt::format("{}\t{}\t{}\t{}\t{}\t{:.6f}\t{:g}\t{}\t{}\t{:g}\n", b.name, b.character, b.file.string(),
                       or_dash(b.animation.string()), or_dash(b.clip), b.clip_start, b.fps, b.frame_count,
                       or_dash(meshes), b.height);
  }
  return out;
}

Result<std::vector<SweepBake>> read_sweep_list(const fs::path& file) {
  auto text = read_text(file);
  if (!text) return text.error();
  std::vector<SweepBake> out;
  std::istringstream lines(*text);
  std::string line;
  std::getline(lines, line);  // names of the fields
  while (std::getline(lines, line)) {
    std::vector<std::string> fields;
    std::istringstream row(line);
    for (std::string field; std::getline(row, field, '\t');) fields.push_back(not_dash(field));
    if (fields.size() != 10) return input_error("has a line that is not of a list of bakes", file.string());
    SweepBake b;
    b.name = fields[0], b.character = fields[1], b.file = fields[2], b.animation = fields[3], b.clip = fields[4];
    b.clip_start = std::atof(fields[5].c_str()), b.fps = std::atof(fields[6].c_str());
    b.frame_count = std::atoi(fields[7].c_str()), b.height = std::atof(fields[9].c_str());
    std::istringstream meshes(fields[8]);
    for (std::string mesh; std::getline(meshes, mesh, ',');) b.meshes.push_back(mesh);
    out.push_back(std::move(b));
  }
  return out;
}

}  // namespace ft::bench
