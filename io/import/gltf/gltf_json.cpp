#include "io/import/gltf/gltf_json.h"

#include <cmath>

namespace ft::inline io::gltf {

const Json& member(const Json& object, const char* key) {
  static const Json none;
  if (!object.is_object()) return none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}
const Json& element(const Json& array, std::int64_t index) {
  static const Json none;
  if (!array.is_array() || index < 0 || static_cast<std::size_t>(index) >= array.size()) return none;
  return array[static_cast<std::size_t>(index)];
}
std::int64_t integer(const Json& value, std::int64_t otherwise) {
  if (value.is_number_unsigned()) {
    const auto v = value.get<std::uint64_t>();
    return v < (std::uint64_t{1} << 53) ? static_cast<std::int64_t>(v) : otherwise;
  }
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (value.is_number_float()) {
    const double v = value.get<double>();
    if (std::isfinite(v) && std::abs(v) < 0x1p53) return static_cast<std::int64_t>(v);
  }
  return otherwise;
}
std::string text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : std::string();
}
std::vector<double> numbers(const Json& array) {
  std::vector<double> out;
  if (array.is_array())
    for (const Json& v : array) out.push_back(v.is_number() ? v.get<double>() : std::nan(""));
  return out;
}
std::size_t size_of_array(const Json& value) {
  return value.is_array() ? value.size() : 0;
}

std::string decode_percent(const std::string& uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto digit = [&](std::size_t k) {
      const char c = k < uri.size() ? uri[k] : '?';
      return c >= '0' && c <= '9'   ? c - '0'
             : c >= 'a' && c <= 'f' ? c - 'a' + 10
             : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                    : -1;
    };
    if (uri[i] == '%' && digit(i + 1) >= 0 && digit(i + 2) >= 0)
      out.push_back(static_cast<char>(digit(i + 1) * 16 + digit(i + 2))), i += 2;
    else
      out.push_back(uri[i]);
  }
  return out;
}

Bytes decode_base64(std::string_view encoded) {
  Bytes out;
  out.reserve(encoded.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : encoded) {
    int value = -1;
    if (c >= 'A' && c <= 'Z')
      value = c - 'A';
    else if (c >= 'a' && c <= 'z')
      value = c - 'a' + 26;
    else if (c >= '0' && c <= '9')
      value = c - '0' + 52;
    else if (c == '+' || c == '-')
      value = 62;
    else if (c == '/' || c == '_')
      value = 63;
    if (value < 0) continue;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    if ((count += 6) >= 8) out.push_back(static_cast<std::byte>(bits >> (count -= 8) & 255));
  }
  return out;
}

std::string name_or_place(const Json& object, const char* list, std::int64_t index) {
  std::string name = text(member(object, "name"));
  return name.empty() ? std::string(list) + "[" + std::to_string(index) + "]" : name;
}

std::string named(const Json& json, const char* list, std::int64_t index) {
  const std::string name = text(member(element(member(json, list), index), "name"));
  const std::string place = std::string(list) + "[" + std::to_string(index) + "]";
  return name.empty() ? place : place + " \"" + name + "\"";
}

}  // namespace ft::inline io::gltf
