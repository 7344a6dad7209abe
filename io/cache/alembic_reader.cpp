// The Alembic reader: any Ogawa archive with a polygon mesh, curves or points. The tree is read once, when the file
// is opened; a frame is one read, checked against its key. Own files are checked against their hashes as well, so that
// no flipped bit passes.
#include <algorithm>
#include <cmath>

#include "io/cache/alembic_view.h"
#include "io/cache/formats.h"

namespace ft::inline io {
namespace {

using namespace alembic;

class AlembicReader final : public CacheReader {
 public:
  AlembicReader(InputFile file, ShapeView view) : file_(std::move(file)), view_(std::move(view)) {}

  const CacheInfo& info() const override { return view_.info; }

  Status read_frame(int index, std::vector<Vec3f>& positions) override {
    const Status status = values(k_positions, index, positions);
    if (!status || view_.transforms.identity()) return status;
    const Eigen::Affine3d to_world = to_world_at(index);
    for (Vec3f& p : positions) p = (to_world * p.cast<double>()).cast<float>();
    return finite(index, positions);
  }

  Status read_velocities(int index, std::vector<Vec3f>& velocities) override {
    if (!view_.info.has_velocity) return input_error("holds no velocities", file_.path().string());
    const Status status = values(k_velocities, index, velocities);
    if (!status || view_.transforms.identity()) return status;
    const Mat3 to_world = to_world_at(index).linear();
    for (Vec3f& v : velocities) v = (to_world * v.cast<double>()).cast<float>();
    return finite(index, velocities);
  }

  Status read(int index, FrameData& frame) override {
    frame = {};
    Status status = read_frame(index, frame.positions);
    const std::size_t count = frame.positions.size();
    if (status && view_.info.has_velocity) {
      status = read_velocities(index, frame.velocities);
      if (status && frame.velocities.size() != count) return damaged(index, "has velocities of other points");
    }
    if (status) status = read_faces(index, frame);
    if (status) status = read_ids(index, frame);
    if (status) status = each(k_widths, index, count, frame.widths);
    if (status) status = each(k_orientations, index, count, frame.orientations);
    if (status) status = each(k_angular_velocities, index, count, frame.angular_velocities);
    if (status) status = each(k_scales, index, count, frame.scales);
    frame.scalars.resize(view_.info.content.scalars.size());
    for (std::size_t i = 0; status && i < frame.scalars.size(); ++i)
      status = each(static_cast<Channel>(k_scalars + i), index, count, frame.scalars[i]);
    return status;
  }

 private:
  template <class T>
  Status values(Channel channel, int index, std::vector<T>& out) {
    if (index < 0 || index >= view_.info.frame_count)
      return input_error("has no frame with index " + std::to_string(index), file_.path().string());
    const Property& property = view_.channels[channel];
    auto read = values_of<T>(file_, property.samples[property.slot_of(static_cast<std::uint32_t>(index))]);
    if (!read) return read.error();
    out = std::move(*read);
    return finite(index, out);
  }

  /// A value for each of `count` points, where the file has the channel.
  template <class T>
  Status each(Channel channel, int index, std::size_t count, std::vector<T>& out) {
    if (view_.channels[channel].samples.empty()) return {};
    const Status status = values(channel, index, out);
    if (!status || out.size() == count) return status;
    return damaged(index, "has " + std::to_string(out.size()) + " \"" + view_.channels[channel].name + "\" for " +
                              std::to_string(count) + " points");
  }

  Status read_faces(int index, FrameData& frame) {
    if (view_.channels[k_face_sizes].samples.empty()) return {};
    Status status = values(k_face_sizes, index, frame.face_sizes);
    if (status) status = values(k_face_corners, index, frame.face_vertices);
    if (!status) return status;
    std::string fault = fault_of_faces(frame.face_sizes, frame.face_vertices, frame.positions.size());
    if (!fault.empty()) return damaged(index, "has " + std::move(fault));
    reverse_faces(frame.face_sizes, frame.face_vertices);
    return {};
  }

  /// Points without ids are numbered.
  Status read_ids(int index, FrameData& frame) {
    const OutputShape shape = view_.info.content.shape;
    if (shape != OutputShape::k_points) return {};
    const Property& ids = view_.channels[k_ids];
    if (!ids.samples.empty() && ids.samples[ids.slot_of(static_cast<std::uint32_t>(index))].size > 0)
      return each(k_ids, index, frame.positions.size(), frame.ids);
    for (std::size_t i = 0; i < frame.positions.size(); ++i) frame.ids.push_back(i);
    return {};
  }

  Eigen::Affine3d to_world_at(int index) const {
    return view_.transforms.at(sample_time(view_.times, static_cast<std::uint32_t>(index)));
  }

  template <class T>
  static bool is_finite(const T& value) {
    if constexpr (std::is_same_v<T, Eigen::Quaternionf>)
      return value.coeffs().allFinite();
    else if constexpr (std::is_same_v<T, Vec3f>)
      return value.allFinite();
    else if constexpr (std::is_floating_point_v<T>)
      return std::isfinite(value);
    else
      return true;
  }

  template <class T>
  Status finite(int index, const std::vector<T>& all) const {
    if (std::all_of(all.begin(), all.end(), is_finite<T>)) return {};
    return damaged(index, "holds numbers that are not finite");
  }

  Error damaged(int index, std::string what) const {
    return input_error("is damaged: frame " + std::to_string(view_.info.first_frame + index) + " " + std::move(what),
                       file_.path().string());
  }

  InputFile file_;
  ShapeView view_;
};

Result<std::unique_ptr<CacheReader>> open_once(const std::filesystem::path& path, ogawa::Reference& root) {
  auto file = InputFile::open(path);
  if (!file) return file.error();
  std::vector<StoredHashes> hashes;
  const auto archive = parse(*file, &hashes, &root);
  if (!archive) return archive.error();
  const Archive& a = archive.value();
  if (is_own(a) && (hashes.empty() || hashes.front().children != hash_children(a.top, a.time_samplings)))
    return input_error("is damaged: its content does not match its hash", path.string());
  auto view = find_shape(*file, a);
  if (!view) return view.error();
  return std::unique_ptr<CacheReader>(std::make_unique<AlembicReader>(std::move(*file), std::move(*view)));
}

}  // namespace

Result<std::unique_ptr<CacheReader>> open_alembic_reader(const std::filesystem::path& path) {
  // A file that is being written moves its root with every frame; a tail may be replaced while it is read.
  ogawa::Reference root = 0, root_before = 0;
  for (;;) {
    auto reader = open_once(path, root);
    if (reader || root == root_before) return reader;
    root_before = root;
  }
}

}  // namespace ft::inline io
