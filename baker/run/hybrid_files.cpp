#include "baker/run/hybrid_files.h"

#include <cmath>

#include "baker/core/file.h"
#include "baker/record/report_json.h"
#include "io/export/motion_files.h"
#include "io/shot/shot_values.h"

namespace ft::inline baker {
namespace {

Json vector_json(const Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}
Json limit_json(double limit) {
  return std::isfinite(limit) ? Json(limit) : Json(nullptr);
}

Json standin_json(const StandInKeys& keys, const Shot& shot) {
  Json out = {{"name", keys.name}};
  for (const std::string& name : {keys.name, in_quotes(keys.name)}) {  // as settings() spells it
    const std::string section = "standin." + name + ".";
    for (const auto& [key, value] : settings(shot))
      if (key.starts_with(section)) out[key.substr(section.size())] = value;
  }
  return out;
}

std::string sidecar(const PrimaryPlan& primary, const Shot& shot) {
  const HybridPass& pass = *primary.hybrid;
  Json out = Json::object();
  out["primary"] = primary.name;
  out["units"] = {{"force", "N"}, {"torque", "N m"}, {"offset", "m"}, {"acceleration", "m/s2"},
                  {"work", "J"},  {"turn", "rad"},   {"mass", "kg"}};
  out["mass"] = pass.mass;
  const DeviationSettings& s = pass.settings;
  const char* comebacks[] = {"free", "spring", "window", "hold"};
  out["settings"] = {{"comeback", comebacks[static_cast<int>(s.comeback)]},
                     {"omega", s.omega},
                     {"zeta", s.zeta},
                     {"window", s.window},
                     {"max_displacement", limit_json(s.max_displacement)},
                     {"max_acceleration", limit_json(s.max_acceleration)}};
  Json stand_ins = Json::array();
  for (const StandInKeys* keys : stand_ins_of(shot, primary.name)) stand_ins.push_back(standin_json(*keys, shot));
  out["standins"] = std::move(stand_ins);
  if (primary.yielding) out["input"] = primary.yielding->imported->content.hex();
  out["largest"] = {{"force", pass.largest.force.norm()},
                    {"acceleration", pass.largest.force.norm() / pass.mass},
                    {"offset", pass.largest_displacement},
                    {"work", pass.work}};
  Json frames = Json::array();
  for (const HybridFrame& frame : pass.frames) {
    const Eigen::AngleAxisd turn(frame.offset.rotation);
    frames.push_back({{"frame", frame.frame},
                      {"force", vector_json(frame.mean.force)},
                      {"torque", vector_json(frame.mean.torque)},
                      {"offset", vector_json(frame.offset.position)},
                      {"turn", vector_json(turn.angle() * turn.axis())},
                      {"acceleration", frame.mean.force.norm() / pass.mass},
                      {"peak", frame.peak},
                      {"work", frame.work}});
  }
  out["frames"] = std::move(frames);
  return to_text(out);
}

}  // namespace

Result<std::vector<ManifestFile>> write_hybrid_files(const BakePlan& plan, const std::filesystem::path& folder,
                                                     std::vector<std::string>& notes) {
  std::vector<ManifestFile> out;
  const auto write = [&](const std::string& name, std::span<const std::byte> bytes) {
    out.push_back({name, bytes.size(), hash_bytes(bytes).hex()});
    return write_file_durably(folder / name, bytes);
  };
  const auto write_text = [&](const std::string& name, const std::string& text) {
    return write(name, std::as_bytes(std::span(text)));
  };
  for (const PrimaryPlan& primary : plan.primaries) {
    if (!primary.hybrid) continue;
    const std::string name = primary.name + "_hybrid";
    if (const Status s = write_text(name + ".json", sidecar(primary, plan.shot())); !s) return s.error();
    if (!primary.yielding) continue;
    const YieldingCharacter& c = *primary.yielding;
    auto files = export_motion(c.request, *c.imported, c.motion.channels, c.frames);
    if (!files) return files.error();
    for (const std::string& note : files->notes) notes.push_back("primary \"" + primary.name + "\": " + note);
    if (const Status s = write(name + ".glb", files->glb); !s) return s.error();
    if (const Status s = write_text(name + ".bvh", files->bvh); !s) return s.error();
  }
  return out;
}

}  // namespace ft::inline baker
