// The feasible colliders of real characters do not jump between poses that are 2 ms apart.
#include "tests/support/collider_jumps.h"

#include <gtest/gtest.h>

#include "io/import/import.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

TEST(ColliderJumps, There_are_none_of_the_rumba_mannequin_whose_nails_and_eyes_are_pieces_slow) {
  const auto folder = test::assets_root() / "garments/cipc_mannequin_rumba";
  FT_REQUIRE_FILE(folder / "rumba_body_121f.pc2");
  ImportRequest request;
  request.file = folder / "rumba_body_121f.pc2", request.topology = folder / "body_frame0_yup.obj";
  request.source_fps = 25, request.shot_fps = 24, request.duration = 4.8;
  const auto primary = import_primary(request);
  ASSERT_TRUE(primary) << primary.error().text();
  const auto jumps = test::collider_jumps(*primary->trajectory, {}, 0, 4.8, 500, 2e-3);
  EXPECT_TRUE(jumps.empty()) << jumps.size() << ", the first at " << jumps.front().time << " s of vertex "
                             << jumps.front().vertex;
}

}  // namespace
}  // namespace ft
