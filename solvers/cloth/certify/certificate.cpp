#include "solvers/cloth/certify/certificate.h"

#include <algorithm>
#include <string>
#include <vector>

#include "baker/core/parallel.h"
#include "collision/check/crossings.h"
#include "collision/check/penetration.h"
#include "solvers/cloth/advance/tangles.h"

namespace ft::inline solvers {
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

/// Crossings with the feasible collider, but for what of it is absent. Returns how many.
int certify_body(const ClothModel& model, std::span<const Crossing> crossings, const ClothMotion& m,
                 FrameReport& report) {
  const auto parts = model.collider->part_of_vertex();
  const auto& names = model.collider->trajectory().surface().parts;
  std::vector<Crossing> met;
  for (const Crossing& c : crossings)
    if (!model.absence.is_absent(model, c, m.absent)) met.push_back(c);
  report.crossings_body = static_cast<int>(met.size());
  report.crossings_absent = static_cast<int>(crossings.size() - met.size());
  add_crossings(
      model, m, met, [](const Crossing& c) { return c.edge_of_first ? c.edge[0] : c.triangle[0]; },
      [&](const Crossing& c) {
        const int part = parts[at(c.edge_of_first ? c.triangle[0] : c.edge[0])];
        return "cloth crosses the collider's part " + names[at(part)].name;
      },
      report);
  return report.crossings_body;
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

/// What is absent from here on; what was let go is an incident.
void describe_absent(const ClothModel& model, const BodyPose& body, const ClothMotion& m, FrameReport& report) {
  const auto& names = model.collider->trajectory().surface().parts;
  const int n = static_cast<int>(model.absence.body_count());
  for (int g = 0; g < static_cast<int>(model.setup.garments.size()); ++g) {
    int absent = 0;
    for (int b = 0; b < n; ++b) absent += m.absent[model.absence.place(g, b)];
    report.absent_vertices = std::max(report.absent_vertices, absent);
    const Absence::LetGo gone = model.absence.let_go_now(g, body.absent, m.absent);
    if (gone.count == 0) continue;
    report.released_vertices += gone.count;
    // At the garment's vertex that is nearest.
    int nearest = model.first_vertex[at(g)];
    const Vec3& place = body.feasible[at(gone.vertex)];
    for (int v = nearest; v < model.first_vertex[at(g + 1)]; ++v)
      if ((m.x[at(v)] - place).squaredNorm() < (m.x[at(nearest)] - place).squaredNorm()) nearest = v;
    add_incident(model, m, Incident::Kind::k_released, nearest, 0,
                 "no room: the cloth does not meet " + std::to_string(gone.count) + " vertices of the collider, at " +
                     names[at(model.collider->part_of_vertex()[at(gone.vertex)])].name +
                     " (leave parts out with `ignore` or `ignores`)",
                 report);
  }
}

/// Whether what is nearest of the collider to a cloth vertex is absent for it.
bool nearest_is_absent(const ClothModel& model, int vertex, const CheckedSurface& collider, const ClothMotion& m) {
  TriangleTree::Hit hit;
  collider.tree().closest(m.x[at(vertex)], collider.positions(), collider.triangles(), hit);
  return hit.triangle >= 0 &&
         model.absence.is_absent(m.absent, model.garment_of(vertex), collider.triangles()[at(hit.triangle)]);
}

/// Where the cloth is inside the body as it is drawn: the body overlaps itself there, or leaves no room; or the cloth
/// has got to the wrong side of it, which is where it is inside the feasible collider, too.
/// solid: what of a surface has an inside.
void describe_drawn(const ClothModel& model, const CheckedSurface& cloth, const CheckedSurface& drawn,
                    const CheckedSurface& solid_drawn, const CheckedSurface& feasible,
                    const CheckedSurface& solid_feasible, const ClothMotion& m, FrameReport& report) {
  const std::vector<Crossing> crossings = crossings_between(cloth, drawn);
  report.crossings_drawn = static_cast<int>(crossings.size());
  std::vector<Vec3> points;
  std::vector<int> vertex;
  int worst = -1;
  for (const Penetration& p : penetrations(m.x, model.rest_edges.edges, crossings, solid_drawn)) {
    if (p.depth > report.deepest_drawn) report.deepest_drawn = p.depth, worst = p.vertex;
    if (p.depth <= k_notable_depth) continue;
    points.push_back(m.x[at(p.vertex)]);
    vertex.push_back(p.vertex);
  }
  double deepest = 0;
  int misplaced = -1;
  for (const Penetration& p : penetrations(points, solid_feasible, k_notable_depth)) {
    if (nearest_is_absent(model, vertex[at(p.vertex)], feasible, m)) continue;
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
      drawn_(model.collider ? model.collider->trajectory().surface().triangles : std::span<const Triangle>{}) {
  if (!model.collider || !model.collider->has_sheets()) return;
  solid_collider_.emplace(model.collider->solid_triangles());
  solid_drawn_.emplace(model.collider->solid_drawn_triangles());
}

int Certificate::certify(const BodyPose& body, ClothMotion& m, FrameReport& report) {
  std::vector<Crossing> with_body, own;
  cloth_.move(m.x);
  collider_.move(body.feasible);
  parallel_tasks(2, [&](std::size_t task) {
    if (task == 0)
      with_body = crossings_between(cloth_, collider_);
    else
      own = own_crossings(model_, crossings_within(cloth_));
  });
  int avoidable = 0;
  if (model_.collider) avoidable += certify_body(model_, with_body, m, report);
  avoidable += certify_cloths(model_, own, m, report);
  if (model_.collider) {
    model_.absence.bring_back(model_, with_body, collider_, body.absent, m);
    model_.absence.let_go_of_what_caught(model_, collider_, m);
    describe_absent(model_, body, m, report);
  }
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
    if (solid_drawn_) solid_drawn_->move(drawn), solid_collider_->move(collider_.positions());
    describe_drawn(model_, cloth_, drawn_, solid_drawn_ ? *solid_drawn_ : drawn_, collider_,
                   solid_collider_ ? *solid_collider_ : collider_, m, report);
    for (CheckedSurface* surface : {&cloth_, &drawn_, &collider_}) surface->forget_boxes();
    for (auto* solid : {&solid_drawn_, &solid_collider_})
      if (*solid) (*solid)->forget_boxes();
  }
  describe_seams(model_, time, m, report);
  // What the promise is about goes first, then by depth.
  const auto weight = [](const Incident& i) {
    using enum Incident::Kind;
    return i.kind == k_crossing ? 2 : i.kind == k_released || i.kind == k_cut_short ? 1 : 0;
  };
  std::stable_sort(report.incidents.begin(), report.incidents.end(), [&](const Incident& a, const Incident& b) {
    return weight(a) != weight(b) ? weight(a) > weight(b) : a.depth > b.depth;
  });
  if (report.incidents.size() > k_incidents_per_frame) report.incidents.resize(k_incidents_per_frame);
}

}  // namespace ft::inline solvers
