#include "baker/record/primary_paths.h"

#include <numeric>

#include "baker/record/cache_track.h"

namespace ft::inline baker {

Result<std::vector<PrimaryPath>> primary_paths(const std::filesystem::path& bake_folder, const Manifest& manifest) {
  std::vector<PrimaryPath> out;
  for (const ManifestSystem& system : manifest.systems) {
    if (system.role != "body") continue;
    auto track = open_track(bake_folder, system, manifest);
    if (!track) return track.error();
    PrimaryPath& path = out.emplace_back(PrimaryPath{system.name, {}});
    std::vector<Vec3> x;
    for (int f = 0; f < track->reader->info().frame_count; ++f) {
      x.clear();
      if (const Status read = track->read(f, x); !read) return read.error();
      path.centres.push_back(std::accumulate(x.begin(), x.end(), Vec3(Vec3::Zero())) / static_cast<double>(x.size()));
    }
  }
  return out;
}

}  // namespace ft::inline baker
