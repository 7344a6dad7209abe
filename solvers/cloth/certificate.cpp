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

void add_crossing(const ClothModel& model, const ClothMotion& m, int vertex, std::string text, FrameReport& report) {
  if (report.incidents.size() < k_incidents_per_frame)
    add_incident(model, m, Incident::Kind::k_crossing, vertex, 0, std::move(text), report);
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
    add_crossing(model, m, c.edge_of_first ? c.edge[0] : c.triangle[0],
                 "cloth crosses the collider's part " + names[at(part)].name, report);
  }
  return avoidable;
}

/// Crossings among the cloths; marks the tangles anew. Returns those that could have been avoided.
int certify_cloths(const ClothModel& model, std::span<const Crossing> own, ClothMotion& m, FrameReport& report) {
  report.crossings_self = static_cast<int>(own.size());
  int avoidable = 0;
  for (const Crossing& c : own) {
    if (!among_tangled(c, m.tangled)) ++avoidable;
    add_crossing(model, m, c.edge[0], "cloth crosses cloth", report);
  }
  mark_tangled(model, own, m.tangled);
  return avoidable;
}

/// A part holds the cloth again once none of the cloth that it let through crosses it or is inside it, or a smaller
/// part, for those let it through too.
void hold_again(const ClothModel& model, std::span<const Vec3> body, std::span<const char> touched, ClothMotion& m,
                FrameReport& report) {
  if (std::all_of(m.released.begin(), m.released.end(), [](double part) { return part < 0; })) return;
  const auto parts = model.collider->part_of_vertex();
  for (std::size_t part = 0; part < touched.size(); ++part) {
    std::vector<Vec3> through;
    std::vector<int> index;
    for (std::size_t i = 0; i < m.released.size(); ++i)
      if (m.released[i] == static_cast<double>(part)) through.push_back(m.x[i]), index.push_back(static_cast<int>(i));
    if (through.empty()) continue;
    report.released_vertices += static_cast<int>(through.size());
    bool any_touched = false;
    for (std::size_t p = 0; p < touched.size(); ++p)
      any_touched = any_touched || (touched[p] && model.may_pass(static_cast<double>(part), static_cast<int>(p)));
    std::vector<Triangle> shell;
    for (const Triangle& t : model.collider->triangles())
      if (model.may_pass(static_cast<double>(part), parts[at(t[0])])) shell.push_back(t);
    double deepest = 0;
    int worst = index[0];
    for (const Penetration& p : penetrations(through, body, shell))
      if (p.depth > deepest) deepest = p.depth, worst = index[at(p.vertex)];
    add_incident(model, m, Incident::Kind::k_released, worst, deepest,
                 "no room: " + std::to_string(through.size()) + " vertices let through part " +
                     model.collider->trajectory().surface().parts[part].name,
                 report);
    if (!any_touched && deepest == 0)
      for (const int i : index) m.released[at(i)] = -1;
  }
}

/// Where the cloth is inside the body as it is drawn: the body overlaps itself there, or leaves no room.
void describe_drawn(const ClothModel& model, const CheckedSurface& cloth, const CheckedSurface& drawn,
                    const ClothMotion& m, FrameReport& report) {
  const std::vector<Crossing> crossings = crossings_between(cloth, drawn);
  report.crossings_drawn = static_cast<int>(crossings.size());
  const std::vector<Penetration> inside = penetrations(m.x, model.rest_edges.edges, crossings, drawn);
  int worst = -1;
  for (const Penetration& p : inside)
    if (p.depth > report.deepest_drawn) report.deepest_drawn = p.depth, worst = p.vertex;
  if (worst >= 0 && report.deepest_drawn > k_notable_depth)
    add_incident(model, m, Incident::Kind::k_penetration, worst, report.deepest_drawn,
                 "cloth is inside the drawn body, where it overlaps itself or leaves no room", report);
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
  return avoidable;
}

void Certificate::describe(std::span<const Vec3> drawn, const ClothMotion& m, FrameReport& report) {
  const StrainSummary strain = summary(edge_strains(model_.rest_edges, m.x));
  report.strain_mean = strain.mean;
  report.strain_p99 = strain.p99;
  report.strain_max = strain.max;
  for (std::size_t i = 0; i < m.v.size(); ++i) report.kinetic_energy += 0.5 * model_.mass[i] * m.v[i].squaredNorm();
  if (model_.collider) {
    cloth_.move(m.x);
    drawn_.move(drawn);
    describe_drawn(model_, cloth_, drawn_, m, report);
  }
  std::stable_sort(report.incidents.begin(), report.incidents.end(),
                   [](const Incident& a, const Incident& b) { return a.depth > b.depth; });
  if (report.incidents.size() > k_incidents_per_frame) report.incidents.resize(k_incidents_per_frame);
}

}  // namespace ft
