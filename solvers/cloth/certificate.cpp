#include "solvers/cloth/certificate.h"

#include <algorithm>
#include <string>
#include <vector>

#include "baker/core/parallel.h"
#include "collision/crossings.h"
#include "collision/penetration.h"
#include "solvers/cloth/tangles.h"

namespace ft {
namespace {

constexpr std::size_t k_incidents_per_frame = 16;
/// Cloth that is less deep in the drawn body than this [m] is no incident.
constexpr double k_notable_depth = 1e-3;
/// A stitch that is open by less [m] is closed.
constexpr double k_open_stitch = 2e-3;

/// Something happened at a cloth vertex.
void add_incident(const ClothModel& model, const ClothMotion& m, Incident::Kind kind, int vertex, double depth,
                  std::string text, FrameReport& report) {
  const int garment = model.garment_of(vertex);
  Incident out;
  out.kind = kind;
  out.frame = report.frame;
  out.system = model.setup.garments[at(garment)].name;
  out.vertex = vertex - model.first_vertex[at(garment)];
  out.place = m.x[at(vertex)];
  out.depth = depth;
  out.text = std::move(text);
  report.incidents.push_back(std::move(out));
}

/// Incidents of some crossings, from all over the list and no vertex twice. text(crossing): what is crossed.
template <class Vertex, class Text>
void add_crossings(const ClothModel& model, const ClothMotion& m, std::span<const Crossing> crossings, Vertex&& vertex,
                   Text&& text, FrameReport& report) {
  std::vector<std::size_t> chosen;
  std::vector<char> seen(m.x.size(), 0);
  for (std::size_t c = 0; c < crossings.size(); ++c)
    if (char& known = seen[at(vertex(crossings[c]))]; known == 0) known = 1, chosen.push_back(c);
  const std::size_t room = k_incidents_per_frame - std::min(k_incidents_per_frame, report.incidents.size());
  const std::size_t count = std::min(room, chosen.size());
  for (std::size_t k = 0; k < count; ++k) {
    const Crossing& c = crossings[chosen[k * chosen.size() / count]];
    add_incident(model, m, Incident::Kind::k_crossing, vertex(c), 0, text(c), report);
  }
}

bool any_released_to(const ClothModel& model, int part, std::span<const int> cloth_vertices, const ClothMotion& m) {
  return std::any_of(cloth_vertices.begin(), cloth_vertices.end(),
                     [&](int v) { return model.may_pass(m.released[at(v)], part); });
}

/// Crossings with the feasible collider; notes which of its parts cloth crosses. Returns those that could have been
/// avoided.
int certify_body(const ClothModel& model, std::span<const Crossing> crossings, const ClothMotion& m,
                 std::vector<char>& touched, FrameReport& report) {
  const auto parts = model.collider->part_of_vertex();
  const auto& names = model.collider->trajectory().surface().parts;
  touched.assign(names.size(), 0);
  report.crossings_body = static_cast<int>(crossings.size());
  int avoidable = 0;
  for (const Crossing& c : crossings) {
    const int part = parts[at(c.edge_of_first ? c.triangle[0] : c.edge[0])];
    touched[at(part)] = 1;
    if (!any_released_to(model, part, c.edge_of_first ? std::span<const int>(c.edge) : c.triangle, m)) ++avoidable;
  }
  add_crossings(
      model, m, crossings, [](const Crossing& c) { return c.edge_of_first ? c.edge[0] : c.triangle[0]; },
      [&](const Crossing& c) {
        const int part = parts[at(c.edge_of_first ? c.triangle[0] : c.edge[0])];
        return "cloth crosses the collider's part " + names[at(part)].name;
      },
      report);
  return avoidable;
}

/// Crossings among the cloths; marks the tangles anew. Returns those that could have been avoided.
int certify_cloths(const ClothModel& model, std::span<const Crossing> own, ClothMotion& m, FrameReport& report) {
  report.crossings_self = static_cast<int>(own.size());
  int avoidable = 0;
  for (const Crossing& c : own)
    if (!among_tangled(c, m.tangled)) ++avoidable;
  add_crossings(
      model, m, own, [](const Crossing& c) { return c.edge[0]; },
      [&](const Crossing& c) {
        const int garment = model.garment_of(c.edge[0]), other = model.garment_of(c.triangle[0]);
        return garment == other ? std::string("cloth crosses itself")
                                : "cloth crosses \"" + model.setup.garments[at(other)].name + "\"";
      },
      report);
  mark_tangled(model, own, m.tangled);
  return avoidable;
}

/// A part holds the cloth again once none of the cloth that it let through crosses it or is inside it, or a smaller
/// part, for those let it through too.
void hold_again(const ClothModel& model, std::span<const Vec3> body, std::span<const char> touched, ClothMotion& m,
                FrameReport& report) {
  if (std::all_of(m.released.begin(), m.released.end(), [](int part) { return part < 0; })) return;
  const auto parts = model.collider->part_of_vertex();
  for (int part = 0; part < static_cast<int>(touched.size()); ++part) {
    std::vector<Vec3> through;
    std::vector<int> index;
    for (std::size_t i = 0; i < m.released.size(); ++i)
      if (m.released[i] == part) through.push_back(m.x[i]), index.push_back(static_cast<int>(i));
    if (through.empty()) continue;
    report.released_vertices += static_cast<int>(through.size());
    bool any_touched = false;
    for (std::size_t p = 0; p < touched.size(); ++p)
      any_touched = any_touched || (touched[p] && model.may_pass(part, static_cast<int>(p)));
    std::vector<Triangle> shell;
    for (const Triangle& t : model.collider->triangles())
      if (model.may_pass(part, parts[at(t[0])])) shell.push_back(t);
    double deepest = 0;
    int worst = index[0];
    for (const Penetration& p : penetrations(through, body, shell))
      if (p.depth > deepest) deepest = p.depth, worst = index[at(p.vertex)];
    add_incident(model, m, Incident::Kind::k_released, worst, deepest,
                 "no room: " + std::to_string(through.size()) + " vertices let through part " +
                     model.collider->trajectory().surface().parts[at(part)].name,
                 report);
    if (!any_touched && deepest == 0)
      for (const int i : index) m.released[at(i)] = -1;
  }
}

/// Where the cloth is inside the body as it is drawn: the body overlaps itself there, or leaves no room; or the cloth
/// has got to the wrong side of it, which is where it is inside the feasible collider, too.
void describe_drawn(const ClothModel& model, const CheckedSurface& cloth, const CheckedSurface& drawn,
                    const CheckedSurface& feasible, const ClothMotion& m, FrameReport& report) {
  const std::vector<Crossing> crossings = crossings_between(cloth, drawn);
  report.crossings_drawn = static_cast<int>(crossings.size());
  std::vector<Vec3> points;
  std::vector<int> vertex;
  int worst = -1;
  for (const Penetration& p : penetrations(m.x, model.rest_edges.edges, crossings, drawn)) {
    if (p.depth > report.deepest_drawn) report.deepest_drawn = p.depth, worst = p.vertex;
    if (p.depth <= k_notable_depth || m.released[at(p.vertex)] >= 0) continue;
    points.push_back(m.x[at(p.vertex)]);
    vertex.push_back(p.vertex);
  }
  double deepest = 0;
  int misplaced = -1;
  for (const Penetration& p : penetrations(points, feasible, k_notable_depth)) {
    ++report.inside_body;
    if (p.depth > deepest) deepest = p.depth, misplaced = vertex[at(p.vertex)];
  }
  if (misplaced >= 0)
    add_incident(model, m, Incident::Kind::k_penetration, misplaced, deepest,
                 std::to_string(report.inside_body) + " vertices are on the wrong side of the body's surface", report);
  else if (worst >= 0 && report.deepest_drawn > k_notable_depth)
    add_incident(model, m, Incident::Kind::k_penetration, worst, report.deepest_drawn,
                 "cloth is inside the drawn body, where it overlaps itself or leaves no room", report);
}

/// Seams have as long again as they took to close, in which their strength grows.
void describe_seams(const ClothModel& model, double time, const ClothMotion& m, FrameReport& report) {
  int widest = -1;
  for (const SeamPoint& p : model.seams) {
    if (time < 2 * p.closed_at - p.opens_at) continue;
    const Vec3 to = (1 - p.place) * m.x[at(p.edge[0])] + p.place * m.x[at(p.edge[1])];
    const double gap = (m.x[at(p.vertex)] - to).norm();
    if (!(gap > k_open_stitch)) continue;
    ++report.open_stitches;
    if (gap > report.widest_seam) report.widest_seam = gap, widest = p.vertex;
  }
  if (widest >= 0)
    add_incident(model, m, Incident::Kind::k_open_seam, widest, report.widest_seam,
                 std::to_string(report.open_stitches) + " stitches do not close", report);
}

}  // namespace

Certificate::Certificate(const ClothModel& model)
    : model_(model),
      cloth_(model.triangles),
      collider_(model.collider ? model.collider->triangles() : std::span<const Triangle>{}),
      drawn_(model.collider ? model.collider->trajectory().surface().triangles : std::span<const Triangle>{}) {}

int Certificate::certify(std::span<const Vec3> body, ClothMotion& m, FrameReport& report) {
  std::vector<Crossing> with_body, own;
  cloth_.move(m.x);
  collider_.move(body);
  parallel_tasks(2, [&](std::size_t task) {
    if (task == 0)
      with_body = crossings_between(cloth_, collider_);
    else
      own = own_crossings(model_, crossings_within(cloth_));
  });
  int avoidable = 0;
  std::vector<char> touched;
  if (model_.collider) avoidable += certify_body(model_, with_body, m, touched, report);
  avoidable += certify_cloths(model_, own, m, report);
  if (model_.collider) hold_again(model_, body, touched, m, report);
  cloth_.forget_boxes();
  return avoidable;
}

void Certificate::describe(double time, std::span<const Vec3> drawn, const ClothMotion& m, FrameReport& report) {
  const StrainSummary strain = summary(edge_strains(model_.rest_edges, m.x));
  report.strain_mean = strain.mean;
  report.strain_p99 = strain.p99;
  report.strain_max = strain.max;
  for (std::size_t i = 0; i < m.v.size(); ++i) report.kinetic_energy += 0.5 * model_.mass[i] * m.v[i].squaredNorm();
  if (model_.collider) {
    cloth_.move(m.x);
    drawn_.move(drawn);
    describe_drawn(model_, cloth_, drawn_, collider_, m, report);
    for (CheckedSurface* surface : {&cloth_, &drawn_, &collider_}) surface->forget_boxes();
  }
  describe_seams(model_, time, m, report);
  std::stable_sort(report.incidents.begin(), report.incidents.end(),
                   [](const Incident& a, const Incident& b) { return a.depth > b.depth; });
  if (report.incidents.size() > k_incidents_per_frame) report.incidents.resize(k_incidents_per_frame);
}

}  // namespace ft
