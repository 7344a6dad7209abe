#include "solvers/cloth/model/contact_potential.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "baker/core/check.h"
#include "baker/core/give_back.h"
#include "baker/core/parallel.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 512;
constexpr float k_rounding = 1.0001f;  ///< of float sums of ways
constexpr float k_no_way = 1e30f;
/// What is known of distances is counted in these, rounded down; what is more than two bytes hold is that much [m].
constexpr float k_known_step = 1e-6f;
constexpr std::uint16_t k_nothing_known = 0;
/// Share of the radius below which the contact law rises faster: cloth that is drawn taut over an edge of the body, at
/// 100 kPa, must keep a gap in which it can follow the body [1].
constexpr double k_taut = 0.125;

std::uint16_t known_steps(float distance) {
  constexpr float k_most = std::numeric_limits<std::uint16_t>::max();
  const float steps = distance / k_known_step;
  return steps > 0 ? static_cast<std::uint16_t>(std::min(steps, k_most)) : k_nothing_known;  // nor of what is no number
}

PairGeometry geometry_of(bool vertex_face, const std::array<int, 4>& v, std::span<const Vec3> x) {
  return vertex_face ? vertex_face_geometry(x[at(v[0])], x[at(v[1])], x[at(v[2])], x[at(v[3])])
                     : edge_edge_geometry(x[at(v[0])], x[at(v[1])], x[at(v[2])], x[at(v[3])]);
}

/// At the closest point of the vertices [begin, end) of a pair. Where they agree it is exactly their value.
double side_radius(const std::array<int, 4>& v, const PairGeometry& geometry, std::span<const double> radius,
                   std::size_t begin, std::size_t end) {
  const double first = radius[at(v[begin])];
  double r = first;
  for (std::size_t k = begin + 1; k < end; ++k) r += std::abs(geometry.weight[k]) * (radius[at(v[k])] - first);
  return r;
}

std::array<float, 3> last_three(const std::array<double, 4>& weight) {
  return {static_cast<float>(weight[1]), static_cast<float>(weight[2]), static_cast<float>(weight[3])};
}

}  // namespace

ContactLaw contact_law(double d, double r, double k) {
  if (d >= r) return {0, 0, 0};
  const double half = 0.5 * r;
  if (d > half) return {0.5 * k * (r - d) * (r - d), k * (r - d), k};
  const double a = 0.25 * k * r * r;
  const double safe = std::max(d, 1e-9);
  const double taut = std::max(0.0, std::log(k_taut * r / safe)), factor = 1 + 3 * taut * taut;
  return {0.125 * k * r * r + a * (taut * taut * taut - std::log(safe / half)), a / safe * factor,
          a / (safe * safe) * (factor + 6 * taut)};
}

ContactPotential::Lagged::Lagged(const Contact& contact, double most_force)
    : most(static_cast<float>(most_force)),
      normal(contact.geometry.normal.cast<float>()),
      last_weights(last_three(contact.geometry.weight)),
      vertex(contact.vertex) {}

bool ContactPotential::Lagged::is_at(const Contact& contact) const {
  return vertex == contact.vertex && last_weights == last_three(contact.geometry.weight);
}

std::array<double, 4> ContactPotential::Lagged::weight() const {
  const double a = last_weights[0], b = last_weights[1], c = last_weights[2];
  return {-(a + b + c), a, b, c};
}

Vec3 ContactPotential::Lagged::slip(std::span<const Vec3> x, std::span<const Vec3> x_start) const {
  const std::array<double, 4> w = weight();
  Vec3 u = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k) u += w[k] * (x[at(vertex[k])] - x_start[at(vertex[k])]);
  const Vec3 n = normal.cast<double>();
  return u - n.dot(u) * n;
}

void ContactPotential::begin(const PairList& pairs, std::span<const Vec3> x_start, double h, double friction_share) {
  pairs_ = &pairs;
  friction_share_ = friction_share;
  x_start_ = x_start;
  h_ = h;
  way_.assign(at(model_.cloth_vertex_count), 0.f);
  known_vf_.assign(pairs.vertex_face.size(), k_nothing_known);
  known_ee_.assign(pairs.edge_edge.size(), k_nothing_known);
  contacts_.clear();
  lagged_.clear();
}

double ContactPotential::pair_radius(const std::array<int, 4>& v, bool vertex_face, const PairGeometry& geometry,
                                     double* friction, double* area) const {
  const int n = model_.cloth_vertex_count;
  const std::size_t split = vertex_face ? 1 : 2;
  const bool first_cloth = v[0] < n, second_cloth = v[3] < n;
  double r = 0, mu = 0, a = 0;
  if (first_cloth && second_cloth) {
    for (const int i : v) {
      mu = std::max(mu, model_.self_friction[at(model_.garment[at(i)])]);
      a += 0.25 * model_.area[at(i)];
    }
    r = ContactModel::self_radius(
        std::min(side_radius(v, geometry, model_.radius, 0, split), side_radius(v, geometry, model_.radius, split, 4)));
    if (model_.garment[at(v[0])] == model_.garment[at(v[3])]) {
      const double rest = geometry_of(vertex_face, v, model_.rest).distance;
      r = std::min(r, 0.5 * rest);
    }
  } else {
    int count = 0;
    for (const int i : v) {
      if (i >= n) continue;
      mu = std::max(mu, model_.friction[at(model_.garment[at(i)])]);
      a += model_.area[at(i)];
      ++count;
    }
    a /= std::max(count, 1);
    r = first_cloth ? side_radius(v, geometry, model_.radius, 0, split)
                    : side_radius(v, geometry, model_.radius, split, 4);
  }
  *friction = mu;
  *area = a;
  return r;
}

/// How far the features of a pair can have come nearer, at most: way_ of the farthest vertex on either side; the body
/// stands still.
float ContactPotential::way_of(const std::array<int, 4>& v, bool vertex_face, bool farthest) const {
  const std::size_t split = vertex_face ? 1 : 2;
  float side[2] = {farthest ? 0.f : k_no_way, farthest ? 0.f : k_no_way};
  for (std::size_t k = 0; k < 4; ++k) {
    const float way = v[k] < model_.cloth_vertex_count ? way_[at(v[k])] : 0.f;
    float& s = side[k < split ? 0 : 1];
    s = farthest ? std::max(s, way) : std::min(s, way);
  }
  return side[0] + side[1];
}

/// Whether a pair can be no farther apart than `reach` [m] now. known: of known_vf_ or known_ee_.
bool ContactPotential::may_be_within(const std::array<int, 4>& v, bool vertex_face, std::uint16_t known,
                                     float reach) const {
  return known == k_nothing_known ||
         !(static_cast<float>(known) * k_known_step - k_rounding * way_of(v, vertex_face, true) > reach);
}

/// The pairs from the first on.
void ContactPotential::update_kind(bool vertex_face, std::span<const Vec3> x, std::size_t first) {
  const PairKind kind = vertex_face ? PairKind::k_vertex_face : PairKind::k_edge_edge;
  auto& known = vertex_face ? known_vf_ : known_ee_;
  const int n = model_.cloth_vertex_count;
  const std::size_t count = pairs_->of(kind).size() - first, blocks = block_count(count, k_block);
  if (block_contacts_.size() < blocks) block_contacts_.resize(blocks);
  parallel_for(count, k_block, [&](std::size_t begin, std::size_t end) {
    auto& out = block_contacts_[begin / k_block];
    out.clear();
    for (std::size_t p = first + begin; p < first + end; ++p) {
      const auto v = pairs_->stencil(kind, p).v;
      const bool self = v[0] < n && v[3] < n;
      double largest = 0;
      for (const int i : v)
        if (i < n) largest = std::max(largest, model_.radius[at(i)]);
      if (self) largest = ContactModel::self_radius(largest);
      if (!may_be_within(v, vertex_face, known[p], static_cast<float>(largest) + 1e-6f)) continue;
      const PairGeometry g = geometry_of(vertex_face, v, x);
      known[p] = known_steps(static_cast<float>(g.distance) + k_rounding * way_of(v, vertex_face, false));
      if (g.distance >= largest || g.distance <= 0) continue;
      if (!vertex_face && !g.interior) continue;
      Contact c;
      c.vertex = v;
      c.geometry = g;
      double area = 0;
      c.radius = pair_radius(v, vertex_face, g, &c.friction, &area);
      if (g.distance >= c.radius) continue;
      c.stiffness = model_.stiffness_per_area * area;
      out.push_back(c);
    }
  });
  std::size_t found = contacts_.size();
  for (std::size_t b = 0; b < blocks; ++b) found += block_contacts_[b].size();
  contacts_.reserve(found);
  for (std::size_t b = 0; b < blocks; ++b)
    contacts_.insert(contacts_.end(), block_contacts_[b].begin(), block_contacts_[b].end());
  block_contacts_.clear();
}

void ContactPotential::update(std::span<const Vec3> x, std::span<const Vec3> move, double share) {
  CHECK(move.empty() || move.size() == way_.size());
  parallel_for(move.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) way_[i] += static_cast<float>(share * move[i].norm());
  });
  contacts_.clear();
  update_kind(true, x, 0);
  update_kind(false, x, 0);
}

void ContactPotential::forget_contacts() {
  give_back(contacts_);
}

void ContactPotential::extend(std::span<const Vec3> x) {
  const std::size_t first_vf = known_vf_.size(), first_ee = known_ee_.size(), first_contact = contacts_.size();
  CHECK(first_vf <= pairs_->vertex_face.size() && first_ee <= pairs_->edge_edge.size());
  const auto add = [](std::vector<std::uint16_t>& known, std::size_t count) {
    reserve_sparingly(known, count);
    known.resize(count, k_nothing_known);
  };
  add(known_vf_, pairs_->vertex_face.size());
  add(known_ee_, pairs_->edge_edge.size());
  update_kind(true, x, first_vf);
  update_kind(false, x, first_ee);
  lag_friction_from(first_contact);
}

void ContactPotential::lag_friction() {
  lagged_.clear();
  lag_friction_from(0);
}

void ContactPotential::lag_friction_from(std::size_t first) {
  lagged_.reserve(lagged_.size() + contacts_.size() - first);
  for (const Contact& c : std::span(contacts_).subspan(first)) {
    const double friction = friction_share_ * c.friction;
    if (friction <= 0) continue;
    lagged_.emplace_back(c, friction * contact_law(c.geometry.distance, c.radius, c.stiffness).force);
  }
}

double ContactPotential::value(std::span<const Vec3> x) const {
  double energy = parallel_sum(contacts_.size(), k_block, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Contact& c = contacts_[i];
      sum += contact_law(c.geometry.distance, c.radius, c.stiffness).energy;
    }
    return sum;
  });
  const double eps = model_.sliding_speed * h_;
  energy += parallel_sum(lagged_.size(), k_block, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Lagged& f = lagged_[i];
      const double s = f.slip(x, x_start_).norm();
      sum += static_cast<double>(f.most) * (s > eps ? s - 0.5 * eps : 0.5 * s * s / eps);
    }
    return sum;
  });
  return energy;
}

double ContactPotential::friction_stiffness(const Lagged& f, const Vec3& slip, double eps) {
  return static_cast<double>(f.most) / std::max(slip.norm(), eps);
}

/// Of the contacts whose vertices count.
template <class Counts>
void ContactPotential::add_gradient_where(std::span<const Vec3> x, std::span<Vec3> gradient, Counts&& counts) const {
  const int n = model_.cloth_vertex_count;
  const auto add = [&](const std::array<int, 4>& v, const std::array<double, 4>& weight, const Vec3& g) {
    for (std::size_t k = 0; k < 4; ++k)
      if (v[k] < n) gradient[at(v[k])] += weight[k] * g;
  };
  for (const Contact& c : contacts_) {
    if (!counts(c.vertex)) continue;
    const ContactLaw law = contact_law(c.geometry.distance, c.radius, c.stiffness);
    add(c.vertex, c.geometry.weight, -law.force * c.geometry.normal);
  }
  const double eps = model_.sliding_speed * h_;
  for (const Lagged& f : lagged_) {
    if (!counts(f.vertex)) continue;
    const Vec3 slip = f.slip(x, x_start_);
    add(f.vertex, f.weight(), friction_stiffness(f, slip, eps) * slip);
  }
}

void ContactPotential::add_gradient(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  add_gradient_where(x, gradient, [](const std::array<int, 4>&) { return true; });
}

void ContactPotential::add_gradient_between_garments(std::span<const Vec3> x, std::span<Vec3> gradient) const {
  const int n = model_.cloth_vertex_count;
  add_gradient_where(x, gradient, [&](const std::array<int, 4>& v) {
    return v[0] < n && v[3] < n && model_.garment[at(v[0])] != model_.garment[at(v[3])];
  });
}

void ContactPotential::add_gradient_with_body(std::span<const Vec3> x, int body, std::span<const int> body_of_vertex,
                                              std::span<Vec3> gradient) const {
  const int n = model_.cloth_vertex_count;
  add_gradient_where(x, gradient, [&](const std::array<int, 4>& v) {
    const int of_body = std::max(v[0], v[3]), of_cloth = std::min(v[0], v[3]);
    return of_cloth < n && of_body >= n && body_of_vertex[at(of_body - n)] == body;
  });
}

void ContactPotential::mark_touching(std::span<char> of_garment) const {
  const int n = model_.cloth_vertex_count;
  for (const Contact& c : contacts_)
    if ((c.vertex[0] < n) != (c.vertex[3] < n))
      of_garment[at(model_.garment[at(c.vertex[0] < n ? c.vertex[0] : c.vertex[3])])] = 1;
}

void ContactPotential::add_terms(std::span<const Vec3> x, std::vector<PairTerm>& terms) const {
  const int n = model_.cloth_vertex_count;
  const auto add = [&](const std::array<int, 4>& v, const std::array<double, 4>& weight, const Mat3& stiffness) {
    PairTerm term;
    for (std::size_t k = 0; k < 4; ++k) {
      term.vertex[k] = v[k] < n ? v[k] : -1;
      term.weight[k] = static_cast<float>(weight[k]);
    }
    term.stiffness = stiffness.cast<float>();
    terms.push_back(term);
  };
  const double eps = model_.sliding_speed * h_;
  const auto of_friction = [&](const Lagged& f) -> Mat3 {
    const Vec3 normal = f.normal.cast<double>();
    return friction_stiffness(f, f.slip(x, x_start_), eps) * (Mat3::Identity() - normal * normal.transpose());
  };
  // Friction that was lagged at these contacts comes in their order, on the same weights: one term for both.
  terms.reserve(terms.size() + std::max(contacts_.size(), lagged_.size()));
  auto lagged = lagged_.begin();
  for (const Contact& c : contacts_) {
    const ContactLaw law = contact_law(c.geometry.distance, c.radius, c.stiffness);
    Mat3 stiffness = law.stiffness * c.geometry.normal * c.geometry.normal.transpose();
    if (lagged != lagged_.end() && lagged->is_at(c)) stiffness += of_friction(*lagged++);
    add(c.vertex, c.geometry.weight, stiffness);
  }
  for (; lagged != lagged_.end(); ++lagged) add(lagged->vertex, lagged->weight(), of_friction(*lagged));
}

double ContactPotential::smallest_gap() const {
  double gap = std::numeric_limits<double>::infinity();
  for (const Contact& c : contacts_) gap = std::min(gap, c.geometry.distance);
  return gap;
}

}  // namespace ft::inline solvers
