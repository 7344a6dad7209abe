#include "solvers/cloth/body_advance.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "baker/core/parallel.h"
#include "collision/ccd_li2021.h"
#include "solvers/cloth/carry_field.h"

namespace ft {
namespace {

constexpr std::size_t k_block = 2048;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

double seconds_since(std::chrono::steady_clock::time_point& last) {
  const auto now = std::chrono::steady_clock::now();
  const double s = std::chrono::duration<double>(now - last).count();
  last = now;
  return s;
}

}  // namespace

struct BodyAdvance::Scratch {
  Scratch(const ClothModel& model)
      : finder(model.vertex_count(), model.triangles, model.collider ? model.collider->vertex_count() : 0,
               shifted_triangles(model)),
        step(model) {}

  /// Collider triangles in the common numbering.
  static std::vector<Triangle> shifted_triangles(const ClothModel& model) {
    std::vector<Triangle> out;
    if (!model.collider) return out;
    out.assign(model.collider->triangles().begin(), model.collider->triangles().end());
    for (Triangle& t : out)
      for (int& v : t) v += model.vertex_count();
    return out;
  }

  PairFinder finder;
  ImplicitStep step;
  std::vector<VertexBox> boxes;
  ContactPairs found, near_body, pairs;
  std::vector<Vec3> all, all_end, motion, carry, inertia, body_motion, x, v, pins;
  std::vector<double> slack, earliest;
  std::vector<std::vector<Stencil>> kept;
};

BodyAdvance::BodyAdvance(const ClothModel& model) : scratch_(std::make_unique<Scratch>(model)), model_(model) {}
BodyAdvance::~BodyAdvance() = default;

namespace {

/// A pair counts unless it is a cloth vertex against a part that it may pass, or cloth that does not collide with itself.
bool counts(const ClothModel& model, const ClothMotion& motion, const Stencil& s) {
  const int n = model.vertex_count();
  int part = -1;
  for (const int v : s.v)
    if (v >= n) part = model.collider->part_of_vertex()[at(v - n)];
  for (const int v : s.v) {
    if (v >= n) continue;
    if (part >= 0 && motion.released[at(v)] == part) return false;
    if (part < 0 && !model.self_collides[at(v)]) return false;
  }
  return true;
}

}  // namespace

AdvanceReport BodyAdvance::substep(const SubstepInput& in, ClothMotion& m) {
  Scratch& s = *scratch_;
  const int n = model_.vertex_count();
  const std::size_t nc = at(n), nb = in.body_t0.size();
  AdvanceReport report;
  report.smallest_gap = std::numeric_limits<double>::infinity();
  double radius = 1e-3, self_radius = 0;
  for (const double r : model_.contact.radius) radius = std::max(radius, r);
  for (const double r : model_.contact.self_radius) self_radius = std::max(self_radius, r);
  const bool any_self = std::any_of(model_.self_collides.begin(), model_.self_collides.end(), [](char c) { return c; });
  const double gravity = model_.setup.gravity.norm();

  double done = 0, beta = 1;
  while (done < 1) {
    auto clock = std::chrono::steady_clock::now();
    const double h = (1 - done) * in.h;
    // The body at the start of this piece, and its motion to the end of the substep.
    s.all.resize(nc + nb);
    std::copy(m.x.begin(), m.x.end(), s.all.begin());
    s.body_motion.resize(nb);
    for (std::size_t i = 0; i < nb; ++i) {
      s.all[nc + i] = in.body_t0[i] + done * (in.body_t1[i] - in.body_t0[i]);
      s.body_motion[i] = in.body_t1[i] - s.all[nc + i];
    }
    Vec3 mean = Vec3::Zero();
    for (std::size_t i = 0; i < nc; ++i) mean += m.v[i] * (h / static_cast<double>(nc));

    double t = 1, largest_slack = 0;
    bool carried = false;
    while (true) {
      s.inertia.resize(nc);
      for (std::size_t i = 0; i < nc; ++i) s.inertia[i] = beta * h * m.v[i];
      s.carry = s.inertia;
      double fastest = 0;
      if (nb > 0) {
        // Which body vertices are near: a first, wide search around the cloth's place alone.
        Box box = bounds(m.x);
        for (std::size_t i = 0; i < nc; ++i) box.include((m.x[i] + h * m.v[i]).eval());
        box.inflate(2 * radius);
        for (std::size_t i = 0; i < nb; ++i) {
          Box b;
          b.include(s.all[nc + i]);
          b.include(in.body_t1[i]);
          if (b.overlaps(box)) fastest = std::max(fastest, (s.body_motion[i] - mean).norm());
        }
        const double range = 2 * radius + std::min(fastest, 0.05);
        s.boxes.resize(nc + nb);
        for (std::size_t i = 0; i < nc; ++i) s.boxes[i] = VertexBox::swept(m.x[i], m.x[i], 0.5 * range);
        for (std::size_t i = 0; i < nb; ++i) s.boxes[nc + i] = VertexBox::swept(s.all[nc + i], s.all[nc + i], 0.5 * range);
        s.finder.find(s.boxes, false, s.found);
        s.near_body.vertex_face.clear();
        for (const Stencil& stencil : s.found.vertex_face)
          if (counts(model_, m, stencil)) s.near_body.vertex_face.push_back(stencil);
        CarryInput carry;
        carry.cloth_vertex_count = n;
        carry.x = s.all;
        carry.body_motion = s.body_motion;
        carry.inertia = s.inertia;
        carry.edges = model_.edges;
        carry.pairs = &s.near_body;
        carry.range = range;
        if (!s.near_body.vertex_face.empty()) carry_field(carry, s.carry);
      }
      // Candidates in a frame that moves with the cloth's mean carry; complete while every vertex stays within its slack.
      Vec3 frame = Vec3::Zero();
      for (std::size_t i = 0; i < nc; ++i) frame += s.carry[i] / static_cast<double>(nc);
      s.slack.resize(nc);
      largest_slack = 0;
      for (std::size_t i = 0; i < nc; ++i) {
        s.slack[i] = 1.2 * (h * m.v[i] - s.carry[i]).norm() + 0.6 * h * h * gravity + 1e-3 + 0.1 * std::min(fastest, 0.05) +
                     in.extra_slack;
        largest_slack = std::max(largest_slack, s.slack[i]);
      }
      s.boxes.resize(nc + nb);
      for (std::size_t i = 0; i < nc; ++i)
        s.boxes[i] = VertexBox::swept(m.x[i], m.x[i] + s.carry[i] - frame, s.slack[i] + 0.5 * radius);
      for (std::size_t i = 0; i < nb; ++i)
        s.boxes[nc + i] = VertexBox::swept(s.all[nc + i], s.all[nc + i] + s.body_motion[i] - frame, 0.5 * radius);
      s.finder.find(s.boxes, any_self, s.found);

      // Keep what can come nearer than the contact radius; conservative CCD over the kept ones.
      s.motion.resize(nc + nb);
      std::copy(s.carry.begin(), s.carry.end(), s.motion.begin());
      std::copy(s.body_motion.begin(), s.body_motion.end(), s.motion.begin() + static_cast<std::ptrdiff_t>(nc));
      t = 1;
      for (const bool vertex_face : {true, false}) {
        const auto& list = vertex_face ? s.found.vertex_face : s.found.edge_edge;
        auto& to = vertex_face ? s.pairs.vertex_face : s.pairs.edge_edge;
        to.clear();
        const std::size_t blocks = block_count(list.size(), k_block);
        if (s.kept.size() < blocks) s.kept.resize(blocks);
        s.earliest.assign(blocks, 1.0);
        parallel_for(list.size(), k_block, [&](std::size_t begin, std::size_t end) {
          auto& kept = s.kept[begin / k_block];
          kept.clear();
          double first = 1;
          for (std::size_t p = begin; p < end; ++p) {
            const auto& v = list[p].v;
            const std::array<Vec3, 4> x{s.all[at(v[0])], s.all[at(v[1])], s.all[at(v[2])], s.all[at(v[3])]};
            const std::array<Vec3, 4> d{s.motion[at(v[0])], s.motion[at(v[1])], s.motion[at(v[2])], s.motion[at(v[3])]};
            const std::size_t split = vertex_face ? 1 : 2;
            double relative = 0, slack_a = 0, slack_b = 0;
            for (std::size_t a = 0; a < split; ++a)
              for (std::size_t b = split; b < 4; ++b) relative = std::max(relative, (d[a] - d[b]).squaredNorm());
            relative = std::sqrt(relative);
            for (std::size_t k = 0; k < 4; ++k)
              if (v[k] < n) (k < split ? slack_a : slack_b) = std::max(k < split ? slack_a : slack_b, s.slack[at(v[k])]);
            const double reach = relative + slack_a + slack_b + radius;
            const PairGeometry g = vertex_face ? vertex_face_geometry(x[0], x[1], x[2], x[3])
                                               : edge_edge_geometry(x[0], x[1], x[2], x[3]);
            if (g.distance >= reach || !counts(model_, m, list[p])) continue;
            kept.push_back(list[p]);
            if (g.distance * 0.9 > relative && g.distance > 1e-4) continue;
            first = std::min(first, ccd_time(vertex_face ? PairKind::k_vertex_face : PairKind::k_edge_edge, x, d));
          }
          s.earliest[begin / k_block] = first;
        });
        for (std::size_t b = 0; b < blocks; ++b) {
          to.insert(to.end(), s.kept[b].begin(), s.kept[b].end());
          t = std::min(t, s.earliest[b]);
        }
      }
      if (t >= 1 || beta == 0) {
        carried = true;
        break;
      }
      beta = beta > 0.5 ? 0.5 : 0;  // less inertia in the carry costs candidates, not time
    }
    (void)carried;
    report.seconds_candidates += seconds_since(clock);

    bool shortened = false;
    if (t < 1) {
      shortened = true;
      t = std::clamp(0.9 * t, 0.0, 0.9);
      if (t * h < in.shortest) {
        // No room: whatever blocks is let through, with its neighbourhood, until the part is clear of all cloth again.
        int freed = 0, cloth_pairs = 0;
        for (const bool vertex_face : {true, false}) {
          auto& list = vertex_face ? s.pairs.vertex_face : s.pairs.edge_edge;
          std::vector<Stencil> staying;
          staying.reserve(list.size());
          for (const Stencil& stencil : list) {
            const auto& v = stencil.v;
            const std::array<Vec3, 4> x{s.all[at(v[0])], s.all[at(v[1])], s.all[at(v[2])], s.all[at(v[3])]};
            const std::array<Vec3, 4> d{s.motion[at(v[0])], s.motion[at(v[1])], s.motion[at(v[2])], s.motion[at(v[3])]};
            const double first = ccd_time(vertex_face ? PairKind::k_vertex_face : PairKind::k_edge_edge, x, d);
            if (0.9 * first * h >= in.shortest) {
              staying.push_back(stencil);
              continue;
            }
            int part = -1;
            for (const int i : v)
              if (i >= n) part = model_.collider->part_of_vertex()[at(i - n)];
            for (const int i : v)
              if (i < n && part >= 0 && m.released[at(i)] != part) m.released[at(i)] = part, ++freed;
            if (part < 0) ++cloth_pairs;
          }
          list.swap(staying);
        }
        report.released += freed;
        report.let_through += cloth_pairs;
        if (freed > 0) continue;  // search again without them
        // Cloth on cloth: these pairs pass this once; the certificate will say so.
        t = 1;
        shortened = false;
      }
    }

    s.all_end.resize(nc + nb);
    for (std::size_t i = 0; i < nc; ++i) s.all_end[i] = m.x[i] + t * s.carry[i];
    for (std::size_t i = 0; i < nb; ++i)
      s.all_end[nc + i] = t >= 1 ? in.body_t1[i] : (s.all[nc + i] + t * s.body_motion[i]).eval();
    const double end = t >= 1 ? 1.0 : done + t * (1 - done);
    s.pins.resize(in.pins_t0.size());
    for (std::size_t p = 0; p < s.pins.size(); ++p) s.pins[p] = in.pins_t0[p] + end * (in.pins_t1[p] - in.pins_t0[p]);
    report.seconds_advance += seconds_since(clock);

    StepInput step;
    step.x_t0 = m.x;
    step.v_t0 = m.v;
    step.x_tm1 = m.x_previous;
    step.v_tm1 = m.v_previous;
    step.h = t * h;
    step.h_previous = m.h_previous;
    step.time = in.time_t0 + end * in.h;
    step.all_start = s.all;
    step.all_begin = s.all_end;
    step.pin_target = s.pins;
    step.slack = s.slack;
    step.pairs = &s.pairs;
    // A gap that an unconverged solve leaves closed blocks the next advance.
    step.newton_iterations = model_.setup.newton_iterations * (shortened ? 4 : 1);
    s.x.resize(nc);
    s.v.resize(nc);
    const StepResult result = s.step.solve(step, s.x, s.v);
    report.newton_iterations += result.newton_iterations;
    report.linear_iterations += result.linear_iterations;
    report.smallest_gap = std::min(report.smallest_gap, result.smallest_gap);
    report.finite = report.finite && result.finite;
    report.seconds_assembly += result.seconds_assembly;
    report.seconds_linear += result.seconds_linear;
    report.seconds_contact += result.seconds_contact;
    ++report.pieces;
    m.x_previous.swap(m.x);
    m.v_previous.swap(m.v);
    m.x.swap(s.x);
    m.v.swap(s.v);
    m.h_previous = step.h;
    done = end;
  }
  return report;
}

}  // namespace ft
