// Comparison of caches: see compare.h.
#include "baker/commands/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "baker/commands/compare_report.h"
#include "baker/core/file.h"

namespace ft::inline baker {
namespace {

struct Difference {
  double max = 0, square_sum = 0;
  int vertex = -1;
};

Difference difference(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b, std::vector<float>* distances) {
  Difference d;
  if (distances != nullptr) distances->clear();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double square = (a[i].cast<double>() - b[i].cast<double>()).squaredNorm(), distance = std::sqrt(square);
    d.square_sum += square;
    if (distance > d.max) {
      d.max = distance;
      d.vertex = static_cast<int>(i);
    }
    if (distances != nullptr) distances->push_back(static_cast<float>(distance));
  }
  return d;
}

/// Why the two cannot be compared; empty when they can.
std::string mismatch(const CacheInfo& a, const CacheInfo& b) {
  if (a.content.shape != b.content.shape)
    return fmt::format("another shape: {} against {}", shape_name(a.content.shape), shape_name(b.content.shape));
  if (a.content.shape == OutputShape::k_mesh && a.vertex_count != b.vertex_count)
    return fmt::format("another topology: {} vertices against {}", a.vertex_count, b.vertex_count);
  if (a.has_topology && b.has_topology) {
    if (a.mesh.face_count() != b.mesh.face_count())
      return fmt::format("another topology: {} faces against {}", a.mesh.face_count(), b.mesh.face_count());
    if (a.mesh.face_sizes != b.mesh.face_sizes || a.mesh.face_vertices != b.mesh.face_vertices)
      return "another topology: the faces connect other vertices";
  }
  const auto range = [](const CacheInfo& i) {
    return i.frame_count == 0 ? std::string("no frames")
                              : fmt::format("frames {}-{}", i.first_frame, i.first_frame + i.frame_count - 1);
  };
  if (a.first_frame != b.first_frame || a.frame_count != b.frame_count)
    return fmt::format("another frame range: {} against {}", range(a), range(b));
  if (a.has_fps && b.has_fps && std::abs(a.fps - b.fps) > 1e-9 * a.fps)
    return fmt::format("another frame rate: {} fps against {}", a.fps, b.fps);
  return {};
}

CompareReport incomparable(std::string system, const std::filesystem::path& a, const std::filesystem::path& b,
                           std::string reason) {
  CompareReport r;
  r.system = std::move(system);
  r.a = a.string();
  r.b = b.string();
  r.verdict = CompareVerdict::k_incomparable;
  r.reason = std::move(reason);
  return r;
}

struct Tolerances {
  double metres, degrees;
};

/// Meshes of constant topology, instances, curves and points can be compared.
Result<std::unique_ptr<CacheReader>> open_comparable(const std::filesystem::path& path) {
  auto reader = open_cache_of_any_shape(path);
  const auto holds = [&](OutputShape shape) { return reader && (*reader)->info().content.shape == shape; };
  if (holds(OutputShape::k_instances) || holds(OutputShape::k_curves) || holds(OutputShape::k_points)) return reader;
  return open_cache(path);
}

CompareReport compare_files(const std::filesystem::path& a, const std::filesystem::path& b, Tolerances tolerance) {
  auto reader_a = open_comparable(a);
  if (!reader_a) return incomparable(a.stem().string(), a, b, reader_a.error().text());
  auto reader_b = open_comparable(b);
  if (!reader_b) return incomparable(a.stem().string(), a, b, reader_b.error().text());
  CompareReport r = compare_caches(**reader_a, **reader_b, tolerance.metres, tolerance.degrees);
  r.system = a.stem().string();
  r.a = a.string();
  r.b = b.string();
  return r;
}

/// Caches in a folder: system -> files, both sorted.
std::map<std::string, std::vector<std::filesystem::path>> caches_in(const std::filesystem::path& folder) {
  std::map<std::string, std::vector<std::filesystem::path>> out;
  std::error_code error;
  for (std::filesystem::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    const auto extension = i->path().extension().string();
    for (const CacheFormat& f : cache_formats())
      if (extension == f.extension) out[i->path().stem().string()].push_back(i->path());
  }
  for (auto& [system, files] : out) std::sort(files.begin(), files.end());
  return out;
}

std::vector<CompareReport> compare_folders(const std::filesystem::path& a, const std::filesystem::path& b,
                                           Tolerances tolerance) {
  std::vector<CompareReport> reports;
  const auto in_a = caches_in(a), in_b = caches_in(b);
  for (const auto& [system, files] : in_a) {
    const auto twin = in_b.find(system);
    if (twin == in_b.end()) {
      reports.push_back(incomparable(system, files.front(), b, "no cache of this name in " + b.string()));
      continue;
    }
    for (const auto& file : files) {
      // The same format where there is one, else whatever the other folder has of this system.
      const auto same = std::find(twin->second.begin(), twin->second.end(), b / file.filename());
      reports.push_back(compare_files(file, same != twin->second.end() ? *same : twin->second.front(), tolerance));
    }
  }
  for (const auto& [system, files] : in_b)
    if (!in_a.contains(system))
      reports.push_back(incomparable(system, a, files.front(), "no cache of this name in " + a.string()));
  if (reports.empty()) reports.push_back(incomparable(a.filename().string(), a, b, "no caches in either folder"));
  std::stable_sort(reports.begin(), reports.end(), [](const auto& x, const auto& y) { return x.system < y.system; });
  return reports;
}

}  // namespace

int CompareReport::diverging_count() const {
  return static_cast<int>(
      std::count_if(frames.begin(), frames.end(), [&](const FrameDifference& f) { return diverges(f); }));
}

std::string CompareReport::element(int index) const {
  if (curves) return curves->element(index);
  if (points) return "point " + (index < 0 ? std::string("-") : std::to_string(points->ids[at(index)]));
  if (!instances) return "vertex " + std::to_string(index);
  return "instance " + (index < 0 ? std::string("-") : std::to_string(instances->ids[at(index)]));
}

void CompareReport::add(const FrameDifference& frame, std::vector<Vec3f> places, std::vector<float> distances,
                        bool is_last) {
  const int index = static_cast<int>(frames.size());
  const bool is_worst = frame.max > (worst < 0 ? 0 : frames[at(worst)].max);
  if (is_worst) worst = index;
  if (is_worst || (worst < 0 && is_last)) {
    picture_positions = std::move(places);
    picture_distances = std::move(distances);
  }
  if (first_diverging < 0 && diverges(frame)) first_diverging = index;
  frames.push_back(frame);
}

CompareReport compare_caches(CacheReader& a, CacheReader& b, double tolerance, double degrees) {
  const CacheInfo &info_a = a.info(), &info_b = b.info();
  CompareReport r;
  r.system = info_a.system;
  r.tolerance = tolerance;
  r.vertex_count = info_a.vertex_count;
  r.first_frame = info_a.first_frame;
  r.velocities = info_a.has_velocity && info_b.has_velocity;
  const double fps = info_a.has_fps ? info_a.fps : info_b.fps;
  r.speed_tolerance = tolerance * fps;
  r.turn_tolerance = degrees;
  r.spin_tolerance = degrees * fps;
  const auto give_up = [&](std::string reason) {
    r.verdict = CompareVerdict::k_incomparable;
    r.reason = std::move(reason);
    return r;
  };
  if (std::string reason = mismatch(info_a, info_b); !reason.empty()) return give_up(std::move(reason));
  if (info_a.content.shape == OutputShape::k_instances) {
    if (const Status s = compare_instances(a, b, r); !s) return give_up(s.error().text());
    return r;
  }
  if (info_a.content.shape == OutputShape::k_curves) {
    if (const Status s = compare_curves(a, b, r); !s) return give_up(s.error().text());
    return r;
  }
  if (info_a.content.shape == OutputShape::k_points) {
    if (const Status s = compare_points(a, b, r); !s) return give_up(s.error().text());
    return r;
  }

  double square_sum = 0;
  FrameData x_a, x_b;
  std::vector<float> distances;
  r.scalars = paired_scalars(info_a, info_b);
  for (int i = 0; i < info_a.frame_count; ++i) {
    if (const Status s = a.read(i, x_a); !s) return give_up(s.error().text());
    if (const Status s = b.read(i, x_b); !s) return give_up(s.error().text());
    const Difference d = difference(x_a.positions, x_b.positions, &distances);
    FrameDifference f;
    f.frame = r.first_frame + i;
    f.max = d.max;
    f.rms = distances.empty() ? 0 : std::sqrt(d.square_sum / static_cast<double>(distances.size()));
    f.vertex = d.vertex;
    square_sum += d.square_sum;
    if (r.velocities) {
      const Difference v = difference(x_a.velocities, x_b.velocities, nullptr);
      f.max_speed = v.max;
      f.speed_vertex = v.vertex;
    }
    compare_scalars(x_a, x_b, r.scalars, f);
    r.add(f, x_b.positions, distances, i + 1 == info_a.frame_count);
  }
  const double count = static_cast<double>(r.frames.size()) * r.vertex_count;
  r.rms = count > 0 ? std::sqrt(square_sum / count) : 0;
  r.verdict = r.first_diverging < 0 ? CompareVerdict::k_equal : CompareVerdict::k_different;
  return r;
}

std::vector<CompareReport> compare_paths(const std::filesystem::path& a, const std::filesystem::path& b, double metres,
                                         double degrees) {
  const Tolerances tolerance{metres, degrees};
  std::error_code ignored;
  const bool folder_a = std::filesystem::is_directory(a, ignored), folder_b = std::filesystem::is_directory(b, ignored);
  if (folder_a && folder_b) return compare_folders(a, b, tolerance);
  if (folder_a != folder_b && std::filesystem::exists(folder_a ? b : a, ignored))
    return {incomparable(a.stem().string(), a, b, "one is a folder, the other is a file")};
  return {compare_files(a, b, tolerance)};
}

CompareVerdict overall_verdict(const std::vector<CompareReport>& reports) {
  CompareVerdict worst = CompareVerdict::k_equal;
  for (const CompareReport& r : reports) worst = std::max(worst, r.verdict);
  return worst;
}

int exit_code(CompareVerdict verdict) {
  return verdict == CompareVerdict::k_equal       ? 0
         : verdict == CompareVerdict::k_different ? 1
                                                  : exit_code(ErrorKind::k_input);
}

int run_compare(const CompareOptions& options) {
  if (!(options.tolerance >= 0) || !std::isfinite(options.tolerance)) {
    fmt::print(stderr, "--tolerance must be a distance in metres, 0 or more\n");
    return exit_code(ErrorKind::k_usage);
  }
  if (!(options.degrees >= 0) || !std::isfinite(options.degrees)) {
    fmt::print(stderr, "--degrees must be an angle in degrees, 0 or more\n");
    return exit_code(ErrorKind::k_usage);
  }
  const auto reports = compare_paths(options.a, options.b, options.tolerance, options.degrees);
  std::vector<ForceComparison> forces;  // of folders that are bakes
  std::vector<PathComparison> paths;
  if (const auto a = read_manifest(options.a), b = read_manifest(options.b); a && b) {
    forces = compare_forces(*a, *b);
    if (const auto in_a = primary_paths(options.a, *a), in_b = primary_paths(options.b, *b); in_a && in_b)
      paths = compare_primaries(*in_a, *a, *in_b, *b);
  }
  fmt::print("{}{}{}", compare_text(reports), to_text(paths), to_text(forces));
  Status status;
  if (!options.json.empty()) status = write_text_durably(options.json, compare_json(reports, forces, paths));
  if (status && !options.html.empty()) status = write_text_durably(options.html, compare_html(reports));
  if (status && !options.junit.empty()) status = write_text_durably(options.junit, compare_junit(reports));
  if (!status) {
    fmt::print(stderr, "{}\n", status.error().text());
    return exit_code(status.error().kind);
  }
  return exit_code(overall_verdict(reports));
}

}  // namespace ft::inline baker
