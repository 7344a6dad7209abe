// Strands grown from a painted region of a scalp: roots spread over it (roots.h), and from each a strand that leaves
// along the normal, bends into the combing direction, lies on the body where it meets it, and hangs from where it does
// not. A shape to begin with, as a groom is: gravity and the other strands come with the simulation.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "baker/core/result.h"
#include "baker/core/types.h"

namespace ft::inline baker {

/// A parting: strands near to it lie to the side of it that they are on.
struct Parting {
  Vec3 point = Vec3::Zero();       ///< on the line, at the scalp [m]
  Vec3 direction = Vec3::UnitZ();  ///< of the line, along the scalp; any length but 0
};

struct Growth {
  double density = 8000;          ///< roots per area where painted fully [1/m2]; guides 3e3..2e4, beyond is for renders
  double length = 0.4;            ///< along the strand [m]; 0.05 short, 0.6 to the waist
  double length_variation = 0.1;  ///< evenly up and down, of the length [1]; 0 all the same, 0.9 a wild cut
  double curl_radius = 0;         ///< of the helix [m]; 0 straight, 0.005 waves, 0.015 locks
  double curl_pitch = 0.05;       ///< of the helix, along the strand's middle [m]; small against the radius is a coil
  double clump_size = 0;          ///< distance of locks on the scalp [m]; 0 none, 0.01 fine, 0.04 heavy locks
  double lift = 0.4;              ///< at the root: 0 flat along the scalp, 1 along the normal
  double bend = 0.03;             ///< length over which a strand turns to the comb [m]; 0.01 limp, 0.2 a brush
  double volume = 0.012;          ///< how far above the body the uppermost strands lie [m]; 0 all at the gap
  Vec3 comb = Vec3(0, -1, 0);     ///< where strands go in the end; any length but 0. Down: as they hang
  std::optional<Parting> part;    ///< none: they lie as the comb says
  std::uint64_t seed = 1;
  int vertices = 24;  ///< of a strand, at equal distances; 2 or more
};

/// Where it grows: a piece of the body, or a mesh of its own that lies on it.
struct PaintedRegion {
  std::span<const Vec3> positions;  ///< m
  std::span<const Triangle> triangles;
  std::span<const double> weight;  ///< of each vertex: painted 0 to 1
};

struct GrownStrand {
  std::vector<Vec3> line;          ///< root first [m]
  int triangle = 0;                ///< of the region, on which the root is
  std::array<double, 3> weight{};  ///< barycentric, of the root
};

/// How near vertices come to the body, but for the root [m].
inline constexpr double k_strand_gap = 0.002;
/// What is more is a slip in the density.
inline constexpr double k_most_strands = 500'000;

/// The body is all that strands have to lie outside of, facing outwards; it need not be closed. As many strands as
/// painted area times density says, rounded, less those that would begin inside, under another layer of the body; the
/// same on every machine and for every number of threads. In folds narrower than two gaps vertices may be nearer.
/// Errors: values out of range, nothing painted, too many strands.
Result<std::vector<GrownStrand>> grown(const Growth& growth, std::span<const Vec3> body,
                                       std::span<const Triangle> body_triangles, const PaintedRegion& region);

/// What a painted region is [m2].
double painted_area(const PaintedRegion& region);

}  // namespace ft::inline baker
