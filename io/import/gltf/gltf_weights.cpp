#include "io/import/gltf/gltf_weights.h"

#include <algorithm>

namespace ft::inline io::gltf {
namespace {

constexpr double k_most_joint = 65535;
constexpr std::size_t k_most_set_vertices = 40'000'000;  ///< of one primitive, over its sets

struct Set {
  AccessorValues joints, weights;
};

Result<std::vector<Set>> read_sets(const Json& attributes, const ReadAttribute& read, std::size_t vertex_count,
                                   MeshOddities& odd) {
  std::vector<Set> sets;
  if (!attributes.is_object()) return sets;
  bool lonely = false;
  for (std::size_t n = 0; n < attributes.size(); ++n) {
    const std::string joint_name = "JOINTS_" + std::to_string(n), weight_name = "WEIGHTS_" + std::to_string(n);
    const bool has_joints = attributes.contains(joint_name), has_weights = attributes.contains(weight_name);
    if (has_joints != has_weights) lonely = true;
    if (!has_joints || !has_weights) continue;
    if ((sets.size() + 1) * vertex_count > k_most_set_vertices)
      return input_error(joint_name + ": more than 40 million sets of weights");
    auto joints = read(joint_name.c_str(), Integers::k_themselves);
    if (!joints) return input_error(joint_name + ": " + joints.error().what);
    auto weights = read(weight_name.c_str(), Integers::k_fractions);
    if (!weights) return input_error(weight_name + ": " + weights.error().what);
    for (const auto& [name, values] : {std::pair{&joint_name, &*joints}, {&weight_name, &*weights}})
      if (values->count() != vertex_count || values->width != joints->width)
        return input_error(*name + " has " + std::to_string(values->count()) + " values of " +
                           std::to_string(values->width) + " numbers for " + std::to_string(vertex_count) +
                           " vertices");
    sets.push_back({std::move(*joints), std::move(*weights)});
  }
  if (lonely) ++odd.lonely_sets;
  return sets;
}

}  // namespace

Result<JointWeights> read_weights(const Json& attributes, const ReadAttribute& read, std::size_t vertex_count,
                                  MeshOddities& odd) {
  auto sets = read_sets(attributes, read, vertex_count, odd);
  if (!sets) return sets.error();
  JointWeights out;
  if (sets->empty()) return out;
  out.start.reserve(vertex_count + 1);
  out.start.push_back(0);
  std::vector<std::pair<int, double>> row;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    row.clear();
    for (const Set& set : *sets)
      for (std::size_t k = 0; k < static_cast<std::size_t>(set.joints.width); ++k) {
        const std::size_t at = v * static_cast<std::size_t>(set.joints.width) + k;
        const double weight = set.weights.values[at], joint = set.joints.values[at];
        if (weight == 0) continue;
        if (!(weight > 0 && weight < 1e6))
          ++odd.bad_weights;
        else if (!(joint >= 0 && joint <= k_most_joint))
          return input_error("vertex " + std::to_string(v) + " names a joint that no skin can have");
        else
          row.emplace_back(static_cast<int>(joint), weight);
      }
    std::sort(row.begin(), row.end());
    const std::size_t begin = out.joint.size();
    double sum = 0;
    for (const auto& [joint, weight] : row) {
      if (out.joint.size() > begin && out.joint.back() == joint)
        out.weight.back() += weight;
      else
        out.joint.push_back(joint), out.weight.push_back(weight);
      sum += weight;
    }
    if (row.empty())
      ++odd.unweighted;
    else
      odd.least_sum = std::min(odd.least_sum, sum), odd.most_sum = std::max(odd.most_sum, sum),
      out.most_joint = std::max(out.most_joint, row.back().first);
    for (std::size_t k = begin; k < out.weight.size(); ++k) out.weight[k] = std::min(1.0, out.weight[k] / sum);
    out.start.push_back(static_cast<int>(out.joint.size()));
  }
  return out;
}

}  // namespace ft::inline io::gltf
