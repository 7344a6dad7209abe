// Carries benchmark cases to our program and back, and sums up. For tests/bench/run.sh:
//   case_tool to-shot CASE FOLDER [--pins 0-199]     body.obj, body.pc2, cloth.obj and shot.toml from Blender's case
//   case_tool from-bake CASE BAKE OUT drawn|feasible our cloth beside the drawn body or the feasible collider
//   case_tool obj CACHE FRAME OUT.obj                one frame of any cache that knows its faces, to look at
//   case_tool to-judge BAKE CLOTH BODY FLAT.obj OUT  a bake without a peer: CLOTH beside the feasible collider of BODY
//   case_tool result ...                             the table and the RESULT line, see result_line()
//   case_tool result-alone ...                       the RESULT line of a bake without a peer, see result_alone()
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "baker/core/file.h"
#include "io/cache/cache.h"
#include "io/shot/mesh_file.h"
#include "tests/bench/bench_case.h"

namespace ft::bench {
namespace {

namespace fs = std::filesystem;

std::vector<Vec3> to_double(const std::vector<Vec3f>& points) {
  std::vector<Vec3> out;
  for (const Vec3f& p : points) out.push_back(p.cast<double>());
  return out;
}

Status to_shot(const fs::path& case_folder, const fs::path& folder, const std::string& pins) {
  auto data = read_case(case_folder);
  if (!data) return data.error();
  if (Status status = make_folders(folder); !status) return status;
  const Mesh body = make_triangle_mesh("body", to_double(data->body[0]), data->body_triangles);
  const Mesh cloth = make_triangle_mesh("cloth", to_double(data->rest), data->cloth_triangles);
  if (Status status = write_obj(folder / "body.obj", body); !status) return status;
  if (Status status = write_obj(folder / "cloth.obj", cloth); !status) return status;
  CacheInfo info;
  info.system = "body";
  info.mesh = body;
  info.frame_count = data->frame_count;
  auto writer = find_cache_format("pc2")->open_writer(folder / "body.pc2", info, 0);
  if (!writer) return writer.error();
  for (int k = 0; k < data->frame_count; ++k)
    if (Status status = (*writer)->write_frame(to_double(data->body[static_cast<std::size_t>(k)]), {}); !status)
      return status;
  if (Status status = (*writer)->close(); !status) return status;
  // Sources are stored as they are; the clip holds its own pre-roll, so ours is none.
  std::string shot = fmt::format(
      "[shot]\nframes = \"1-{}\"\nfps = 24\npreroll = 0\n\n[primary.body]\nfile = \"body.pc2\"\ntopology = "
      "\"body.obj\"\n"
      "source_fps = 24\nunit_scale = 1\n\n[cloth.cloth]\nmesh = \"cloth.obj\"\nfabric = \"cotton\"\non = \"body\"\n",
      data->frame_count);
  if (!pins.empty()) shot += fmt::format("pins = [ {{ vertices = \"{}\" }} ]\n", pins);
  shot += "\n[cache]\nformats = [\"abc\"]\n";
  return write_text_durably(folder / "shot.toml", shot);
}

/// All frames of a cache, and its triangles.
Status read_cache(const fs::path& path, std::vector<std::vector<Vec3f>>& frames, std::vector<Triangle>* triangles) {
  auto reader = open_cache(path);
  if (!reader) return reader.error();
  if (triangles) *triangles = triangulate((*reader)->info().mesh);
  for (int k = 0; k < (*reader)->info().frame_count; ++k)
    if (Status status = (*reader)->read_frame(k, frames.emplace_back()); !status) return status;
  return {};
}

Status from_bake(const fs::path& case_folder, const fs::path& bake, const fs::path& out, const std::string& against) {
  auto data = read_case(case_folder);
  if (!data) return data.error();
  data->cloth.clear();
  if (Status status = read_cache(bake / "cloth.abc", data->cloth, nullptr); !status) return status;
  if (against == "feasible") {
    data->body.clear();
    if (Status status = read_cache(bake / "body.collider.abc", data->body, &data->body_triangles); !status)
      return status;
  }
  data->frame_count = static_cast<int>(std::min(data->cloth.size(), data->body.size()));
  data->cloth.resize(static_cast<std::size_t>(data->frame_count));
  data->body.resize(static_cast<std::size_t>(data->frame_count));
  if (data->frame_count == 0 || data->cloth[0].size() != data->rest.size())
    return input_error("the bake is not of this case", bake.string());
  return write_case(out, *data);
}

/// Strain is judged against `flat`, whose positions are the pattern.
Status to_judge(const fs::path& bake, const std::string& cloth, const std::string& body, const fs::path& flat,
                const fs::path& out) {
  const auto rest = read_obj(flat);
  if (!rest) return rest.error();
  Case data;
  for (const Vec3& p : rest->positions) data.rest.push_back(p.cast<float>());
  if (Status status = read_cache(bake / (cloth + ".abc"), data.cloth, &data.cloth_triangles); !status) return status;
  if (Status status = read_cache(bake / (body + ".collider.abc"), data.body, &data.body_triangles); !status)
    return status;
  data.frame_count = static_cast<int>(std::min(data.cloth.size(), data.body.size()));
  if (data.frame_count == 0 || data.cloth[0].size() != data.rest.size())
    return input_error("is not the flat shape of what was baked", flat.string());
  return write_case(out, data);
}

Status one_frame(const fs::path& cache, int frame, const fs::path& out) {
  auto reader = open_cache(cache);
  if (!reader) return reader.error();
  Mesh mesh = (*reader)->info().mesh;
  std::vector<Vec3f> points;
  if (Status status = (*reader)->read_frame(frame - (*reader)->info().first_frame, points); !status) return status;
  mesh.positions = to_double(points);
  return write_obj(out, mesh);
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

/// What follows "key=" in a text, as a number; NaN when it is not there.
double number_after(const std::string& text, const std::string& key, std::size_t from = 0) {
  const std::size_t place = text.find(key + "=", from);
  return place == std::string::npos ? std::nan("") : std::atof(text.c_str() + place + key.size() + 1);
}

struct Judged {
  double frames = 0, inside_frames = 0, depth_mm = 0, body_frames = 0, body_worst = 0, self_frames = 0, self_worst = 0,
         p99 = 0;
};

/// The judge's SUMMARY line.
Judged read_judge(const std::string& file) {
  const auto text = read_text(file);
  const std::string all = text ? *text : "";
  const std::size_t start = all.find("SUMMARY"), body = all.find("frames_with_bodyX", start),
                    self = all.find("frames_with_selfX", start);
  Judged j;
  j.frames = number_after(all, " frames", start);
  j.inside_frames = number_after(all, "frames_with_inside_verts", start);
  j.depth_mm = number_after(all, "worst_depth_mm", start);
  j.body_frames = number_after(all, "frames_with_bodyX", start), j.body_worst = number_after(all, " worst", body);
  j.self_frames = number_after(all, "frames_with_selfX", start), j.self_worst = number_after(all, " worst", self);
  j.p99 = number_after(all, "worst_p99_strain", start);
  return j;
}

void print_row(const std::string& who, double cpu, double wall, const Judged& j) {
  fmt::print(
      "| {:<34} | {:>7.3f} | {:>7.3f} | {:>4.0f} | {:>5.0f} ({:>5.0f}) | {:>5.0f} ({:>5.0f}) | {:>4.0f} | {:>7.2f} | "
      "{:>6.2f} % |\n",
      who, cpu, wall, j.frames, j.body_frames, j.body_worst, j.self_frames, j.self_worst, j.inside_frames, j.depth_mm,
      100 * j.p99);
}

/// What a bake cost, its pre-roll included.
struct Cost {
  std::vector<double> wall;  ///< of each frame [s]
  double cpu = 0;            ///< mean of the whole run [s per frame]
  double rss_mb = 0;
};

Result<Cost> read_cost(const std::string& report_file, const std::string& cpu_seconds) {
  auto text = read_text(report_file);
  if (!text) return text.error();
  const auto report = nlohmann::json::parse(*text, nullptr, false);
  if (report.is_discarded() || !report.contains("frames")) return input_error("is not a report of a bake", report_file);
  Cost out;
  for (const auto& frame : report["frames"])
    if (const double milliseconds = frame.value("milliseconds", 0.0); milliseconds > 0)
      out.wall.push_back(milliseconds / 1e3);  // the first is given
  out.cpu = std::atof(cpu_seconds.c_str()) / static_cast<double>(out.wall.size());
  out.rss_mb = report.value("peak_memory_bytes", 0.0) / 1e6;
  return out;
}

/// SCENE N REPORT_JSON OUR_CPU_SECONDS JUDGE_FEASIBLE CHECK_JSON. Crossings of the cloth with itself are those of
/// `check`: the judge takes what is sewn together for crossing.
Status result_alone(const std::vector<std::string>& a) {
  const auto cost = read_cost(a[2], a[3]);
  if (!cost) return cost.error();
  const auto text = read_text(a[5]);
  if (!text) return text.error();
  const auto check = nlohmann::json::parse(*text, nullptr, false);
  if (check.is_discarded() || !check.contains("crossings_self")) return input_error("is not of `check`", a[5]);
  const Judged judged = read_judge(a[4]);
  fmt::print(
      "RESULT scene={} n={} ours_cpu={:.4f} ours_wall={:.4f} crossings={:.0f} depth_mm={:.2f} "
      "p99_strain={:.4f} rss_mb={:.0f}\n",
      a[0], a[1], cost->cpu, median(cost->wall), judged.body_worst + check.value("crossings_self", 0.0),
      judged.depth_mm, judged.p99, cost->rss_mb);
  return {};
}

/// SCENE N REPORT_JSON OUR_CPU_SECONDS PEER_TIMING JUDGE_PEER JUDGE_DRAWN JUDGE_FEASIBLE
Status result_line(const std::vector<std::string>& a) {
  const auto cost = read_cost(a[2], a[3]);
  if (!cost) return cost.error();
  const std::vector<double>& ours = cost->wall;
  const double our_cpu = cost->cpu, rss = cost->rss_mb;
  std::vector<double> theirs;
  auto timing = read_text(a[4]);
  if (!timing) return timing.error();
  const double peer_cpu = number_after(*timing, "cpu/frame");
  std::istringstream list(timing->substr(std::min(timing->size(), timing->find('\n') + 1)));
  for (double seconds; list >> seconds;) theirs.push_back(seconds);
  const Judged peer = read_judge(a[5]), drawn = read_judge(a[6]), feasible = read_judge(a[7]);
  fmt::print(
      "\n| {:<34} | cpu s/f | wall s/f | frames | frames (worst) with body crossings | self crossings | frames inside "
      "| depth mm | p99 strain |\n|---|---|---|---|---|---|---|---|---|\n",
      a[0]);
  print_row("peer, drawn body", peer_cpu, median(theirs), peer);
  print_row("ours, drawn body", our_cpu, median(ours), drawn);
  print_row("ours, feasible collider", our_cpu, median(ours), feasible);
  fmt::print(
      "\ncpu is the mean of a whole run (ours with import and caches, the peer's stepping alone); wall is the median "
      "frame.\n");
  fmt::print(
      "crossings: the worst frame's, ours, with the feasible collider and among the cloth; depth: ours, in the "
      "feasible collider.\n");
  fmt::print(
      "RESULT scene={} n={} ours_cpu={:.4f} ours_wall={:.4f} peer_cpu={:.4f} peer_wall={:.4f} crossings={:.0f} "
      "depth_mm={:.2f} p99_strain={:.4f} rss_mb={:.0f}\n",
      a[0], a[1], our_cpu, median(ours), peer_cpu, median(theirs), feasible.body_worst + feasible.self_worst,
      feasible.depth_mm, feasible.p99, rss);
  return {};
}

int run(const std::vector<std::string>& a) {
  Status status = usage_error(
      "case_tool to-shot CASE FOLDER [--pins LIST] | from-bake CASE BAKE OUT drawn|feasible | obj CACHE FRAME OUT | "
      "to-judge BAKE CLOTH BODY FLAT OUT | result ... | result-alone ...");
  if (a.size() >= 3 && a[0] == "to-shot") status = to_shot(a[1], a[2], a.size() >= 5 && a[3] == "--pins" ? a[4] : "");
  if (a.size() == 5 && a[0] == "from-bake") status = from_bake(a[1], a[2], a[3], a[4]);
  if (a.size() == 4 && a[0] == "obj") status = one_frame(a[1], std::atoi(a[2].c_str()), a[3]);
  if (a.size() == 6 && a[0] == "to-judge") status = to_judge(a[1], a[2], a[3], a[4], a[5]);
  if (a.size() == 7 && a[0] == "result-alone") status = result_alone({a.begin() + 1, a.end()});
  if (a.size() == 9 && a[0] == "result") status = result_line({a.begin() + 1, a.end()});
  if (status) return 0;
  fmt::print(stderr, "case_tool: {}\n", status.error().text());
  return exit_code(status.error().kind);
}

}  // namespace
}  // namespace ft::bench

int main(int argc, char** argv) {
  return ft::bench::run({argv + 1, argv + argc});
}
