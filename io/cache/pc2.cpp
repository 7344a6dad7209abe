// PointCache2: 32 bytes of header, then float32 x y z per vertex and frame. For Blender's Mesh Cache modifier, 3ds Max
// and whatever else takes points without topology. It takes what is a constant number of positions: meshes that do not
// change, and the vertices of curves in turn, which come back as points. Points are refused, for their number changes
// and ids say who is who; instances, for they turn. A frame counts when the header says so: its floats are written and
// synced first, the number of samples after them, so that the file is whole at every moment and its bytes depend on
// nothing but the frames. Careful: the format stores no frame rate, no velocity, no scalars of vertices and no
// checksum; a flipped bit in a coordinate cannot be seen.
#include <cmath>

#include "baker/core/file.h"
#include "io/cache/formats.h"
#include "io/cache/input_file.h"

namespace ft::inline io {
namespace {

constexpr char k_magic[12] = {'P', 'O', 'I', 'N', 'T', 'C', 'A', 'C', 'H', 'E', '2', '\0'};
constexpr std::uint64_t k_header_size = 32, k_sample_count_offset = 28;

struct Header {
  char magic[12];
  std::int32_t version;
  std::int32_t point_count;
  float start_frame;
  float frames_per_sample;
  std::int32_t sample_count;

  std::uint64_t frame_size() const { return 12 * static_cast<std::uint64_t>(point_count); }
  std::uint64_t end(int samples) const { return k_header_size + frame_size() * static_cast<std::uint64_t>(samples); }
};
static_assert(sizeof(Header) == k_header_size);

Result<Header> read_header(const InputFile& file) {
  const std::string where = file.path().string();
  Header h{};
  if (!file.read_at(0, std::as_writable_bytes(std::span(&h, 1))))
    return input_error("is too short for a PC2 file", where);
  if (std::memcmp(h.magic, k_magic, sizeof k_magic) != 0) return input_error("is not a PC2 file", where);
  if (h.version != 1) return input_error("has the unknown PC2 version " + std::to_string(h.version), where);
  if (h.point_count < 0 || h.sample_count < 0) return input_error("is damaged: negative counts", where);
  if (!std::isfinite(h.start_frame) || std::abs(h.start_frame) > 1e9f ||
      !(h.frames_per_sample > 0 && h.frames_per_sample < 1e9f))
    return input_error("is damaged: the start frame or the sample rate makes no sense", where);
  if (h.point_count == 0 && file.size() != k_header_size) return input_error("is damaged: no points, but data", where);
  const std::uint64_t data = file.size() - k_header_size, samples = static_cast<std::uint64_t>(h.sample_count);
  if (h.frame_size() > 0 && data / h.frame_size() < samples)
    return input_error("is cut: " + std::to_string(samples) + " frames announced, " +
                           std::to_string(data / h.frame_size()) + " are there",
                       where);
  // A file that grows holds at most the frame that is being written on top of what it announces.
  if (h.frame_size() > 0 && data - samples * h.frame_size() > h.frame_size())
    return input_error("is damaged: more data than " + std::to_string(samples) + " frames of " +
                           std::to_string(h.point_count) + " points",
                       where);
  return h;
}

class Pc2Writer final : public CacheWriter {
 public:
  Pc2Writer(OutputFile file, const Header& header, const CacheInfo& info) : file_(std::move(file)), header_(header) {
    info_.system = info.system;
    info_.content = info.content;
    info_.first_frame = info.first_frame;
    info_.vertex_count = header.point_count;
  }

  int frame_count() const override { return header_.sample_count; }

  Status write_frame(const CacheFrame& frame) override {
    if (broken_) return output_error("an earlier frame could not be written", file_.path().string());
    if (Status sound = check_frame(frame, info_, frame_count(), !frame.velocities.empty()); !sound) return sound;
    Status status = file_.write_at(header_.end(header_.sample_count), std::as_bytes(frame.positions));
    if (status) status = file_.sync();
    if (status) status = set_sample_count(header_.sample_count + 1);
    broken_ = !status;
    return status;
  }

  Status close() override { return file_.close(); }

  /// Frame by frame, so that the file is whole at every moment.
  Status cut_to(int keep_frames) {
    Status status;
    while (status && header_.sample_count > keep_frames) {
      status = file_.truncate(header_.end(header_.sample_count));
      if (status) status = set_sample_count(header_.sample_count - 1);
    }
    if (status) status = file_.truncate(header_.end(keep_frames));
    return status ? file_.sync() : status;
  }

 private:
  Status set_sample_count(std::int32_t count) {
    Status status = file_.write_at(k_sample_count_offset, std::as_bytes(std::span(&count, 1)));
    if (status) status = file_.sync();
    if (status) header_.sample_count = count;
    return status;
  }

  OutputFile file_;
  Header header_;
  CacheInfo info_;  // without rest data; for checks and messages
  bool broken_ = false;
};

class Pc2Reader final : public CacheReader {
 public:
  Pc2Reader(InputFile file, const Header& header) : file_(std::move(file)), header_(header) {
    info_.system = file_.path().stem().string();
    info_.first_frame = static_cast<int>(std::lround(header.start_frame));
    info_.frame_count = header.sample_count;
    info_.vertex_count = header.point_count;
    info_.has_topology = info_.has_fps = info_.content.velocities = false;
  }

  const CacheInfo& info() const override { return info_; }

  Status read_frame(int index, std::vector<Vec3f>& positions) override {
    if (index < 0 || index >= info_.frame_count)
      return input_error("has no frame with index " + std::to_string(index), file_.path().string());
    Bytes raw(static_cast<std::size_t>(header_.frame_size()));
    if (!file_.read_at(header_.end(index), raw)) return input_error("cannot be read to its end", file_.path().string());
    if (!points_from_bytes(raw, positions))
      return input_error(
          "is damaged: frame " + std::to_string(info_.first_frame + index) + " holds numbers that are not finite",
          file_.path().string());
    return {};
  }

  Status load_first_frame() {
    if (info_.frame_count == 0) return {};
    std::vector<Vec3f> points;
    Status status = read_frame(0, points);
    for (const Vec3f& p : points) info_.mesh.positions.push_back(p.cast<double>());
    return status;
  }

 private:
  InputFile file_;
  Header header_;
  CacheInfo info_;
};

}  // namespace

Status pc2_accepts(const FrameContent& content) {
  const auto refusal = [](std::string what) {
    return usage_error("PC2 cannot hold " + std::move(what), {}, "it holds a constant number of positions; take abc");
  };
  switch (content.shape) {
    case OutputShape::k_mesh: return content.changes ? Status(refusal("a mesh whose faces change")) : Status();
    case OutputShape::k_curves: return {};
    default: return refusal(std::string(shape_name(content.shape)));
  }
}

std::uint64_t pc2_bytes_per_frame(const FrameContent&, const FrameCounts& counts) {
  return 12 * counts.elements;
}

Result<std::unique_ptr<CacheWriter>> open_pc2_writer(const std::filesystem::path& path, const CacheInfo& info,
                                                     int keep_frames) {
  if (Status taken = pc2_accepts(info.content); !taken) return taken.error();
  if (Status sound = check_rest(info); !sound) return sound.error();
  Header header{};
  std::memcpy(header.magic, k_magic, sizeof k_magic);
  header.version = 1;
  header.point_count = constant_element_count(info);
  header.start_frame = static_cast<float>(info.first_frame);
  header.frames_per_sample = 1;
  if (keep_frames == 0) {
    const Status status = write_file_durably(path, std::as_bytes(std::span(&header, 1)));
    if (!status) return status.error();
  } else {
    auto old_file = InputFile::open(path);
    if (!old_file) return cannot_continue(path, old_file.error().what);
    const auto old_header = read_header(*old_file);
    if (!old_header) return cannot_continue(path, old_header.error().what);
    header.sample_count = old_header.value().sample_count;
    if (std::memcmp(&header, &old_header.value(), sizeof header) != 0)
      return cannot_continue(path, "it was written for another mesh or frame range");
    if (header.sample_count < keep_frames)
      return cannot_continue(
          path, "it has " + std::to_string(header.sample_count) + " frames of " + std::to_string(keep_frames));
  }
  auto file = OutputFile::open_existing(path);
  if (!file) return file.error();
  auto writer = std::make_unique<Pc2Writer>(std::move(*file), header, info);
  if (keep_frames > 0) {
    const Status status = writer->cut_to(keep_frames);
    if (!status) return status.error();
  }
  return std::unique_ptr<CacheWriter>(std::move(writer));
}

Result<std::unique_ptr<CacheReader>> open_pc2_reader(const std::filesystem::path& path) {
  auto file = InputFile::open(path);
  if (!file) return file.error();
  const auto header = read_header(*file);
  if (!header) return header.error();
  auto reader = std::make_unique<Pc2Reader>(std::move(*file), header.value());
  const Status status = reader->load_first_frame();
  if (!status) return status.error();
  return std::unique_ptr<CacheReader>(std::move(reader));
}

}  // namespace ft::inline io
