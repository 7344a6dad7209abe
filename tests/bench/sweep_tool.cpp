// Lists, sets up and sums up the bakes of a sweep. For tests/bench/sweep.sh:
//   sweep_tool list ASSETS SEED FRAMES FOLDER LIST  what there is to bake, see sweep_list.h
//   sweep_tool shot LIST NAME GARMENTS SHOT.toml          shot file of one; GARMENTS has skirt.obj, top.obj,
//   blanket.obj sweep_tool blanket CHARACTER HEIGHT OUT.obj           a sheet over the back of what has four legs
//   sweep_tool run LIMIT LOG RUN PROGRAM ARGUMENT ...     runs a bake for LIMIT seconds of CPU at most, see sweep_run.h
//   sweep_tool row NAME BAKE RUN GARMENTS                 the row of one, see sweep_rows.h
//   sweep_tool sum LIST ROWS OUT.tsv                      table of the rows that are in the folder ROWS, one a file
//   sweep_tool worst ROWS.tsv COUNT                       name and frame to look at of the worst
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstring>

#include "baker/core/file.h"
#include "io/import/import.h"
#include "io/shot/mesh_file.h"
#include "tests/bench/sweep_list.h"
#include "tests/bench/sweep_rows.h"
#include "tests/bench/sweep_run.h"

namespace ft::bench {
namespace {

namespace fs = std::filesystem;

Status list(const std::vector<std::string>& a) {
  SweepSettings settings;
  settings.assets = a[0];
  settings.seed = std::strtoull(a[1].c_str(), nullptr, 10);
  settings.most_frames = std::atoi(a[2].c_str());
  settings.import_cache = fs::path(a[3]) / "import", settings.motions = fs::path(a[3]) / "motions";
  if (settings.most_frames < 2) return usage_error("a bake has 2 frames at least", a[2]);
  std::vector<std::string> notes;
  const auto bakes = list_sweep(settings, notes);
  for (const std::string& note : notes) fmt::print("{}\n", note);
  if (!bakes) return bakes.error();
  return write_text_durably(a[4], to_lines(*bakes));
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return out + "\"";
}

std::string shot_text(const SweepBake& bake, const fs::path& garments) {
  std::string out = fmt::format("# {}\n[shot]\nframes = \"1-{}\"\nfps = {:g}\n\n[primary.body]\nfile = {}\n", bake.name,
                                bake.frame_count, bake.fps, quoted(bake.file.string()));
  if (!bake.animation.empty()) out += fmt::format("animation = {}\n", quoted(bake.animation.string()));
  if (!bake.clip.empty()) out += fmt::format("clip = {}\nclip_start = {:.6f}\n", quoted(bake.clip), bake.clip_start);
  if (!bake.meshes.empty()) {
    std::string names;
    for (const std::string& m : bake.meshes) names += (names.empty() ? "" : ", ") + quoted(m);
    out += fmt::format("meshes = [{}]\n", names);
  }
  if (bake.height > 0) out += fmt::format("height = {:g}\n", bake.height);
  struct Garment {
    const char *name, *fabric, *pin;
  };
  for (const Garment& g :
       {Garment{"skirt", "cotton", "waist"}, Garment{"top", "jersey", ""}, Garment{"blanket", "wool", "spine"}}) {
    const fs::path mesh = garments / (std::string(g.name) + ".obj");
    if (!fs::exists(mesh)) continue;
    out += fmt::format("\n[cloth.{}]\nmesh = {}\nfabric = \"{}\"\non = \"body\"\n", g.name,
                       quoted(fs::absolute(mesh).string()), g.fabric);
    if (*g.pin != 0) out += fmt::format("pin = \"{}\"\n", g.pin);
  }
  return out + "\n[cache]\nformats = [\"abc\"]\n";
}

Status shot(const std::vector<std::string>& a) {
  const auto bakes = read_sweep_list(a[0]);
  if (!bakes) return bakes.error();
  for (const SweepBake& bake : *bakes)
    if (bake.name == a[1]) return write_text_durably(a[3], shot_text(bake, a[2]));
  return usage_error("there is no such bake in the list", a[1]);
}

/// 63 x 63 vertices just above the back, between the hooves, or above the head; the group "spine" is the middle from
/// front to back.
Status blanket(const fs::path& character, double height, const fs::path& out) {
  constexpr int k_side = 63;
  constexpr double k_above = 0.015;  // m
  ImportRequest request;
  request.file = character, request.height = height;
  const auto primary = import_primary(request);
  if (!primary) return primary.error();
  const std::vector<Vec3> body = bind_pose_of(*primary->trajectory);
  const Box all = bounds(body);
  Box hooves;
  for (const Vec3& p : body)
    if (p.y() < all.lo.y() + 0.05 * all.size().y()) hooves.include(p);
  const int along = hooves.size().x() > hooves.size().z() ? 0 : 2, across = 2 - along;
  const Vec3 centre = 0.5 * (hooves.lo + hooves.hi);
  const double length = std::max(0.55 * hooves.size()[along], 0.4 * all.size().y()), width = 0.7 * all.size().y();
  double back = all.lo.y();
  for (const Vec3& p : body)
    if (std::abs(p[along] - centre[along]) < 0.5 * length) back = std::max(back, p.y());
  Mesh sheet;
  sheet.name = "blanket";
  for (int i = 0; i < k_side; ++i)
    for (int j = 0; j < k_side; ++j) {
      Vec3 p;
      p[along] = centre[along] + length * (static_cast<double>(i) / (k_side - 1) - 0.5);
      p[across] = centre[across] + width * (static_cast<double>(j) / (k_side - 1) - 0.5);
      p.y() = back + k_above;
      sheet.positions.push_back(p);
    }
  VertexGroup spine{"spine", {}, {}};
  for (int i = 0; i < k_side; ++i)
    for (const int j : {k_side / 2 - 1, k_side / 2, k_side / 2 + 1}) spine.vertices.push_back(i * k_side + j);
  spine.weights.assign(spine.vertices.size(), 1.0);
  sheet.groups.push_back(std::move(spine));
  for (int i = 0; i + 1 < k_side; ++i)
    for (int j = 0; j + 1 < k_side; ++j) {
      const int v = i * k_side + j;
      sheet.face_sizes.push_back(4);
      if (along == 0)
        sheet.face_vertices.insert(sheet.face_vertices.end(), {v, v + 1, v + k_side + 1, v + k_side});
      else
        sheet.face_vertices.insert(sheet.face_vertices.end(), {v, v + k_side, v + k_side + 1, v + 1});
    }
  return write_obj(out, sheet);
}

Status run_bake(const std::vector<std::string>& a) {
  const auto run = run_measured({a.begin() + 3, a.end()}, std::atof(a[0].c_str()), a[1]);
  return run ? write_run(a[2], *run) : Status(run.error());
}

Status row(const std::vector<std::string>& a) {
  const auto run = read_run(a[2]);
  if (!run) return run.error();
  auto made = row_of_bake(a[1], *run);
  if (!made) return made.error();
  made->name = a[0];
  made->garments = a[3];
  fmt::print("{}", to_line(*made));
  return {};
}

Result<std::vector<SweepRow>> read_rows(const fs::path& file) {
  auto text = read_text(file);
  if (!text) return text.error();
  std::vector<SweepRow> out;
  std::size_t from = text->find('\n') + 1;  // after the names of the fields
  for (std::size_t to; (to = text->find('\n', from)) != std::string::npos; from = to + 1) {
    auto one = row_from_line(text->substr(from, to - from));
    if (!one) return one.error();
    out.push_back(std::move(*one));
  }
  return out;
}

/// Bakes of the list that have no row yet are left out.
Status sum(const fs::path& list_file, const fs::path& folder, const fs::path& out) {
  const auto bakes = read_sweep_list(list_file);
  if (!bakes) return bakes.error();
  std::string lines = row_header();
  for (const SweepBake& bake : *bakes)
    if (const auto text = read_text(folder / (bake.name + ".tsv")); text) lines += *text;
  if (Status status = write_text_durably(out, lines); !status) return status;
  const auto rows = read_rows(out);
  if (!rows) return rows.error();
  if (rows->size() < bakes->size()) fmt::print("{} of {} bakes have a row\n", rows->size(), bakes->size());
  fmt::print("{}", table_of(*rows));
  return {};
}

Status worst(const fs::path& file, std::size_t count) {
  auto rows = read_rows(file);
  if (!rows) return rows.error();
  const auto sorted = worst_first(std::move(*rows));
  for (std::size_t i = 0; i < std::min(count, sorted.size()); ++i)
    fmt::print("{} {}\n", sorted[i].name, sorted[i].worst_frame);
  return {};
}

int run(const std::vector<std::string>& a) {
  const std::string what = a.empty() ? "" : a[0];
  const std::vector<std::string> rest(a.begin() + (a.empty() ? 0 : 1), a.end());
  Status status = usage_error(
      "sweep_tool list ASSETS SEED FRAMES FOLDER LIST | shot LIST NAME GARMENTS SHOT | blanket CHARACTER HEIGHT OUT | "
      "run LIMIT LOG RUN PROGRAM ... | row NAME BAKE RUN GARMENTS | sum LIST ROWS OUT | worst ROWS COUNT");
  if (what == "list" && rest.size() == 5) status = list(rest);
  if (what == "shot" && rest.size() == 4) status = shot(rest);
  if (what == "blanket" && rest.size() == 3) status = blanket(rest[0], std::atof(rest[1].c_str()), rest[2]);
  if (what == "run" && rest.size() >= 4) status = run_bake(rest);
  if (what == "row" && rest.size() == 4) status = row(rest);
  if (what == "sum" && rest.size() == 3) status = sum(rest[0], rest[1], rest[2]);
  if (what == "worst" && rest.size() == 2)
    status = worst(rest[0], static_cast<std::size_t>(std::max(0, std::atoi(rest[1].c_str()))));
  if (status) return 0;
  fmt::print(stderr, "sweep_tool: {}\n", status.error().text());
  return exit_code(status.error().kind);
}

}  // namespace
}  // namespace ft::bench

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--import-child") == 0) return ft::import_child_main(argc, argv);
  return ft::bench::run({argv + 1, argv + argc});
}
