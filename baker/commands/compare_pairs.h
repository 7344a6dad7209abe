// compare, of caches whose elements have ids: who is whom, whatever their order, and numbers over all pairs.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "baker/core/types.h"

namespace ft::inline baker {

/// Places of one element in both caches.
struct ComparedPair {
  std::size_t in_a, in_b;
};

struct ComparedPairs {
  std::vector<ComparedPair> both;             ///< by ascending id
  std::vector<std::uint64_t> missing, extra;  ///< ids that only a has, that only b has, ascending
};
/// Ids of both, none twice in either.
ComparedPairs pair_by_id(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b);

/// "3, 7, 12": the first ten; JSON has all.
std::string id_list(const std::vector<std::uint64_t>& ids);

double distance(const Vec3f& a, const Vec3f& b);

/// Smallest value that so many percent of them are not above; 0 of none.
double percentile(std::vector<double> values, std::size_t percent);

/// most and place become value and element where value is larger.
void raise(double value, std::size_t element, double& most, int& place);

}  // namespace ft::inline baker
