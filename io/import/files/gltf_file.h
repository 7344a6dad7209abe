// A glTF file (.glb, or .gltf with its buffers beside it or in it) as JSON and bytes, for the reader of clips and for
// the writer of changed files. Members keep their order. Nothing in it is trusted: the helpers give a null value for
// what is missing or of another kind.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "baker/core/bytes.h"
#include "baker/core/result.h"
#include "io/import/character/character.h"

namespace ft::inline io::gltf {

using Json = nlohmann::ordered_json;

/// Member of an object, element of an array; a null value where there is none.
const Json& member(const Json& object, const char* key);
const Json& element(const Json& array, std::int64_t index);
std::int64_t integer(const Json& value, std::int64_t otherwise);
std::string text(const Json& value);
std::vector<double> numbers(const Json& array);
std::string decode_percent(const std::string& uri);

/// The JSON and the buffers; a buffer is read when it is first needed.
class GltfFile {
 public:
  static Result<GltfFile> open(const std::filesystem::path& path);

  const Json& json() const { return json_; }
  const std::filesystem::path& folder() const { return folder_; }
  /// Numbers of an accessor, `width` per element, normalised integers as the specification says.
  Result<std::vector<double>> accessor(std::int64_t index, int& width);
  /// All bytes of a buffer; a .glb's own may be up to three bytes longer than its byteLength.
  Result<const Bytes*> buffer(std::int64_t index);
  /// Chunks of a .glb behind JSON and BIN, heads included.
  const Bytes& further_chunks() const { return further_chunks_; }

 private:
  Json json_;
  std::filesystem::path folder_;
  Bytes embedded_, further_chunks_;
  std::vector<Bytes> buffers_;
};

/// Node of the character for each node of the JSON (-1: not in the scene), by walking both trees side by side; empty
/// when the trees differ.
std::vector<int> match_nodes(const Json& json, const Character& character);

}  // namespace ft::inline io::gltf
