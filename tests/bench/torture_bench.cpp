// Walks torture scenes and prints what was measured. For tests/bench/run.sh torture:
//   torture_bench list                              the names of the scenes
//   torture_bench NAME [--frames N] [--obj FOLDER]  table of the frames, RESULT line; cloth and collider as OBJ files
//                 [--substeps LEAST] [--newton N] [--linear TOLERANCE]    to find out what a failure depends on
// The crossings are those that the independent checker finds; 1 is returned when there are any, or when it disagrees
// with the certificate, or when the scene misses a bar of its own.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "io/shot/mesh_file.h"
#include "tests/support/torture/scene.h"

namespace ft::torture {
namespace {

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void write_objs(const std::filesystem::path& folder, const Scene& scene, const Solver& solver, const State& state) {
  const AllCloth cloth = all_cloth(solver, state);
  std::vector<Vec3> body;
  solver.collider_positions(state, body);
  const std::string stem = fmt::format("{}_{:04}", scene.name, state.frame);
  const Status a =
      write_obj(folder / (stem + "_cloth.obj"), make_triangle_mesh("cloth", cloth.positions, cloth.triangles));
  const Status b =
      write_obj(folder / (stem + "_body.obj"), make_triangle_mesh("body", body, solver.collider_triangles()));
  for (const Status* s : {&a, &b})
    if (!*s) fmt::print(stderr, "{}\n", s->error().text());
}

void print_frame(const CheckedFrame& f) {
  const FrameReport& r = f.report;
  fmt::print("{:5} {:7.3f} {:5} {:7} {:7} {:7} {:>3}+{:<3} {:8} {:9.1f} {:8.2f} {:8.1f} {:7.2f} {:8.2f} {:>9}\n",
             r.frame, f.seconds, r.substeps, r.rewinds, f.crossings_body, f.crossings_self, r.crossings_body,
             r.crossings_self, r.released_vertices, 1e6 * r.smallest_gap, 100 * r.strain_p99, 100 * r.strain_max,
             f.speed, 1e3 * r.deepest_drawn, r.finite ? "yes" : "NO");
  for (const Incident& i : r.incidents)
    if (i.kind == Incident::Kind::k_crossing || i.kind == Incident::Kind::k_released) {
      fmt::print("      {} {}: vertex {} at ({:.3f} {:.3f} {:.3f}), {:.2f} mm: {}\n", name(i.kind), i.system, i.vertex,
                 i.place.x(), i.place.y(), i.place.z(), 1e3 * i.depth, i.text);
      break;
    }
  std::fflush(stdout);
}

int run(const Scene& scene, const std::string& folder, const std::function<void(ClothSetup&)>& change) {
  fmt::print("{}: {}\n{:>5} {:>7} {:>5} {:>7} {:>7} {:>7} {:>7} {:>8} {:>9} {:>8} {:>8} {:>7} {:>8} {:>9}\n",
             scene.name, scene.what, "frame", "s", "sub", "rewinds", "body", "self", "(cert.)", "released", "gap um",
             "p99 %", "max %", "m/s", "drawn mm", "finite");
  const Walked walked = walk(
      scene,
      [&](const Solver& solver, const State& state, const CheckedFrame& frame) {
        if (!folder.empty()) write_objs(folder, scene, solver, state);
        print_frame(frame);
      },
      change);
  std::vector<double> wall, cpu;
  std::size_t crossings = 0, frames_crossing = 0;
  double strain = 0, depth = 0, speed = 0;
  int released = 0;
  FrameProfile profile;
  bool bad = walked.start.crossings_body + walked.start.crossings_self > 0;
  for (const CheckedFrame& f : walked.frames) {
    const FrameReport& r = f.report;
    wall.push_back(f.seconds);
    cpu.push_back(f.cpu_seconds);
    profile += r.profile;
    crossings = std::max(crossings, f.crossings_body + f.crossings_self);
    if (f.crossings_body + f.crossings_self > 0) ++frames_crossing;
    strain = std::max(strain, r.strain_p99);
    speed = std::max(speed, f.speed);
    depth = std::max(depth, r.deepest_drawn);
    released = std::max(released, r.released_vertices);
    bad = bad || !r.finite || static_cast<int>(f.crossings_body) != r.crossings_body ||
          static_cast<int>(f.crossings_self) != r.crossings_self;
  }
  bad = bad || ((crossings > 0 || released > 0) && scene.has_room) || strain > scene.strain_bar ||
        speed > scene.speed_bar;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  for (const ProfilePhase& phase : profile_phases()) fmt::print("{} {:.1f} s, ", phase.title, profile.*phase.time);
  fmt::print("total {:.1f} s; worst frame {:.2f} s\n", profile.total, *std::max_element(wall.begin(), wall.end()));
  fmt::print(
      "RESULT scene={} n={} ours_cpu={:.4f} ours_wall={:.4f} peer_cpu=nan peer_wall=nan crossings={} depth_mm={:.2f} "
      "p99_strain={:.4f} rss_mb={} "
      "frames={} crossing_frames={} released={} speed={:.2f} verdict={}\n",
      scene.name, walked.vertex_count, median(cpu), median(wall), crossings, 1e3 * depth, strain,
      usage.ru_maxrss / 1024, walked.frames.size(), frames_crossing, released, speed, bad ? "fails" : "passes");
  return bad ? 1 : 0;
}

int main_of(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "list") == 0) {
    for (const Scene& s : scenes()) fmt::print("{}\n", s.name);
    return 0;
  }
  const Scene* found = argc > 1 ? find_scene(argv[1]) : nullptr;
  Scene scene = found ? *found : Scene{};
  std::string folder;
  int substeps = 0, newton = 0;
  double tolerance = 0;
  bool understood = found != nullptr && argc % 2 == 0;
  for (int i = 2; understood && i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--frames") == 0)
      scene.frames = std::clamp(std::atoi(argv[i + 1]), 1, scene.frames);
    else if (std::strcmp(argv[i], "--obj") == 0)
      folder = argv[i + 1];
    else if (std::strcmp(argv[i], "--substeps") == 0)
      substeps = std::atoi(argv[i + 1]);
    else if (std::strcmp(argv[i], "--newton") == 0)
      newton = std::atoi(argv[i + 1]);
    else if (std::strcmp(argv[i], "--linear") == 0)
      tolerance = std::atof(argv[i + 1]);
    else
      understood = false;
  }
  if (!understood) {
    fmt::print(
        stderr,
        "torture_bench list | NAME [--frames N] [--obj FOLDER] [--substeps N] [--newton N] [--linear TOLERANCE]\n");
    return 2;
  }
  return run(scene, folder, [=](ClothSetup& setup) {
    if (substeps > 0) setup.min_substeps = substeps, setup.max_substeps = std::max(substeps, setup.max_substeps);
    if (newton > 0) setup.newton_iterations = newton;
    if (tolerance > 0) setup.linear_tolerance = tolerance;
  });
}

}  // namespace
}  // namespace ft::torture

int main(int argc, char** argv) {
  return ft::torture::main_of(argc, argv);
}
