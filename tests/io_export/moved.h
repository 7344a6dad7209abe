// Characters of the assets with a motion that is to be adjusted, and where their joints and vertices are.
#pragma once

#include <gtest/gtest.h>

#include "io/import/character/pose.h"
#include "io/import/motion/adjust.h"
#include "io/import/motion/placed_character.h"
#include "tests/support/assets.h"

namespace ft::test {

struct MovedCase {
  const char* name;
  ImportRequest request;
  std::vector<std::array<const char*, 3>> legs;  ///< hip, knee, ankle; empty: by the words in the names
  double key_beside_frame = 0;                   ///< a key that lies so far from a frame stands for it [s]
};

inline std::vector<MovedCase> moved_cases() {
  const auto root = assets_root() / "characters";
  std::vector<MovedCase> out(4);
  out[0].name = "cesium_man", out[0].request.file = root / "cesium_man/cesium_man.gltf";
  out[0].legs = {{"nodes[7]", "nodes[8]", "nodes[9]"}, {"nodes[3]", "nodes[4]", "nodes[5]"}};
  out[1].name = "quaternius", out[1].request.file = root / "quaternius_base_human/human-base-animations.glb";
  out[1].request.clip = "Jog_Fwd_Loop";
  out[2].name = "mh_adult", out[2].request.file = root / "mh_adult_cmu_dressed/adult_cmu01.glb";
  out[2].request.clip = "01_03_climb_hang_swing", out[2].request.clip_start = 20;
  out[2].key_beside_frame = 1e-4;  // 30 fps, in steps of 0.0333332 s
  out[3].name = "ozz_fbx", out[3].request.file = root / "ozz_pab_fbx/skeleton.fbx";
  out[3].request.animation = root / "ozz_pab_fbx/run.fbx";
  return out;
}

/// Places of all nodes in the world at a time of the clip [m].
inline std::vector<Mat4> nodes_at(const PlacedCharacter& placed, double time) {
  const Character& c = placed.character;
  const ClipPose pose(c, placed.clip < 0 ? nullptr : &c.clips[at(placed.clip)]);
  std::vector<Mat4> locals(c.nodes.size()), globals(c.nodes.size());
  std::vector<double> morphs(pose.rest_morphs().size());
  pose.sample(time, locals, morphs);
  globals_from_locals(c.nodes, locals, globals);
  for (Mat4& m : globals) m = placed.placement * m;
  return globals;
}

inline Vec3 place_of(const Mat4& m) {
  return m.topRightCorner<3, 1>();
}

inline std::vector<Vec3> vertices_at(const Trajectory& t, double time) {
  std::vector<Vec3> out(at(t.surface().vertex_count()));
  t.sample(time, out);
  return out;
}

/// The shot's frames over the clip, at 24 fps.
inline MotionAdjustment adjustment_of(const PlacedCharacter& placed) {
  MotionAdjustment out;
  const Clip& clip = placed.character.clips[at(placed.clip)];
  out.roots = motion_roots(placed.character, placed.clip, {});
  out.first_frame = placed.playback.start;
  out.frame_count = static_cast<int>((clip.end - placed.playback.start) * 24) + 1;
  return out;
}

}  // namespace ft::test
