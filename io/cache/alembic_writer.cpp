// The Alembic writer: valid after every frame, resumable, its bytes a function of the frames alone.
//
//   | header 16 B | static data | slot 0 | slot 1 | frame 1 | frame 2 | ... | slot 0' | slot 1' | frame c+1 | ...
//        `--> root: in the slot of the last whole frame
//
// The tail (all groups and headers, what a reader starts from) after n frames stands in slot n mod 2, padded to the
// size of the slot: the tail of n - 1 frames stays whole beside it. A frame is: its data, its tail, sync, the 8 bytes
// of the root, sync. A process killed at any instant leaves the root on a whole tail. Slots hold as many frames as were
// announced; when more come, two slots of twice that capacity follow the frames. So the overhead stays proportional to
// the frames (about 80 B each), where appending a tail per frame would be quadratic, and nothing has to be copied when
// the file is closed. Resume rebuilds the place of everything from the samples that the last tail lists, and refuses a
// file that is laid out otherwise.
#include <algorithm>
#include <array>

#include "baker/core/file.h"
#include "io/cache/alembic_mesh.h"
#include "io/cache/formats.h"

namespace ft {
namespace {

using namespace alembic;

constexpr std::uint32_t k_default_capacity = 64;  // frames, where nobody says how many will come

/// Two slots, and the frames whose tails go there.
struct Region {
  std::uint64_t base = 0, slot_size = 0;
  std::uint32_t first = 0;     ///< fewest frames that a tail here may have
  std::uint32_t capacity = 0;  ///< most
  std::uint64_t slot(std::uint32_t frames) const { return base + (frames % 2) * slot_size; }
  std::uint64_t end() const { return base + 2 * slot_size; }
};

std::uint64_t node_end(const Sample& s) {
  return (s.data & ~ogawa::k_data_bit) + sizeof(std::uint64_t) + s.size;
}

class AlembicWriter final : public CacheWriter {
 public:
  AlembicWriter(const CacheInfo& info, std::filesystem::path path)
      : tree_(info), path_(std::move(path)), vertex_count_(info.mesh.positions.size()) {
    names_.system = info.system;
    names_.first_frame = info.first_frame;
    region_.base = ogawa::k_header_size + tree_.static_bytes().size();
    region_.capacity = info.frame_count > 0 ? static_cast<std::uint32_t>(info.frame_count) : k_default_capacity;
    region_.slot_size = tree_.tail_bound(region_.capacity);
    end_ = region_.end();
  }

  Status start_new() {
    ogawa::Reference root = 0;
    const Bytes tail = tail_at(region_.slot(0), 0, region_.slot_size, root);
    ByteWriter all;
    for (const Bytes& part : {ogawa::header(root), tree_.static_bytes(), tail, Bytes(region_.slot_size)})
      all.write_array(std::span<const std::byte>(part));
    Status status = write_file_durably(path_, all.bytes());
    return status ? open() : status;
  }

  Status continue_after(std::uint32_t keep_frames);

  int frame_count() const override { return static_cast<int>(frames_.count()); }

  Status write_frame(std::span<const Vec3> positions, std::span<const Vec3> velocities) override {
    if (broken_) return output_error("an earlier frame could not be written", path_.string());
    const auto points = frame_floats(positions, vertex_count_, names_, frame_count(), "position");
    if (!points) return points.error();
    const bool with_velocities = frame_count() == 0 ? !velocities.empty() : !frames_.velocities.empty();
    const auto speeds =
        frame_floats(velocities, with_velocities ? vertex_count_ : 0, names_, frame_count(), "velocity");
    if (!speeds) return speeds.error();
    const Status status = append_frame(points.value(), speeds.value(), with_velocities);
    broken_ = !status;
    return status;
  }

  Status close() override { return file_.empty() ? Status{} : file_.front().close(); }

 private:
  OutputFile& file() { return file_.front(); }

  Status open() {
    auto file = OutputFile::open_existing(path_);
    if (!file) return file.error();
    file_.push_back(std::move(*file));
    tree_.forget_static_bytes();
    return {};
  }

  /// The place of the next frame: behind the last one, or behind two new slots when the old ones are full.
  void make_room() {
    if (frames_.count() < region_.capacity) return;
    region_ = {end_, tree_.tail_bound(2 * region_.capacity), region_.capacity + 1, 2 * region_.capacity};
    end_ = region_.end();
  }

  /// The sample of new values; those of the frame before serve again when nothing changed.
  template <class T>
  Sample add(ogawa::Builder& out, const std::vector<Sample>& before, std::span<const T> values) {
    const auto raw = std::as_bytes(values);
    Sample s;
    if (raw.empty()) return s;
    s.key = murmur3(raw);
    s.size = raw.size() + 16;
    if (!before.empty() && before.back().same_values(s)) return before.back();
    s.data = out.data(sample_payload(raw));
    return s;
  }

  Status append_frame(const std::vector<float>& points, const std::vector<float>& speeds, bool with_velocities) {
    make_room();
    std::array<double, 6> box{};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double x = points[i];
      box[i % 3] = i < 3 ? x : std::min(box[i % 3], x);
      box[i % 3 + 3] = i < 3 ? x : std::max(box[i % 3 + 3], x);
    }
    ogawa::Builder out(end_);
    const Sample position = add(out, frames_.positions, std::span<const float>(points));
    if (with_velocities) frames_.velocities.push_back(add(out, frames_.velocities, std::span<const float>(speeds)));
    frames_.bounds.push_back(add(out, frames_.bounds, std::span<const double>(box)));
    frames_.positions.push_back(position);
    const std::uint64_t place = end_;
    end_ = out.end();
    const Bytes data = out.take();
    Status status = file().write_at(place, data);
    return status ? commit(frames_.count(), region_.slot(frames_.count()), region_.slot_size) : status;
  }

  /// The tail after count frames, for this place, padded with zeros.
  Bytes tail_at(std::uint64_t place, std::uint32_t count, std::uint64_t size, ogawa::Reference& root) const {
    Bytes tail = emit(tree_.archive(frames_, count), place, root);
    CHECK(tail.size() <= size);
    tail.resize(size);
    return tail;
  }

  Status commit(std::uint32_t count, std::uint64_t place, std::uint64_t size) {
    ogawa::Reference root = 0;
    Status status = file().write_at(place, tail_at(place, count, size, root));
    if (status) status = file().sync();
    if (status) status = file().write_at(ogawa::k_root_offset, std::as_bytes(std::span(&root, 1)));
    return status ? file().sync() : status;
  }

  Status adopt(const Archive& archive, std::uint32_t keep_frames);
  Status restore_slots(ogawa::Reference live_root);

  MeshTree tree_;
  std::filesystem::path path_;
  std::size_t vertex_count_;
  CacheInfo names_;               // system and first frame, for messages
  std::vector<OutputFile> file_;  // none or one
  FrameSamples frames_;
  Region region_;
  std::uint64_t end_ = 0;  // of the last frame
  bool broken_ = false;
};

Status AlembicWriter::continue_after(std::uint32_t keep_frames) {
  auto old_file = InputFile::open(path_);
  if (!old_file) return cannot_continue(path_, old_file.error().what);
  Bytes start(tree_.static_bytes().size());
  if (!old_file->read_at(ogawa::k_header_size, start) || start != tree_.static_bytes())
    return cannot_continue(path_, "it was written for another mesh or with other settings");
  ogawa::Reference root = 0;
  const auto archive = parse(*old_file, nullptr, &root);
  if (!archive) return cannot_continue(path_, archive.error().what);
  Status status = adopt(archive.value(), keep_frames);
  if (status) status = open();
  if (status) status = restore_slots(root);
  if (status) status = file().truncate(end_);
  return status ? file().sync() : status;
}

/// Takes over the first frames of a file, walking through the layout as if they were written once more.
Status AlembicWriter::adopt(const Archive& archive, std::uint32_t keep_frames) {
  const Property* geom = archive.top.children.empty() || archive.top.children[0].properties.empty()
                             ? nullptr
                             : &archive.top.children[0].properties[0];
  const Property* positions = geom == nullptr ? nullptr : geom->find("P");
  const Property* bounds = geom == nullptr ? nullptr : geom->find(".selfBnds");
  if (positions == nullptr || bounds == nullptr) return cannot_continue(path_, "it was written by another program");
  if (positions->sample_count < keep_frames || bounds->sample_count != positions->sample_count)
    return cannot_continue(
        path_, "it has " + std::to_string(positions->sample_count) + " frames of " + std::to_string(keep_frames));
  const Property* velocities = geom->find(".velocities");
  if (velocities != nullptr && velocities->sample_count != positions->sample_count)
    return cannot_continue(path_, "its velocities do not match its positions");
  bool sound = true;
  const auto take = [&](std::vector<Sample>& taken, const Property* property, std::uint32_t index) {
    if (property == nullptr) return;
    const Sample& s = property->samples[property->slot_of(index)];
    const bool again = !taken.empty() && taken.back().data == s.data;
    sound = sound && (again || s.size == 0 || s.data == (end_ | ogawa::k_data_bit));
    if (!again && s.size > 0) end_ = node_end(s);
    taken.push_back(s);
  };
  for (std::uint32_t i = 0; i < keep_frames && sound; ++i) {
    make_room();
    take(frames_.positions, positions, i);
    take(frames_.velocities, velocities, i);
    take(frames_.bounds, bounds, i);
    if (frames_.positions.back().size != (vertex_count_ == 0 ? 0 : 12 * vertex_count_ + 16)) sound = false;
  }
  return sound ? Status{} : cannot_continue(path_, "its frames are not where this program puts them");
}

/// Both slots as they were after the last kept frame, though the process that wrote the file went on and died at any
/// point. The root never leaves a whole tail: where the slot that must change is the live one, the same frames are
/// committed in the other first.
Status AlembicWriter::restore_slots(ogawa::Reference live_root) {
  const std::uint32_t count = frames_.count();
  const std::uint64_t slot = region_.slot(count), other = region_.slot(count + 1);
  const bool live = live_root >= slot && live_root < slot + region_.slot_size;
  Status status;
  if (live) {
    ogawa::Reference root = 0;
    const Bytes wanted = tail_at(slot, count, region_.slot_size, root);
    Bytes found(wanted.size());
    const auto file_now = InputFile::open(path_);
    if (!file_now) return file_now.error();
    if (!file_now.value().read_at(slot, found) || found != wanted || root != live_root) {
      status = commit(count, other, region_.slot_size);
      if (status) status = commit(count, slot, region_.slot_size);
    }
  } else {
    status = commit(count, slot, region_.slot_size);
  }
  ogawa::Reference unused = 0;
  const Bytes before =
      count > region_.first ? tail_at(other, count - 1, region_.slot_size, unused) : Bytes(region_.slot_size);
  return status ? file().write_at(other, before) : status;
}

}  // namespace

Result<std::unique_ptr<CacheWriter>> open_alembic_writer(const std::filesystem::path& path, const CacheInfo& info,
                                                         int keep_frames) {
  auto writer = std::make_unique<AlembicWriter>(info, path);
  const Status status =
      keep_frames == 0 ? writer->start_new() : writer->continue_after(static_cast<std::uint32_t>(keep_frames));
  if (!status) return status.error();
  return std::unique_ptr<CacheWriter>(std::move(writer));
}

}  // namespace ft
