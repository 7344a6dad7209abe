// Text, JSON and JUnit of compare: see compare_report.h.
#include "baker/commands/compare_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace ft::inline baker {
namespace {

constexpr int k_most_lines = 20;  // frames listed as text; JSON has all

const FrameDifference& at(const CompareReport& r, int index) {
  return r.frames[static_cast<std::size_t>(index)];
}

nlohmann::ordered_json to_json(const CompareReport& r, const FrameDifference& f) {
  nlohmann::ordered_json j = {{"frame", f.frame}, {"max", f.max}, {"rms", f.rms}};
  const auto place = [&](const char* of_mesh, const char* of_instances, const char* of_strands, int element) {
    if (element < 0) return;
    if (r.instances)
      j[of_instances] = r.instances->ids[static_cast<std::size_t>(element)];
    else if (r.points)
      j[std::string(of_mesh) == "vertex" ? "point" : "speed_point"] = r.points->ids[static_cast<std::size_t>(element)];
    else
      j[of_mesh] = element;
    if (!r.curves) return;
    const std::size_t strand = r.curves->strand_of(element);
    j[of_strands] = {{"id", r.curves->ids[strand]}, {"vertex", element - r.curves->starts[strand]}};
  };
  place("vertex", "instance", "strand", f.vertex);
  if (f.speed_vertex >= 0) j["max_speed"] = f.max_speed;
  place("speed_vertex", "speed_instance", "speed_strand", f.speed_vertex);
  if (f.scalar_vertex >= 0)
    j["max_scalar"] = {{"name", r.scalars.both[static_cast<std::size_t>(f.scalar_index)].name},
                       {"max", f.scalar},
                       {"vertex", f.scalar_vertex}};
  if (!r.instances) return j;
  j["max_degrees"] = f.turn;
  place("", "degrees_instance", "", f.turn_vertex);
  return j;
}

nlohmann::ordered_json to_json(const InstanceDifference& d) {
  return {{"common", d.common},
          {"missing", d.missing},
          {"extra", d.extra},
          {"replaced", d.replaced},
          {"p95", d.p95},
          {"degrees_rms", d.turn_rms},
          {"degrees_p95", d.turn_p95},
          {"degrees_max", d.turn_max},
          {"scale_max", d.scale_max}};
}

nlohmann::ordered_json to_json(const LengthRatios& l) {
  return {{"mean", l.mean},
          {"p99_change", l.p99},
          {"worst", l.worst},
          {"worst_frame", l.worst_frame},
          {"worst_strand", l.worst_strand}};
}

nlohmann::ordered_json to_json(const CurveDifference& d) {
  return {{"matched_by", d.by_id ? "id" : "index"},
          {"common", d.common},
          {"missing", d.missing},
          {"extra", d.extra},
          {"resized", d.resized},
          {"p95", d.p95},
          {"root_max", d.root_max},
          {"root_frame", d.root_frame},
          {"root_strand", d.root_strand},
          {"lengths_a", to_json(d.lengths_a)},
          {"lengths_b", to_json(d.lengths_b)}};
}

nlohmann::ordered_json to_json(const PointDifference& d) {
  return {{"common", d.common}, {"missing", d.missing}, {"extra", d.extra}, {"p95", d.p95}, {"width_max", d.width_max}};
}

std::string place_in_table(const CompareReport& r, int element) {
  if (element < 0) return "-";
  if (r.instances) return std::to_string(r.instances->ids[static_cast<std::size_t>(element)]);
  if (r.points) return std::to_string(r.points->ids[static_cast<std::size_t>(element)]);
  if (!r.curves) return std::to_string(element);
  const std::size_t strand = r.curves->strand_of(element);
  return fmt::format("{}/{}", r.curves->ids[strand], element - r.curves->starts[strand]);
}

/// Of what differs first in a frame that is beyond a tolerance.
std::string first_difference(const CompareReport& r, const FrameDifference& f) {
  if (f.max > r.tolerance)
    return fmt::format("first beyond the tolerance of {} in frame {}, {} ({})", length_text(r.tolerance), f.frame,
                       r.element(f.vertex), length_text(f.max));
  if (f.turn > r.turn_tolerance)
    return fmt::format("first beyond the tolerance of {:.4g} degrees in frame {}, {} ({:.4g} degrees)",
                       r.turn_tolerance, f.frame, r.element(f.turn_vertex), f.turn);
  if (f.scale > r.tolerance) return fmt::format("scales first differ in frame {}, by {:.4g}", f.frame, f.scale);
  if (f.max_speed > r.speed_tolerance)
    return fmt::format("velocities first beyond the tolerance of {:.4g} m/s in frame {}, {} ({:.4g} m/s)",
                       r.speed_tolerance, f.frame, r.element(f.speed_vertex), f.max_speed);
  if (f.scalar > r.tolerance)
    return fmt::format("\"{}\" first beyond the tolerance of {:.4g} in frame {}, {} ({:.4g})",
                       r.scalars.both[static_cast<std::size_t>(f.scalar_index)].name, r.tolerance, f.frame,
                       r.element(f.scalar_vertex), f.scalar);
  return fmt::format("angular velocities first beyond the tolerance of {:.4g} degrees/s in frame {} ({:.4g} degrees/s)",
                     r.spin_tolerance, f.frame, f.spin);
}

}  // namespace

std::string_view verdict_name(CompareVerdict verdict) {
  return verdict == CompareVerdict::k_equal       ? "equal"
         : verdict == CompareVerdict::k_different ? "different"
                                                  : "incomparable";
}

std::string length_text(double metres) {
  if (metres == 0) return "0";
  return metres < 1 ? fmt::format("{:.4g} mm", 1000 * metres) : fmt::format("{:.4g} m", metres);
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\'')
      out += "&#39;";
    else if (static_cast<unsigned char>(c) < 32 && c != '\n' && c != '\t')
      out += '?';
    else
      out += c;
  }
  return out;
}

std::string summary(const CompareReport& r) {
  if (r.verdict == CompareVerdict::k_incomparable) return r.reason;
  if (r.verdict == CompareVerdict::k_equal) {
    const bool speeds_equal = std::all_of(r.frames.begin(), r.frames.end(), [](const auto& f) {
      return f.max_speed == 0 && f.turn == 0 && f.spin == 0 && f.scale == 0 && f.scalar == 0;
    });
    const bool scalars_missing = !r.scalars.only_a.empty() || !r.scalars.only_b.empty();
    if (r.worst < 0 && speeds_equal) return scalars_missing ? "what both have does not differ" : "no difference at all";
    if (r.worst < 0)
      return std::string("positions do not differ, ") + (r.instances ? "rotations and " : "") +
             (r.scalars.both.empty() ? "" : "scalars of vertices and ") + "velocities within the tolerance";
    const FrameDifference& w = at(r, r.worst);
    return fmt::format("largest difference {} in frame {}, {}; RMS {}; tolerance {}", length_text(w.max), w.frame,
                       r.element(w.vertex), length_text(r.rms), length_text(r.tolerance));
  }
  if (r.first_diverging < 0 && r.points && r.points->same_set())
    return fmt::format("widths differ by up to {}", length_text(r.points->width_max));
  if (r.first_diverging < 0)
    return std::string(r.curves   ? "the strands"
                       : r.points ? "the points"
                                  : "the instances") +
           " are not the same ones; those that both have do not differ";
  std::string text = first_difference(r, at(r, r.first_diverging));
  if (r.worst >= 0)
    text += fmt::format("; largest {} in frame {}, {}; RMS {}", length_text(at(r, r.worst).max), at(r, r.worst).frame,
                        r.element(at(r, r.worst).vertex), length_text(r.rms));
  return text + fmt::format("; {} of {} frames differ", r.diverging_count(), r.frames.size());
}

std::string compare_text(const std::vector<CompareReport>& reports) {
  std::string out;
  for (const CompareReport& r : reports) {
    out += fmt::format("{}: {}: {}\n  a: {}\n  b: {}\n", r.system, verdict_name(r.verdict), summary(r), r.a, r.b);
    if (r.instances) out += instances_text(r);
    if (r.curves) out += curves_text(r);
    if (r.points) out += points_text(r);
    out += scalars_text(r.scalars);
    if (r.verdict != CompareVerdict::k_different || r.first_diverging < 0) continue;
    const char* where = r.instances ? "instance" : r.curves ? "strand/vertex" : r.points ? "point" : "vertex";
    out += fmt::format("  {:>8} {:>12} {:>12} {:>14} {:>12}\n", "frame", "max [mm]", "rms [mm]", where,
                       r.instances ? "max [deg]" : "max [m/s]");
    int lines = 0;
    for (const FrameDifference& f : r.frames)
      if (r.diverges(f) && ++lines <= k_most_lines)
        out += fmt::format("  {:>8} {:>12.4g} {:>12.4g} {:>14} {:>12}\n", f.frame, 1000 * f.max, 1000 * f.rms,
                           place_in_table(r, f.vertex),
                           r.instances    ? fmt::format("{:.4g}", f.turn)
                           : r.velocities ? fmt::format("{:.4g}", f.max_speed)
                                          : "-");
    if (lines > k_most_lines) out += fmt::format("  and {} more frames\n", lines - k_most_lines);
  }
  return out;
}

std::string compare_json(const std::vector<CompareReport>& reports, const std::vector<ForceComparison>& forces,
                         const std::vector<PathComparison>& paths) {
  const CompareVerdict verdict = overall_verdict(reports);
  Json all = {{"verdict", verdict_name(verdict)},
              {"exit_code", exit_code(verdict)},
              {"units", "m, m/s, N, degrees"},
              {"caches", Json::array()}};
  for (const CompareReport& r : reports) {
    Json j = {
        {"system", r.system}, {"a", r.a}, {"b", r.b}, {"verdict", verdict_name(r.verdict)}, {"summary", summary(r)}};
    if (r.verdict != CompareVerdict::k_incomparable) {
      j["tolerance"] = r.tolerance;
      j["vertex_count"] = r.vertex_count;
      if (r.instances) j["instances"] = to_json(*r.instances);
      if (r.curves) j["curves"] = to_json(*r.curves);
      if (r.points) j["points"] = to_json(*r.points);
      j["velocities_compared"] = r.velocities;
      for (const ScalarDifference& d : r.scalars.both) j["scalars"][d.name] = d.max;
      if (!r.scalars.only_a.empty()) j["scalars_only_in_a"] = r.scalars.only_a;
      if (!r.scalars.only_b.empty()) j["scalars_only_in_b"] = r.scalars.only_b;
      j["rms"] = r.rms;
      j["diverging_frames"] = r.diverging_count();
      if (r.first_diverging >= 0) j["first_diverging"] = to_json(r, at(r, r.first_diverging));
      if (r.worst >= 0) j["worst"] = to_json(r, at(r, r.worst));
      j["frames"] = Json::array();
      for (const FrameDifference& f : r.frames) j["frames"].push_back(to_json(r, f));
    }
    all["caches"].push_back(std::move(j));
  }
  if (!forces.empty()) all["forces"] = to_json(forces);
  if (!paths.empty()) all["primaries"] = to_json(paths);
  return all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string compare_junit(const std::vector<CompareReport>& reports) {
  int failures = 0, errors = 0;
  std::string cases;
  for (const CompareReport& r : reports) {
    cases += fmt::format("  <testcase classname=\"followthrough.compare\" name=\"{}\">",
                         escaped(std::filesystem::path(r.a).filename().string()));
    const bool different = r.verdict == CompareVerdict::k_different;
    if (r.verdict != CompareVerdict::k_equal) {
      ++(different ? failures : errors);
      cases += fmt::format("\n    <{0} message=\"{1}\">{2} against {3}</{0}>\n  ", different ? "failure" : "error",
                           escaped(summary(r)), escaped(r.a), escaped(r.b));
    }
    cases += "</testcase>\n";
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"followthrough compare\" tests=\"{}\" "
      "failures=\"{}\" errors=\"{}\">\n{}</testsuite>\n",
      reports.size(), failures, errors, cases);
}

}  // namespace ft::inline baker
