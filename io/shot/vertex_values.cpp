#include "io/shot/vertex_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "baker/core/file.h"
#include "baker/core/types.h"
#include "io/shot/shot_values.h"
#include "io/shot/words.h"

namespace ft::inline io {
namespace {

constexpr std::uint64_t k_max_bytes = std::uint64_t{1} << 30;

constexpr std::string_view k_blanks = " \t\r\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(k_blanks);
  if (begin == std::string_view::npos) return {};
  text.remove_prefix(begin);
  text.remove_suffix(text.size() - 1 - text.find_last_not_of(k_blanks));
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

/// Cells of a line: between semicolons, else commas, else blanks.
std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> out;
  const char mark = line.find(';') != std::string_view::npos   ? ';'
                    : line.find(',') != std::string_view::npos ? ','
                                                               : ' ';
  while (true) {
    if (mark == ' ') {
      const std::size_t begin = line.find_first_not_of(k_blanks);
      if (begin == std::string_view::npos) return out;
      line.remove_prefix(begin);
    }
    const std::size_t end = mark == ' ' ? line.find_first_of(k_blanks) : line.find(mark);
    out.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return out;
    line.remove_prefix(end + 1);
  }
}

bool parse_number(std::string_view word, double& out) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), out);
  return !word.empty() && end == word.data() + word.size() && fault == std::errc{};
}

bool is_header(const std::vector<std::string_view>& cells) {
  double ignored = 0;
  return std::any_of(cells.begin(), cells.end(),
                     [&](std::string_view c) { return !c.empty() && !parse_number(c, ignored); });
}

std::string named(const std::string& column) {
  return column.empty() ? std::string() : "column " + in_quotes(column) + " ";
}

}  // namespace

Result<VertexValues> parse_vertex_values(std::string_view text, std::string_view where) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  VertexValues out;
  int line_number = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++line_number;
    line = line.substr(0, line.find('#'));
    if (trimmed(line).empty()) continue;
    const auto cells = cells_of(line);
    const std::string place = std::string(where) + ":" + std::to_string(line_number);
    if (out.columns.empty()) {
      const bool names = is_header(cells);
      for (const std::string_view cell : cells) out.columns.emplace_back(names ? printable(cell) : std::string());
      out.values.resize(cells.size());
      if (names) continue;
    }
    const std::string vertex = "vertex " + std::to_string(out.lines.size());
    if (cells.size() != out.columns.size())
      return input_error("has " + std::to_string(cells.size()) + " numbers for " + vertex +
                             ", the line before it has " + std::to_string(out.columns.size()),
                         place);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      double number = 0;
      if (!parse_number(cells[c], number))
        return input_error("has \"" + printable(cells[c]) + "\" for a number of " + vertex, place);
      if (!std::isfinite(number))
        return input_error("has " + named(out.columns[c]) + printable(cells[c]) + " for " + vertex, place,
                           "every vertex needs a finite number");
      out.values[c].push_back(number);
    }
    out.lines.push_back(line_number);
  }
  if (out.lines.empty())
    return input_error("holds no numbers", std::string(where), "one line for each vertex of the mesh is needed");
  return out;
}

Result<VertexValues> read_vertex_values(const std::filesystem::path& path) {
  const auto text = read_text(path, k_max_bytes);
  if (!text) return text.error();
  return parse_vertex_values(*text, path.filename().string());
}

Result<std::vector<double>> vertex_column(const std::filesystem::path& path, const std::string& column,
                                          int vertex_count, double lowest, double highest, std::string_view unit) {
  auto table = read_vertex_values(path);
  if (!table) return table.error();
  const std::string file = path.filename().string();
  const bool has_names = !table->columns.front().empty();
  std::size_t chosen = 0;
  if (column.empty() && table->columns.size() > 1)
    return usage_error("has " + std::to_string(table->columns.size()) + " columns", file,
                       has_names ? "column = says which; there are: " + joined(table->columns)
                                 : "a first line with their names is needed, and column = says which");
  if (!column.empty()) {
    const auto found = std::find(table->columns.begin(), table->columns.end(), column);
    if (found == table->columns.end())
      return usage_error("has no column " + in_quotes(column), file,
                         has_names ? suggestion(column, table->columns) : "its first line names no columns");
    chosen = static_cast<std::size_t>(found - table->columns.begin());
  }
  std::vector<double>& values = table->values[chosen];
  if (values.size() != at(vertex_count))
    return input_error("has " + std::to_string(values.size()) + " lines of numbers, the mesh has " +
                           std::to_string(vertex_count) + " vertices",
                       file, "one line for each vertex in the mesh's order is needed");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= lowest && values[i] <= highest) continue;
    const Allowed allowed{lowest, highest, unit};
    return input_error(named(column) + "= " + number_text(values[i]) + " for vertex " + std::to_string(i) +
                           " is outside [" + number_text(lowest) + ", " + number_text(highest) + "]" +
                           (unit.empty() || unit == "1" ? "" : " " + std::string(unit)),
                       file + ":" + std::to_string(table->lines[i]), unit_slip(values[i], allowed));
  }
  return std::move(values);
}

}  // namespace ft::inline io
