#include "tests/bench/sweep_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "baker/core/file.h"
#include "baker/core/types.h"

namespace ft::bench {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr double k_good_strain = 0.1;  ///< p99 [1]
constexpr double k_slow_frame = 10;    ///< over the median one [1]

Json read_json(const fs::path& file) {
  const auto text = read_text(file);
  return text ? Json::parse(*text, nullptr, false) : Json();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n == 0 ? 0 : n % 2 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

/// First and last frames of the places without room.
std::vector<std::array<int, 2>> places_without_room(const Json& report) {
  std::vector<std::array<int, 2>> out;
  if (report.contains("room"))
    for (const Json& place : report["room"].value("places", Json::array()))
      out.push_back({place.value("first_frame", 0), place.value("last_frame", 0)});
  return out;
}

bool had_room(const std::vector<std::array<int, 2>>& places, int frame) {
  return std::none_of(places.begin(), places.end(),
                      [&](const auto& p) { return p[0] <= frame && p[1] >= frame - k_room_frames; });
}

void take_times(const MeasuredRun& run, SweepRow& row) {
  if (run.frame_cpu_seconds.empty()) return;
  row.cpu_seconds = run.cpu_seconds / static_cast<double>(run.frame_cpu_seconds.size());
  const std::vector<double> frames(run.frame_cpu_seconds.begin() + 1, run.frame_cpu_seconds.end());  // after the import
  const auto shot = std::min(frames.size(), at(row.frame_count));
  if (const double middle = median(std::vector<double>(frames.end() - static_cast<std::ptrdiff_t>(shot), frames.end()));
      middle > 0)
    row.worst_frame_ratio = *std::max_element(frames.begin(), frames.end()) / middle;
}

double share(const std::vector<SweepRow>& rows, bool (*good)(const SweepRow&)) {
  if (rows.empty()) return 0;
  return static_cast<double>(std::count_if(rows.begin(), rows.end(), good)) / static_cast<double>(rows.size());
}

}  // namespace

Result<SweepRow> row_of_bake(const fs::path& folder, const MeasuredRun& run) {
  SweepRow row;
  row.exit_code = run.exit_code;
  if (!fs::exists(folder / "manifest.json")) return row;
  const Json manifest = read_json(folder / "manifest.json"), report = read_json(folder / "report.json");
  if (!manifest.is_object() || !manifest.contains("frames"))
    return input_error("is not a bake's", (folder / "manifest.json").string());
  row.complete = manifest.value("complete", false);
  const auto places = places_without_room(report);
  int absent = 0, most = -1;
  double most_strain = -1;
  for (const Json& frame : manifest["frames"]) {
    const int number = frame.value("frame", 0);
    const int body = frame.value("crossings_body", 0), self = frame.value("crossings_self", 0);
    const double strain = frame.value("strain_p99", 0.0);
    ++row.frame_count;
    row.crossings_body += body, row.crossings_self += self;
    row.crossings_last = body + self;
    row.crossing_frames += body + self > 0;
    row.late_frames += body + self > 0 && had_room(places, number);
    row.strain_p99 = std::max(row.strain_p99, strain);
    absent += frame.value("absent_vertices", 0) > 0;
    if (body + self > most || (body + self == most && strain > most_strain))
      most = body + self, most_strain = strain, row.worst_frame = number;
  }
  take_times(run, row);
  if (row.frame_count > 0) row.absent_share = static_cast<double>(absent) / row.frame_count;
  return row;
}

std::string row_header() {
  return "name\tframes\texit\tcomplete\tcrossings_body\tcrossings_self\tcrossing_frames\tcrossings_last\tlate_frames\t"
         "strain_p99\tabsent_share\tcpu_s_per_frame\tworst_frame_ratio\tworst_frame\tgarments\n";
}

std::string to_line(const SweepRow& r) {
  return fmt::format("{}\t{}\t{}\t{:d}\t{}\t{}\t{}\t{}\t{}\t{:.6g}\t{:.4g}\t{:.5g}\t{:.4g}\t{}\t{}\n", r.name,
                     r.frame_count, r.exit_code, r.complete, r.crossings_body, r.crossings_self, r.crossing_frames,
                     r.crossings_last, r.late_frames, r.strain_p99, r.absent_share, r.cpu_seconds, r.worst_frame_ratio,
                     r.worst_frame, r.garments.empty() ? "-" : r.garments);
}

Result<SweepRow> row_from_line(const std::string& line) {
  std::istringstream in(line);
  SweepRow r;
  in >> r.name >> r.frame_count >> r.exit_code >> r.complete >> r.crossings_body >> r.crossings_self >>
      r.crossing_frames >> r.crossings_last >> r.late_frames >> r.strain_p99 >> r.absent_share >> r.cpu_seconds >>
      r.worst_frame_ratio >> r.worst_frame >> r.garments;
  if (!in) return input_error("is not a row of a sweep", line);
  return r;
}

std::vector<SweepRow> worst_first(std::vector<SweepRow> rows) {
  std::stable_sort(rows.begin(), rows.end(), [](const SweepRow& a, const SweepRow& b) {
    if (a.complete != b.complete) return b.complete;
    if (a.crossings() != b.crossings()) return a.crossings() > b.crossings();
    return a.strain_p99 > b.strain_p99;
  });
  return rows;
}

std::string table_of(const std::vector<SweepRow>& rows) {
  std::string out = fmt::format("{:<70} {:>4} {:>6} {:>6} {:>6} {:>5} {:>5} {:>8} {:>6} {:>7} {:>6}  {}\n", "bake", "f",
                                "body", "cloth", "frames", "last", "late", "p99", "absent", "cpu s/f", "worst", "");
  double cpu = 0, ratio = 0;
  for (const SweepRow& r : worst_first(rows)) {
    std::string remark = r.exit_code == 124 ? "UNFINISHED"
                         : r.exit_code != 0 ? fmt::format("EXIT {}", r.exit_code)
                                            : "";
    if (r.garments != "skirt+top") remark += (remark.empty() ? "wears " : ", wears ") + r.garments;
    out += fmt::format("{:<70} {:>4} {:>6} {:>6} {:>6} {:>5} {:>5} {:>6.2f} % {:>4.0f} % {:>7.3f} {:>6.1f}  {}\n",
                       r.name, r.frame_count, r.crossings_body, r.crossings_self, r.crossing_frames, r.crossings_last,
                       r.late_frames, 100 * r.strain_p99, 100 * r.absent_share, r.cpu_seconds, r.worst_frame_ratio,
                       remark);
    cpu += r.cpu_seconds, ratio = std::max(ratio, r.worst_frame_ratio);
  }
  const auto unfinished = std::count_if(rows.begin(), rows.end(), [](const SweepRow& r) { return !r.complete; });
  const auto failed = std::count_if(rows.begin(), rows.end(), [](const SweepRow& r) { return r.exit_code != 0; });
  const double clean = share(rows, [](const SweepRow&r) { return r.complete && r.crossings() == 0; }),
               clean_last = share(rows, [](const SweepRow&r) { return r.complete && r.crossings_last == 0; }),
               not_late = share(rows, [](const SweepRow&r) { return r.complete && r.late_frames == 0; }),
               p99_ok = share(rows, [](const SweepRow&r) { return r.complete && r.strain_p99 < k_good_strain; }),
               quick = share(rows, [](const SweepRow&r) { return r.worst_frame_ratio <= k_slow_frame; });
  if (!rows.empty()) cpu /= static_cast<double>(rows.size());
  out += fmt::format(
      "\nbody, cloth: crossings with the feasible collider and among cloth, sums over the frames; frames: with any; "
      "last: in the last frame;\nlate: frames with any although there has been room for {} frames; p99: worst frame's; "
      "absent: share of the frames;\ncpu: mean, with import, pre-roll and caches; worst: the slowest frame, of the "
      "pre-roll too, over the shot's median one\n\n",
      k_room_frames);
  out += fmt::format(
      "{} bakes: {:.1f} % without a crossing in any frame, {:.1f} % in the last frame, {:.1f} % where there is room; "
      "p99 strain below {:g} % in {:.1f} %;\n{} not complete, {} with another exit code than 0; {:.3f} s of CPU a "
      "frame; no frame over {:g} times the median one in {:.1f} %, the slowest took {:.1f} times it\n",
      rows.size(), 100 * clean, 100 * clean_last, 100 * not_late, 100 * k_good_strain, 100 * p99_ok, unfinished, failed,
      cpu, k_slow_frame, 100 * quick, ratio);
  out += fmt::format(
      "RESULT scene=sweep bakes={} clean={:.4f} clean_last={:.4f} not_late={:.4f} p99_ok={:.4f} unfinished={} "
      "failed={} cpu={:.4f} worst_frame_ratio={:.2f}\n",
      rows.size(), clean, clean_last, not_late, p99_ok, unfinished, failed, cpu, ratio);
  return out;
}

}  // namespace ft::bench
