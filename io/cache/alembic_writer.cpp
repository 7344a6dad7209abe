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
#include "io/cache/alembic_view.h"
#include "io/cache/formats.h"

namespace ft::inline io {
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

/// Least and greatest coordinates; of nothing, zeros.
std::array<double, 6> box_of(std::span<const Vec3f> points) {
  std::array<double, 6> box{};
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const double x = points[i][static_cast<Eigen::Index>(c)];
      box[c] = i == 0 ? x : std::min(box[c], x);
      box[c + 3] = i == 0 ? x : std::max(box[c + 3], x);
    }
  return box;
}

class AlembicWriter final : public CacheWriter {
 public:
  AlembicWriter(const CacheInfo& info, std::filesystem::path path) : tree_(info), path_(std::move(path)) {
    info_.system = info.system;
    info_.content = info.content;
    info_.first_frame = info.first_frame;
    info_.vertex_count = constant_element_count(info);
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

  Status write_frame(const CacheFrame& frame) override {
    if (broken_) return output_error("an earlier frame could not be written", path_.string());
    const FrameContent& content = info_.content;
    bool velocities = content.velocities;
    if (content.shape == OutputShape::k_mesh && !content.changes)
      velocities = frame_count() == 0 ? !frame.velocities.empty() : !frames_.of[k_velocities].empty();
    if (Status sound = check_frame(frame, info_, frame_count(), velocities); !sound) return sound;
    const Status status = append_frame(frame, velocities);
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
  void add(ogawa::Builder& out, Channel channel, std::span<const std::byte> raw) {
    std::vector<Sample>& all = frames_.of[channel];
    Sample s;
    if (!raw.empty()) {
      s.key = murmur3(raw);
      s.size = raw.size() + 16;
      if (!all.empty() && all.back().same_values(s))
        s = all.back();
      else
        s.data = out.data(sample_payload(raw));
    }
    all.push_back(s);
  }

  Status append_frame(const CacheFrame& frame, bool velocities) {
    make_room();
    const FrameContent& content = info_.content;
    ogawa::Builder out(end_);
    add(out, k_positions, std::as_bytes(frame.positions));
    if (velocities) add(out, k_velocities, std::as_bytes(frame.velocities));
    if (content.shape == OutputShape::k_mesh && content.changes) {
      std::vector<int> corners(frame.face_vertices.begin(), frame.face_vertices.end());
      reverse_faces(frame.face_sizes, corners);
      add(out, k_face_sizes, std::as_bytes(frame.face_sizes));
      add(out, k_face_corners, std::as_bytes(std::span(corners)));
    }
    if (content.shape == OutputShape::k_points) {
      add(out, k_ids, std::as_bytes(frame.ids));
      if (content.widths) add(out, k_widths, std::as_bytes(frame.widths));
    }
    if (content.shape == OutputShape::k_instances) {
      add(out, k_orientations, std::as_bytes(frame.orientations));
      if (content.angular_velocities) add(out, k_angular_velocities, std::as_bytes(frame.angular_velocities));
      if (content.scales) add(out, k_scales, std::as_bytes(frame.scales));
    }
    for (std::size_t i = 0; i < frame.scalars.size(); ++i)
      add(out, static_cast<Channel>(k_scalars + i), std::as_bytes(std::span(frame.scalars[i])));
    const std::array<double, 6> box = box_of(frame.positions);
    add(out, k_bounds, std::as_bytes(std::span(box)));
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

  ArchiveTree tree_;
  std::filesystem::path path_;
  CacheInfo info_;                // without rest data; for checks and messages
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
  auto channels = tree_.channels_in(archive);
  const Property *positions = channels[k_positions], *bounds = channels[k_bounds];
  if (positions == nullptr || bounds == nullptr) return cannot_continue(path_, "it was written by another program");
  if (positions->sample_count < keep_frames || bounds->sample_count != positions->sample_count)
    return cannot_continue(
        path_, "it has " + std::to_string(positions->sample_count) + " frames of " + std::to_string(keep_frames));
  for (const Property* p : channels)
    if (p != nullptr && p->sample_count != positions->sample_count)
      return cannot_continue(path_, "its " + p->name + " does not match its positions");
  bool sound = true;
  const FrameContent& content = info_.content;
  const bool constant = content.shape != OutputShape::k_points && !content.changes;
  const auto count = static_cast<std::size_t>(info_.vertex_count);
  for (std::uint32_t i = 0; i < keep_frames && sound; ++i) {
    make_room();
    for (std::size_t c = 0; c < k_channel_count && sound; ++c) {
      if (channels[c] == nullptr) continue;
      std::vector<Sample>& taken = frames_.of[c];
      const Sample& s = channels[c]->samples[channels[c]->slot_of(i)];
      const bool again = !taken.empty() && taken.back().data == s.data;
      sound = again || s.size == 0 || s.data == (end_ | ogawa::k_data_bit);
      if (!again && s.size > 0) end_ = node_end(s);
      taken.push_back(s);
    }
    if (sound && constant && frames_.of[k_positions].back().size != (count == 0 ? 0 : 12 * count + 16)) sound = false;
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

Status alembic_accepts(const FrameContent& content) {
  if (!content.scalars.empty() && content.shape != OutputShape::k_mesh)
    return usage_error("Alembic files of ours hold scalars by name of meshes alone, and not of " +
                       std::string(shape_name(content.shape)));
  if (content.scalars.size() > k_most_scalars)
    return usage_error("Alembic files of ours hold up to " + std::to_string(k_most_scalars) +
                       " scalars by name of a mesh, and not " + std::to_string(content.scalars.size()));
  if (std::ranges::count(content.scalars, "Pref") > 0)
    return usage_error("Alembic has \"Pref\" for rest positions, and cannot hold scalars of that name");
  switch (content.shape) {
    case OutputShape::k_mesh:
    case OutputShape::k_points: return {};
    case OutputShape::k_curves:
    case OutputShape::k_instances:
      if (!content.changes) return {};
      return usage_error("Alembic files of ours hold no " + std::string(shape_name(content.shape)) +
                         " whose number changes");
    case OutputShape::k_grid: break;
  }
  return usage_error("Alembic cannot hold " + std::string(shape_name(content.shape)));
}

std::uint64_t alembic_bytes_per_frame(const FrameContent& c, const FrameCounts& counts) {
  std::uint64_t each = 12 + (c.velocities ? 12 : 0);  // float32, x y z
  each += 4 * c.scalars.size();
  if (c.shape == OutputShape::k_points) each += 8 + (c.widths ? 4 : 0);
  if (c.shape == OutputShape::k_instances) each += 16 + (c.angular_velocities ? 12 : 0) + (c.scales ? 12 : 0);
  const bool faces = c.shape == OutputShape::k_mesh && c.changes;
  return each * counts.elements + (faces ? 4 * (counts.faces + counts.corners) : 0);
}

Result<std::unique_ptr<CacheWriter>> open_alembic_writer(const std::filesystem::path& path, const CacheInfo& info,
                                                         int keep_frames) {
  if (Status taken = alembic_accepts(info.content); !taken) return taken.error();
  if (Status sound = check_rest(info); !sound) return sound.error();
  auto writer = std::make_unique<AlembicWriter>(info, path);
  const Status status =
      keep_frames == 0 ? writer->start_new() : writer->continue_after(static_cast<std::uint32_t>(keep_frames));
  if (!status) return status.error();
  return std::unique_ptr<CacheWriter>(std::move(writer));
}

}  // namespace ft::inline io
