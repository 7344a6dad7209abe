// Bytes to tree, believing nothing: every reference, count, width and index is checked before it is used, nothing is
// allocated that the file is too small to hold, and groups that contain each other run out of a budget instead of out
// of memory.
#include <cmath>

#include "io/cache/alembic_archive.h"

namespace ft::inline io::alembic {
namespace {

constexpr int k_max_depth = 64;
constexpr std::uint64_t k_max_text_bytes = std::uint64_t{64} << 20;  // headers of one compound or object
constexpr std::uint8_t k_inline_metadata = 255;

std::string text_of(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

class Parser {
 public:
  explicit Parser(const InputFile& file) : source_(file), file_(file) {}

  Result<Archive> run(std::vector<StoredHashes>* stored_hashes, ogawa::Reference* root_place) {
    Archive archive;
    if (root_place != nullptr) *root_place = source_.root();
    const auto root = source_.group(source_.root());
    if (root.size() < 6) fail("is damaged: the root group is incomplete");
    if (source_.ok()) {
      if (number(root[0]) != 0) fail("has an unknown layout version");
      if (number(root[1]) < 9999) fail("was written by a version of Alembic that is too old");
      archive.metadata = text_of(source_.data(root[3], k_max_text_bytes));
      read_time_samplings(root[4], archive.time_samplings);
      read_metadata_table(root[5]);
      time_sampling_count_ = archive.time_samplings.size();
      read_object(root[2], archive.top, 0);
    }
    if (!source_.ok()) return input_error(source_.fault(), file_.path().string());
    if (stored_hashes != nullptr) *stored_hashes = hashes_;
    return archive;
  }

 private:
  void fail(std::string what) { source_.fail(std::move(what)); }

  std::int32_t number(ogawa::Reference reference) {
    const Bytes bytes = source_.data(reference, sizeof(std::int32_t));
    ByteReader in(bytes);
    return in.read<std::int32_t>();
  }

  void read_time_samplings(ogawa::Reference reference, std::vector<TimeSampling>& out) {
    const Bytes bytes = source_.data(reference, k_max_text_bytes);
    ByteReader in(bytes);
    out.clear();
    while (in.ok() && in.remaining() > 0) {
      TimeSampling t;
      t.max_samples = in.read<std::uint32_t>();
      t.time_per_cycle = in.read<double>();
      t.times = in.read_array<double>(in.read<std::uint32_t>());
      bool sound = !t.times.empty() && std::isfinite(t.time_per_cycle) && t.time_per_cycle > 0;
      for (const double time : t.times) sound = sound && std::isfinite(time);
      if (!sound) in.fail();
      out.push_back(std::move(t));
    }
    if (!in.ok() || out.empty()) fail("is damaged: the time samplings make no sense");
  }

  void read_metadata_table(ogawa::Reference reference) {
    const Bytes bytes = source_.data(reference, k_max_text_bytes);
    ByteReader in(bytes);
    table_.assign(1, "");
    while (in.ok() && in.remaining() > 0) {
      const auto text = in.read_span(in.read<std::uint8_t>());
      table_.emplace_back(reinterpret_cast<const char*>(text.data()), text.size());
    }
    if (!in.ok() || table_.size() > k_inline_metadata) fail("is damaged: the metadata table is cut");
  }

  std::string table_entry(std::uint32_t index) {
    if (index < table_.size()) return table_[index];
    fail("is damaged: metadata outside the table");
    return {};
  }

  void read_object(ogawa::Reference reference, Object& object, int depth) {
    if (depth > k_max_depth) fail("is damaged: objects are nested too deeply");
    const auto children = source_.group(reference);
    if (children.size() < 2) fail("is damaged: an object is incomplete");
    if (!source_.ok()) return;
    read_compound(children[0], object.properties, depth);
    const Bytes bytes = source_.data(children.back(), k_max_text_bytes);
    if (bytes.size() < 32) return fail("is damaged: an object has no hashes");
    const std::span<const std::byte> whole(bytes);
    ByteReader in(whole.first(bytes.size() - 32));
    for (std::size_t i = 1; i + 1 < children.size() && source_.ok(); ++i) {
      Object child;
      child.name = in.read_string();
      const auto metadata = in.read<std::uint8_t>();
      child.metadata = metadata == k_inline_metadata ? in.read_string() : table_entry(metadata);
      if (!in.ok() || child.name.empty()) return fail("is damaged: object headers are cut");
      object.children.push_back(std::move(child));
    }
    if (in.remaining() > 0) return fail("is damaged: more object headers than objects");
    ByteReader hashes(whole.last(32));
    StoredHashes stored;
    stored.properties = {hashes.read<std::uint64_t>(), hashes.read<std::uint64_t>()};
    stored.children = {hashes.read<std::uint64_t>(), hashes.read<std::uint64_t>()};
    hashes_.push_back(stored);
    for (std::size_t i = 0; i < object.children.size() && source_.ok(); ++i)
      read_object(children[i + 1], object.children[i], depth + 1);
  }

  Property read_header(ByteReader& in) {
    Property p;
    const auto info = in.read<std::uint32_t>();
    const std::uint32_t kind = info & 3, hint = info >> 2 & 3;
    const auto value = [&]() -> std::uint32_t {
      if (hint == 0) return in.read<std::uint8_t>();
      if (hint == 1) return in.read<std::uint16_t>();
      return in.read<std::uint32_t>();
    };
    bool sound = hint <= 2;
    if (kind != 0) {
      p.kind = kind == 1 ? PropertyKind::k_scalar : PropertyKind::k_array;
      p.single_element = kind == 3;
      const std::uint32_t pod = info >> 4 & 15;
      p.pod = static_cast<Pod>(pod);
      p.extent = static_cast<int>(info >> 12 & 255);
      p.homogeneous = (info >> 10 & 1) != 0;
      p.sample_count = value();
      const bool constant_bit = (info >> 11 & 1) != 0, range = (info >> 9 & 1) != 0;
      if (range) {
        p.first_changed = value();
        p.last_changed = value();
      } else if (!constant_bit && p.sample_count > 0) {
        p.first_changed = 1;
        p.last_changed = p.sample_count - 1;
      }
      if ((info >> 8 & 1) != 0) p.time_sampling = value();
      sound = sound && pod <= 13 && p.extent > 0 && p.time_sampling < time_sampling_count_ && !(constant_bit && range);
      sound = sound && (p.last_changed == 0 || (p.first_changed <= p.last_changed && p.last_changed < p.sample_count));
      sound = sound && (p.last_changed == 0 || p.first_changed > 0);
      if (p.last_changed == 0) p.first_changed = 0;
    }
    const auto name = in.read_span(value());
    p.name.assign(reinterpret_cast<const char*>(name.data()), name.size());
    const std::uint32_t metadata = info >> 20 & 255;
    if (metadata == k_inline_metadata) {
      const auto text = in.read_span(value());
      p.metadata.assign(reinterpret_cast<const char*>(text.data()), text.size());
    } else {
      p.metadata = table_entry(metadata);
    }
    if (!sound || !in.ok()) fail("is damaged: a property header makes no sense");
    return p;
  }

  void read_compound(ogawa::Reference reference, std::vector<Property>& properties, int depth) {
    if (depth > k_max_depth) fail("is damaged: properties are nested too deeply");
    const auto children = source_.group(reference);
    if (children.empty() || !source_.ok()) return;
    const Bytes bytes = source_.data(children.back(), k_max_text_bytes);
    ByteReader in(bytes);
    for (std::size_t i = 0; i + 1 < children.size() && source_.ok(); ++i) {
      Property p = read_header(in);
      if (!source_.ok()) return;
      if (p.kind == PropertyKind::k_compound)
        read_compound(children[i], p.children, depth + 1);
      else
        read_samples(children[i], p);
      properties.push_back(std::move(p));
    }
    if (in.remaining() > 0) fail("is damaged: more property headers than properties");
  }

  void read_samples(ogawa::Reference reference, Property& p) {
    const auto slots = source_.group(reference);
    const std::size_t step = p.kind == PropertyKind::k_array ? 2 : 1;
    const std::uint64_t expected = p.sample_count == 0 ? 0
                                   : p.constant()      ? 1
                                                       : std::uint64_t{p.last_changed} - p.first_changed + 2;
    if (source_.ok() && slots.size() != expected * step)
      return fail("is damaged: property \"" + p.name + "\" has " + std::to_string(slots.size() / step) +
                  " samples instead of " + std::to_string(expected));
    for (std::size_t i = 0; i < slots.size() && source_.ok(); i += step) {
      Sample s;
      s.data = slots[i];
      s.size = source_.data_size(s.data);
      if (s.size > 0 && s.size < 16) return fail("is damaged: a sample is shorter than its key");
      const Bytes key = source_.data(s.data, 16);
      ByteReader in(key);
      if (s.size > 0) s.key = {in.read<std::uint64_t>(), in.read<std::uint64_t>()};
      if (step == 2) {
        s.dimensions = slots[i + 1];
        source_.data_size(s.dimensions);
      }
      p.samples.push_back(s);
    }
  }

  ogawa::Source source_;
  const InputFile& file_;
  std::vector<std::string> table_;
  std::size_t time_sampling_count_ = 0;
  std::vector<StoredHashes> hashes_;
};

}  // namespace

Result<Archive> parse(const InputFile& file, std::vector<StoredHashes>* stored_hashes, ogawa::Reference* root) {
  return Parser(file).run(stored_hashes, root);
}

Result<Bytes> read_values(const InputFile& file, const Sample& sample) {
  if (sample.size == 0) return Bytes{};
  CHECK(sample.size >= 16);
  Bytes values(static_cast<std::size_t>(sample.size - 16));
  const std::uint64_t offset = (sample.data & ~ogawa::k_data_bit) + sizeof(std::uint64_t) + 16;
  if (!file.read_at(offset, values)) return input_error("cannot be read to its end", file.path().string());
  if (murmur3(values) != sample.key)
    return input_error("is damaged: a sample does not match its key", file.path().string());
  return values;
}

}  // namespace ft::inline io::alembic
