#include "tests/io_volume/openvdb_sample.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <fstream>

namespace ft::test {
namespace {

namespace vdb = openvdb;

vdb::math::Transform::Ptr transform_of(const SampleGrid& sample) {
  if (sample.frustum)
    return vdb::math::Transform::createFrustumTransform(vdb::BBoxd(vdb::Vec3d(0), vdb::Vec3d(10)), 0.5, 1.0, 0.1);
  vdb::Mat4d m = vdb::Mat4d::identity();  // of rows
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) m(column, row) = sample.to_world(row, column);
  return vdb::math::Transform::createLinearTransform(m);
}

template <class GridT, class Value>
vdb::GridBase::Ptr make(const SampleGrid& sample, Value value) {
  auto grid = GridT::create();
  auto voxels = grid->getAccessor();
  for (int i = 0; i < sample.count[0]; ++i)
    for (int j = 0; j < sample.count[1]; ++j)
      for (int k = 0; k < sample.count[2]; ++k) {
        const vdb::Coord voxel(sample.lowest[0] + i, sample.lowest[1] + j, sample.lowest[2] + k);
        voxels.setValue(voxel, value(Vec3(voxel.x(), voxel.y(), voxel.z())));
      }
  if (sample.far_voxel) voxels.setValue(vdb::Coord(1'000'000), value(Vec3::Constant(1e6)));
  grid->setName(sample.name);
  grid->setTransform(transform_of(sample));
  grid->setSaveFloatAsHalf(sample.half);
  if (sample.staggered) grid->setGridClass(vdb::GRID_STAGGERED);
  if (sample.local) grid->setIsInWorldSpace(false), grid->setVectorType(vdb::VEC_CONTRAVARIANT_RELATIVE);
  return grid;
}

template <class GridT>
vdb::GridBase::Ptr make_vectors(const SampleGrid& sample) {
  return make<GridT>(sample, [&](const Vec3& index) {
    typename GridT::ValueType out;
    for (int c = 0; c < 3; ++c) {
      const Vec3 place = sample.to_world * (sample.staggered ? Vec3(index - 0.5 * Vec3::Unit(c)) : index);
      Vec3 v = sample.field(place);
      if (sample.local) v = sample.to_world.linear().inverse() * v;
      out[c] = static_cast<typename GridT::ValueType::value_type>(v[c]);
    }
    return out;
  });
}

template <class GridT>
vdb::GridBase::Ptr make_numbers(const SampleGrid& sample) {
  return make<GridT>(sample, [&](const Vec3& index) {
    return static_cast<typename GridT::ValueType>(sample.field(sample.to_world * index)[sample.component]);
  });
}

vdb::GridBase::Ptr make(const SampleGrid& sample) {
  switch (sample.kind) {
    case SampleGrid::k_vec3s: return make_vectors<vdb::Vec3SGrid>(sample);
    case SampleGrid::k_vec3d: return make_vectors<vdb::Vec3DGrid>(sample);
    case SampleGrid::k_float: return make_numbers<vdb::FloatGrid>(sample);
    case SampleGrid::k_double: return make_numbers<vdb::DoubleGrid>(sample);
    case SampleGrid::k_int: return make_numbers<vdb::Int32Grid>(sample);
  }
  return {};
}

template <class Archive>
void write(Archive&& archive, const SampleFile& file, const vdb::GridPtrVec& grids) {
  archive.setCompression(vdb::io::COMPRESS_ACTIVE_MASK | (file.blosc ? vdb::io::COMPRESS_BLOSC : 0));
  archive.write(grids);
}

}  // namespace

void write_vdb(const std::filesystem::path& path, const SampleFile& file) {
  vdb::initialize();
  vdb::GridPtrVec grids;
  for (const SampleGrid& sample : file.grids) grids.push_back(make(sample));
  if (file.instanced) grids.at(1)->setTree(grids.at(0)->baseTreePtr());
  if (file.seekable) {
    vdb::io::File archive(path.string());
    write(archive, file, grids);
    archive.close();
  } else {
    std::ofstream out(path, std::ios::binary);
    write(vdb::io::Stream(out), file, grids);
  }
}

}  // namespace ft::test
