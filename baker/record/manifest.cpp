#include "baker/record/manifest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "baker/core/file.h"
#include "baker/record/report_json.h"
#include "baker/systems/interface/system.h"
#include "io/shot/shot.h"

namespace ft::inline baker {
namespace {

constexpr int k_manifest_version = 1;

Json system_json(const ManifestSystem& system) {
  Json caches = Json::array();
  for (const ManifestCache& c : system.caches)
    caches.push_back({{"format", c.format}, {"file", c.file}, {"bytes", c.bytes}, {"content", c.content}});
  Json out{{"name", system.name}, {"role", system.role}, {"primary", system.primary}};
  if (system.shape == OutputShape::k_mesh) {
    out["vertices"] = system.vertex_count;
    out["faces"] = system.face_count;
  } else {
    out["shape"] = shape_key(system.shape);
    out["count"] = system.count;
    if (system.shape == OutputShape::k_curves) out["curves"] = system.curve_count;
    if (!system.prototypes.empty()) out["prototypes"] = Json::array();
    for (const ManifestPrototype& p : system.prototypes)
      out["prototypes"].push_back({{"name", p.name}, {"vertices", p.vertex_count}, {"faces", p.face_count}});
  }
  out["topology"] = system.topology;
  out["caches"] = std::move(caches);
  if (system.pattern_scale > 0) out["pattern_scale"] = system.pattern_scale;
  if (system.weld > 0) out["weld"] = system.weld;
  if (!system.meets.empty()) out["meets"] = system.meets;
  if (system.sheet) out["sheet"] = true;
  if (!system.scalars.empty()) out["scalars"] = system.scalars;
  return out;
}

ManifestSystem system_from(const Json& json) {
  ManifestSystem out;
  out.name = json.at("name").get<std::string>();
  out.role = json.at("role").get<std::string>();
  out.primary = json.at("primary").get<std::string>();
  if (json.contains("shape")) {
    const auto shape = find_shape(json["shape"].get<std::string>());
    if (!shape) throw Json::other_error::create(501, "a system of an unknown shape", &json);
    out.shape = *shape;
    out.count = json.at("count").get<int>();
    if (out.shape == OutputShape::k_curves) out.curve_count = json.at("curves").get<int>();
    if (json.contains("prototypes"))
      for (const Json& p : json["prototypes"])
        out.prototypes.push_back(
            {p.at("name").get<std::string>(), p.at("vertices").get<int>(), p.at("faces").get<int>()});
  } else {
    out.vertex_count = json.at("vertices").get<int>();
    out.face_count = json.at("faces").get<int>();
  }
  out.topology = json.at("topology").get<std::string>();
  out.pattern_scale = json.value("pattern_scale", 0.0);
  out.weld = json.value("weld", 0.0);
  out.meets = json.value("meets", std::vector<std::string>());
  out.sheet = json.value("sheet", false);
  out.scalars = json.value("scalars", std::vector<std::string>());
  for (const Json& c : json.at("caches"))
    out.caches.push_back({c.at("format").get<std::string>(), c.at("file").get<std::string>(),
                          c.at("bytes").get<std::uint64_t>(), c.at("content").get<std::string>()});
  return out;
}

/// Totals over the written frames, for a reader who wants one line.
Json certificate(const Manifest& manifest) {
  FrameReport worst;
  int crossing_frames = 0, written = 0;
  bool any = false;
  for (const FrameReport& frame : manifest.frames) {
    if (frame.frame < manifest.first_written) continue;
    ++written;
    crossing_frames += frame.crossings_body + frame.crossings_self > 0;
    FrameReport same = frame;
    same.frame = 0;
    same.incidents.clear();
    same.forces.clear();
    worst.frame = 0;
    worst = any ? merge(worst, same) : same;
    any = true;
  }
  return Json{{"frames", written},
              {"frames_with_crossings", crossing_frames},
              {"crossings_body", worst.crossings_body},
              {"crossings_self", worst.crossings_self},
              {"smallest_gap", std::isfinite(worst.smallest_gap) ? Json(worst.smallest_gap) : Json(nullptr)},
              {"deepest_drawn", worst.deepest_drawn},
              {"strain_p99", worst.strain_p99},
              {"strain_max", worst.strain_max},
              {"rewinds", worst.rewinds},
              {"finite", worst.finite}};
}

}  // namespace

std::string to_text(const Manifest& m) {
  Json out = Json::object();
  out["program"] = {
      {"name", "followthrough"}, {"version", m.version}, {"build", m.build}, {"manifest", k_manifest_version}};
  out["shot"] = m.shot;
  out["complete"] = m.complete;
  out["fingerprint"] = m.fingerprint;
  out["range"] = {{"first", m.first_frame},
                  {"last", m.last_frame},
                  {"first_written", m.first_written},
                  {"fps", m.fps},
                  {"preroll", m.preroll}};
  out["units"] = {{"length", "m"}, {"time", "s"}, {"mass", "kg"}, {"force", "N"}, {"up", "y"}, {"strain", "1"}};
  Json inputs = Json::array();
  for (const ManifestInput& i : m.inputs)
    inputs.push_back({{"role", i.role}, {"name", i.name}, {"content", i.content}});
  out["inputs"] = std::move(inputs);
  Json settings = Json::object();
  for (const auto& [key, value] : m.settings) settings[key] = value;
  out["settings"] = std::move(settings);
  Json systems = Json::array();
  for (const ManifestSystem& s : m.systems) systems.push_back(system_json(s));
  out["systems"] = std::move(systems);
  Json files = Json::array();
  for (const ManifestFile& f : m.files) files.push_back({{"file", f.file}, {"bytes", f.bytes}, {"content", f.content}});
  if (!files.empty()) out["files"] = std::move(files);
  out["notes"] = m.notes;
  out["certificate"] = certificate(m);
  Json incidents = Json::array(), preroll = Json::array(), frames = Json::array();
  for (const FrameReport& frame : m.frames) {
    Json row = to_json(frame);
    row.erase("incidents");
    (frame.frame < m.first_written ? preroll : frames).push_back(std::move(row));
    for (const Incident& i : frame.incidents) incidents.push_back(to_json(i));
  }
  out["incidents"] = std::move(incidents);
  out["preroll"] = std::move(preroll);
  out["frames"] = std::move(frames);
  return to_text(out);
}

Result<Manifest> manifest_from_text(const std::string& text, const std::string& where) {
  auto json = parse_json(text, where);
  if (!json) return json.error();
  try {
    const Json& in = *json;
    Manifest m;
    const Json& program = in.at("program");
    if (program.at("manifest").get<int>() != k_manifest_version)
      return input_error("is a manifest of another version", where);
    m.version = program.at("version").get<std::string>();
    m.build = program.at("build").get<std::string>();
    m.shot = in.at("shot").get<std::string>();
    m.complete = in.at("complete").get<bool>();
    m.fingerprint = in.at("fingerprint").get<std::string>();
    const Json& range = in.at("range");
    m.first_frame = range.at("first").get<int>();
    m.last_frame = range.at("last").get<int>();
    m.first_written = range.at("first_written").get<int>();
    m.fps = range.at("fps").get<double>();
    m.preroll = range.at("preroll").get<int>();
    for (const Json& i : in.at("inputs"))
      m.inputs.push_back(
          {i.at("role").get<std::string>(), i.at("name").get<std::string>(), i.at("content").get<std::string>()});
    for (const auto& item : in.at("settings").items())
      m.settings.emplace_back(item.key(), item.value().get<std::string>());
    for (const Json& s : in.at("systems")) m.systems.push_back(system_from(s));
    if (in.contains("files"))
      for (const Json& f : in.at("files"))
        m.files.push_back(
            {f.at("file").get<std::string>(), f.at("bytes").get<std::uint64_t>(), f.at("content").get<std::string>()});
    m.notes = in.at("notes").get<std::vector<std::string>>();
    for (const char* part : {"preroll", "frames"})
      for (const Json& row : in.at(part)) {
        auto report = frame_report_from_json(row);
        if (!report) return report.error();
        m.frames.push_back(std::move(*report));
      }
    for (const Json& i : in.at("incidents")) {
      auto report = frame_report_from_json(Json{{"incidents", Json::array({i})}});
      if (!report) return report.error();
      for (FrameReport& frame : m.frames)
        if (frame.frame == report->incidents[0].frame) frame.incidents.push_back(report->incidents[0]);
    }
    return m;
  } catch (const nlohmann::json::exception& fault) {
    return input_error(std::string("is not a manifest of a bake: ") + fault.what(), where);
  }
}

Result<Manifest> read_manifest(const std::filesystem::path& bake_folder) {
  const auto path = bake_folder / k_manifest_name;
  if (!std::filesystem::exists(path))
    return input_error("is not a bake folder: it has no manifest.json", bake_folder.string());
  auto text = read_text(path);
  if (!text) return text.error();
  return manifest_from_text(*text, path.string());
}

std::vector<std::string> stale_reasons(const Manifest& before, const Manifest& now) {
  std::vector<std::string> out;
  if (before.version != now.version)
    out.push_back("the program changed from version " + before.version + " to " + now.version);
  else if (before.build != now.build)
    out.push_back("the program was built anew");
  const auto input = [](const Manifest& m, const std::string& role) {
    return std::find_if(m.inputs.begin(), m.inputs.end(), [&](const ManifestInput& i) { return i.role == role; });
  };
  for (const ManifestInput& i : now.inputs) {
    const auto old = input(before, i.role);
    if (old == before.inputs.end())
      out.push_back(i.role + " (" + i.name + ") is new");
    else if (old->content != i.content)
      out.push_back(old->name == i.name ? i.name + " changed"
                                        : i.role + " changed from " + old->name + " to " + i.name);
  }
  for (const ManifestInput& i : before.inputs)
    if (input(now, i.role) == now.inputs.end()) out.push_back(i.role + " (" + i.name + ") is gone");
  // Enough to see what it is about.
  constexpr std::size_t k_most_settings = 10;
  std::vector<std::string> settings = changed_settings(before.settings, now.settings);
  const std::size_t more = settings.size() - std::min(settings.size(), k_most_settings);
  settings.resize(settings.size() - more);
  out.insert(out.end(), settings.begin(), settings.end());
  if (more > 0) out.push_back(fmt::format("{} more settings", more));
  // The lists explain; the fingerprint decides.
  if (out.empty() && before.fingerprint != now.fingerprint) out.push_back("its inputs changed");
  return out;
}

Gates gates_of(const Shot& shot) {
  return {shot.gate_p99_strain, shot.gate_crossings, shot.gate_most};
}

namespace {

Status judge_metrics(const FrameReport& frame, const Gates& gates, const std::string& where) {
  for (const auto& [key, limit] : gates.most) {
    const Metric* metric = find_metric(key);
    if (!metric || !(value_of(frame, *metric) > limit)) continue;
    return Error{ErrorKind::k_quality,
                 fmt::format("quality gate: {} = {:.4g} is above {:.4g}{}{}", key, value_of(frame, *metric), limit,
                             metric->unit.empty() ? "" : " ", metric->unit),
                 where, "look at the frame in the preview, which plots it, or raise the limit in [gate] most"};
  }
  return {};
}

}  // namespace

Status judge(const Manifest& manifest, const Gates& gates) {
  for (const FrameReport& frame : manifest.frames) {
    const std::string where = fmt::format("frame {}", frame.frame);
    if (!frame.finite)
      return Error{ErrorKind::k_diverged, "the solver found no finite step and held the last finite state", where,
                   "the caches are complete; try more substeps ([solver] max_substeps) from this frame on"};
    if (frame.frame < manifest.first_written) continue;
    if (gates.crossings && frame.crossings_body + frame.crossings_self > 0)
      return Error{ErrorKind::k_quality,
                   fmt::format("quality gate: {} crossings", frame.crossings_body + frame.crossings_self), where,
                   "the manifest lists the places; [solver] gap leaves the cloth more room"};
    if (gates.p99_strain > 0 && frame.strain_p99 > gates.p99_strain)
      return Error{ErrorKind::k_quality,
                   fmt::format("quality gate: p99 strain {:.4g} is above {:.4g}", frame.strain_p99, gates.p99_strain),
                   where, "a stiffer fabric or more newton_iterations stretches less"};
    if (const Status within = judge_metrics(frame, gates, where); !within) return within;
  }
  return {};
}

}  // namespace ft::inline baker
