#include "baker/run/output_names.h"

#include "baker/run/wind_file.h"
#include "io/cache/cache.h"

namespace ft::inline baker {

std::vector<std::string> output_names(const Shot& shot) {
  std::vector<std::string> out = {"manifest.json", "report.json"};
  const auto add_system = [&](const std::string& name) {
    out.push_back(name + ".obj");
    for (const std::string& format : shot.cache_formats)
      if (const CacheFormat* known = find_cache_format(format)) out.push_back(name + std::string(known->extension));
  };
  for (const auto& secondary : shot.secondaries) {
    for (const std::string& name : secondary->section->system_names(*secondary)) add_system(name);
    for (std::string& file : secondary->section->written_files(*secondary)) out.push_back(std::move(file));
  }
  if (!shot.winds.empty() || shot.wind.velocity != Vec3::Zero()) out.emplace_back(k_wind_file);
  for (const PrimarySpec& primary : shot.primaries) {
    add_system(primary.name);
    add_system(primary.name + ".collider");
    for (const char* extension : {".json", ".glb", ".bvh"}) out.push_back(primary.name + "_hybrid" + extension);
  }
  return out;
}

Status check_inputs_stay(const BakeInputs& inputs, const BakeFolder& folder) {
  for (const std::string& name : output_names(inputs.shot))
    for (const InputRecord& input : inputs.files) {
      std::error_code error;  // of what does not exist: no input
      if (std::filesystem::equivalent(folder.path / name, input.path, error))
        return usage_error("the bake would overwrite " + input.path.string() + ", which it reads (" + input.role + ")",
                           folder.path.string(), "choose another folder with --out");
    }
  return {};
}

}  // namespace ft::inline baker
