#include "baker/systems/cloth/cloth_grammar.h"

#include "baker/systems/cloth/cloth_keys.h"
#include "baker/systems/cloth/cloth_maps.h"
#include "io/shot/key_text.h"
#include "io/shot/ranges.h"
#include "io/shot/words.h"

namespace ft::inline baker {
namespace {

/// A pin that never holds, or fades without an end to do it at.
void judge_hold(const std::string& owner, const Value& value, const PinSpec& pin, FaultList& faults) {
  const Member *until = value.find("until"), *fade = value.find("fade"), *opens = value.find("opens");
  if (until && pin.from && pin.until && !(*pin.from < *pin.until))
    faults.add(until->place, owner + ": until = " + number_text(*pin.until) +
                                 " is not after from = " + number_text(*pin.from) + ": it would never hold");
  if (fade && !until && !value.find("from"))
    faults.add(fade->place, owner + ": fade needs until (or from), the frame at which it begins");
  if (opens && !(pin.fade > 0))
    faults.add(opens->place, owner + ": opens needs fade, the frames that it takes from one end to the other");
  for (const char* key : {"stiffness", "max_pull"})
    if (const Member* member = value.find(key); member && value.find("to") && pin.to != k_pin_world)
      faults.add(member->place, owner + ": " + key + " does not go with to: a cloth is held as firmly as by a seam; " +
                                    "weights below 1 (file, group) hold it less");
}

void read_pin(const KeyReader& keys, const std::string& owner, const Value& value, ClothSpec& cloth) {
  PinSpec pin;
  if (value.kind == Value::Kind::k_text) {
    pin.group = value.text;
    if (pin.group.empty()) keys.faults().add(value.place, owner + ": the name of a vertex group is empty");
    cloth.pins.push_back(std::move(pin));
    return;
  }
  if (value.kind != Value::Kind::k_table) {
    keys.faults().add(value.place,
                      owner + " needs a table like { group = \"waist\" } or { within = 0.02 }, not " + describe(value));
    return;
  }
  keys.read(owner, value, pin, pin_keys());
  const bool group = value.find("group") != nullptr, within = value.find("within") != nullptr,
             vertices = value.find("vertices") != nullptr, file = value.find("file") != nullptr;
  const int selections = group + within + vertices + file;
  if (selections != 1)
    keys.faults().add(value.place, owner + ": needs one of group, within, vertices, file, and has " +
                                       (selections == 0 ? "none" : std::to_string(selections)) +
                                       " (several pins are written as several { } in the list)");
  if (group && pin.group.empty()) keys.faults().add(value.place, owner + ": the name of a vertex group is empty");
  judge_column(owner, value, keys.faults());
  judge_hold(owner, value, pin, keys.faults());
  pin.select = within     ? PinSpec::Select::k_within
               : vertices ? PinSpec::Select::k_vertices
               : file     ? PinSpec::Select::k_file
                          : PinSpec::Select::k_group;
  cloth.pins.push_back(std::move(pin));
}

void read_map(const KeyReader& keys, const std::string& owner, const Value& value, ClothSpec& cloth) {
  MapSpec& map = cloth.maps.emplace_back();
  if (value.kind != Value::Kind::k_table) {
    keys.faults().add(value.place,
                      owner +
                          " needs a table like { of = \"thickness\", from = \"red\", low = 1e-3, high = 4e-3 }, not " +
                          describe(value));
    return;
  }
  keys.read(owner, value, map, map_keys());
  judge_map(owner, value, map, keys.faults());
}

std::string pin_text(const PinSpec& pin, const std::filesystem::path& folder) {
  std::string out = "{ ";
  switch (pin.select) {
    case PinSpec::Select::k_group: out.append("group = ").append(toml_text(pin.group)); break;
    case PinSpec::Select::k_within: out.append("within = ").append(number_text(pin.within)); break;
    case PinSpec::Select::k_vertices: out.append("vertices = ").append(toml_text(vertices_text(pin.vertices))); break;
    case PinSpec::Select::k_file: out.append("file = ").append(relative_text(pin.file, folder)); break;
  }
  if (!pin.column.empty()) out.append(", column = ").append(toml_text(pin.column));
  out.append(", stiffness = ")
      .append(number_text(pin.stiffness))
      .append(", max_pull = ")
      .append(number_text(pin.max_pull));
  if (pin.from) out.append(", from = ").append(number_text(*pin.from));
  if (pin.until) out.append(", until = ").append(number_text(*pin.until));
  if (pin.fade > 0) out.append(", fade = ").append(number_text(pin.fade));
  if (!pin.to.empty()) out.append(", to = ").append(toml_text(pin.to));
  if (!pin.opens.isZero()) out.append(", opens = ").append(vector_text(pin.opens));
  return out.append(" }");
}

std::string map_text(const MapSpec& map, const std::filesystem::path& folder) {
  std::string out = "{ of = " + toml_text(map.of);
  if (!map.from.empty()) out.append(", from = ").append(toml_text(map.from));
  if (!map.file.empty()) out.append(", file = ").append(relative_text(map.file, folder));
  if (!map.column.empty()) out.append(", column = ").append(toml_text(map.column));
  if (map.low) out.append(", low = ").append(number_text(*map.low));
  if (map.high) out.append(", high = ").append(number_text(*map.high));
  return out.append(" }");
}

}  // namespace

void read_pins(const KeyReader& keys, const ValueReader& reader, const Value& value, const Allowed&, ClothSpec& cloth) {
  if (value.kind != Value::Kind::k_list) return read_pin(keys, reader.owner + ", pins", value, cloth);
  for (std::size_t i = 0; i < value.items.size(); ++i)
    read_pin(keys, reader.owner + ", pin " + std::to_string(i + 1), value.items[i], cloth);
}

void read_single_pin(const KeyReader& keys, const ValueReader& reader, const Value& value, const Allowed&,
                     ClothSpec& cloth) {
  read_pin(keys, reader.owner + ", pin", value, cloth);
}

void read_pin_vertices(const KeyReader&, const ValueReader& reader, const Value& value, const Allowed&, PinSpec& pin) {
  const bool list = value.kind == Value::Kind::k_list;
  std::string text, fault;
  for (const Value& item : list ? std::span(value.items) : std::span(&value, 1)) {
    if (item.kind != Value::Kind::k_text && item.kind != Value::Kind::k_integer)
      return reader.fault(item, "needs vertices like \"0-199\" or [0, 1, 2], not " + describe(item));
    if (!text.empty()) text.append(",");
    text.append(item.kind == Value::Kind::k_integer ? std::to_string(item.integer) : item.text);
  }
  if (list && value.items.empty()) return reader.fault(value, "is empty");
  std::vector<int> vertices;
  if (parse_vertices(text, vertices, fault))
    pin.vertices = std::move(vertices);
  else
    reader.fault(value, fault);
}

void read_maps(const KeyReader& keys, const ValueReader& reader, const Value& value, const Allowed&, ClothSpec& cloth) {
  const bool list = value.kind == Value::Kind::k_list;
  int number = 0;
  for (const Value& item : list ? std::span(value.items) : std::span(&value, 1))
    read_map(keys, reader.owner + (list ? ", map " + std::to_string(++number) : ", maps"), item, cloth);
  judge_maps(reader.owner, value, cloth.maps, keys.faults());
}

std::string pins_text(const ClothSpec& cloth, const std::filesystem::path& folder) {
  std::string out = "[";
  for (const PinSpec& pin : cloth.pins) out.append(out.size() > 1 ? ", " : "").append(pin_text(pin, folder));
  return out.append("]");
}

std::string maps_text(const ClothSpec& cloth, const std::filesystem::path& folder) {
  std::string out;
  for (const MapSpec& map : cloth.maps) out.append(out.empty() ? "[" : ", ").append(map_text(map, folder));
  return out.empty() ? out : out.append("]");
}

}  // namespace ft::inline baker
