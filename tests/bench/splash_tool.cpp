// A splash beside Blender's liquid. For tests/bench/run.sh splash:
//   splash_tool scene SCENE               ball.obj, ball.pc2 and shots of ours; scene.txt and path.txt for
//   splash_peer.py splash_tool result SCENE CELLS WORK   a row of each, and the RESULT line: WORK has bake, cpu.txt and
//   peer/frames.txt
// A ball of 0.2 m falls from 0.6 m into a pool of 2 x 2 x 0.75 m with walls, is stopped under water, rests there, is
// pulled out again and stays out: its way is given, to both. At the start and at the end all water is in the pool and
// the ball is not, so that volumes of the two are compared without a word on the ball. Coordinates are ours, y up, in
// metres; level at rest 0.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "baker/core/file.h"
#include "baker/core/shapes.h"
#include "io/cache/cache.h"
#include "io/shot/mesh_file.h"

namespace ft::bench {
namespace {

namespace fs = std::filesystem;

constexpr double k_size = 2, k_depth = 0.75, k_height = 1, k_radius = 0.2;  // m; the peer's domain ends at k_height
constexpr int k_frames = 120, k_samples = 4, k_fps = 24;                    // the ball's poses a frame
constexpr double k_drop = 0.6, k_brake = -0.05, k_lowest = -0.4;            // m, of its middle
constexpr int k_dives = 3;
constexpr double k_pull = 0.65, k_pulled = 1.2, k_dive = 1.25;  // s: the ball is pulled out, is out, falls again
constexpr double k_gravity = 9.81;
constexpr double k_given = k_size * k_size * k_depth;  // m3

/// Of the ball's middle, at a time [s].
double ball_height(double time) {
  const double fall = std::sqrt(2 * (k_drop - k_brake) / k_gravity), speed = k_gravity * fall;
  const double braking = 2 * (k_brake - k_lowest) / speed;
  const double t = time - k_dive * std::clamp(std::floor(time / k_dive), 0.0, k_dives - 1.0);
  if (t < fall) return k_drop - 0.5 * k_gravity * t * t;
  if (t < fall + braking) {
    const double left = 1 - (t - fall) / braking;
    return k_lowest + (k_brake - k_lowest) * left * left;
  }
  const double out = std::clamp((t - k_pull) / (k_pulled - k_pull), 0.0, 1.0);
  return k_lowest + (k_drop - k_lowest) * 0.5 * (1 - std::cos(std::numbers::pi * out));
}

/// The part of the ball below the level at rest [m3].
double dipped(double middle) {
  const double h = std::clamp(k_radius - middle, 0.0, 2 * k_radius);
  return std::numbers::pi * h * h * (k_radius - h / 3);
}

std::string shot(int cells) {
  return fmt::format(
      "[shot]\nframes = \"1-{}\"\nfps = {}\npreroll = 0\n\n[primary.ball]\nfile = \"ball.pc2\"\ntopology = "
      "\"ball.obj\"\n"
      "source_fps = {}\nunit_scale = 1\n\n[water.pool]\nmodel = \"pond\"\nposition = [0, 0, 0]\nsize = [{}, 0, {}]\n"
      "depth = {}\nedges = \"wall\"\ncell = {}\n\n[cache]\nformats = [\"abc\"]\n",
      k_frames, k_fps, k_samples * k_fps, k_size, k_size, k_depth, k_size / cells);
}

Status write_scene(const fs::path& folder, const std::vector<std::string>& all_cells) {
  if (Status status = make_folders(folder); !status) return status;
  const TriangleSurface ball = sphere_surface(k_radius, 4);
  CacheInfo info;
  info.mesh = make_triangle_mesh("ball", ball.positions, ball.triangles);
  info.frame_count = k_samples * (k_frames - 1) + 1;
  if (Status status = write_obj(folder / "ball.obj", info.mesh); !status) return status;
  auto writer = find_cache_format("pc2")->open_writer(folder / "ball.pc2", info, 0);
  if (!writer) return writer.error();
  std::string path;
  for (int k = 0; k < info.frame_count; ++k) {
    const double y = ball_height(static_cast<double>(k) / (k_samples * k_fps));
    std::vector<Vec3> pose = ball.positions;
    for (Vec3& p : pose) p.y() += y;
    if (Status status = (*writer)->write_frame(pose, {}); !status) return status;
    path += fmt::format("0 {:.9f} 0\n", y);
  }
  if (Status status = (*writer)->close(); !status) return status;
  if (Status status = write_text_durably(folder / "path.txt", path); !status) return status;
  for (const std::string& cells : all_cells)
    if (Status status = write_text_durably(folder / ("shot" + cells + ".toml"), shot(std::atoi(cells.c_str())));
        !status)
      return status;
  return write_text_durably(folder / "scene.txt",
                            fmt::format("frames {}\nsamples {}\nfps {}\nsize {}\ndepth {}\nheight {}\nradius {}\n",
                                        k_frames, k_samples, k_fps, k_size, k_depth, k_height, k_radius));
}

/// What a program made of it.
struct Splash {
  std::vector<double> volume;    ///< of the water in each frame, the ball left out [m3]
  double highest = 0;            ///< of its water over all frames [m]
  double cpu = 0, wall = 0;      ///< s a frame
  double memory = 0;             ///< MB
  std::optional<double> ledger;  ///< largest error of the program's own account [1]
};

/// Of a square grid of vertices from rim to rim: half of those on its rim belong to it, and a quarter of its corners.
double mean_height(const std::vector<Vec3f>& x) {
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(x.size()))));
  CHECK(side * side == x.size());
  double sum = 0;
  for (std::size_t k = 0; k < side; ++k)
    for (std::size_t i = 0; i < side; ++i)
      sum += (i == 0 || i + 1 == side ? 0.5 : 1) * (k == 0 || k + 1 == side ? 0.5 : 1) *
             static_cast<double>(x[k * side + i].y());
  return sum / static_cast<double>((side - 1) * (side - 1));
}

/// Water between surface and floor, what flies, and without the ball's part below the level at rest: the surface goes
/// over it.
Result<Splash> ours(const fs::path& work) {
  const auto text = read_text(work / "bake/report.json"), cpu = read_text(work / "cpu.txt"),
             manifest_text = read_text(work / "bake/manifest.json");
  for (const auto* file : {&text, &cpu, &manifest_text})
    if (!*file) return file->error();
  const auto report = nlohmann::json::parse(*text, nullptr, false),
             manifest = nlohmann::json::parse(*manifest_text, nullptr, false);
  if (report.is_discarded() || manifest.is_discarded() || !report.contains("frames"))
    return input_error("has no report of a bake", work.string());
  Splash out;
  out.cpu = std::atof(cpu->c_str()) / k_frames;
  out.wall = report.value("wall_seconds", 0.0) / k_frames;
  out.memory = report.value("peak_memory_bytes", 0.0) / 1e6;
  out.ledger = 0;
  for (const auto& frame : manifest.at("frames"))
    out.ledger = std::max(*out.ledger, std::abs(frame.value("water_error", std::nan(""))));
  auto surface = open_cache(work / "bake/pool.abc"), drops = open_cache_of_any_shape(work / "bake/pool_droplets.abc");
  if (!surface) return surface.error();
  if (!drops) return drops.error();
  std::vector<Vec3f> x;
  FrameData flying;
  for (int f = 0; f < k_frames; ++f) {
    if (Status read = (*surface)->read_frame(f, x); !read) return read.error();
    if (Status read = (*drops)->read(f, flying); !read) return read.error();
    for (const Vec3f& p : x) out.highest = std::max(out.highest, static_cast<double>(p.y()));
    double volume = 0;
    for (const float width : flying.widths) volume += std::numbers::pi / 6 * std::pow(static_cast<double>(width), 3);
    for (const Vec3f& p : flying.positions) out.highest = std::max(out.highest, static_cast<double>(p.y()));
    out.volume.push_back(mean_height(x) * k_size * k_size + volume + k_given -
                         dipped(ball_height(static_cast<double>(f) / k_fps)));
  }
  return out;
}

/// frames.txt: frames, seconds of CPU and of wall, bytes; then of each frame volume and highest place of the mesh.
Result<Splash> peers(const fs::path& file) {
  const auto text = read_text(file);
  if (!text) return text.error();
  std::istringstream list(*text);
  Splash out;
  int frames = 0;
  double cpu = 0, wall = 0, bytes = 0;
  list >> frames >> cpu >> wall >> bytes;
  out.cpu = cpu / frames, out.wall = wall / frames, out.memory = bytes / 1e6;
  for (double volume = 0, highest = 0; list >> volume >> highest;) {
    out.volume.push_back(volume);
    out.highest = std::max(out.highest, highest);
  }
  if (frames != k_frames || out.volume.size() != at(k_frames))
    return input_error("is not of this scene", file.string());
  return out;
}

std::size_t frame_at(double time) {
  return static_cast<std::size_t>(std::lround(time * k_fps));
}

struct Change {
  double resting, last, least, most;  ///< against the first frame [1]
};
Change change_of(const Splash& s) {
  const double first = s.volume.front();
  const auto [least, most] = std::minmax_element(s.volume.begin(), s.volume.end());
  return {s.volume[frame_at((k_dives - 1) * k_dive + k_pull)] / first - 1, s.volume.back() / first - 1,
          *least / first - 1, *most / first - 1};
}

void print_row(const std::string& who, const Splash& s) {
  const Change c = change_of(s);
  fmt::print(
      "| {} | {:.3f} | {:.3f} | {:.0f} | {:.4f} ({:+.1f} %) | {:+.3f} % | {:+.3f} % | {:+.3f} to {:+.3f} % | {} | "
      "{:.2f} |\n",
      who, s.cpu, s.wall, s.memory, s.volume.front(), 100 * (s.volume.front() / k_given - 1), 100 * c.resting,
      100 * c.last, 100 * c.least, 100 * c.most, s.ledger ? fmt::format("{:.1e}", *s.ledger) : "none", s.highest);
}

Status write_result(const std::string& cells, const fs::path& work) {
  const auto our = ours(work), peer = peers(work / "peer/frames.txt");
  if (!our) return our.error();
  if (!peer) return peer.error();
  fmt::print("\n| splash, {} x {} cells {}\n|---|---|---|---|---|---|---|---|---|---|\n", cells, cells,
             "| cpu s/f | wall s/f | memory MB | volume of the first frame m3 (of what was given) | change: ball at "
             "rest below | "
             "ball out, last frame | least to most | its ledger's error | highest water m |");
  print_row("Blender", *peer);
  print_row("ours", *our);
  const Change a = change_of(*our), b = change_of(*peer);
  fmt::print(
      "RESULT scene=splash n={} ours_cpu={:.4f} ours_wall={:.4f} peer_cpu={:.4f} peer_wall={:.4f} ratio_cpu={:.1f} "
      "ratio_wall={:.1f} ours_change={:.2e} peer_change={:.4f} peer_least={:.4f} peer_most={:.4f} ledger={:.1e}\n",
      cells, our->cpu, our->wall, peer->cpu, peer->wall, peer->cpu / our->cpu, peer->wall / our->wall, a.last, b.last,
      b.least, b.most, *our->ledger);
  return {};
}

int run(const std::vector<std::string>& a) {
  Status status = usage_error("splash_tool scene SCENE CELLS... | result CELLS WORK");
  if (a.size() >= 3 && a[0] == "scene") status = write_scene(a[1], {a.begin() + 2, a.end()});
  if (a.size() == 3 && a[0] == "result") status = write_result(a[1], a[2]);
  if (status) return 0;
  fmt::print(stderr, "splash_tool: {}\n", status.error().text());
  return exit_code(status.error().kind);
}

}  // namespace
}  // namespace ft::bench

int main(int argc, char** argv) {
  return ft::bench::run({argv + 1, argv + argc});
}
