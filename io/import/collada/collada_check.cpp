#include "io/import/collada/collada_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <map>
#include <optional>

namespace ft::inline io {
namespace {

constexpr const char* k_spaces = " \t\r\n";
constexpr std::uint64_t k_most_columns = 256;  ///< inputs of a primitive; a file has ten at most

/// "<p> in "body"": the id is the nearest one around the element.
std::string place(const pugi::xml_node& element) {
  pugi::xml_node named = element;
  while (named && !named.attribute("id")) named = named.parent();
  if (!named) return fmt::format("<{}>", element.name());
  return fmt::format("<{}> {}\"{}\"", element.name(), named == element ? "" : "in ", named.attribute("id").value());
}

Error damaged_at(const pugi::xml_node& element, const std::string& what) {
  return input_error(place(element) + " " + what, "", "copy or export the file again");
}

std::uint64_t number(const pugi::xml_node& element, const char* name, std::uint64_t otherwise = 0) {
  return element.attribute(name).as_ullong(otherwise);
}

/// visit(position, index) for each word; an error at what is no whole number of at most 32 bits.
template <class Visit>
Result<std::uint64_t> for_each_index(const pugi::xml_node& element, Visit visit) {
  const char* text = element.child_value();
  const char* end = text + std::strlen(text);
  std::uint64_t count = 0;
  for (const char* p = text + std::strspn(text, k_spaces); p != end; ++count) {
    std::uint32_t index = 0;
    const auto [after, error] = std::from_chars(p, end, index);
    if (error != std::errc() || (after != end && std::strchr(k_spaces, *after) == nullptr))
      return damaged_at(element, fmt::format("has \"{}\" where an index belongs",
                                             std::string(p, std::min<std::size_t>(std::strcspn(p, k_spaces), 20))));
    visit(count, std::uint64_t{index});
    p = after + std::strspn(after, k_spaces);
  }
  return count;
}

std::uint64_t count_words(const pugi::xml_node& element) {
  std::uint64_t count = 0;
  for (const char* p = element.child_value(); *(p += std::strspn(p, k_spaces)) != '\0'; p += std::strcspn(p, k_spaces))
    ++count;
  return count;
}

class Check {
 public:
  explicit Check(const ColladaFile& file) : file_(file) {}

  /// Arrays before accessors, accessors before indices: each rests on the one before.
  Status run() {
    for (const auto step : {&Check::array, &Check::accessor, &Check::primitive, &Check::skin})
      if (Status s = visit_all(step); !s) return s;
    return {};
  }

 private:
  Status visit_all(Status (Check::*step)(const pugi::xml_node&)) {
    for (pugi::xml_node n = file_.root(); n; n = next_element(n, file_.root()))
      if (Status s = (this->*step)(n); !s) return s;
    return {};
  }

  Status array(const pugi::xml_node& n) {
    if (!std::string(n.name()).ends_with("_array")) return {};
    const std::uint64_t said = number(n, "count"), there = count_words(n);
    if (said > there) return damaged_at(n, fmt::format("is to have {} values and has {}", said, there));
    array_sizes_[n] = said;
    return {};
  }

  Status accessor(const pugi::xml_node& n) {
    if (std::string(n.name()) != "accessor") return {};
    const auto size = array_sizes_.find(file_.find(n.attribute("source").value()));
    const std::uint64_t count = number(n, "count");
    if (size == array_sizes_.end() || count == 0) return {};
    std::uint64_t columns = 0;
    for (const pugi::xml_node param : n.children("param")) columns += collada_columns(param);
    if (!reaches(n, count, std::max<std::uint64_t>(columns, 1), size->second))
      return damaged_at(n, fmt::format("takes more than the {} values of its array", size->second));
    return {};
  }

  /// Whether `count` rows of that many columns lie within the array.
  static bool reaches(const pugi::xml_node& accessor, std::uint64_t count, std::uint64_t columns, std::uint64_t size) {
    const std::uint64_t stride = number(accessor, "stride", 1), offset = number(accessor, "offset");
    if (count == 0) return true;
    return offset <= size && stride <= size && count <= size && (count - 1) * stride + columns + offset <= size;
  }

  /// Accessor of a <source>, or of the positions of <vertices>.
  pugi::xml_node accessor_of(const pugi::xml_node& input) const {
    pugi::xml_node source = file_.find(input.attribute("source").value());
    if (std::string(source.name()) == "vertices") {
      const pugi::xml_node positions = source.find_child_by_attribute("input", "semantic", "POSITION");
      source = file_.find(positions.attribute("source").value());
    }
    return source.child("technique_common").child("accessor");
  }

  /// Rows that an index of each column may name; nothing where the input leads nowhere.
  Result<std::vector<std::optional<std::uint64_t>>> columns_of(const pugi::xml_node& element) const {
    std::vector<std::optional<std::uint64_t>> out;
    for (const pugi::xml_node input : element.children("input")) {
      const std::uint64_t column = number(input, "offset");
      if (column >= k_most_columns) return damaged_at(element, fmt::format("has an input at offset {}", column));
      if (out.size() <= column) out.resize(column + 1);
      if (const pugi::xml_node accessor = accessor_of(input))
        out[column] = std::min(out[column].value_or(UINT64_MAX), number(accessor, "count"));
    }
    return out;
  }

  /// <vcount> of an element that counts its parts: the sum; an error when there are fewer numbers than parts.
  Result<std::uint64_t> sum_of_counts(const pugi::xml_node& element) const {
    const std::uint64_t parts = number(element, "count");
    std::uint64_t sum = 0;
    const auto counted = for_each_index(element.child("vcount"), [&](std::uint64_t at, std::uint64_t value) {
      if (at < parts) sum += value;
    });
    if (!counted) return counted.error();
    if (*counted < parts) return damaged_at(element, fmt::format("is to have {} parts and has {}", parts, *counted));
    return sum;
  }

  Status primitive(const pugi::xml_node& n) {
    const std::string kind = n.name();
    if (kind != "triangles" && kind != "polylist" && kind != "polygons" && kind != "lines" && kind != "linestrips" &&
        kind != "trifans" && kind != "tristrips")
      return {};
    const auto columns = columns_of(n);
    if (!columns) return columns.error();
    std::optional<std::uint64_t> points;
    if (kind == "triangles") points = 3 * std::min<std::uint64_t>(number(n, "count"), UINT32_MAX);
    if (kind == "polylist") {
      const auto sum = sum_of_counts(n);
      if (!sum) return sum.error();
      points = *sum;
    }
    for (const pugi::xml_node p : n.children("p"))
      if (Status s = indices(n, p, *columns, points); !s) return s;
    return {};
  }

  Status indices(const pugi::xml_node& n, const pugi::xml_node& p,
                 const std::vector<std::optional<std::uint64_t>>& columns, std::optional<std::uint64_t> points) {
    const std::size_t width = std::max<std::size_t>(columns.size(), 1);
    std::vector<std::uint64_t> largest(width, 0);
    const auto count = for_each_index(
        p, [&](std::uint64_t at, std::uint64_t index) { largest[at % width] = std::max(largest[at % width], index); });
    if (!count) return count.error();
    if (*count == 0) return {};
    if (*count % width != 0) return damaged_at(p, fmt::format("has {} indices, {} of them to a point", *count, width));
    if (points && *points > *count / width)
      return damaged_at(n, fmt::format("is to have {} points and has {}", *points, *count / width));
    for (std::size_t c = 0; c < columns.size(); ++c)
      if (columns[c] && largest[c] >= *columns[c])
        return damaged_at(p, fmt::format("has the index {} of {} values", largest[c], *columns[c]));
    for (const pugi::xml_node input : n.children("input"))
      if (std::string(input.attribute("semantic").value()) == "VERTEX") {
        std::uint64_t& used = used_points_[n.parent().parent()];
        used = std::max(used, largest[number(input, "offset")] + 1);
      }
    return {};
  }

  Status skin(const pugi::xml_node& n) {
    if (std::string(n.name()) != "skin") return {};
    const pugi::xml_node weights = n.child("vertex_weights");
    if (!weights) return {};
    const auto columns = columns_of(weights);
    if (!columns) return columns.error();
    const auto pairs = sum_of_counts(weights);
    if (!pairs) return pairs.error();
    const pugi::xml_node shape = shape_of(n);
    const auto used = used_points_.find(shape);
    if (used != used_points_.end() && number(weights, "count") < used->second)
      return damaged_at(weights, fmt::format("is for {} vertices, and \"{}\" has {}", number(weights, "count"),
                                             shape.attribute("id").value(), used->second));
    const auto joints = joint_count(n);
    if (!joints) return joints.error();
    const std::size_t width = columns->size();
    std::vector<std::uint64_t> largest(std::max<std::size_t>(width, 1), 0);
    const pugi::xml_node v = weights.child("v");
    const auto count = for_each_index(v, [&](std::uint64_t at, std::uint64_t index) {
      if (width != 0 && at < *pairs * width) largest[at % width] = std::max(largest[at % width], index);
    });
    if (!count) return count.error();
    if (*count / std::max<std::size_t>(width, 1) < *pairs)
      return damaged_at(weights,
                        fmt::format("is to have {} pairs of joint and weight and has {} numbers", *pairs, *count));
    for (const pugi::xml_node input : weights.children("input")) {
      const std::uint64_t c = number(input, "offset");
      const bool is_joint = std::string(input.attribute("semantic").value()) == "JOINT";
      const std::uint64_t most = is_joint ? *joints : (*columns)[c].value_or(UINT64_MAX);
      if (*pairs > 0 && largest[c] >= most)
        return damaged_at(weights, fmt::format("has the {} {} of {}", is_joint ? "joint" : "weight", largest[c], most));
    }
    return {};
  }

  /// The <geometry> below a skin, through a morph if there is one.
  pugi::xml_node shape_of(const pugi::xml_node& skin) const {
    pugi::xml_node out = file_.find(skin.attribute("source").value());
    for (int depth = 0; depth < 8 && std::string(out.name()) == "controller"; ++depth) {
      const pugi::xml_node inner = out.child("morph") ? out.child("morph") : out.child("skin");
      out = file_.find(inner.attribute("source").value());
    }
    return out;
  }

  /// Joints by the array of their names; an error when there are not as many names and matrices in reach.
  Result<std::uint64_t> joint_count(const pugi::xml_node& skin) const {
    std::uint64_t joints = UINT64_MAX;
    for (const auto& [semantic, width] : {std::pair{"JOINT", 1}, std::pair{"INV_BIND_MATRIX", 16}}) {
      const pugi::xml_node input = skin.child("joints").find_child_by_attribute("input", "semantic", semantic);
      const pugi::xml_node accessor = accessor_of(input);
      const auto size = array_sizes_.find(file_.find(accessor.attribute("source").value()));
      if (size == array_sizes_.end()) continue;
      if (width == 1) joints = size->second;
      if (joints != UINT64_MAX && !reaches(accessor, joints, static_cast<std::uint64_t>(width), size->second))
        return damaged_at(skin.child("joints"), fmt::format("has {} joints, and {} values of its {} are not enough",
                                                            joints, size->second, semantic));
    }
    return joints;
  }

  const ColladaFile& file_;
  std::map<pugi::xml_node, std::uint64_t> array_sizes_;
  std::map<pugi::xml_node, std::uint64_t> used_points_;  ///< by <geometry>
};

}  // namespace

Status check_collada(const ColladaFile& file) {
  return Check(file).run();
}

}  // namespace ft::inline io
