// Wavefront's l elements: "l v1/vt1 v2/vt2 ...", indices from 1 or, negative, back from the last vertex so far. Faces
// beside them are skipped with a note. Careful: an element may name vertices that come later, so that indices are
// judged at the end.
#include "io/hair/obj_lines.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/shot/obj_words.h"

namespace ft::inline io {
namespace {

std::string_view cut_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

/// Where a line ends in a backslash the next one belongs to it.
bool take_continuation(std::string_view& line) {
  while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  if (!line.ends_with('\\')) return false;
  line.remove_suffix(1);
  return true;
}

struct Element {
  std::vector<int> vertices;
  int line_number = 0;
};

class LinesParser {
 public:
  explicit LinesParser(std::string_view where) : where_(where) {}

  Status parse(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    int next_number = 1;
    std::string joined;
    while (!text.empty()) {
      number_ = next_number++;
      std::string_view line = cut_line(text);
      bool goes_on = take_continuation(line);
      if (goes_on) joined = line;
      const bool many = goes_on;
      while (goes_on && !text.empty()) {
        line = cut_line(text), ++next_number;
        goes_on = take_continuation(line);
        joined.append(" ").append(line);
      }
      if (const Status status = parse_line(many ? std::string_view(joined) : line); !status) return status;
    }
    for (const Element& e : elements_)
      for (const int v : e.vertices)
        if (at(v) >= positions_.size()) {
          number_ = e.line_number;
          return fault(fmt::format("line names vertex {}; the file has {}", v + 1, positions_.size()));
        }
    return {};
  }

  std::vector<Vec3> positions_;
  std::vector<Element> elements_;
  std::size_t face_count_ = 0;

 private:
  Error fault(std::string what) const {
    return input_error(std::move(what), fmt::format("{}:{}", where_, number_),
                       "the file may be cut or damaged; export it again");
  }

  Status parse_line(std::string_view line) {
    const std::string_view key = next_word(line);
    if (key == "v") return parse_vertex(line);
    if (key == "l") return parse_element(line);
    if (key == "f") ++face_count_;
    return {};
  }

  Status parse_vertex(std::string_view line) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
      const std::string_view word = next_word(line);
      if (!parse_number(word, p[k])) return fault(fmt::format("vertex has \"{}\" for a number", shown(word)));
      if (!std::isfinite(p[k])) return fault(fmt::format("vertex has the value {}, which is not finite", shown(word)));
    }
    positions_.push_back(p);
    return {};
  }

  Status parse_element(std::string_view line) {
    Element e{{}, number_};
    for (auto word = next_word(line); !word.empty() && word.front() != '#'; word = next_word(line)) {
      long long index = 0;
      if (!parse_index(word.substr(0, word.find('/')), index) || index == 0)
        return fault(fmt::format("line has \"{}\" for a vertex; they count from 1", shown(word)));
      const long long vertex = index > 0 ? index - 1 : static_cast<long long>(positions_.size()) + index;
      if (vertex < 0 || vertex >= std::numeric_limits<int>::max())
        return fault(fmt::format("line names vertex {}, which does not exist", shown(word)));
      e.vertices.push_back(static_cast<int>(vertex));
    }
    if (e.vertices.size() < 2) return fault("line has fewer than two vertices");
    elements_.push_back(std::move(e));
    return {};
  }

  std::string_view where_;
  int number_ = 0;
};

/// Joins elements at vertices where exactly two of them end.
class Chains {
 public:
  Chains(std::span<const Element> elements, std::size_t vertex_count)
      : elements_(elements), used_(elements.size(), false), ends_(vertex_count, {-1, -1}), end_count_(vertex_count, 0) {
    for (std::size_t e = 0; e < elements.size(); ++e)
      for (const int v : {elements[e].vertices.front(), elements[e].vertices.back()}) {
        if (end_count_[at(v)] < 2) ends_[at(v)][at(end_count_[at(v)])] = static_cast<int>(e);
        ++end_count_[at(v)];
      }
  }

  std::vector<std::vector<int>> joined() {
    std::vector<std::vector<int>> out;
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      const auto& vertices = elements_[e].vertices;
      const bool first_free = !goes_on(vertices.front()), last_free = !goes_on(vertices.back());
      if (used_[e] || (!first_free && !last_free)) continue;
      out.push_back(walk(static_cast<int>(e), first_free ? vertices.front() : vertices.back()));
      // What is one element has the direction that it was written in.
      if (out.back().size() > vertices.size() && out.back().back() < out.back().front())
        std::reverse(out.back().begin(), out.back().end());
    }
    return out;
  }
  std::size_t circle_count() const { return static_cast<std::size_t>(std::ranges::count(used_, false)); }

 private:
  bool goes_on(int vertex) const { return end_count_[at(vertex)] == 2; }

  std::vector<int> walk(int element, int from) {
    std::vector<int> out{from};
    while (element >= 0 && !used_[at(element)]) {
      used_[at(element)] = true;
      const auto& vertices = elements_[at(element)].vertices;
      if (vertices.front() == out.back())
        out.insert(out.end(), vertices.begin() + 1, vertices.end());
      else
        out.insert(out.end(), vertices.rbegin() + 1, vertices.rend());
      const auto& next = ends_[at(out.back())];
      element = goes_on(out.back()) ? (next[0] == element ? next[1] : next[0]) : -1;
    }
    return out;
  }

  std::span<const Element> elements_;
  std::vector<bool> used_;
  std::vector<std::array<int, 2>> ends_;
  std::vector<int> end_count_;
};

}  // namespace

bool has_obj_lines(std::string_view text) {
  while (!text.empty()) {
    std::string_view line = cut_line(text);
    if (next_word(line) == "l") return true;
  }
  return false;
}

Result<std::vector<std::vector<Vec3>>> parse_obj_lines(std::string_view text, std::string_view where,
                                                       std::vector<std::string>& notes) {
  LinesParser parser(where);
  if (const Status status = parser.parse(text); !status) return status.error();
  Chains chains(parser.elements_, parser.positions_.size());
  const auto joined = chains.joined();
  if (const std::size_t count = chains.circle_count(); count > 0)
    notes.push_back(fmt::format("{} lines that close to circles are left out: they have no root", count));
  if (parser.face_count_ > 0)
    notes.push_back(fmt::format("{} faces are left out: the file has lines, which are the guides", parser.face_count_));
  std::vector<std::vector<Vec3>> out;
  for (const auto& line : joined) {
    auto& strand = out.emplace_back();
    for (const int v : line) strand.push_back(parser.positions_[at(v)]);
  }
  return out;
}

}  // namespace ft::inline io
