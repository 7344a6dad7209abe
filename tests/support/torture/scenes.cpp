// The list of torture scenes.
#include <algorithm>
#include <vector>

#include "tests/support/torture/scene.h"
#include "tests/support/torture/scene_functions.h"

namespace ft::torture {

std::span<const Scene> scenes() {
  static const std::vector<Scene> list = {
      // name, what, make, frames, strain, speed, has room, fails today, strained today
      // Twist: 20 cm of cloth 2 mm apart make a rope 3 cm thick, whose outer fibre ten turns over 64 cm stretch by 42
      // %.
      {"twist", "a sheet is twisted by ten turns", twist, 56, 0.3, 9, true, "",
       "p99 strain is 31 to 34 % at most, by rounding; with ten substeps a frame and more 28 to 30 %"},
      {"ring", "a sheet is pulled through a ring", ring, 44, 0.3, 5, true, ""},
      {"funnel", "a sheet is pulled through a funnel", funnel, 44, 0.3, 5, true, ""},
      {"knot", "a knotted ribbon is pulled tight", knot, 54, 0.3, 5, true, ""},
      {"taut", "a strip of ripstop is drawn taut over the edge of a board that rises and rocks", taut, 48, 0.2, 5, true,
       ""},
      {"plates", "plates close on a tube of cloth to less than its thickness, and open", plates, 60, 0.2, 4, true, ""},
      {"plates_no_room", "plates pass into each other with cloth between them, and open", plates_no_room, 72, 0.3, 4,
       false, ""},
      {"elbow", "a sleeve on an elbow that bends to 150 degrees, and back", elbow, 64, 0.3, 6, true, ""},
      {"legs", "a panel between two legs that cross, and open", legs, 60, 0.3, 6, true, ""},
      {"ball_5", "a ball goes through a hanging sheet at 5 m/s", ball_5, 24, 0.5, 13, true, ""},
      {"ball_10", "a ball goes through a hanging sheet at 10 m/s", ball_10, 24, 0.5, 23, true, ""},
      {"ball_20", "a ball goes through a hanging sheet at 20 m/s", ball_20, 24, 0.5, 43, true, ""},
      {"ball_40", "a ball goes through a hanging sheet at 40 m/s", ball_40, 24, 0.5, 83, true, ""},
      {"stack", "ten sheets fall onto a table", stack, 36, 0.1, 5, true, ""},
      {"needles", "a sheet falls onto 25 needles", needles, 30, 0.2, 5, true, ""},
      {"tiny_triangles", "a tenth of the triangles are 1000 times smaller", tiny_triangles, 48, 0.1, 6, true, ""},
      {"cut_edges", "some edges are cut in two, a two hundredth from one end", cut_edges, 48, 0.1, 6, true, ""},
      {"caps", "some triangles are 300 times longer than they are high", caps, 48, 0.1, 6, true, ""},
      {"tiny_edges", "a tenth of the triangles have 1000 times shorter edges", tiny_edges, 48, 0.1, 6, true, ""},
  };
  return list;
}

const Scene* find_scene(std::string_view name) {
  const auto all = scenes();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Scene& s) { return s.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace ft::torture
