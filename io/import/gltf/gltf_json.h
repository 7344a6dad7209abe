// What a glTF's JSON says, read without trust: a null value for what is missing or of another kind.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "baker/core/bytes.h"

namespace ft::inline io::gltf {

using Json = nlohmann::ordered_json;  ///< members keep their order

/// Member of an object, element of an array; a null value where there is none.
const Json& member(const Json& object, const char* key);
const Json& element(const Json& array, std::int64_t index);
std::int64_t integer(const Json& value, std::int64_t otherwise);
std::string text(const Json& value);
std::vector<double> numbers(const Json& array);
std::size_t size_of_array(const Json& value);  ///< 0 when it is none

std::string decode_percent(const std::string& uri);
/// Characters that base64 does not have are passed over.
Bytes decode_base64(std::string_view encoded);

/// `node "Hips"`, or `nodes[3]` without a name: for messages.
std::string named(const Json& json, const char* list, std::int64_t index);
/// The name, or "nodes[3]" where it has none.
std::string name_or_place(const Json& object, const char* list, std::int64_t index);

}  // namespace ft::inline io::gltf
