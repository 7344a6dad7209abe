// A head of hair beside Blender's hair dynamics. For tests/bench/run.sh hair:
//   hair_tool scene SCENE      head.obj, head.pc2, groom.obj, yaw.txt and shot.toml
//   hair_tool result ROUND...  the table and the RESULT line, medians of rounds: each a folder with what they cost and
//                              did, as bake, cpu.txt, peer.pc2, timing.txt
// A ball of 0.1 m under strands of 0.3 m that are combed down along it stands still for two seconds, and then turns
// about its upright axis by 0.8 rad either way, once a second, for two more. Coordinates are ours, y up, in metres.
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

constexpr double k_radius = 0.1, k_length = 0.3;  // m
constexpr int k_strands = 200, k_vertices = 32;
constexpr int k_still = 48, k_frames = 96, k_samples = 4;  // frames at 24 a second; the head's poses a frame
/// Faces of the head lie up to 0.16 mm inside of its ball: deeper than this is inside [m].
constexpr double k_inside = 2e-4;

double yaw(double frame) {
  return 0.8 * std::sin(2 * std::numbers::pi * std::max(0.0, frame - 1 - k_still) / 24);
}

/// From the crown down along the head, 3 mm away from it, and from its widest place straight down.
std::vector<Vec3> combed(double from_crown, double around) {
  std::vector<Vec3> out;
  const Vec3 side(std::cos(around), 0, std::sin(around));
  for (int i = 0; i < k_vertices; ++i) {
    const double s = k_length * i / (k_vertices - 1), radius = k_radius + std::min(0.003, 0.3 * s);
    const double angle = from_crown + s / k_radius, below = std::max(0.0, angle - std::numbers::pi / 2);
    out.push_back(radius * (std::sin(angle - below) * side + std::cos(angle - below) * Vec3::UnitY()) -
                  below * k_radius * Vec3::UnitY());
  }
  return out;
}

Status write_scene(const fs::path& folder) {
  if (Status status = make_folders(folder); !status) return status;
  const TriangleSurface ball = sphere_surface(k_radius, 4);
  CacheInfo head;
  head.mesh = make_triangle_mesh("head", ball.positions, ball.triangles);
  head.frame_count = k_samples * (k_frames - 1) + 1;
  if (Status status = write_obj(folder / "head.obj", head.mesh); !status) return status;
  auto writer = find_cache_format("pc2")->open_writer(folder / "head.pc2", head, 0);
  if (!writer) return writer.error();
  std::string angles;
  for (int k = 0; k < head.frame_count; ++k) {
    const Eigen::AngleAxisd turn(yaw(1 + static_cast<double>(k) / k_samples), Vec3::UnitY());
    std::vector<Vec3> pose = ball.positions;
    for (Vec3& p : pose) p = turn * p;
    if (Status status = (*writer)->write_frame(pose, {}); !status) return status;
    if (k % k_samples == 0) angles += fmt::format("{:.9f}\n", turn.angle());
  }
  if (Status status = (*writer)->close(); !status) return status;
  if (Status status = write_text_durably(folder / "yaw.txt", angles); !status) return status;
  std::string points, lines;
  for (int s = 0; s < k_strands; ++s) {
    lines += "l";
    for (const Vec3& p : combed(std::acos(1 - 0.85 * (s + 0.5) / k_strands), 2.39996 * s))
      points += fmt::format("v {:.9f} {:.9f} {:.9f}\n", p.x(), p.y(), p.z());
    for (int i = 0; i < k_vertices; ++i) lines += fmt::format(" {}", s * k_vertices + i + 1);
    lines += "\n";
  }
  if (Status status = write_text_durably(folder / "groom.obj", points + lines); !status) return status;
  return write_text_durably(
      folder / "shot.toml",
      fmt::format("[shot]\nframes = \"1-{}\"\nfps = 24\npreroll = 0\n\n[primary.head]\nfile = \"head.pc2\"\n"
                  "topology = \"head.obj\"\nsource_fps = {}\nunit_scale = 1\n\n[hair.hair]\nguides = \"groom.obj\"\n"
                  "vertices = {}\n\n[cache]\nformats = [\"pc2\"]\n",
                  k_frames, 24 * k_samples, k_vertices));
}

struct Judged {
  int finite = 0;                     ///< frames before the first that is not
  double strand = 0, segment = 0;     ///< largest |length / rest - 1|
  double drift = 0, mean_drift = 0;   ///< of tips from the groom after two seconds at rest [m]
  int inside = 0, inside_frames = 0;  ///< vertices in the worst frame, and frames with any
  double deepest = 0;                 ///< m
};

/// The first frame is the groom: it tells what lengths are at rest.
Result<Judged> judge(const fs::path& path) {
  auto reader = open_cache(path);
  if (!reader) return reader.error();
  Judged out;
  std::vector<Vec3f> x, groom;
  constexpr std::size_t n = k_vertices;
  for (int f = 0; f < (*reader)->info().frame_count; ++f) {
    if (!(*reader)->read_frame(f, x)) break;  // not finite
    if (x.size() != n * k_strands) return input_error("is not of this groom", path.string());
    if (f == 0) groom = x;
    ++out.finite;
    int inside = 0;
    for (std::size_t s = 0; s < x.size(); s += n) {
      double length = 0, rest = 0;
      for (std::size_t i = s + 1; i < s + n; ++i) {
        const auto now = static_cast<double>((x[i] - x[i - 1]).norm());
        const auto was = static_cast<double>((groom[i] - groom[i - 1]).norm());
        length += now, rest += was;
        out.segment = std::max(out.segment, std::abs(now / was - 1));
        const double deep = k_radius - static_cast<double>(x[i].norm());
        inside += deep > k_inside;
        out.deepest = std::max(out.deepest, deep);
      }
      out.strand = std::max(out.strand, std::abs(length / rest - 1));
      if (f != k_still) continue;
      const double off = static_cast<double>((x[s + n - 1] - groom[s + n - 1]).norm());
      out.drift = std::max(out.drift, off);
      out.mean_drift += off / k_strands;
    }
    out.inside = std::max(out.inside, inside);
    out.inside_frames += inside > 0;
  }
  return out;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? std::nan("") : values[values.size() / 2];
}

/// A run, or the medians of some [s a frame].
struct Cost {
  double cpu = 0, mean = 0, median = 0;
};
Cost cost_of(double cpu, const std::vector<double>& wall) {
  const auto count = static_cast<double>(std::max<std::size_t>(1, wall.size()));
  Cost out{cpu / count, 0, median(wall)};
  for (const double w : wall) out.mean += w / count;
  return out;
}
double median_of(const std::vector<Cost>& all, double Cost::*what) {
  std::vector<double> values;
  for (const Cost& one : all) values.push_back(one.*what);
  return median(values);
}

/// timing.txt: the seconds of CPU of all frames, then the wall seconds of each.
Result<Cost> peer_cost(const fs::path& timing) {
  const auto text = read_text(timing);
  if (!text) return text.error();
  std::istringstream list(*text);
  std::vector<double> wall;
  double cpu = 0;
  list >> cpu;
  for (double seconds; list >> seconds;) wall.push_back(seconds);
  return cost_of(cpu, wall);
}
Result<Cost> our_cost(const fs::path& round) {
  const auto text = read_text(round / "bake" / "report.json"), cpu = read_text(round / "cpu.txt");
  if (!text) return text.error();
  if (!cpu) return cpu.error();
  const auto report = nlohmann::json::parse(*text, nullptr, false);
  if (report.is_discarded() || !report.contains("frames"))
    return input_error("has no report of a bake", round.string());
  std::vector<double> wall;
  for (const auto& frame : report["frames"])
    if (const double ms = frame.value("milliseconds", 0.0); ms > 0) wall.push_back(ms / 1e3);  // the first is given
  return cost_of(std::atof(cpu->c_str()), wall);
}

void print_row(const std::string& who, const Cost& cost, const Judged& j) {
  fmt::print("| {} | {:.4f} | {:.4f} | {:.4f} | {} of {} | {:.3f} %, {:.3f} % | {:.3f}, {:.3f} | {} ({}) | {:.2f} |\n",
             who, cost.cpu, cost.mean, cost.median, j.finite, k_frames, 100 * j.strand, 100 * j.segment, 1e3 * j.drift,
             1e3 * j.mean_drift, j.inside_frames, j.inside, 1e3 * std::max(0.0, j.deepest));
}

Status write_result(const std::vector<std::string>& rounds) {
  std::vector<Cost> ours, theirs;
  std::vector<double> cpu, wall;
  for (const fs::path round : rounds) {
    const auto our = our_cost(round), peer = peer_cost(round / "timing.txt");
    if (!our) return our.error();
    if (!peer) return peer.error();
    ours.push_back(*our), theirs.push_back(*peer);
    cpu.push_back(peer->cpu / our->cpu), wall.push_back(peer->mean / our->mean);
  }
  // Both do the same in every round.
  const fs::path first = rounds.at(0);
  const auto our = judge(first / "bake" / "hair.pc2"), peer = judge(first / "peer.pc2");
  if (!our) return our.error();
  if (!peer) return peer.error();
  const auto typical = [](const std::vector<Cost>& all) {
    return Cost{median_of(all, &Cost::cpu), median_of(all, &Cost::mean), median_of(all, &Cost::median)};
  };
  const Cost a = typical(ours), b = typical(theirs);
  fmt::print("\n| hair, {} x {} {}\n|---|---|---|---|---|---|---|---|---|\n", k_strands, k_vertices,
             "| cpu s/f | wall s/f, mean | median | finite frames | stretch of a strand, a segment "
             "| drift of tips after 2 s, largest, mean mm | frames (worst) with vertices inside | depth mm |");
  print_row("peer", b, *peer);
  print_row("ours", a, *our);
  fmt::print("\nratios of the rounds, of cpu:");
  for (const double r : cpu) fmt::print(" {:.1f}", r);
  fmt::print("; of wall:");
  for (const double r : wall) fmt::print(" {:.1f}", r);
  fmt::print("\ncpu is of a whole run (ours with import and caches, the peer's stepping alone), by its frames.\n");
  fmt::print(
      "RESULT scene=hair n={} ours_cpu={:.4f} ours_wall={:.4f} peer_cpu={:.4f} peer_wall={:.4f} ratio_cpu={:.1f} "
      "ratio_wall={:.1f} stretch={:.5f} peer_stretch={:.5f} drift_mm={:.3f} peer_drift_mm={:.3f} inside={} "
      "peer_inside={} peer_finite={}\n",
      k_strands * k_vertices, a.cpu, a.mean, b.cpu, b.mean, median(cpu), median(wall), our->strand, peer->strand,
      1e3 * our->drift, 1e3 * peer->drift, our->inside, peer->inside, peer->finite);
  return {};
}

int run(const std::vector<std::string>& a) {
  Status status = usage_error("hair_tool scene SCENE | result ROUND...");
  if (a.size() == 2 && a[0] == "scene") status = write_scene(a[1]);
  if (a.size() >= 2 && a[0] == "result") status = write_result({a.begin() + 1, a.end()});
  if (status) return 0;
  fmt::print(stderr, "hair_tool: {}\n", status.error().text());
  return exit_code(status.error().kind);
}

}  // namespace
}  // namespace ft::bench

int main(int argc, char** argv) {
  return ft::bench::run({argv + 1, argv + argc});
}
