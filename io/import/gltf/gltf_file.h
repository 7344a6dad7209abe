// A glTF file (.glb, or .gltf with its buffers beside it or in it) as JSON and bytes, for the reader of characters and
// for the writer of changed files. Nothing in it is trusted: offsets, strides and counts are compared with the bytes
// that are there before anything is allocated.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "baker/core/bytes.h"
#include "baker/core/result.h"
#include "io/import/character/character.h"
#include "io/import/gltf/gltf_json.h"

namespace ft::inline io::gltf {

/// What integers of an accessor stand for.
enum class Integers {
  k_as_flagged,  ///< fractions where the accessor says "normalized", else themselves
  k_fractions,   ///< of the largest one: keys and weights
  k_themselves,  ///< indices, joints
};

/// Numbers of an accessor, `width` per element (matrices column by column).
struct AccessorValues {
  int width = 0;
  std::vector<double> values;
  std::size_t count() const { return width > 0 ? values.size() / static_cast<std::size_t>(width) : 0; }
};

/// Bytes of a bufferView, decompressed; stride 0: elements lie side by side.
struct ViewBytes {
  std::span<const std::byte> bytes;
  std::size_t stride = 0;
};

/// The JSON and the buffers; a buffer is read when it is first needed.
class GltfFile {
 public:
  /// Refuses what is no glTF 2 and a .glb that is cut short; see also is_version_1().
  static Result<GltfFile> open(const std::filesystem::path& path);

  const Json& json() const { return json_; }
  const std::filesystem::path& folder() const { return folder_; }
  /// Version 1, whose JSON has another shape; its buffers are not read here.
  bool is_version_1() const { return version_1_; }
  Result<AccessorValues> read(std::int64_t accessor, Integers integers);
  /// Numbers of an accessor, `width` per element; integers are fractions, as those of animations are.
  Result<std::vector<double>> accessor(std::int64_t index, int& width);
  /// Elements that an accessor says it has; 0 when it is not there.
  std::int64_t count(std::int64_t accessor) const;
  Result<ViewBytes> view(std::int64_t index);
  /// All bytes of a buffer; a .glb's own may be up to three bytes longer than its byteLength.
  Result<const Bytes*> buffer(std::int64_t index);
  /// Chunks of a .glb behind JSON and BIN, heads included.
  const Bytes& further_chunks() const { return further_chunks_; }
  /// Files that were opened for buffers so far.
  const std::vector<Dependency>& opened() const { return opened_; }
  /// Most elements that an accessor may have which names no bytes (all zeros): more than any mesh of this file can use.
  std::uint64_t most_zero_elements() const { return 65536 + 64 * byte_count_; }

 private:
  Status read_values(const Json& accessor, const std::string& name, Integers integers, AccessorValues& out);
  Status put_sparse(const Json& accessor, const std::string& name, Integers integers, AccessorValues& out);
  Result<Bytes> decompress(const Json& extension, const std::string& name);

  Json json_;
  std::filesystem::path folder_;
  bool binary_ = false, version_1_ = false;
  Bytes embedded_, further_chunks_;
  std::vector<Bytes> buffers_;
  std::map<std::int64_t, Bytes> decompressed_;  ///< by bufferView
  std::vector<Dependency> opened_;
  std::uint64_t byte_count_ = 0;  ///< of this file and the files of its buffers
};

}  // namespace ft::inline io::gltf
