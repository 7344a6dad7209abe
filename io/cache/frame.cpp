// What is checked of a cache and its frames before a byte is written: see frame.h. What is ours to get right is a bug,
// what a solver may come to is divergence.
#include "io/cache/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/cache/cache.h"

namespace ft::inline io {
namespace {

template <class T>
bool has_twins(std::span<const T> values) {
  if (std::adjacent_find(values.begin(), values.end(), [](T a, T b) { return a >= b; }) == values.end()) return false;
  std::vector<T> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
}

std::string fault_of_attribute(const CacheAttribute& a, std::size_t each_count, std::size_t vertex_count) {
  const std::size_t wanted[] = {1, each_count, vertex_count};
  const std::size_t count = std::visit([](const auto& v) { return v.size(); }, a.values);
  if (a.name.empty()) return "an attribute has no name";
  if (count != wanted[static_cast<std::size_t>(a.scope)])
    return fmt::format("attribute \"{}\" has {} values for {}", a.name, count,
                       wanted[static_cast<std::size_t>(a.scope)]);
  return {};
}

std::string fault_of_curves(const CurveSet& c) {
  std::uint64_t vertices = 0;
  for (const int n : c.vertices_per_curve) {
    if (n < 2) return fmt::format("a curve has {} vertices", n);
    vertices += static_cast<std::uint64_t>(n);
  }
  if (vertices != c.rest.size()) return fmt::format("{} vertices in curves of {}", c.rest.size(), vertices);
  const std::size_t curves = c.vertices_per_curve.size(), widths = c.widths.size();
  if (widths > 1 && widths != curves && widths != vertices)
    return fmt::format("{} widths for {} curves of {} vertices", widths, curves, vertices);
  if (!c.ids.empty() && c.ids.size() != curves) return fmt::format("{} ids for {} curves", c.ids.size(), curves);
  for (const std::uint64_t id : c.ids)
    if (id > std::numeric_limits<std::int32_t>::max()) return fmt::format("the id {} of a curve is too large", id);
  if (has_twins(std::span(c.ids))) return "two curves have the same id";
  return {};
}

std::string fault_of_instances(const InstanceSet& s) {
  if (s.prototypes.size() != s.ids.size())
    return fmt::format("{} prototypes for {} instances", s.prototypes.size(), s.ids.size());
  for (const int p : s.prototypes)
    if (p < 0 || at(p) >= s.prototype_names.size()) return fmt::format("there is no prototype {}", p);
  if (has_twins(std::span(s.ids))) return "two instances have the same id";
  return {};
}

std::string fault_of_scalars(std::span<const std::string> names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty() || names[i].find('/') != std::string::npos || names[i].find('\0') != std::string::npos)
      return fmt::format("\"{}\" is no name for scalars", names[i]);
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
        names.begin() + static_cast<std::ptrdiff_t>(i))
      return fmt::format("there are two scalars \"{}\"", names[i]);
  }
  return {};
}

/// All checks of one frame share where they are.
class FrameCheck {
 public:
  FrameCheck(const CacheInfo& info, int frame_index)
      : where_(fmt::format("frame {}, {}", info.first_frame + frame_index, info.system)) {}

  Status status;

  void count(std::string_view what, std::size_t found, std::size_t wanted) {
    if (status && found != wanted) bug(fmt::format("{} {} for {}", found, what, wanted));
  }
  void finite(std::string_view what, std::span<const Vec3f> values) {
    for (std::size_t i = 0; status && i < values.size(); ++i)
      if (!values[i].allFinite()) diverged(fmt::format("{} is not finite", what), i);
  }
  void turns(std::span<const Eigen::Quaternionf> values) {
    // Float holds a length of 1 to 1e-7; whoever is off by more than 1e-4 has forgotten to normalise.
    for (std::size_t i = 0; status && i < values.size(); ++i)
      if (!(std::abs(values[i].squaredNorm() - 1) < 2e-4f)) diverged("orientation is not of length 1", i);
  }
  void widths(std::span<const float> values) {
    for (std::size_t i = 0; status && i < values.size(); ++i)
      if (!(std::isfinite(values[i]) && values[i] >= 0)) diverged("width is not finite or negative", i);
  }
  void numbers(std::string_view what, std::span<const float> values) {
    for (std::size_t i = 0; status && i < values.size(); ++i)
      if (!std::isfinite(values[i])) diverged(fmt::format("\"{}\" is not finite", what), i);
  }
  void bug(std::string what) { status = Error{ErrorKind::k_bug, std::move(what), where_, {}}; }

 private:
  void diverged(std::string what, std::size_t vertex) {
    status = Error{ErrorKind::k_diverged, std::move(what), fmt::format("{}, vertex {}", where_, vertex), {}};
  }
  std::string where_;
};

}  // namespace

Status check_rest(const CacheInfo& info) {
  std::string fault;
  const bool curves = info.content.shape == OutputShape::k_curves;
  const bool instances = info.content.shape == OutputShape::k_instances;
  const std::size_t each = curves ? info.curves.vertices_per_curve.size() : info.instances.ids.size();
  if (curves) fault = fault_of_curves(info.curves);
  if (instances) fault = fault_of_instances(info.instances);
  if (!curves && !instances && !info.attributes.empty())
    fault = fmt::format("{} with attributes", shape_name(info.content.shape));
  if (fault.empty()) fault = fault_of_scalars(info.content.scalars);
  for (const CacheAttribute& a : info.attributes)
    if (fault.empty()) fault = fault_of_attribute(a, each, curves ? info.curves.rest.size() : each);
  if (fault.empty()) return {};
  return Error{ErrorKind::k_bug, std::move(fault), info.system, {}};
}

Status check_frame(const CacheFrame& f, const CacheInfo& info, int frame_index, bool velocities) {
  const FrameContent& c = info.content;
  const bool points = c.shape == OutputShape::k_points, instances = c.shape == OutputShape::k_instances;
  const bool faces = c.shape == OutputShape::k_mesh && c.changes;
  const std::size_t count = points || c.changes ? f.positions.size() : static_cast<std::size_t>(info.vertex_count);
  FrameCheck check(info, frame_index);
  check.count("values", f.positions.size(), count);
  check.finite("position", f.positions);
  check.count("velocities", f.velocities.size(), velocities ? count : 0);
  check.finite("velocity", f.velocities);
  check.count("ids", f.ids.size(), points ? count : 0);
  check.count("widths", f.widths.size(), points && c.widths ? count : 0);
  check.widths(f.widths);
  check.count("orientations", f.orientations.size(), instances ? count : 0);
  check.turns(f.orientations);
  check.count("angular velocities", f.angular_velocities.size(), instances && c.angular_velocities ? count : 0);
  check.finite("angular velocity", f.angular_velocities);
  check.count("scales", f.scales.size(), instances && c.scales ? count : 0);
  check.finite("scale", f.scales);
  check.count("scalars", f.scalars.size(), c.scalars.size());
  for (std::size_t i = 0; check.status && i < c.scalars.size(); ++i) {
    check.count(fmt::format("values of \"{}\"", c.scalars[i]), f.scalars[i].size(), count);
    check.numbers(c.scalars[i], f.scalars[i]);
  }
  if (check.status && has_twins(f.ids)) check.bug("two points have the same id");
  if (!faces) {
    check.count("faces", f.face_sizes.size() + f.face_vertices.size(), 0);
  } else if (check.status) {
    std::string fault = fault_of_faces(f.face_sizes, f.face_vertices, count);
    if (!fault.empty()) check.bug(std::move(fault));
  }
  return check.status;
}

std::string fault_of_faces(std::span<const int> sizes, std::span<const int> corners, std::size_t vertex_count) {
  std::uint64_t total = 0;
  for (const int n : sizes) {
    if (n < 3) return "a face with " + std::to_string(n) + " corners";
    total += static_cast<std::uint64_t>(n);
  }
  if (total != corners.size()) return "face sizes do not add up";
  for (const int v : corners)
    if (v < 0 || static_cast<std::size_t>(v) >= vertex_count) return "a face uses vertex " + std::to_string(v);
  return {};
}

}  // namespace ft::inline io
