// What the parts of a mesh are called in its file, for messages: vertices, faces and stitches count from 0 in the order
// of the file there, as in the shot file, whatever was joined for the simulation.
#pragma once

#include <vector>

#include "baker/core/types.h"

namespace ft::inline io {

/// Of each part its number in the file; an empty list: the number that it has. Of joined vertices the first counts.
struct FileNumbers {
  std::vector<int> vertices, faces, stitches;
  std::vector<int> corners;  ///< places in face_vertices

  int vertex(int i) const { return number(vertices, i); }
  int face(int i) const { return number(faces, i); }
  int stitch(int i) const { return number(stitches, i); }
  int corner(int i) const { return number(corners, i); }

 private:
  static int number(const std::vector<int>& list, int i) { return list.empty() ? i : list[at(i)]; }
};

}  // namespace ft::inline io
