// Caches: the frames of one output. shape.h says what an output may be, frame.h what a frame of it is. Every format has
// a writer and a reader, and says which shapes it takes; both are listed in registry.cpp and the contract tests run
// over the list. A cache carries no times of day and no host names: the same bake gives the same bytes. It is valid
// after every frame: open the file at any moment and all finished frames are there.
//
//   CacheInfo info;                                        // once: name, frame rate, shape, rest data
//   info.content = {.shape = OutputShape::k_points, .changes = true};
//   if (const Status taken = format.accepts(info.content); !taken) ...
//   auto writer = format.open_writer(path, info, 0);
//   (*writer)->write_frame(data.view());                   // every frame: a FrameData that the conductor has filled
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "baker/core/mesh.h"
#include "baker/core/output_shape.h"
#include "baker/core/result.h"
#include "io/cache/frame.h"

namespace ft::inline io {

struct CacheInfo {
  std::string system;    ///< name of the garment; object name in the cache
  FrameContent content;  ///< the shape, and what its frames hold
  Mesh mesh;             ///< topology, uvs, rest positions; file order. Reader: positions of the first frame
  CurveSet curves;
  InstanceSet instances;
  std::vector<CacheAttribute> attributes;  ///< of curves and instances
  double fps = 24;
  int first_frame = 1;  ///< frame number of the first sample
  int vertex_count =
      0;  ///< reader: points of the first frame, known even where mesh is empty; writers count for themselves
  int frame_count = 0;  ///< writer: frames that will come; reader: frames there are
  std::vector<std::pair<std::string, std::string>> metadata;  ///< sorted by key; units, version, hash of the inputs
  bool has_topology = true;   ///< reader: false for formats that hold points only (PC2, MDD)
  bool has_velocity = false;  ///< reader; the same as content.velocities
  bool has_fps = true;        ///< reader: false where the format stores no frame rate (PC2); fps is then a guess
};

class CacheWriter {
 public:
  virtual ~CacheWriter() = default;
  /// Frames written so far, those kept by resume included.
  virtual int frame_count() const = 0;
  /// Appends one frame. Durable when it returns.
  virtual Status write_frame(const CacheFrame& frame) = 0;
  /// The same for positions [m], velocities [m/s] (may be empty) and scalars of vertices.
  Status write_frame(std::span<const Vec3> positions, std::span<const Vec3> velocities,
                     std::span<const std::vector<float>> scalars = {});
  virtual Status close() = 0;
};

class CacheReader {
 public:
  virtual ~CacheReader() = default;
  virtual const CacheInfo& info() const = 0;
  /// index counts from 0. Everything that the frame holds, all of it finite; of meshes the faces only where they
  /// change.
  virtual Status read(int index, FrameData& frame);
  /// Positions [m], all finite. An index outside [0, frame_count) is an error.
  virtual Status read_frame(int index, std::vector<Vec3f>& positions) = 0;
  /// Velocities [m/s]; an error where info().has_velocity is false.
  virtual Status read_velocities(int index, std::vector<Vec3f>& velocities);
};

struct CacheFormat {
  std::string_view name;       ///< as in [cache] formats: "abc", "pc2"
  std::string_view extension;  ///< ".abc"
  std::string_view description;
  /// An error that names what this format cannot hold.
  std::function<Status(const FrameContent&)> accepts;
  /// What a frame costs on disk [bytes], without headers.
  std::function<std::uint64_t(const FrameContent&, const FrameCounts&)> bytes_per_frame;
  /// keep_frames = 0: a new file; n > 0: continue a file after its first n frames, cutting what follows. A resumed file
  /// is byte-identical to one written without interruption. What accepts() refuses is refused before a file is touched.
  std::function<Result<std::unique_ptr<CacheWriter>>(const std::filesystem::path&, const CacheInfo&, int keep_frames)>
      open_writer;
  std::function<Result<std::unique_ptr<CacheReader>>(const std::filesystem::path&)> open_reader;
  /// Names of what it takes and does not keep: scalars of vertices; velocities are its description's.
  std::function<std::vector<std::string>(const FrameContent&)> leaves_out;
  std::string_view magic;  ///< first bytes of every file of the format
};

std::span<const CacheFormat> cache_formats();
const CacheFormat* find_cache_format(std::string_view name);
/// By content first, extension second: a mesh of constant topology, or points that stand for one.
Result<std::unique_ptr<CacheReader>> open_cache(const std::filesystem::path& path);
/// The same for all shapes; look at info().content.
Result<std::unique_ptr<CacheReader>> open_cache_of_any_shape(const std::filesystem::path& path);

}  // namespace ft::inline io
