// Writes a bake of hair that swings on a ball, to look at: followthrough preview FOLDER.
//   write_combed_ball FOLDER STRANDS VERTICES FRAMES
#include <cstdlib>

#include "tests/support/combed_bake.h"

int main(int argc, char** argv) {
  using namespace ft;
  CHECK(argc == 5);
  test::CombedBall ball;
  ball.strands = std::atoi(argv[2]), ball.vertices = std::atoi(argv[3]);
  test::write_combed_bake(argv[1], ball, std::atoi(argv[4]));
}
