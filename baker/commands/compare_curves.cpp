#include "baker/commands/compare_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "baker/commands/compare.h"
#include "baker/commands/compare_pairs.h"
#include "baker/commands/compare_report.h"
#include "baker/core/check.h"

namespace ft::inline baker {
namespace {

std::vector<int> starts_of(const CurveSet& set) {
  std::vector<int> out;
  int next = 0;
  for (const int n : set.vertices_per_curve) {
    out.push_back(next);
    next += n;
  }
  return out;
}

/// Its ids, or indices in their place.
std::vector<std::uint64_t> names_of(const CurveSet& set, bool by_id) {
  if (by_id) return set.ids;
  std::vector<std::uint64_t> out(set.vertices_per_curve.size());
  std::iota(out.begin(), out.end(), std::uint64_t{0});
  return out;
}

template <class Point>
double length_of(const std::vector<Point>& x, int start, int count) {
  double out = 0;
  for (std::size_t v = at(start) + 1; v < at(start + count); ++v)
    out += (x[v].template cast<double>() - x[v - 1].template cast<double>()).norm();
  return out;
}

/// Adds up the lengths of one cache, frame by frame.
class Lengths {
 public:
  Lengths(const CurveSet& set, std::vector<std::uint64_t> names)
      : set_(set), names_(std::move(names)), starts_(starts_of(set)) {
    for (std::size_t c = 0; c < starts_.size(); ++c)
      rest_.push_back(set.rest.empty() ? 0 : length_of(set.rest, starts_[c], set.vertices_per_curve[c]));
  }
  void add(int frame, const FrameData& x) {
    for (std::size_t c = 0; c < starts_.size(); ++c) {
      if (!(rest_[c] > 0)) continue;
      const double ratio = length_of(x.positions, starts_[c], set_.vertices_per_curve[c]) / rest_[c];
      sum_ += ratio;
      changes_.push_back(std::abs(ratio - 1));
      if (changes_.back() <= std::abs(out_.worst - 1) && changes_.size() > 1) continue;
      out_.worst = ratio, out_.worst_frame = frame, out_.worst_strand = names_[c];
    }
  }
  LengthRatios result() const {
    LengthRatios out = out_;
    out.count = changes_.size();
    if (out.count > 0) out.mean = sum_ / static_cast<double>(out.count);
    out.p99 = percentile(changes_, 99);
    return out;
  }

 private:
  const CurveSet& set_;
  std::vector<std::uint64_t> names_;
  std::vector<int> starts_;
  std::vector<double> rest_, changes_;
  double sum_ = 0;
  LengthRatios out_;
};

struct VertexPair {
  std::size_t in_a, in_b;
  bool root;
};

/// Of the strands that have as many vertices in both.
std::vector<VertexPair> vertices_of(const std::vector<ComparedPair>& strands, const CurveSet& a, const CurveSet& b,
                                    CurveDifference& out) {
  const std::vector<int> starts_b = starts_of(b);
  std::vector<VertexPair> pairs;
  for (const auto& [in_a, in_b] : strands) {
    const int count = a.vertices_per_curve[in_a];
    if (count != b.vertices_per_curve[in_b]) {
      out.resized.push_back(out.ids[in_a]);
      continue;
    }
    for (int v = 0; v < count; ++v) pairs.push_back({at(out.starts[in_a] + v), at(starts_b[in_b] + v), v == 0});
  }
  return pairs;
}

std::string lengths_line(const char* which, const LengthRatios& l) {
  if (l.count == 0) return fmt::format("  lengths of {}: no strand has a length at rest\n", which);
  return fmt::format(
      "  lengths of {}: mean {:.6g} of rest, p99 of the change {:.4g} %, worst {:.6g} in frame {}, strand {}\n", which,
      l.mean, 100 * l.p99, l.worst, l.worst_frame, l.worst_strand);
}

}  // namespace

std::size_t CurveDifference::strand_of(int vertex) const {
  CHECK(vertex >= 0 && !starts.empty());
  return static_cast<std::size_t>(std::upper_bound(starts.begin(), starts.end(), vertex) - starts.begin()) - 1;
}

std::string CurveDifference::element(int vertex) const {
  if (vertex < 0) return "no strand";
  const std::size_t strand = strand_of(vertex);
  return fmt::format("strand {}, vertex {}", ids[strand], vertex - starts[strand]);
}

Status compare_curves(CacheReader& a, CacheReader& b, CompareReport& r) {
  const CurveSet &set_a = a.info().curves, &set_b = b.info().curves;
  CurveDifference& out = r.curves.emplace();
  out.by_id = !set_a.ids.empty() && !set_b.ids.empty();
  out.ids = names_of(set_a, out.by_id);
  out.starts = starts_of(set_a);
  const std::vector<std::uint64_t> ids_b = names_of(set_b, out.by_id);
  ComparedPairs strands = pair_by_id(out.ids, ids_b);
  out.common = static_cast<int>(strands.both.size());
  out.missing = std::move(strands.missing), out.extra = std::move(strands.extra);
  const std::vector<VertexPair> pairs = vertices_of(strands.both, set_a, set_b, out);
  Lengths lengths_a(set_a, out.ids), lengths_b(set_b, ids_b);
  std::vector<double> distances;
  double square_sum = 0;
  FrameData x, y;
  for (int i = 0; i < a.info().frame_count; ++i) {
    if (const Status s = a.read(i, x); !s) return s;
    if (const Status s = b.read(i, y); !s) return s;
    FrameDifference f;
    f.frame = r.first_frame + i;
    lengths_a.add(f.frame, x), lengths_b.add(f.frame, y);
    double frame_sum = 0;
    std::vector<Vec3f> places;
    std::vector<float> offs;
    for (const auto& [in_a, in_b, root] : pairs) {
      const double d = distance(x.positions[in_a], y.positions[in_b]);
      raise(d, in_a, f.max, f.vertex);
      if (root && d > out.root_max) {
        out.root_max = d, out.root_frame = f.frame;
        out.root_strand = out.ids[out.strand_of(static_cast<int>(in_a))];
      }
      if (r.velocities) raise(distance(x.velocities[in_a], y.velocities[in_b]), in_a, f.max_speed, f.speed_vertex);
      frame_sum += d * d;
      distances.push_back(d);
      places.push_back(y.positions[in_b]);
      offs.push_back(static_cast<float>(d));
    }
    f.rms = pairs.empty() ? 0 : std::sqrt(frame_sum / static_cast<double>(pairs.size()));
    square_sum += frame_sum;
    r.add(f, std::move(places), std::move(offs), i + 1 == a.info().frame_count);
  }
  const double count = static_cast<double>(distances.size());
  r.rms = count > 0 ? std::sqrt(square_sum / count) : 0;
  out.p95 = percentile(std::move(distances), 95);
  out.lengths_a = lengths_a.result(), out.lengths_b = lengths_b.result();
  r.verdict = r.first_diverging < 0 && out.same_set() ? CompareVerdict::k_equal : CompareVerdict::k_different;
  return {};
}

std::string curves_text(const CompareReport& r) {
  const CurveDifference& d = *r.curves;
  std::string out = fmt::format("  strands: {} in both, matched by {}", d.common, d.by_id ? "id" : "index");
  for (const auto& [what, ids] : {std::pair("only in a", &d.missing), std::pair("only in b", &d.extra),
                                  std::pair("with another number of vertices", &d.resized)})
    if (!ids->empty()) out += fmt::format(", {} {} ({})", ids->size(), what, id_list(*ids));
  const double most = r.worst < 0 ? 0 : r.frames[at(r.worst)].max;
  out +=
      fmt::format("\n  vertices: rms {}, p95 {}, max {}\n", length_text(r.rms), length_text(d.p95), length_text(most));
  out += "  roots: max " + length_text(d.root_max) +
         (d.root_max > 0 ? fmt::format(" in frame {}, strand {}\n", d.root_frame, d.root_strand) : std::string("\n"));
  return out + lengths_line("a", d.lengths_a) + lengths_line("b", d.lengths_b);
}

}  // namespace ft::inline baker
