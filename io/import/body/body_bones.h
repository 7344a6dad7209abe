// The flesh on a skeleton: tapered capsules by the names of the joints, in a frame where Y is up and the skeleton is 1
// tall. Proportions: half breadths and depths of an adult as shares of stature (Drillis and Contini 1966; ANSUR 1988
// medians), rounded.
#pragma once

#include <vector>

#include "io/import/body/body_frame.h"

namespace ft::inline io {

struct BodyBone {
  int node = -1;  ///< moves with it
  Vec3 a, b;      ///< shares of the skeleton's height
  double radius_a = 0, radius_b = 0;
};

/// Many overlapping capsules that blend into a body: lobes beside the spine, hips, heels, skull.
std::vector<BodyBone> flesh(const Character& character, const BodyFrame& frame);

/// Thin capsules along bones that flesh() has no flesh for: they hold together what would come in pieces.
std::vector<BodyBone> links(const BodyFrame& frame);

/// One capsule per bone, as thick as a body is there.
std::vector<BodyBone> capsules(const Character& character, const BodyFrame& frame);

/// Signed distance to a capsule's surface, near enough: exact for equal radii.
double capsule_distance(const BodyBone& bone, const Vec3& p);

}  // namespace ft::inline io
