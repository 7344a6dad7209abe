// Entries to archive: see alembic_tree.h.
#include "io/cache/alembic_tree.h"

#include <fmt/format.h>

#include <algorithm>

namespace ft::inline io::alembic {
namespace {

constexpr const char* k_application = "Followthrough";
constexpr std::uint32_t k_shot_times = 1;  // index of the shot's time sampling

/// Names of objects and properties hold no '/', values of metadata no ';' and '='.
std::string plain(std::string text, std::string_view forbidden) {
  for (char& c : text)
    if (c == '\0' || forbidden.find(c) != std::string_view::npos) c = '_';
  return text.empty() ? "_" : text;
}

Layout layout_of(const CacheInfo& info, ogawa::Builder& out) {
  switch (info.content.shape) {
    case OutputShape::k_curves: return curves_layout(info, out);
    case OutputShape::k_points: return points_layout(info, out);
    case OutputShape::k_instances: return instances_layout(info, out);
    default: return mesh_layout(info, out);
  }
}

Entry provenance(const CacheInfo& info, ogawa::Builder& out) {
  std::vector<Entry> entries;
  for (const auto& [key, value] : info.metadata) {
    std::vector<char> text(value.begin(), std::find(value.begin(), value.end(), '\0'));
    text.push_back('\0');
    Entry e = constant_entry(plain(key, "/"), "", Pod::k_string, 1, append(out, text));
    e.property.kind = PropertyKind::k_scalar;
    entries.push_back(std::move(e));
  }
  return compound_entry(".userProperties", "", std::move(entries));
}

/// static_count: samples of what is constant but sampled as the frames are.
void build(const Entry& e, const FrameSamples& frames, std::uint32_t count, std::uint32_t static_count,
           std::vector<Property>& to) {
  const Property& p = e.property;
  if (e.channel) {
    const auto& all = frames.of[*e.channel];
    if (!e.always && (count == 0 || all.empty())) return;
    to.push_back(animated(p.kind, p.name, p.metadata, p.pod, p.extent, k_shot_times, std::span(all).first(count)));
  } else if (p.kind == PropertyKind::k_compound) {
    std::vector<Property> children;
    for (const Entry& child : e.children) build(child, frames, count, static_count, children);
    to.push_back(compound(p.name, p.metadata, std::move(children)));
  } else {
    to.push_back(constant(p.kind, p.name, p.metadata, p.pod, p.extent, e.shot_times ? k_shot_times : 0, e.sample,
                          e.shot_times ? static_count : 1));
  }
}

void find_channels(std::span<const Entry> entries, std::span<const Property> properties,
                   std::array<const Property*, k_channel_count>& found) {
  for (const Entry& e : entries)
    for (const Property& p : properties) {
      if (p.name != e.property.name || p.kind != e.property.kind) continue;
      if (e.channel) found[*e.channel] = &p;
      find_channels(e.children, p.children, found);
    }
}

void list_channels(std::span<const Entry> entries, std::vector<Channel>& to) {
  for (const Entry& e : entries) {
    if (e.channel) to.push_back(*e.channel);
    list_channels(e.children, to);
  }
}

}  // namespace

Entry channel_entry(Channel channel, std::string name, std::string metadata, Pod pod, int extent, bool always) {
  Entry e = constant_entry(std::move(name), std::move(metadata), pod, extent, {});
  e.channel = channel;
  e.always = always;
  return e;
}

Entry constant_entry(std::string name, std::string metadata, Pod pod, int extent, const Sample& sample,
                     bool shot_times) {
  Entry e;
  e.property.kind = PropertyKind::k_array;
  e.property.name = std::move(name);
  e.property.metadata = std::move(metadata);
  e.property.pod = pod;
  e.property.extent = extent;
  e.sample = sample;
  e.shot_times = shot_times;
  return e;
}

Entry compound_entry(std::string name, std::string metadata, std::vector<Entry> children) {
  Entry e;
  e.property = compound(std::move(name), std::move(metadata), {});
  e.children = std::move(children);
  return e;
}

std::vector<Entry> first_entries(std::string_view scope) {
  std::vector<Entry> out = {channel_entry(k_bounds, ".selfBnds", "interpretation=box", Pod::k_f64, 6, true)};
  out.front().property.kind = PropertyKind::k_scalar;
  out.push_back(
      channel_entry(k_positions, "P", fmt::format("geoScope={};interpretation=point", scope), Pod::k_f32, 3, true));
  return out;
}

std::string parameter_metadata(std::string_view scope, std::string_view interpretation, int extent,
                               std::string_view pod) {
  return fmt::format("arrayExtent=1;geoScope={};{}{}{}isGeomParam=true;podExtent={};podName={}", scope,
                     interpretation.empty() ? "" : "interpretation=", interpretation, interpretation.empty() ? "" : ";",
                     extent, pod);
}

void add_scalars(std::span<const std::string> names, std::vector<Entry>& to) {
  CHECK(names.size() <= k_most_scalars);
  for (std::size_t i = 0; i < names.size(); ++i)
    to.push_back(channel_entry(static_cast<Channel>(k_scalars + i), names[i],
                               parameter_metadata("vtx", "", 1, "float32_t"), Pod::k_f32, 1, true));
}

void add_attributes(std::span<const CacheAttribute> attributes, std::array<std::string_view, 3> scopes,
                    ogawa::Builder& out, std::vector<Entry>& to) {
  for (const CacheAttribute& a : attributes) {
    const std::string_view scope = scopes[static_cast<std::size_t>(a.scope)];
    const auto add = [&](Pod pod, int extent, std::string_view pod_name, std::string_view interpretation,
                         const Sample& sample) {
      to.push_back(constant_entry(plain(a.name, "/"), parameter_metadata(scope, interpretation, extent, pod_name), pod,
                                  extent, sample));
    };
    if (const auto* v = std::get_if<std::vector<std::int16_t>>(&a.values))
      add(Pod::k_i16, 1, "int16_t", "", append(out, *v));
    if (const auto* v = std::get_if<std::vector<std::int32_t>>(&a.values))
      add(Pod::k_i32, 1, "int32_t", "", append(out, *v));
    if (const auto* v = std::get_if<std::vector<float>>(&a.values))
      add(Pod::k_f32, 1, "float32_t", "", append(out, *v));
    if (const auto* v = std::get_if<std::vector<Eigen::Vector2f>>(&a.values))
      add(Pod::k_f32, 2, "float32_t", "vector", append(out, *v));
    if (const auto* v = std::get_if<std::vector<std::string>>(&a.values))
      add(Pod::k_string, 1, "string", "", append_strings(out, *v));
  }
}

Sample append_strings(ogawa::Builder& out, const std::vector<std::string>& values) {
  std::vector<char> text;
  for (const std::string& value : values) {
    text.insert(text.end(), value.begin(), std::find(value.begin(), value.end(), '\0'));
    text.push_back('\0');
  }
  Sample s = append(out, text);
  const std::uint64_t count = values.size();
  s.dimensions = out.data(std::as_bytes(std::span(&count, 1)));
  return s;
}

std::vector<float> flat(std::span<const Vec3> points) {
  std::vector<float> out;
  for (const Vec3& p : points)
    for (int c = 0; c < 3; ++c) out.push_back(static_cast<float>(p[c]));
  return out;
}

ArchiveTree::ArchiveTree(const CacheInfo& info)
    : system_(plain(info.system, "/")), fps_(info.fps), first_frame_(info.first_frame) {
  ogawa::Builder out(ogawa::k_header_size);
  layout_ = layout_of(info, out);
  layout_.geometry.push_back(provenance(info, out));
  static_bytes_ = out.take();
}

Archive ArchiveTree::archive(const FrameSamples& frames, std::uint32_t count) const {
  const std::uint32_t static_count = std::max(count, 1u);  // so that a cache without frames still has its topology
  std::vector<Property> geom;
  for (const Entry& e : layout_.geometry) build(e, frames, count, static_count, geom);

  Archive archive;
  archive.metadata = fmt::format("_ai_Application={};_ai_DCC_FPS={:.6f};_ai_Description={}", k_application, fps_,
                                 plain(system_, ";="));
  archive.time_samplings.push_back({static_count, 1.0 / fps_, {first_frame_ / fps_}});
  const std::string base = fmt::format("schema={};schemaBaseType=AbcGeom_GeomBase_v1", layout_.schema);
  const std::string title = fmt::format("{};schemaObjTitle={}:.geom", base, layout_.schema);
  Object object{system_, title, {compound(".geom", base, std::move(geom))}, {}};
  archive.top.children.push_back(std::move(object));
  return archive;
}

std::uint64_t ArchiveTree::tail_bound(std::uint32_t capacity) const {
  std::vector<Sample> fake(capacity);
  for (std::uint32_t i = 0; i < capacity; ++i) fake[i].key.h1 = i, fake[i].size = 17 + i % 2;
  std::vector<Channel> channels;
  list_channels(layout_.geometry, channels);
  FrameSamples frames;
  for (const Channel c : channels) frames.of[c] = fake;
  ogawa::Reference root = 0;
  const std::uint64_t ranges = channels.size() * 8;  // first and last change of each, which the fake has not
  constexpr std::uint64_t k_sector = 512;
  return (emit(archive(frames, capacity), 0, root).size() + ranges + k_sector - 1) / k_sector * k_sector;
}

std::array<const Property*, k_channel_count> ArchiveTree::channels_in(const Archive& archive) const {
  std::array<const Property*, k_channel_count> found{};
  if (archive.top.children.empty() || archive.top.children[0].properties.empty()) return found;
  find_channels(layout_.geometry, archive.top.children[0].properties[0].children, found);
  return found;
}

bool is_own(const Archive& archive) {
  return archive.metadata.starts_with(std::string("_ai_Application=") + k_application + ";");
}

}  // namespace ft::inline io::alembic
