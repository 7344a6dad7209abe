#include "baker/commands/compare_pairs.h"

#include <algorithm>

namespace ft::inline baker {
namespace {

constexpr std::size_t k_most_ids = 10;

std::vector<std::size_t> by_id(std::span<const std::uint64_t> ids) {
  std::vector<std::size_t> out(ids.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = i;
  std::stable_sort(out.begin(), out.end(), [&](std::size_t i, std::size_t j) { return ids[i] < ids[j]; });
  return out;
}

}  // namespace

ComparedPairs pair_by_id(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b) {
  ComparedPairs out;
  const auto order_a = by_id(a), order_b = by_id(b);
  std::size_t i = 0, j = 0;
  while (i < order_a.size() || j < order_b.size()) {
    if (j == order_b.size() || (i < order_a.size() && a[order_a[i]] < b[order_b[j]]))
      out.missing.push_back(a[order_a[i++]]);
    else if (i == order_a.size() || b[order_b[j]] < a[order_a[i]])
      out.extra.push_back(b[order_b[j++]]);
    else
      out.both.push_back({order_a[i++], order_b[j++]});
  }
  return out;
}

std::string id_list(const std::vector<std::uint64_t>& ids) {
  std::string out;
  for (std::size_t i = 0; i < std::min(ids.size(), k_most_ids); ++i)
    out += (i == 0 ? "" : ", ") + std::to_string(ids[i]);
  return ids.size() > k_most_ids ? out + ", ..." : out;
}

double distance(const Vec3f& a, const Vec3f& b) {
  return (a.cast<double>() - b.cast<double>()).norm();
}

double percentile(std::vector<double> values, std::size_t percent) {
  if (values.empty()) return 0;
  const std::size_t rank = (values.size() * percent + 99) / 100 - 1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return values[rank];
}

void raise(double value, std::size_t element, double& most, int& place) {
  if (value > most) most = value, place = static_cast<int>(element);
}

}  // namespace ft::inline baker
