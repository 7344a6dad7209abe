// Points as the caches hold them, and as the solvers do.
#pragma once

#include <span>
#include <vector>

namespace ft::inline baker {

template <class To, class From>
std::vector<To> converted(std::span<const From> points) {
  std::vector<To> out;
  out.reserve(points.size());
  for (const From& p : points) out.push_back(p.template cast<typename To::Scalar>());
  return out;
}

}  // namespace ft::inline baker
