#include "io/import/motion/placement.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "io/import/body/t_pose.h"

namespace ft::inline io {
namespace {

struct Unit {
  double metres;
  const char* name;
};
/// Units that BVH files are found in.
constexpr Unit k_units[] = {{1, "metres"},       {0.01, "centimetres"}, {0.0254, "inches"}, {0.05644, "5.644 cm (CMU)"},
                            {0.1, "decimetres"}, {0.001, "millimetres"}};
constexpr double k_usual_height = 1.6;  ///< m, from toes to the top joint, with children in mind

constexpr const char* k_axes[2][3] = {{"x", "y", "z"}, {"-x", "-y", "-z"}};

std::string lower(const std::string& text) {
  std::string out;
  for (const char c : text) out.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  return out;
}

/// From the hip joints to the neck; else from the first node to the first one called a head; else to the top of the
/// tallest direction.
Vec3 upwards(const Character& character, const std::vector<Mat4>& globals) {
  if (const Vec3 trunk = trunk_of(find_figure(character), globals); trunk.norm() > 0) return trunk;
  std::size_t root = 0;
  for (std::size_t i = 0; i < character.nodes.size(); ++i)
    if (lower(character.nodes[i].name).find("hip") != std::string::npos ||
        lower(character.nodes[i].name).find("pelvis") != std::string::npos) {
      root = i;
      break;
    }
  for (std::size_t i = 0; i < character.nodes.size(); ++i)
    if (lower(character.nodes[i].name).find("head") != std::string::npos)
      return globals[i].topRightCorner<3, 1>() - globals[root].topRightCorner<3, 1>();
  Vec3 size = node_bounds(globals).size();
  size.x() = 0;
  return size;
}

std::string format(const char* how, double a, double b = 0) {
  char text[160];
  std::snprintf(text, sizeof text, how, a, b);
  return text;
}

}  // namespace

Mat4 Placement::matrix() const {
  Mat4 m = Mat4::Identity();
  m.topLeftCorner<3, 3>() = unit_scale * axes;
  return m;
}

Box node_bounds(const std::vector<Mat4>& globals) {
  Box box;
  for (const Mat4& m : globals) box.include(Vec3(m.topRightCorner<3, 1>()));
  return box;
}

std::string main_axis(const Vec3& direction) {
  const int k = std::abs(direction.z()) > std::abs(direction.y()) ? 2 : 1;
  return k_axes[direction[k] < 0 ? 1 : 0][k];
}

Result<Mat3> axes_from_up(const std::string& up) {
  const bool down = up.starts_with("-");
  const std::string letter = lower(down ? up.substr(1) : up);
  Mat3 m;
  if (letter == "y")
    m = down ? Mat3(Vec3(1, -1, -1).asDiagonal()) : Mat3::Identity();
  else if (letter == "z" && !down)
    m << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  else if (letter == "z")
    m << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  else if (letter == "x" && !down)
    m << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  else if (letter == "x")
    m << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  else
    return usage_error("up = \"" + up + "\" is no axis", "", "\"y\" or \"z\", perhaps \"x\" or with a minus");
  return m;
}

Result<Placement> find_placement(const Character& character, double unit_scale, const std::string& up,
                                 const std::vector<Mat4>& bind_globals, std::vector<std::string>& notes) {
  Placement out;
  out.up = character.file_up;
  out.axes = character.file_axes;
  if (!up.empty()) {
    auto axes = axes_from_up(up);
    if (!axes) return axes.error();
    out.axes = *axes, out.up = up;
  } else if (character.file_up.empty()) {
    out.up = main_axis(upwards(character, bind_globals));
    out.axes = *axes_from_up(out.up);
    notes.push_back("up axis guessed from the skeleton: " + out.up + " (up = ... says otherwise)");
  }

  if (unit_scale < 0 || !std::isfinite(unit_scale))
    return usage_error("unit_scale has to be above 0", "", "metres per file unit: 0.01 for centimetres");
  out.unit_given = unit_scale > 0;
  out.unit_scale = out.unit_given ? unit_scale : character.file_unit;
  if (out.unit_scale == 0) {
    const std::vector<char> own = figure_nodes(character, limbs_by_name(character));
    std::vector<Mat4> figure;
    for (std::size_t i = 0; i < own.size(); ++i)
      if (own[i]) figure.push_back(bind_globals[i]);
    const double size = std::abs((out.axes * node_bounds(figure).size()).y());
    const Unit* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const Unit& unit : k_units) {
      const double off = size > 0 ? std::abs(std::log(size * unit.metres / k_usual_height)) : 0;
      if (off < least) least = off, best = &unit;
    }
    out.unit_scale = best != nullptr ? best->metres : 1;
    notes.push_back(std::string("unit guessed from the skeleton's height: ") +
                    (best != nullptr ? best->name : "metres") +
                    format(", %.3g m tall (unit_scale = ... says otherwise)", size * out.unit_scale));
  }
  return out;
}

Status check_height(double height, const Placement& placement, const std::string& file) {
  if (height >= 0.3 && height <= 4) return {};
  if (!(height > 0)) return input_error("has no height in its bind pose", file);
  std::string hint = "say what a file unit is: ";
  // The usual unit that makes it human-sized, else the factor that does.
  double best = 0, least = 1e300;
  for (const Unit& unit : k_units) {
    const double off = std::abs(std::log(height / placement.unit_scale * unit.metres / k_usual_height));
    if (off < least) least = off, best = unit.metres;
  }
  const double mended = height / placement.unit_scale * best;
  if (mended >= 0.3 && mended <= 4)
    hint += format("unit_scale = %.4g makes it %.3g m tall", best, mended);
  else
    hint += format("unit_scale = %.4g makes it %.3g m tall", placement.unit_scale * 1.7 / height, 1.7);
  hint += format("; unit_scale = %.4g keeps it as it is", placement.unit_scale);
  return input_error(format("is %.4g m tall in its bind pose; characters are 0.3 to 4 m", height), file, hint);
}

}  // namespace ft::inline io
