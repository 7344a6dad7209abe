#include "io/import/collada/collada_stack.h"

#include <algorithm>
#include <cmath>

namespace ft::inline io {
namespace {

Mat4 matrix_of(const std::vector<double>& v) {
  Mat4 out = Mat4::Identity();
  for (std::size_t k = 0; k < 16 && k < v.size(); ++k)
    out(static_cast<Eigen::Index>(k / 4), static_cast<Eigen::Index>(k % 4)) = v[k];
  return out;
}

/// From eye, point of interest and up: the node looks along its -z.
Mat4 look_at(const std::vector<double>& v) {
  const Vec3 eye(v[0], v[1], v[2]), aim(v[3], v[4], v[5]), up(v[6], v[7], v[8]);
  const Vec3 z = (eye - aim).normalized(), x = up.cross(z).normalized(), y = z.cross(x);
  Mat4 out = Mat4::Identity();
  out.block<3, 1>(0, 0) = x, out.block<3, 1>(0, 1) = y, out.block<3, 1>(0, 2) = z, out.block<3, 1>(0, 3) = eye;
  return out;
}

/// Time and value of a key's tangent for output number k of `width`; false: it has no time of its own.
bool tangent_of(const ColladaRows& rows, std::size_t key, std::size_t k, std::size_t width, double& time,
                double& value) {
  const double* row = rows.numbers.data() + key * rows.width;
  if (rows.width == 2 * width) {
    time = row[2 * k], value = row[2 * k + 1];
    return true;
  }
  if (rows.width == width + 1) {
    time = row[0], value = row[1 + k];
    return true;
  }
  value = row[k];
  return false;
}

bool fits(const ColladaRows& rows, std::size_t keys, std::size_t width) {
  return rows.numbers.size() == keys * rows.width &&
         (rows.width == width || rows.width == width + 1 || rows.width == 2 * width);
}

}  // namespace

ColladaTransform collada_transform(const pugi::xml_node& node, int index) {
  ColladaTransform out;
  out.stack.node = index;
  for (const pugi::xml_node child : node.children()) {
    const std::string kind = child.name();
    const std::vector<double> v = collada_numbers(child.child_value());
    ElementaryTransform e;
    if (kind == "translate" && v.size() >= 3) {
      e.kind = TransformKind::k_translate, e.numbers.rest = {v[0], v[1], v[2]};
    } else if (kind == "scale" && v.size() >= 3) {
      e.kind = TransformKind::k_scale, e.numbers.rest = {v[0], v[1], v[2]};
    } else if (kind == "rotate" && v.size() >= 4) {
      e.kind = TransformKind::k_rotate_about, e.numbers.rest = {v[3], 0, 0};
      if (const Vec3 axis(v[0], v[1], v[2]); axis.norm() > 0)
        e.axis = axis;
      else
        e.numbers.rest.setZero();
    } else if (kind == "matrix" && v.size() >= 16) {
      e.kind = TransformKind::k_matrix, e.matrix = matrix_of(v);
    } else if (kind == "lookat" && v.size() >= 9) {
      e.kind = TransformKind::k_matrix, e.matrix = look_at(v);
    } else {
      out.skewed = out.skewed || kind == "skew";
      continue;
    }
    out.stack.elements.push_back(std::move(e));
    out.sids.emplace_back(child.attribute("sid").value());
    out.kinds.push_back(kind);
  }
  return out;
}

Result<std::vector<Curve>> collada_curves(const ColladaFile& file, const pugi::xml_node& sampler, bool& unknown) {
  ColladaRows times, values, how, into, from;
  for (const pugi::xml_node input : sampler.children("input")) {
    const std::string meaning = input.attribute("semantic").value();
    ColladaRows* rows = meaning == "INPUT"           ? &times
                        : meaning == "OUTPUT"        ? &values
                        : meaning == "INTERPOLATION" ? &how
                        : meaning == "IN_TANGENT"    ? &into
                        : meaning == "OUT_TANGENT"   ? &from
                                                     : nullptr;
    if (rows == nullptr) continue;
    auto read = file.source(input.attribute("source").value());
    if (!read) return read.error();
    *rows = std::move(*read);
  }
  const std::size_t n = times.count(), width = values.width;
  if (n == 0 || times.width != 1 || width == 0 || values.numbers.size() != n * width)
    return input_error("a sampler's keys and values do not match");
  std::vector<CurveInterpolation> interpolation(n, CurveInterpolation::k_linear);
  std::vector<char> hermite(n, 0);
  bool cubic = false;
  for (std::size_t i = 0; i < n && i < how.words.size(); ++i) {
    const std::string& word = how.words[i];
    hermite[i] = word == "HERMITE";
    if (word == "STEP") {
      interpolation[i] = CurveInterpolation::k_constant;
    } else if ((word == "BEZIER" || word == "HERMITE") && fits(from, n, width) && fits(into, n, width)) {
      interpolation[i] = CurveInterpolation::k_cubic, cubic = true;
    } else if (word != "LINEAR") {
      unknown = true;
    }
  }
  for (std::size_t i = 1; i < n; ++i)
    if (!(times.numbers[i] >= times.numbers[i - 1])) return input_error("key times do not ascend");

  std::vector<Curve> curves(width);
  for (std::size_t k = 0; k < width; ++k) {
    Curve& curve = curves[k];
    curve.times = times.numbers;
    for (std::size_t i = 0; i < n; ++i) curve.values.push_back(values.numbers[i * width + k]);
    if (!how.words.empty()) curve.interpolation = interpolation;
    if (!cubic) continue;
    curve.handles.resize(n);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      if (interpolation[i] != CurveInterpolation::k_cubic) continue;
      const double span = curve.times[i + 1] - curve.times[i];
      CurveHandles &a = curve.handles[i], &b = curve.handles[i + 1];
      double time = 0, value = 0;
      const bool out_has_time = tangent_of(from, i, k, width, time, value);
      a.after_time = !out_has_time ? span / 3 : hermite[i] ? time / 3 : time - curve.times[i];
      a.after_value = hermite[i] ? value / 3 : value - curve.values[i];
      const bool in_has_time = tangent_of(into, i + 1, k, width, time, value);
      b.before_time = !in_has_time ? span / 3 : hermite[i] ? time / 3 : curve.times[i + 1] - time;
      b.before_value = hermite[i] ? value / 3 : curve.values[i + 1] - value;
      for (double* run : {&a.after_time, &b.before_time}) *run = std::clamp(*run, 0.0, std::max(span, 0.0));
    }
  }
  return curves;
}

}  // namespace ft::inline io
