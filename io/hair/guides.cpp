#include "io/hair/guides.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "baker/core/file.h"
#include "io/cache/alembic_curve_sets.h"
#include "io/hair/obj_lines.h"
#include "io/hair/resample.h"
#include "io/hair/tfx_read.h"
#include "io/shot/mesh_file.h"

namespace ft::inline io {
namespace {

constexpr std::uint64_t k_most_obj_bytes = std::uint64_t{1} << 30;
constexpr int k_most_vertices = 2'000'000;  ///< of a hair mesh: its largest piece is solved at once
constexpr double k_farthest = 1e6;          ///< from the origin: beyond this the scale is wrong, or the file is [m]

Result<GuideSet> from_tfx(const std::filesystem::path& file) {
  GuideSet out;
  auto strands = read_tfx(file, out.notes);
  if (!strands) return strands.error();
  out.strands = std::move(*strands);
  return out;
}

Result<GuideSet> from_obj(const std::filesystem::path& file, double scale, std::span<const Vec3> scalp) {
  const auto data = read_file(file, k_most_obj_bytes);
  if (!data) return data.error();
  const std::string_view text(reinterpret_cast<const char*>(data->data()), data->size());
  GuideSet out;
  if (has_obj_lines(text)) {
    auto strands = parse_obj_lines(text, file.string(), out.notes);
    if (!strands) return strands.error();
    out.strands = std::move(*strands);
    return out;
  }
  auto mesh = parse_obj(text, file.string());
  if (!mesh) return mesh.error();
  if (mesh->face_sizes.empty())
    return input_error("holds no curves", file.string(), "guides are lines (l elements) or a mesh of cards and tubes");
  if (mesh->vertex_count() > k_most_vertices)
    return input_error(fmt::format("has {} vertices; a hair mesh may have {}", mesh->vertex_count(), k_most_vertices),
                       file.string(), "give lines");
  for (Vec3& p : mesh->positions) {
    p *= scale;
    if (!(p.cwiseAbs().maxCoeff() <= k_farthest))
      return input_error("has a vertex more than 1000 km from the origin", file.string(), "look at the scale");
  }
  MiddleLines lines = middle_lines(*mesh, scalp);
  if (lines.strands.empty())
    return input_error("holds no curves: none of its pieces is a strip or a tube" +
                           (lines.notes.empty() ? std::string() : "; " + lines.notes.front()),
                       file.string(), "join vertices that lie at one place, or give lines");
  out.strands = std::move(lines.strands);
  out.riders = std::move(lines.riders);
  out.notes = std::move(lines.notes);
  out.ridden = std::move(*mesh);
  out.ridden.name = file.stem().string();
  return out;
}

Result<GuideSet> from_abc(const std::filesystem::path& file, double scale) {
  const auto objects = read_alembic_curve_sets(file);
  if (!objects) return objects.error();
  GuideSet out;
  int smooth = 0;
  bool all_have_widths = true;
  for (const CurveObject& object : *objects) {
    const CurveSet& curves = object.curves;
    smooth += object.linear ? 0 : curves.curve_count();
    const bool for_each = curves.widths.size() == curves.vertices_per_curve.size();
    const bool for_each_vertex = curves.widths.size() == curves.rest.size();
    all_have_widths = all_have_widths && !curves.widths.empty();
    std::size_t v = 0;
    for (std::size_t c = 0; c < curves.vertices_per_curve.size(); ++c) {
      const std::size_t end = v + at(curves.vertices_per_curve[c]);
      out.strands.emplace_back(curves.rest.begin() + static_cast<std::ptrdiff_t>(v),
                               curves.rest.begin() + static_cast<std::ptrdiff_t>(end));
      if (!curves.widths.empty())
        out.widths.push_back(scale * double{curves.widths[for_each ? c : for_each_vertex ? v : 0]});
      v = end;
    }
  }
  if (!all_have_widths) out.widths.clear();
  if (smooth > 0) out.notes.push_back(fmt::format("{} smooth curves are taken by their control points", smooth));
  return out;
}

/// Into metres, without vertices twice in a row and without strands that are too short.
Status finish(GuideSet& set, const std::filesystem::path& file, double scale) {
  std::size_t short_count = 0, kept = 0;
  double shortest = k_shortest_strand;
  for (std::size_t s = 0; s < set.strands.size(); ++s) {
    auto& strand = set.strands[s];
    for (Vec3& p : strand) {
      p *= scale;
      if (!(p.cwiseAbs().maxCoeff() <= k_farthest))
        return input_error(fmt::format("has a strand more than 1000 km from the origin: {}, from 0", s), file.string(),
                           "look at the scale");
    }
    strand.erase(std::unique(strand.begin(), strand.end()), strand.end());
    if (const double length = length_of(strand); length < k_shortest_strand) {
      ++short_count, shortest = std::min(shortest, length);
      continue;
    }
    if (!set.widths.empty()) set.widths[kept] = set.widths[s];
    if (kept != s) set.strands[kept] = std::move(strand);
    ++kept;
  }
  set.strands.resize(kept);
  if (!set.widths.empty()) set.widths.resize(kept);
  if (kept == 0)
    return input_error(fmt::format("holds no curves of 1 mm or more: {} are shorter", short_count), file.string(),
                       "look at the scale");
  if (short_count > 0)
    set.notes.push_back(
        fmt::format("{} strands are shorter than 1 mm (the shortest {:.2g} m) and left out", short_count, shortest));
  return {};
}

}  // namespace

Result<GuideSet> read_guides(const std::filesystem::path& file, double scale, std::span<const Vec3> scalp) {
  CHECK(scale > 0 && std::isfinite(scale));
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  const bool obj = extension == ".obj";
  if (!obj && extension != ".tfx" && extension != ".abc")
    return input_error("is no file of guides that can be read", file.string(), "guides are .tfx, .obj or .abc");
  Result<GuideSet> out = obj                   ? from_obj(file, scale, scalp)
                         : extension == ".tfx" ? from_tfx(file)
                                               : from_abc(file, scale);
  if (!out || !out->ridden.positions.empty()) return out;  // a hair mesh is in metres
  if (const Status status = finish(*out, file, scale); !status) return status.error();
  return out;
}

}  // namespace ft::inline io
