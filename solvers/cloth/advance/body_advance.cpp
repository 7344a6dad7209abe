#include "solvers/cloth/advance/body_advance.h"

#include <algorithm>
#include <chrono>

#include "baker/core/give_back.h"
#include "baker/core/parallel.h"
#include "solvers/cloth/advance/candidates.h"
#include "solvers/cloth/advance/tangles.h"
#include "solvers/cloth/advance/work_limit.h"
#include "solvers/cloth/model/draw_back.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 2048;  ///< of a loop over vertices
/// A blocked piece is cut to this share of the time to the first touch, but to no less than k_shortest_cut of itself.
constexpr double k_approach = 0.9;
constexpr double k_shortest_cut = 0.25;
/// Before parts of the body are let go for lack of room, some pieces of a substep may be shorter than
/// SubstepInput::shortest, down to this share of it: one is mostly enough for the cloth to find its way.
constexpr double k_last_shortest = 1.0 / 16;
constexpr int k_most_short = 12;
/// Shorter pieces are no way either where so many in a row take less than this share of the substep.
constexpr std::size_t k_patience = 6;
constexpr double k_least_gain = 1.0 / 64;
/// What follows a shortened piece is at most so many times as long: what blocked it is mostly still there, looking for
/// pairs over the whole rest is dear, and the integrator keeps its history (blended_weights()).
constexpr double k_regrowth = 1.5;
/// What Newton may still strain the edges by at the end of a shortened piece [1]: a gap that an unconverged solve
/// leaves closed blocks the next advance.
constexpr double k_shortened_settled = 1e-3;
/// Cloth that wants to leave its slack by more than k_negligible gets other room, with some to spare: what is held back
/// loses momentum [m].
constexpr double k_negligible = 2e-5;
constexpr double k_spare = 5e-4;
/// Where more than this share of the cloth asks for more than so many typical edges, nobody gets more at a time: the
/// pairs would be all there are.
constexpr double k_rush = 0.1, k_most_room = 4;
constexpr double k_ahead = 0.5;  ///< of what was missing, farther on: the next iteration mostly goes the same way
/// Rounds in which what would touch is kept apart, and then in which it is joined to zones, before the piece is
/// shortened.
constexpr int k_parting_rounds = 8;
constexpr int k_joining_rounds = 4;
/// And when it cannot be shortened any more, as long as cloth meets cloth: what moves as one cannot meet itself, so
/// that every round leaves fewer zones.
constexpr int k_last_rounds = 200;
/// When patience is over and so many times something was let go in the substep, the body goes as a whole.
constexpr int k_most_releases = 8;

std::size_t pair_count(const PairList& pairs) {
  return pairs.vertex_face.size() + pairs.edge_edge.size();
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

struct BodyAdvance::Scratch {
  explicit Scratch(const ClothModel& model) : candidates(model), step(model), tangles(model) {
    candidates.leave_open(tangles.way_out());
  }
  Candidates candidates;
  ImplicitStep step;
  Tangles tangles;
  PieceMotion piece;
  std::vector<Vec3> end, pins, pin_motion;  ///< end: of cloth and body
  std::vector<RoomRequest> requests;
  std::vector<SkinHold> skin_holds;
};

BodyAdvance::BodyAdvance(const ClothModel& model) : scratch_(std::make_unique<Scratch>(model)), model_(model) {}
BodyAdvance::~BodyAdvance() = default;

/// Carries the cloth and collects candidates; cloth that would touch is carried at a distance, and where that does not
/// do, as one, which costs candidates and not time. Returns the share of the motion that is free then; where that is
/// not all of it, the largest that any way of carrying left free, for a shorter piece is carried anew.
double BodyAdvance::plan(const ClothMotion& cloth, double h) {
  Scratch& s = *scratch_;
  s.candidates.find_near(cloth, h, s.piece);
  s.candidates.carry(cloth, h, s.piece);
  double t = s.candidates.collect(cloth, h, s.piece);
  double most = t;
  for (int round = 0; t < 1 && round < k_parting_rounds; ++round) {
    t = s.candidates.part_blocked(cloth, s.piece);
    most = std::max(most, t);
  }
  s.candidates.end_parting();
  for (int round = 0; t < 1 && round < k_joining_rounds; ++round) {
    t = s.candidates.join_blocked(cloth, s.piece);
    most = std::max(most, t);
  }
  return most;
}

/// Solves for the cloth at the end of a piece and moves its history on.
void BodyAdvance::solve(const SubstepInput& in, double h, double end, bool shortened, ClothMotion& cloth,
                        AdvanceReport& report) {
  Scratch& s = *scratch_;
  s.pins.resize(in.pins_t0.size());
  s.pin_motion.resize(s.pins.size());
  for (std::size_t p = 0; p < s.pins.size(); ++p) {
    const Vec3 motion = in.pins_t1[p] - in.pins_t0[p];
    s.pins[p] = in.pins_t0[p] + end * motion;
    s.pin_motion[p] = h / in.h * motion;
  }
  StepInput step;
  step.x_t0 = std::span(s.piece.start).first(cloth.x.size());
  step.v_t0 = cloth.v;
  step.x_tm1 = cloth.x_previous;
  step.v_tm1 = cloth.v_previous;
  step.x_tm2 = cloth.x_older;
  step.v_tm2 = cloth.v_older;
  step.h = h;
  step.h_previous = cloth.h_previous;
  step.h_older = cloth.h_older;
  step.time = in.time_t0 + end * in.h;
  step.all_start = s.piece.start;
  step.pin_target = s.pins;
  step.pin_motion = s.pin_motion;
  step.push = s.tangles.push(in.push);
  step.pulls = s.tangles.way_out().pulls;
  step.balls = {step.x_t0, s.piece.centre, s.piece.slack};
  step.friction_share = in.friction_share;
  step.pairs = &s.candidates.pairs();
  step.newton_iterations = model_.setup.newton_iterations;
  step.no_more = report.impatient;
  if (shortened) step.settled_strain = k_shortened_settled;
  step.enough_room = k_negligible;
  double asked = 0;
  step.more_room = [&](std::span<const double> missing, std::span<const Vec3> x, std::span<const Vec3> move) {
    // Each larger ball brings pairs, and beyond what the substep may cost there is none.
    asked += WorkLimit::of_iteration(pair_count(s.candidates.pairs()), at(model_.vertex_count()));
    if (report.work + asked > in.patience) return;
    const auto clock = std::chrono::steady_clock::now();
    const auto most_room = [&](std::size_t i) {
      return k_most_room * model_.typical_edge[at(model_.contact.garment[i])];
    };
    std::size_t far = 0;
    for (std::size_t i = 0; i < missing.size(); ++i) far += missing[i] > most_room(i) ? 1 : 0;
    const bool rush = static_cast<double>(far) > k_rush * static_cast<double>(missing.size());
    for (std::size_t i = 0; i < missing.size(); ++i) {
      if (!(missing[i] > 0)) continue;
      const Vec3 way = move[i].normalized();  // zero of what does not move
      const double given = rush ? std::min(missing[i], most_room(i)) : missing[i];
      const Vec3 to = x[i] + move[i] - (missing[i] - given) * way + k_ahead * given * way;
      s.requests.push_back({static_cast<int>(i), x[i], to, k_spare});
    }
    s.candidates.give_room(cloth, s.requests, s.piece);
    give_back(s.requests);  // in folds a quarter of the cloth asks
    report.seconds_candidates += seconds_since(clock);
  };
  step.pairs_suffice = [&](std::span<const Vec3> x) {
    const auto clock = std::chrono::steady_clock::now();
    bool all = s.candidates.keep_flat(cloth, x, s.piece);
    if (const ContactPairs closed = s.tangles.close_growing(x); !closed.empty()) {
      s.candidates.hold(closed);
      all = false;
    }
    report.seconds_candidates += seconds_since(clock);
    return all;
  };
  if (model_.draw_back != nullptr) model_.draw_back->follow(model_, cloth, s.piece, s.skin_holds, h);
  if (!s.tangles.way_out().empty()) step.may_stop = [&](std::span<const Vec3> x) { return s.tangles.no_worse(x); };
  give_back(s.piece.carry, cloth.x);  // piece.start has the places
  const StepResult result = s.step.solve(step, s.end, cloth.v_older);
  report.newton_iterations += result.newton_iterations;
  report.work +=
      result.newton_iterations * WorkLimit::of_iteration(pair_count(s.candidates.pairs()), at(model_.vertex_count()));
  report.lost_weight += h / in.h * result.lost_weight;
  report.linear_iterations += result.linear_iterations;
  report.seconds_assembly += result.seconds_assembly;
  report.seconds_linear += result.seconds_linear;
  report.seconds_contact += result.seconds_contact;
  report.smallest_gap = std::min(report.smallest_gap, result.smallest_gap);
  report.finite = report.finite && result.finite;
  ++report.pieces;
  for (std::size_t g = 0; g < result.on_body.size(); ++g) {
    OnBody& sum = report.on_body[g];
    const double force = result.on_body[g].force.norm();
    sum.impulse += h * result.on_body[g];
    sum.peak = std::max(sum.peak, force);
    if (force > 0) sum.contact_time += h;
  }
  // What was newest grows older; of the velocities what was oldest has become the newest.
  const std::size_t n = step.x_t0.size();
  cloth.x_older.swap(cloth.x_previous);
  std::copy_n(s.piece.start.begin(), n, cloth.x_previous.begin());
  cloth.x.assign(s.end.begin(), s.end.begin() + static_cast<std::ptrdiff_t>(n));
  cloth.v_older.swap(cloth.v_previous);
  cloth.v_previous.swap(cloth.v);
  cloth.h_older = cloth.h_previous;
  cloth.h_previous = step.h;
}

AdvanceReport BodyAdvance::substep(const SubstepInput& in, ClothMotion& cloth) {
  Scratch& s = *scratch_;
  PieceMotion& piece = s.piece;
  const std::size_t nc = cloth.x.size(), nb = in.body_t0.size();
  AdvanceReport report;
  report.smallest_gap = std::numeric_limits<double>::infinity();
  report.on_body.resize(model_.setup.garments.size() * model_.body_count());
  double done = 0, share = 1;  // share: of what is left, that this piece takes
  int short_pieces = 0, in_haste = 0;
  std::vector<double> starts;  // of the pieces, as done
  const auto gains = [&] {
    return starts.size() < k_patience || done - starts[starts.size() - k_patience] >= k_least_gain;
  };
  const auto find_skin_holds = [&] {
    if (model_.collider) s.skin_holds = model_.absence.skin_holds(model_, in.body_t1, in.deep_t1, cloth);
  };
  find_skin_holds();
  while (done < 1) {
    const auto clock = std::chrono::steady_clock::now();
    const double h = share * (1 - done) * in.h;
    const double end = share >= 1 ? 1.0 : done + share * (1 - done);
    piece.start.resize(nc + nb);
    std::copy(cloth.x.begin(), cloth.x.end(), piece.start.begin());
    piece.body_motion.resize(nb);
    s.end.resize(nc + nb);
    parallel_for(nb, k_block, [&](std::size_t begin, std::size_t stop) {
      for (std::size_t i = begin; i < stop; ++i) {
        const Vec3 motion = in.body_t1[i] - in.body_t0[i];
        piece.start[nc + i] = in.body_t0[i] + done * motion;
        s.end[nc + i] = end >= 1 ? in.body_t1[i] : (in.body_t0[i] + end * motion).eval();
        piece.body_motion[i] = s.end[nc + i] - piece.start[nc + i];
      }
    });
    s.tangles.look(h, cloth);
    const auto search = [&] {
      const double share_free = plan(cloth, h);
      report.work += WorkLimit::of_search(pair_count(s.candidates.pairs()), nc);
      return share_free;
    };
    double free = search();
    const auto carried = [&] {
      std::vector<Vec3> x(nc);
      for (std::size_t i = 0; i < nc; ++i) x[i] = cloth.x[i] + piece.all[i].cast<double>();
      return x;
    };
    while (!s.tangles.way_out().empty() && !s.tangles.close_growing(carried()).empty()) free = search();
    report.impatient = report.work > in.patience;
    report.seconds_candidates += seconds_since(clock);
    if (free < 1) {
      const double shorter = share * std::clamp(k_approach * free, k_shortest_cut, k_approach);
      const double length = shorter * (1 - done) * in.h;
      const bool is_short = length < in.shortest;
      const int most_short = k_most_short / (1 + in.earlier_releases + report.releases);
      if (!report.impatient && gains() &&
          (!is_short || (length >= k_last_shortest * in.shortest && short_pieces < most_short))) {
        if (is_short) ++short_pieces;
        share = shorter;
        continue;  // a shorter piece is carried anew: nothing ever ends next to a touch
      }
      const auto joining = std::chrono::steady_clock::now();
      for (int round = 0; free < 1 && s.candidates.cloth_blocks_cloth() && round < k_last_rounds; ++round)
        free = s.candidates.join_blocked(cloth, s.piece);
      report.seconds_candidates += seconds_since(joining);
      // No room: what blocks is let go until it is clear of the cloth again. Should cloth still block cloth then,
      // these pairs pass this once, and the certificate says so.
      const bool whole = report.impatient && ++in_haste > k_most_releases;
      if (free < 1 && s.candidates.release_blocked(cloth, piece, in.deep_t1, whole) > 0) {
        ++report.releases;
        find_skin_holds();  // at once: what is pressed springs through
        share = 1;
        continue;  // search again without them
      }
    }
    for (std::size_t i = 0; i < nc; ++i) s.end[i] = cloth.x[i] + piece.all[i].cast<double>();
    solve(in, h, end, share < 1, cloth, report);
    starts.push_back(done);
    done = end;
    share = share < 1 ? std::min(1.0, k_regrowth * h / ((1 - done) * in.h)) : 1;
  }
  return report;
}

}  // namespace ft::inline solvers
