// `check DIR`: judges a bake from its caches alone, frame by frame. Exit code 4 when a gate fails; crossings with the
// feasible collider, which a prop is to its cords, and among cloths always do, and so does a bake that is not finished.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include "baker/commands/command_line.h"
#include "baker/core/file.h"
#include "baker/core/parallel.h"
#include "baker/judge/judge_caches.h"
#include "baker/record/report_json.h"

namespace ft::inline baker {
namespace {

struct CheckArguments {
  std::filesystem::path folder, json;
  double max_p99_strain = 0, max_depth = 0;  // 0: off; strain as a number (0.05 is 5 %), depth in m
  int threads = 0;
};

struct Totals {
  int crossing_frames = 0, crossings_body = 0, crossings_self = 0;
  double deepest = 0, strain_p99 = 0;
  double smallest_gap = std::numeric_limits<double>::infinity();
  int deepest_frame = 0, strain_frame = 0;
  int absent_frames = 0, absent_vertices = 0, crossings_absent = 0;
};

Totals add_up(const std::vector<FrameReport>& frames) {
  Totals out;
  for (const FrameReport& f : frames) {
    out.crossing_frames += f.crossings_body + f.crossings_self > 0;
    out.crossings_body += f.crossings_body;
    out.crossings_self += f.crossings_self;
    out.absent_frames += f.absent_vertices > 0;
    out.absent_vertices = std::max(out.absent_vertices, f.absent_vertices);
    out.crossings_absent += f.crossings_absent;
    out.smallest_gap = std::min(out.smallest_gap, f.smallest_gap);
    if (f.deepest_drawn > out.deepest) out.deepest = f.deepest_drawn, out.deepest_frame = f.frame;
    if (f.strain_p99 > out.strain_p99) out.strain_p99 = f.strain_p99, out.strain_frame = f.frame;
  }
  return out;
}

std::vector<std::string> failed_gates(const CheckArguments& a, const CacheJudgement& judgement, const Totals& t) {
  std::vector<std::string> out;
  if (judgement.missing_frames > 0)
    out.push_back(fmt::format("the bake is not finished: {} of {} frames are missing (bake --resume goes on with it)",
                              judgement.missing_frames, judgement.frame_count));
  else if (!judgement.complete)
    out.push_back("the bake is not finished: it stopped after its last frame (bake --resume goes on with it)");
  if (t.crossing_frames > 0)
    out.push_back(fmt::format("{} crossings with the feasible collider and {} among cloths, in {} frames",
                              t.crossings_body, t.crossings_self, t.crossing_frames));
  if (a.max_p99_strain > 0 && t.strain_p99 > a.max_p99_strain)
    out.push_back(
        fmt::format("p99 strain {:.4g} at frame {} is above {:.4g}", t.strain_p99, t.strain_frame, a.max_p99_strain));
  if (a.max_depth > 0 && t.deepest > a.max_depth)
    out.push_back(fmt::format("{:.4g} m inside the drawn body at frame {}, more than {:.4g} m", t.deepest,
                              t.deepest_frame, a.max_depth));
  return out;
}

Json json_of(const CacheJudgement& judgement, const Totals& t, const std::vector<std::string>& failed) {
  Json frames = Json::array();
  for (const FrameReport& f : judgement.frames) frames.push_back(to_json(f));
  return Json{{"shot", judgement.shot},
              {"passed", failed.empty()},
              {"failed", failed},
              {"notes", judgement.notes},
              {"missing_frames", judgement.missing_frames},
              {"crossings_body", t.crossings_body},
              {"crossings_self", t.crossings_self},
              {"absent_frames", t.absent_frames},
              {"absent_vertices", t.absent_vertices},
              {"crossings_absent", t.crossings_absent},
              {"deepest_drawn", t.deepest},
              {"strain_p99", t.strain_p99},
              {"frames", std::move(frames)}};
}

int run(const CheckArguments& a) {
  const ThreadLimit limit(a.threads);
  auto judgement = judge_caches(a.folder);
  if (!judgement) {
    complain(judgement.error().text());
    return exit_code(judgement.error().kind);
  }
  const bool has_gap = std::any_of(judgement->frames.begin(), judgement->frames.end(),
                                   [](const FrameReport& f) { return std::isfinite(f.smallest_gap); });
  std::printf("frame  crossings: body  cloth  drawn   inside drawn   strain p99      max%s\n",
              has_gap ? "   gap of cords" : "");
  for (const FrameReport& f : judgement->frames) {
    std::printf("%5d %16d %6d %6d %11.2f mm %10.2f %% %8.2f %%", f.frame, f.crossings_body, f.crossings_self,
                f.crossings_drawn, 1e3 * f.deepest_drawn, 100 * f.strain_p99, 100 * f.strain_max);
    if (has_gap) std::printf(" %11.3f mm", 1e3 * f.smallest_gap);
    std::printf("\n");
  }
  for (const FrameReport& f : judgement->frames)
    for (const Incident& i : f.incidents)
      if (i.kind == Incident::Kind::k_crossing)
        std::printf("frame %d, %s, vertex %d at (%.4f, %.4f, %.4f): %s\n", i.frame, i.system.c_str(), i.vertex,
                    i.place.x(), i.place.y(), i.place.z(), i.text.c_str());
  for (const std::string& note : judgement->notes) std::printf("note: %s\n", note.c_str());
  const Totals totals = add_up(judgement->frames);
  const auto failed = failed_gates(a, *judgement, totals);
  if (totals.absent_frames > 0)
    std::printf(
        "absent: in %d frames a cloth does not meet all of the feasible collider, at most %d of its vertices are "
        "left out\n",
        totals.absent_frames, totals.absent_vertices);
  if (totals.crossings_absent > 0)
    std::printf(
        "absent: %d crossings are with what is left out, lie where a body overlaps itself, or are of tied hair with a "
        "sheet, and do not count\n",
        totals.crossings_absent);
  std::printf(
      "%s: %zu frames, %d crossings with the feasible collider, %d among cloths, deepest %.2f mm in the drawn body, "
      "worst p99 strain %.2f %%%s\n",
      failed.empty() ? "passed" : "FAILED", judgement->frames.size(), totals.crossings_body, totals.crossings_self,
      1e3 * totals.deepest, 100 * totals.strain_p99,
      has_gap ? fmt::format(", least gap of cords {:.3f} mm", 1e3 * totals.smallest_gap).c_str() : "");
  if (!a.json.empty())
    if (const Status written = write_text_durably(a.json, to_text(json_of(*judgement, totals, failed))); !written) {
      complain(written.error().text());
      return exit_code(written.error().kind);
    }
  for (const std::string& gate : failed) complain("check: " + gate);
  return failed.empty() ? 0 : exit_code(ErrorKind::k_quality);
}

}  // namespace

void add_check_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("check", "Judges a bake from its caches: crossings, penetration, strain");
  auto a = std::make_shared<CheckArguments>();
  command->add_option("folder", a->folder, "Bake folder")->required()->type_name("DIR");
  command->add_option("--json", a->json, "Write the judgement as JSON")->type_name("FILE");
  command
      ->add_option("--max-p99-strain", a->max_p99_strain,
                   "Fail when a frame's p99 edge strain is above this (0.05 is 5 %)")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--max-depth", a->max_depth, "Fail when cloth is deeper than this in the drawn body, in metres")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--threads", a->threads, "Threads; 0 takes all cores")->check(CLI::Range(0, 1024));
  command->callback([a, &exit_code] { exit_code = run(*a); });
}

}  // namespace ft::inline baker
