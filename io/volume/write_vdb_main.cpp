// followthrough_write_vdb SURFACE DROPLETS FOLDER NAME FLOOR VOXEL: started by `followthrough volumes`, not by people.
// Writes FOLDER/NAME.0001.vdb and so on, of all frames of two caches; DROPLETS may be "-".
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "io/cache/cache.h"
#include "io/volume/openvdb_write.h"

namespace {

ft::Status write_all(char** argv) {
  auto surface = ft::open_cache(argv[1]);
  if (!surface) return surface.error();
  std::unique_ptr<ft::CacheReader> droplets;
  if (std::string(argv[2]) != "-") {
    auto opened = ft::open_cache_of_any_shape(argv[2]);
    if (!opened) return opened.error();
    droplets = std::move(*opened);
  }
  ft::LiquidFrame water;
  water.floor = std::atof(argv[5]), water.voxel = std::atof(argv[6]);
  const ft::CacheInfo& info = (*surface)->info();
  water.fps = info.fps;
  for (int i = 0; i < info.frame_count; ++i) {
    ft::FrameData now;
    if (ft::Status s = (*surface)->read(i, now); !s) return s;
    water.surface = std::move(now.positions), water.velocities = std::move(now.velocities);
    const auto& names = info.content.scalars;
    if (const auto foam = std::ranges::find(names, "foam"); foam != names.end())
      water.foam = std::move(now.scalars[static_cast<std::size_t>(foam - names.begin())]);
    if (droplets && i < droplets->info().frame_count)
      if (ft::Status s = droplets->read(i, water.droplets); !s) return s;
    if (i == 0) {
      const auto& x = water.surface;
      while (water.across < static_cast<int>(x.size()) && x[ft::at(water.across)].z() == x[0].z()) ++water.across;
      water.along = water.across > 0 ? static_cast<int>(x.size()) / water.across : 0;
      if (water.across < 2 || water.along < 2 || water.across * water.along != static_cast<int>(x.size()))
        return ft::input_error("its vertices are no grid", argv[1]);
    }
    char number[16];
    std::snprintf(number, sizeof number, ".%04d.vdb", info.first_frame + i);
    const auto path = std::filesystem::path(argv[3]) / (std::string(argv[4]) + number);
    if (ft::Status s = ft::write_liquid_vdb(path, water); !s) return s;
  }
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 7) {
    std::fprintf(stderr, "%s is started by followthrough, to write .vdb files for it\n", argv[0]);
    return 64;
  }
  const ft::Status done = write_all(argv);
  if (!done) std::fprintf(stderr, "%s\n", done.error().text().c_str());
  return done ? 0 : 1;
}
