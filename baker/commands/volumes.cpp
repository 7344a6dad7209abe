#include "baker/commands/volumes.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "baker/commands/command_line.h"
#include "baker/record/cache_track.h"
#include "baker/systems/interface/system.h"

namespace ft::inline baker {
namespace {

constexpr const char* k_writer = "followthrough_write_vdb";

/// Its exit code, or what kept it from running.
Result<int> run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> all{program.string()};
  all.insert(all.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& argument : all) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  if (const int failed = posix_spawn(&child, program.c_str(), nullptr, nullptr, argv.data(), environ); failed != 0)
    return output_error("cannot be started", program.string(),
                        "it is built and installed with followthrough, and has to be in the same folder");
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return output_error("was lost", program.string());
  if (!WIFEXITED(status)) return output_error("crashed", program.string());
  return WEXITSTATUS(status);
}

/// Of a system: its cache in Alembic, which has velocities; empty: none.
std::filesystem::path alembic_of(const std::filesystem::path& folder, const ManifestSystem& system) {
  const auto found = std::ranges::find(system.caches, "abc", &ManifestCache::format);
  return found == system.caches.end() ? std::filesystem::path() : folder / found->file;
}

/// Whether the file of the last frame is there, which is written last, and is newer than its caches.
bool is_there(const std::filesystem::path& folder, const Manifest& manifest, const ManifestSystem& system,
              std::initializer_list<std::filesystem::path> caches) {
  std::error_code failed;
  const int last = manifest.first_written + manifest.written_count() - 1;
  const auto written =
      std::filesystem::last_write_time(folder / fmt::format("{}.{:04}.vdb", system.name, last), failed);
  return !failed && std::ranges::all_of(caches, [&](const std::filesystem::path& cache) {
    return cache.empty() || std::filesystem::last_write_time(cache, failed) <= written;
  });
}

/// The lowest place of a surface in all frames, and the distance of its first two vertices [m].
Result<std::pair<double, double>> measure(const std::filesystem::path& cache) {
  auto reader = open_cache(cache);
  if (!reader) return reader.error();
  std::vector<Vec3f> x;
  double lowest = 0, cell = 0;
  for (int f = 0; f < (*reader)->info().frame_count; ++f) {
    if (const Status read = (*reader)->read_frame(f, x); !read) return read.error();
    if (x.size() < 4) return input_error("has no surface", cache.string());
    if (f == 0) lowest = x[0].y(), cell = std::hypot(x[1].x() - x[0].x(), x[1].z() - x[0].z());
    for (const Vec3f& p : x) lowest = std::min(lowest, static_cast<double>(p.y()));
  }
  return std::pair(lowest, cell);
}

}  // namespace

Result<std::vector<std::string>> write_volumes(const VolumesOptions& options) {
  auto manifest = read_manifest(options.folder);
  if (!manifest) return manifest.error();
  const auto output = options.output.empty() ? options.folder : options.output;
  std::error_code failed;
  std::filesystem::create_directories(output, failed);
  const auto program = std::filesystem::read_symlink("/proc/self/exe", failed).parent_path() / k_writer;
  std::vector<std::string> out;
  for (const ManifestSystem& system : manifest->systems) {
    const SystemKind* kind = find_system_kind(system.role);
    if (!kind || !kind->is_liquid() || system.shape != OutputShape::k_mesh) continue;
    const auto surface = alembic_of(options.folder, system);
    if (surface.empty())
      return usage_error("\"" + system.name + "\" has no Alembic cache", options.folder.string(),
                         "volumes are made from it: [cache] formats = [\"abc\"]");
    const auto drops = std::ranges::find_if(manifest->systems, [&](const ManifestSystem& s) {
      return s.role == system.role && s.shape == OutputShape::k_points && s.name.starts_with(system.name + "_");
    });
    const auto droplets =
        drops == manifest->systems.end() ? std::filesystem::path() : alembic_of(options.folder, *drops);
    const auto measured = measure(surface);
    if (!measured) return measured.error();
    const auto [lowest, cell] = *measured;
    const double voxel = options.voxel > 0 ? options.voxel : cell;
    const bool kept = options.keep && is_there(output, *manifest, system, {surface, droplets});
    const auto done =
        kept ? Result<int>(0)
             : run_program(program, {surface.string(), droplets.empty() ? "-" : droplets.string(), output.string(),
                                     system.name, fmt::format("{}", lowest - 4 * voxel), fmt::format("{}", voxel)});
    if (!done) return done.error();
    if (*done != 0) return output_error("volumes of \"" + system.name + "\" could not be written", output.string());
    out.push_back(
        fmt::format("{}/{}.{:04}.vdb and so on: grids surface (level set), vel (m/s), spray (fog){}; voxels of "
                    "{:.3g} m; closed from below four voxels under the lowest place of the surface",
                    output.string(), system.name, manifest->first_written,
                    std::ranges::count(system.scalars, "foam") > 0 ? ", foam (fog)" : "", voxel));
    out.push_back(
        fmt::format("in Blender: Rotation X = 90 degrees, Location = ({0:.6g}, {1:.6g}, {0:.6g}) m, for it draws all "
                    "volumes half a voxel too far along the axes of their files",
                    -0.5 * voxel, 0.5 * voxel));
  }
  if (out.empty()) return usage_error("there is no water in this bake", options.folder.string());
  out.push_back(
      "Blender: Sequence on, Velocity Unit = Second (its default, Frame, blurs by fps times too much); it finds "
      "`vel` by itself. Motion blur of volumes needs Cycles");
  out.push_back(
      fmt::format("Arnold in Maya: Velocity Grids = vel, Velocity FPS = {:g}. Houdini: `surface` and `vel` are "
                  "its own names, m/s",
                  manifest->fps));
  return out;
}

int run_volumes(const VolumesOptions& options) {
  const auto lines = write_volumes(options);
  if (!lines) {
    complain(lines.error().text());
    return exit_code(lines.error().kind);
  }
  for (const std::string& line : *lines) std::printf("%s\n", line.c_str());
  return 0;
}

}  // namespace ft::inline baker
