// The Alembic reader: any Ogawa archive with a polygon mesh of constant topology. The tree is read once, when the file
// is opened; a frame is one read, checked against its key. Own files are checked against their hashes as well, so that
// no flipped bit passes.
#include "io/cache/alembic_mesh.h"
#include "io/cache/formats.h"

namespace ft {
namespace {

using namespace alembic;

class AlembicReader final : public CacheReader {
 public:
  AlembicReader(InputFile file, MeshView view) : file_(std::move(file)), view_(std::move(view)) {}

  const CacheInfo& info() const override { return view_.info; }

  Status read_frame(int index, std::vector<Vec3f>& positions) override {
    const Status status = read(view_.positions, index, positions);
    if (!status || view_.transforms.identity()) return status;
    const Eigen::Affine3d to_world = to_world_at(index);
    for (Vec3f& p : positions) p = (to_world * p.cast<double>()).cast<float>();
    return finite(index, positions);
  }

  Status read_velocities(int index, std::vector<Vec3f>& velocities) override {
    if (!view_.info.has_velocity) return input_error("holds no velocities", file_.path().string());
    const Status status = read(view_.velocities, index, velocities);
    if (!status || view_.transforms.identity()) return status;
    const Mat3 to_world = to_world_at(index).linear();
    for (Vec3f& v : velocities) v = (to_world * v.cast<double>()).cast<float>();
    return finite(index, velocities);
  }

 private:
  Status read(const Property& property, int index, std::vector<Vec3f>& points) {
    if (index < 0 || index >= view_.info.frame_count)
      return input_error("has no frame with index " + std::to_string(index), file_.path().string());
    const auto raw = read_values(file_, property.samples[property.slot_of(static_cast<std::uint32_t>(index))]);
    if (!raw) return raw.error();
    points_from_bytes(raw.value(), points);
    return finite(index, points);
  }

  Eigen::Affine3d to_world_at(int index) const {
    return view_.transforms.at(sample_time(view_.times, static_cast<std::uint32_t>(index)));
  }

  Status finite(int index, const std::vector<Vec3f>& points) const {
    for (const Vec3f& p : points)
      if (!p.allFinite())
        return input_error("is damaged: frame " + std::to_string(view_.info.first_frame + index) +
                               " holds numbers that are not finite",
                           file_.path().string());
    return {};
  }

  InputFile file_;
  MeshView view_;
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
  auto view = find_mesh(*file, a);
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

}  // namespace ft
