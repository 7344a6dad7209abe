#include "io/import/collada/collada_read.h"

#include "io/import/collada/collada_clips.h"

namespace ft::inline io {

void read_collada_over(const ColladaFile& file, Character& character) {
  // assimp scales the root from the file's unit to metres: its nodes count in that unit, as those of other formats do.
  if (const double unit = file.unit(); !character.nodes.empty() && unit > 1e-9 && unit < 1e9) {
    character.nodes.front().local.topLeftCorner<3, 3>() /= unit;
    auto turn = character.nodes.front().local.topLeftCorner<3, 3>();
    turn = turn.array().round().matrix().eval();  // the file's axes, which are 0, 1 and -1
    character.file_unit = unit;
  }
  note_collada_contents(file, character);
  if (Status s = read_collada_clips(file, character); !s)
    character.notes.push_back("animation read by assimp: " + s.error().what +
                              "; keys are joined by straight lines, steps and curves in the file may be lost");
}

}  // namespace ft::inline io
