// Found in space and in time. In space: more than half of a vertex's edges are many times as long as they are in the
// middle of the clip (its neighbours have one long edge out of six). In time: it is back within a few samples, and is
// far from where it would be if it had kept its place among its neighbours meanwhile. Caution: skin stretches, eyelids
// and lips open along edges that had no length, limbs kick, and whole bodies jump; none of these must count.
#include "io/import/repair/stray_vertices.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

#include "baker/core/parallel.h"

namespace ft::inline io {
namespace {

constexpr float k_torn = 8;                    ///< times its length elsewhere in the clip: an edge that is torn
constexpr double k_least_distance = 0.02;      ///< of the body's size: what is nearer to its place is let be
constexpr int k_longest_run = 8;               ///< samples that are bridged
constexpr std::size_t k_reference_count = 31;  ///< samples whose median is an edge's length
constexpr float k_max_coordinate = 1e9f;

bool is_place(const Vec3f& p) {
  return p.allFinite() && p.cwiseAbs().maxCoeff() <= k_max_coordinate;
}

/// The lower median of what `measure` says of samples all over the clip; infinite ones are left out. 0 without any.
template <class Measure>
float median_over_clip(std::size_t sample_count, Measure&& measure) {
  const std::size_t count = std::min(sample_count, k_reference_count);
  float values[k_reference_count];
  std::size_t known = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const float value = measure(count == 1 ? 0 : k * (sample_count - 1) / (count - 1));
    if (std::isfinite(value)) values[known++] = value;
  }
  if (known == 0) return 0;
  std::nth_element(values, values + (known - 1) / 2, values + known);
  return values[(known - 1) / 2];
}

class Mender {
 public:
  explicit Mender(GeometryCache& cache)
      : cache_(cache),
        edges_(unique_edges(triangulate(cache.mesh))),
        neighbours_(vertex_neighbours(at(cache.vertex_count), edges_)) {
    const std::size_t samples = cache_.times.size();
    lengths_.resize(edges_.size());
    parallel_for(edges_.size(), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e)
        lengths_[e] = median_over_clip(samples, [&](std::size_t s) { return length(s, edges_[e]); });
    });
    size_ = static_cast<double>(median_over_clip(samples, [&](std::size_t s) {
      Box box;
      for (const Vec3f& p : cache_.sample(s))
        if (is_place(p)) box.include(p.cast<double>());
      return box.empty() ? std::numeric_limits<float>::infinity() : static_cast<float>(box.size().maxCoeff());
    }));
  }

  std::vector<StrayVertex> find() const;
  /// Puts those back that are to be mended; drops those that were near enough to their places after all.
  void mend(std::vector<StrayVertex>& strays);

 private:
  struct Task {
    std::size_t stray = 0;
    int sample = 0;
    Vec3f before = Vec3f::Zero(), place = Vec3f::Zero();
  };

  float length(std::size_t sample, const Edge& e) const {
    const auto x = cache_.sample(sample);
    const Vec3f &a = x[at(e[0])], &b = x[at(e[1])];
    return is_place(a) && is_place(b) ? (a - b).norm() : std::numeric_limits<float>::infinity();
  }
  std::vector<int> suspects(std::size_t sample) const;
  std::size_t index(int sample, int vertex) const { return at(sample) * at(cache_.vertex_count) + at(vertex); }
  Vec3 position(int sample, int vertex) const { return cache_.positions[index(sample, vertex)].cast<double>(); }
  bool place_among_neighbours(const StrayVertex& stray, Task& task, bool without_any) const;

  GeometryCache& cache_;
  std::vector<Edge> edges_;
  Adjacency neighbours_;
  std::vector<float> lengths_;  ///< of each edge, in most of the clip [file units]
  double size_ = 0;             ///< file units
  std::vector<char> bad_;       ///< per sample and vertex, while mending
};

/// Vertices that are not finite or torn out, ascending.
std::vector<int> Mender::suspects(std::size_t sample) const {
  const auto x = cache_.sample(sample);
  std::vector<int> torn(x.size(), 0), all(x.size(), 0), out;
  const auto least = static_cast<float>(k_least_distance * size_);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const float now = length(sample, edges_[e]);
    if (!std::isfinite(now)) continue;
    for (const int v : edges_[e]) ++all[at(v)], torn[at(v)] += now > k_torn * lengths_[e] && now > least;
  }
  for (std::size_t v = 0; v < x.size(); ++v)
    if (!is_place(x[v]) || 2 * torn[v] > all[v]) out.push_back(static_cast<int>(v));
  return out;
}

std::vector<StrayVertex> Mender::find() const {
  std::vector<std::vector<int>> found(cache_.times.size());
  parallel_tasks(found.size(), [&](std::size_t s) { found[s] = suspects(s); });
  std::vector<std::pair<int, int>> by_vertex;
  for (std::size_t s = 0; s < found.size(); ++s)
    for (const int v : found[s]) by_vertex.emplace_back(v, static_cast<int>(s));
  std::sort(by_vertex.begin(), by_vertex.end());
  std::vector<StrayVertex> out;
  for (const auto& [vertex, sample] : by_vertex) {
    if (out.empty() || out.back().vertex != vertex || out.back().last_sample != sample - 1)
      out.push_back({vertex, sample, sample});
    out.back().last_sample = sample;
    out.back().finite = out.back().finite && is_place(cache_.positions[index(sample, vertex)]);
  }
  for (StrayVertex& s : out) s.mended = s.last_sample - s.first_sample < k_longest_run;
  std::sort(out.begin(), out.end(), [](const StrayVertex& a, const StrayVertex& b) {
    return std::tie(a.first_sample, a.last_sample, a.vertex) < std::tie(b.first_sample, b.last_sample, b.vertex);
  });
  return out;
}

/// The mean of the neighbours that are where they should be, and to it the vertex's offset from them before and
/// afterwards; without such neighbours, if asked to, the way from its place before to that afterwards.
bool Mender::place_among_neighbours(const StrayVertex& stray, Task& task, bool without_any) const {
  const int samples = static_cast<int>(cache_.times.size());
  const int before = stray.first_sample > 0 ? stray.first_sample - 1 : stray.last_sample + 1;
  const int after = stray.last_sample + 1 < samples ? stray.last_sample + 1 : stray.first_sample - 1;
  const auto time = [&](int sample) { return cache_.times[at(sample)]; };
  const double weight = before == after ? 0 : (time(task.sample) - time(before)) / (time(after) - time(before));
  Vec3 now = Vec3::Zero(), then = Vec3::Zero();
  int count = 0;
  for (const int n : neighbours_.row(stray.vertex)) {
    if (bad_[index(task.sample, n)] || bad_[index(before, n)] || bad_[index(after, n)]) continue;
    now += position(task.sample, n);
    then += (1 - weight) * position(before, n) + weight * position(after, n);
    ++count;
  }
  if (count == 0 && !without_any) return false;
  Vec3 place = (1 - weight) * position(before, stray.vertex) + weight * position(after, stray.vertex);
  if (count > 0) place += (now - then) / count;
  task.place = place.cast<float>();
  return true;
}

void Mender::mend(std::vector<StrayVertex>& strays) {
  bad_.assign(cache_.positions.size(), 0);
  std::vector<Task> tasks;
  for (std::size_t i = 0; i < strays.size(); ++i)
    for (int s = strays[i].first_sample; s <= strays[i].last_sample && strays[i].mended; ++s) {
      bad_[index(s, strays[i].vertex)] = 1;
      tasks.push_back({i, s, cache_.positions[index(s, strays[i].vertex)], Vec3f::Zero()});
    }
  // From the rim of what strays inwards: what was put back is a neighbour for the next.
  std::vector<std::size_t> open(tasks.size()), ready;
  std::iota(open.begin(), open.end(), 0);
  while (!open.empty()) {
    ready.clear();
    for (const bool without_any : {false, true}) {
      if (!ready.empty()) break;
      for (const std::size_t k : open)
        if (place_among_neighbours(strays[tasks[k].stray], tasks[k], without_any)) ready.push_back(k);
    }
    for (const std::size_t k : ready) {
      const std::size_t i = index(tasks[k].sample, strays[tasks[k].stray].vertex);
      cache_.positions[i] = tasks[k].place;
      bad_[i] = 0;
    }
    std::erase_if(open, [&](std::size_t k) { return std::binary_search(ready.begin(), ready.end(), k); });
  }
  for (const Task& task : tasks) {
    StrayVertex& stray = strays[task.stray];
    if (stray.finite) stray.distance = std::max(stray.distance, static_cast<double>((task.place - task.before).norm()));
  }
  const auto is_near = [&](const StrayVertex& s) {
    return s.mended && s.finite && s.distance < k_least_distance * size_;
  };
  for (const Task& task : tasks)
    if (is_near(strays[task.stray])) cache_.positions[index(task.sample, strays[task.stray].vertex)] = task.before;
  std::erase_if(strays, is_near);
}

}  // namespace

Result<std::vector<StrayVertex>> mend_stray_vertices(GeometryCache& cache, const std::string& file) {
  Mender mender(cache);
  std::vector<StrayVertex> strays = mender.find();
  if (strays.empty()) return strays;
  const int last = static_cast<int>(cache.times.size()) - 1;
  for (const StrayVertex& s : strays) {
    if (s.finite) continue;
    if (s.mended && (s.first_sample > 0 || s.last_sample < last)) continue;
    return input_error(
        fmt::format("vertex {} is not a finite position, or is beyond 1e9, in samples {} to {} of 0 to {}", s.vertex,
                    s.first_sample, s.last_sample, last),
        file, fmt::format("up to {} samples are mended; export the cache again", k_longest_run));
  }
  for (StrayVertex& s : strays) s.mended = s.mended && (s.first_sample > 0 || s.last_sample < last);
  mender.mend(strays);
  return strays;
}

namespace {

/// "sample 57", "frames 1011 to 1013".
std::string range_text(const char* what, double first, double last) {
  return first == last ? fmt::format("{} {:g}", what, first) : fmt::format("{}s {:g} to {:g}", what, first, last);
}

/// What is wrong with some vertices over the same samples, and what was done. `first`: one of them.
std::string fault_text(const StrayVertex& first, bool one, double distance) {
  const std::string their = one ? "its" : "their", are = one ? "is" : "are";
  if (!first.finite) return one ? "has no finite position" : "have no finite positions";
  if (!first.mended) return are + " away from " + their + " neighbours";
  return fmt::format("{} up to {:.3g} m away from {} neighbours", are, distance, their);
}

std::string remedy_text(const StrayVertex& first, bool one) {
  if (!first.mended) return "for too long to be mended; look at these frames";
  return first.finite ? "put back among them"
         : one        ? "put back among its neighbours"
                      : "put back among their neighbours";
}

}  // namespace

std::vector<std::string> stray_notes(std::span<const StrayVertex> strays, const std::string& file,
                                     double metres_per_unit, const std::function<double(int)>& frame_of,
                                     std::size_t most) {
  std::vector<std::string> out;
  std::size_t groups = 0;
  for (std::size_t begin = 0, end = 0; begin < strays.size(); begin = end) {
    const StrayVertex& first = strays[begin];
    const auto alike = [&](const StrayVertex& s) {
      return s.first_sample == first.first_sample && s.last_sample == first.last_sample && s.finite == first.finite &&
             s.mended == first.mended;
    };
    std::string vertices;
    double distance = 0;
    for (; end < strays.size() && alike(strays[end]); ++end) {
      distance = std::max(distance, metres_per_unit * strays[end].distance);
      if (end - begin < 3) vertices += (end > begin ? ", " : "") + std::to_string(strays[end].vertex);
    }
    if (++groups > most) continue;
    const std::size_t count = end - begin;
    const std::string who = count == 1 ? "vertex " + vertices
                                       : fmt::format("{} vertices ({}{})", count, vertices, count > 3 ? ", ..." : "");
    out.push_back(
        fmt::format("{}: {} {} at {} ({} of the file): {}", file, who, fault_text(first, count == 1, distance),
                    range_text("frame", frame_of(first.first_sample), frame_of(first.last_sample)),
                    range_text("sample", first.first_sample, first.last_sample), remedy_text(first, count == 1)));
  }
  if (groups > most) out.push_back(fmt::format("{}: {} more such places", file, groups - most));
  return out;
}

}  // namespace ft::inline io
