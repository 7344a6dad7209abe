// The only file that knows OpenVDB 10. The library's own io::File does not look whether the stream has ended, so that a
// cut file gives it garbage; here the stream throws. What is asked before a tree is read: which grids, how large.
//   Museth, "VDB: High-resolution sparse volumes with dynamic topology" (2013)
#include "io/volume/openvdb_read.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <new>
#include <optional>

#include "io/volume/vdb_choice.h"

namespace ft::inline io {
namespace {

namespace vdb = openvdb;

constexpr int k_most_grids = 10'000;
constexpr const char* k_no_vdb = "is no OpenVDB file";

std::string too_many(std::int64_t most) {
  return "the box of its active voxels has more than " + std::to_string(most) +
         " voxels; export it coarser, or cropped";
}

std::int64_t voxels_of(const vdb::CoordBBox& box) {
  if (box.empty()) return 0;
  double out = 1;
  for (int k = 0; k < 3; ++k) out *= static_cast<double>(box.max()[k]) - box.min()[k] + 1;
  return out < 1e15 ? static_cast<std::int64_t>(out) : std::int64_t{1'000'000'000'000'000};
}

/// The file as far as it is understood before trees are read: grids with names and types, where their trees are.
class OpenFile : public vdb::io::Archive {
 public:
  explicit OpenFile(const std::filesystem::path& path) : stream_(path, std::ios::binary) {}

  /// Throws what the library throws, and ios_base::failure when the file is too short.
  Status open() {
    if (!stream_) return input_error("cannot be opened");
    stream_.seekg(0, std::ios::end);
    const std::int64_t size = stream_.tellg();
    stream_.seekg(0);
    std::int64_t magic = 0;
    if (!stream_.read(reinterpret_cast<char*>(&magic), sizeof magic) || magic != vdb::OPENVDB_MAGIC)
      return input_error(k_no_vdb);
    stream_.seekg(0);
    stream_.exceptions(std::ios::failbit | std::ios::badbit);
    vdb::io::setStreamMetadataPtr(stream_, stream_state_, false);
    readHeader(stream_);
    setFormatVersion(stream_), setLibraryVersion(stream_), setDataCompression(stream_);
    vdb::MetaMap ignored;
    ignored.readMeta(stream_);
    const int grids = readGridCount(stream_);
    if (grids < 0 || grids > k_most_grids) return input_error("says that it has " + std::to_string(grids) + " grids");
    for (int i = 0; i < grids; ++i) {
      vdb::io::GridDescriptor descriptor;
      const auto grid = descriptor.read(stream_);
      if (inputHasGridOffsets()) {
        if (descriptor.getGridPos() < 0 || descriptor.getGridPos() > size || descriptor.getEndPos() > size)
          return input_error("is cut, or damaged");
        descriptor.seekToEnd(stream_);
      } else {
        readGrid(grid, descriptor, stream_);
        read_[i] = grid;
      }
      names_.push_back({vdb::io::GridDescriptor::nameAsString(descriptor.uniqueName()), grid->valueType()});
      descriptors_.push_back(descriptor);
    }
    return {};
  }

  std::span<const VdbGridName> names() const { return names_; }

  /// The grid with its tree; null when it says itself that it has more than so many voxels.
  vdb::GridBase::Ptr load(std::size_t index, std::int64_t most_voxels) {
    const auto found = read_.find(static_cast<int>(index));
    const auto& descriptor = descriptors_[index];
    auto grid = found != read_.end() ? found->second : vdb::GridBase::createGrid(descriptor.gridType());
    if (found == read_.end()) {
      grid->setSaveFloatAsHalf(descriptor.saveFloatAsHalf());
      descriptor.seekToGrid(stream_);
      readGridCompression(stream_);
      grid->readMeta(stream_);
      if (said_voxels(*grid) > most_voxels) return nullptr;
      descriptor.seekToGrid(stream_);
      readGrid(grid, descriptor, stream_);
    }
    if (descriptor.isInstance()) grid->setTree(parent_of(descriptor, most_voxels)->baseTreePtr());
    return grid;
  }

 private:
  static std::int64_t said_voxels(const vdb::GridBase& grid) {
    const auto lo = grid.getMetadata<vdb::Vec3IMetadata>(vdb::GridBase::META_FILE_BBOX_MIN);
    const auto hi = grid.getMetadata<vdb::Vec3IMetadata>(vdb::GridBase::META_FILE_BBOX_MAX);
    return lo && hi ? voxels_of({vdb::Coord(lo->value()), vdb::Coord(hi->value())}) : 0;
  }

  /// Of a grid that has its tree from another. Throws.
  vdb::GridBase::Ptr parent_of(const vdb::io::GridDescriptor& child, std::int64_t most_voxels) {
    for (std::size_t i = 0; i < descriptors_.size(); ++i)
      if (descriptors_[i].uniqueName() == child.instanceParentName() && !descriptors_[i].isInstance())
        if (auto grid = load(i, most_voxels)) return grid;
    OPENVDB_THROW(vdb::LookupError, "the grid that has the tree is missing");
  }

  /// The stream keeps the address of this pointer.
  vdb::SharedPtr<vdb::io::StreamMetadata> stream_state_{new vdb::io::StreamMetadata};
  std::ifstream stream_;
  std::vector<vdb::io::GridDescriptor> descriptors_;
  std::vector<VdbGridName> names_;
  std::map<int, vdb::GridBase::Ptr> read_;  ///< all, of a file that can only be read from its beginning to its end
};

Eigen::Affine3d affine_of(const vdb::GridBase& grid) {
  const vdb::Mat4d m = grid.transform().baseMap()->getAffineMap()->getMat4();  // of rows: world = index * m
  Eigen::Affine3d out;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) out(row, column) = m(column, row);
  return out;
}

/// How three grids lie to each other: in one place, staggered by half a voxel, or neither.
enum class Layout { k_centred, k_staggered, k_other };

Layout layout_of(const std::array<Eigen::Affine3d, 3>& to_world) {
  const Mat3 to_voxels = to_world[0].linear().inverse();
  bool centred = true, staggered = true;
  for (int c = 1; c < 3; ++c) {
    const Mat3 turned = to_voxels * to_world[at(c)].linear();
    if (!turned.isIdentity(1e-6)) return Layout::k_other;
    const Vec3 d = to_voxels * (to_world[at(c)].translation() - to_world[0].translation());
    centred = centred && d.norm() < 1e-3;
    staggered = staggered && (d - 0.5 * Vec3::UnitX() + 0.5 * Vec3::Unit(c)).norm() < 1e-3;
  }
  return centred ? Layout::k_centred : staggered ? Layout::k_staggered : Layout::k_other;
}

/// probe(component, voxel, value): whether the voxel is active. Staggered: component c of voxel i lies between the
/// centres of i - 1 and i along c; of the two faces of a voxel those count that are active.
template <class Probe>
void fill(VdbVelocity& out, bool staggered, Probe&& probe) {
  const auto count = out.count;
  out.velocities.resize(at(count[0]) * at(count[1]) * at(count[2]));
  const auto one = [&](const vdb::Coord& voxel, int c) {
    float here = 0, next = 0;
    const bool here_active = probe(c, voxel, here);
    if (!staggered) return here;
    const bool next_active = probe(c, voxel.offsetBy(c == 0, c == 1, c == 2), next);
    if (here_active == next_active) return 0.5f * here + 0.5f * next;
    return here_active ? here : next;
  };
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j)
      for (int k = 0; k < count[2]; ++k) {  // along z the library's voxels lie side by side
        const vdb::Coord voxel(out.lowest[0] + i, out.lowest[1] + j, out.lowest[2] + k);
        Vec3f& v = out.velocities[at(i) + at(count[0]) * (at(j) + at(count[1]) * at(k))];
        for (int c = 0; c < 3; ++c) v[c] = one(voxel, c);
      }
}

template <class GridT>
void fill_from_vectors(VdbVelocity& out, bool staggered, const vdb::GridBase& grid) {
  const auto voxels = static_cast<const GridT&>(grid).getConstAccessor();
  fill(out, staggered, [&](int c, const vdb::Coord& voxel, float& value) {
    typename GridT::ValueType v;
    const bool active = voxels.probeValue(voxel, v);
    value = static_cast<float>(v[c]);
    return active;
  });
}

template <class GridT>
void fill_from_three(VdbVelocity& out, bool staggered, const std::vector<vdb::GridBase::Ptr>& grids) {
  const auto of = [&](std::size_t c) { return static_cast<const GridT&>(*grids[c]).getConstAccessor(); };
  const std::array voxels{of(0), of(1), of(2)};
  fill(out, staggered, [&](int c, const vdb::Coord& voxel, float& value) {
    typename GridT::ValueType v;
    const bool active = voxels[at(c)].probeValue(voxel, v);
    value = static_cast<float>(v);
    return active;
  });
}

/// Some programs store vectors in the grid's own space; only vectors that turn with it can be told.
void bring_to_world(VdbVelocity& out, const vdb::GridBase& grid) {
  if (grid.isInWorldSpace() || grid.getVectorType() == vdb::VEC_INVARIANT) return;
  const Mat3f turn = out.to_world.linear().cast<float>();
  for (Vec3f& v : out.velocities) v = turn * v;
  out.notes.push_back("the velocities of " + out.grid + " are stored in voxels; they were brought to the file's units");
}

Result<VdbVelocity> read_grids(OpenFile& file, const std::vector<std::size_t>& chosen, std::int64_t most_voxels) {
  VdbVelocity out;
  std::vector<vdb::GridBase::Ptr> grids;
  std::array<Eigen::Affine3d, 3> to_world;
  vdb::CoordBBox box;
  bool staggered = true;
  for (const std::size_t index : chosen) {
    const std::string& name = file.names()[index].name;
    const auto grid = file.load(index, most_voxels);
    if (!grid) return input_error("grid " + name + ": " + too_many(most_voxels));
    if (!grid->transform().isLinear())
      return input_error("grid " + name + " is not linear in space (" + grid->transform().mapType() +
                         "); export it with a uniform voxel size");
    auto& m = to_world[grids.size()] = affine_of(*grid);
    if (!m.matrix().allFinite() || !(std::abs(m.linear().determinant()) > 0))
      return input_error("grid " + name + " has no place in space: its transform is not finite, or flat");
    staggered = staggered && grid->getGridClass() == vdb::GRID_STAGGERED;
    box.expand(grid->evalActiveVoxelBoundingBox());
    out.grid += (out.grid.empty() ? "" : " ") + name;
    grids.push_back(grid);
  }
  out.to_world = to_world[0];
  if (grids.size() == 3) {
    const Layout layout = layout_of(to_world);
    if (layout == Layout::k_other) return input_error("grids " + out.grid + " do not have the same voxels");
    if (layout == Layout::k_staggered) {
      staggered = true;
      out.to_world.translation() += 0.5 * to_world[0].linear().col(0);
    }
  }
  // The last faces have no voxel behind them.
  for (int k = 0; k < 3 && staggered && !box.empty(); ++k)
    if (box.min()[k] < box.max()[k]) --box.max()[k];
  if (voxels_of(box) > most_voxels) return input_error("grid " + out.grid + ": " + too_many(most_voxels));
  if (!box.empty())
    for (int k = 0; k < 3; ++k) out.lowest[at(k)] = box.min()[k], out.count[at(k)] = box.dim()[k];

  const std::string holds = grids[0]->valueType();
  if (holds == "vec3s") fill_from_vectors<vdb::Vec3SGrid>(out, staggered, *grids[0]);
  if (holds == "vec3d") fill_from_vectors<vdb::Vec3DGrid>(out, staggered, *grids[0]);
  if (holds == "float") fill_from_three<vdb::FloatGrid>(out, staggered, grids);
  if (holds == "double") fill_from_three<vdb::DoubleGrid>(out, staggered, grids);
  if (staggered)
    out.notes.push_back("grid " + out.grid + " is staggered; it was averaged to the centres of its voxels");
  if (grids.size() == 1) bring_to_world(out, *grids[0]);
  if (!std::all_of(out.velocities.begin(), out.velocities.end(), [](const Vec3f& v) { return v.allFinite(); }))
    return input_error("grid " + out.grid + " has velocities that are not finite");
  return out;
}

}  // namespace

Result<VdbVelocity> read_with_openvdb(const std::filesystem::path& path, const std::string& grid,
                                      std::int64_t most_voxels) try {
  vdb::initialize();
  OpenFile file(path);
  if (Status opened = file.open(); !opened) return opened.error();
  const auto chosen = choose_velocity(file.names(), grid);
  if (!chosen) return chosen.error();
  return read_grids(file, *chosen, most_voxels);
} catch (const std::bad_alloc&) {
  throw;
} catch (const std::ios_base::failure&) {
  return input_error("is cut, or damaged");
} catch (const std::exception& e) {
  return input_error(std::string("is cut, or damaged: ") + e.what());
}

}  // namespace ft::inline io
