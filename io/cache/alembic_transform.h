// Transforms above a mesh in archives of other programs (AbcGeom's Xform schema): chains of operations whose numbers
// may be animated. Our own files have none: they hold world space.
#pragma once

#include <cstdint>
#include <vector>

#include "baker/core/types.h"
#include "io/cache/alembic_archive.h"

namespace ft::inline io::alembic {

/// Time of sample index [s].
double sample_time(const TimeSampling& times, std::uint32_t index);

/// Objects above a mesh, outermost first; what stands above an object that does not inherit is dropped.
class TransformChain {
 public:
  /// xforms: .xform compounds.
  static Result<TransformChain> read(const InputFile& file, const Archive& archive,
                                     const std::vector<Property>& xforms);

  bool identity() const { return links_.empty(); }
  bool constant() const;
  /// Takes points of the mesh at a time [s] to the world; of animated transforms the nearest sample.
  Eigen::Affine3d at(double time) const;

 private:
  struct Link {
    std::vector<std::uint8_t> operations;
    std::vector<std::vector<double>> values;  ///< per sample
    TimeSampling times;
    Eigen::Affine3d matrix(double time) const;
  };
  std::vector<Link> links_;
};

}  // namespace ft::inline io::alembic
