// The paper's decision tree: which coupling an interaction needs, from what a one-way pass of it measures. Significance
// first (does the primary notice?), then stability (can one-way be baked at all?), then what the rest costs.
//
//   insignificant, stable     one-way
//   insignificant, unstable   hybrid
//   significant               two-way, where a debug cycle of it stays interactive
//                             hybrid, where a stand-in models the force
//                             two-way, and a search for the primary's controls
//   between                   both are named
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "baker/core/types.h"
#include "baker/record/report_json.h"

namespace ft::inline baker {

enum class Coupling { k_one_way, k_hybrid, k_two_way };
const char* name(Coupling coupling);

/// Whether anybody looks at it.
enum class Context { k_none, k_background, k_far, k_occluded, k_hero };
std::optional<Context> context_from(const std::string& name);
std::vector<std::string> context_names();

struct AdviceThresholds {
  double insignificant = 1;    ///< effective acceleration below it is not noticed [m/s2] (O'Brien et al. 2000)
  double significant = 5;      ///< from here on it is; between the two both answers are given [m/s2]
  double overwhelmed = 0.1;    ///< of the acceleration that the primary has anyway [1]
  double displacement = 5e-3;  ///< of the primary within half a second of contact [m]
  double strain = 0.1;         ///< p99, above which one-way deforms the secondary out of its looks [1]
  double dissipative = 0.9, upright = 0.9;  ///< share of the frames from which a stand-in fits the pattern [1]
  double interactive = 10;                  ///< longest debug cycle [s]
};

/// What is known of an interaction.
struct Evidence {
  std::string primary, secondary;
  int frames = 0;          ///< with contact
  bool mass_known = true;  ///< the primary's; without it there are no accelerations
  double acceleration_p95 = 0, acceleration_mean = 0, acceleration_max = 0;  ///< effective, |F| / M [m/s2]
  /// The primary's own, gravity's share included: what its muscles and the ground do to it (p95) [m/s2].
  std::optional<double> own_acceleration;
  std::optional<double> displacement;     ///< that F / M would make within half a second of contact, at most [m]
  std::optional<double> velocity_change;  ///< impulse / M [m/s]
  double strain_p99 = 0;
  int crossing_frames = 0, released_frames = 0;
  bool finite = true;
  double cycle_seconds = 0;                                ///< of a coarse pass over the whole shot
  std::optional<double> dissipative_share, upright_share;  ///< of the frames: against the motion; straight upwards [1]
  /// F = -c v fitted to all frames: c [kg/s] and the share of the force that it explains.
  double damping = 0, damping_r2 = 0;
  Box place;                     ///< of the primary while they touch [m]
  bool two_way_possible = true;  ///< the program can step the two together

  /// The fitted stand-in as a table of the shot file; empty where nothing was fitted.
  std::vector<std::string> stand_in_table() const;
};

struct Advice {
  Coupling coupling = Coupling::k_one_way;
  std::optional<Coupling> also;      ///< the other answer of a case between
  std::vector<std::string> reasons;  ///< sentences, in the order of the tree
};

Advice advise(const Evidence& evidence, Context context, const AdviceThresholds& thresholds);

Json to_json(const Evidence& evidence, const Advice& advice);
Json to_json(const AdviceThresholds& thresholds);

}  // namespace ft::inline baker
