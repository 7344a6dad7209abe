#include "solvers/linear/level_matrix.h"

namespace ft {

void LevelMatrix::build(const BlockPattern& pattern) {
  first_pair_.assign(1, 0);
  column_.clear();
  for (int i = 0; i < pattern.vertex_count(); ++i) {
    const int begin = pattern.row_start[at(i)], end = pattern.row_start[at(i) + 1];
    column_.insert(column_.end(), pattern.column.begin() + begin, pattern.column.begin() + end);
    if (column_.size() % 2 != 0) column_.push_back(column_.back());  // a column that the row has anyway
    first_pair_.push_back(static_cast<int>(column_.size() / 2));
  }
  pairs_.assign(column_.size() / 2, Pair{});
}

}  // namespace ft
