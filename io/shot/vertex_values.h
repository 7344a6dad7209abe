// Numbers that belong to the vertices of a mesh, from a text file: what exporters and spreadsheets write. For maps and
// pins of the shot file. A line for each vertex in the mesh's order, numbers between commas, semicolons or blanks;
// blank lines and what follows a # are skipped; a first line that holds words names the columns. Every number has to be
// finite.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "baker/core/result.h"

namespace ft::inline io {

struct VertexValues {
  std::vector<std::string> columns;         ///< names; empty ones where the file has no line of names
  std::vector<std::vector<double>> values;  ///< of each column, one per vertex
  std::vector<int> lines;                   ///< line of each vertex, from 1
};

Result<VertexValues> read_vertex_values(const std::filesystem::path& path);

/// The same from text; `where` stands in front of line numbers in messages.
Result<VertexValues> parse_vertex_values(std::string_view text, std::string_view where);

/// One column as numbers of a mesh of vertex_count vertices, all within [lowest, highest] `unit`; the message about one
/// that is not names the vertex and its line. `column` may be empty when there is only one.
Result<std::vector<double>> vertex_column(const std::filesystem::path& path, const std::string& column,
                                          int vertex_count, double lowest, double highest, std::string_view unit);

}  // namespace ft::inline io
