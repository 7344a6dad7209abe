#include "baker/core/state.h"

#include <atomic>

namespace ft {
namespace {

constexpr char k_magic[8] = {'F', 'T', 'S', 'T', 'A', 'T', 'E', '1'};

ByteParts content_of(const State& state) {
  ByteParts out;
  out.write(k_magic);
  out.write(static_cast<std::int64_t>(state.frame)).write(state.time);
  out.write(static_cast<std::uint64_t>(state.blocks.size()));
  for (const StateBlock& block : state.blocks) {
    out.write_string(block.name);
    const std::vector<double>& values = block.values.read();
    out.write(static_cast<std::uint64_t>(values.size()));
    out.view_array(std::span<const double>(values));
  }
  return out;
}

StateBlock& block_of(State& state, std::string_view name) {
  for (StateBlock& b : state.blocks)
    if (b.name == name) return b;
  state.blocks.push_back({std::string(name), {}});
  return state.blocks.back();
}

}  // namespace

const std::vector<double>& SharedNumbers::read() const {
  static const std::vector<double> none;
  return values_ ? *values_ : none;
}

std::vector<double>& SharedNumbers::write() {
  if (!values_ || values_.use_count() > 1) values_ = std::make_shared<std::vector<double>>(read());
  std::atomic_thread_fence(std::memory_order_acquire);  // whoever had them in another thread has read them
  return *values_;
}

std::vector<double>& State::block(std::string_view name) {
  return block_of(*this, name).values.write();
}

void State::set(std::string_view name, std::vector<double> values) {
  block_of(*this, name).values = SharedNumbers(std::move(values));
}

const std::vector<double>* State::find(std::string_view name) const {
  for (const StateBlock& b : blocks)
    if (b.name == name) return &b.values.read();
  return nullptr;
}

Hash128 hash(const State& state) {
  return hash_bytes(content_of(state).parts());
}

ByteParts parts_of(const State& state) {
  ByteParts out = content_of(state);
  const Hash128 content = hash_bytes(out.parts());
  out.write(content.low).write(content.high);
  return out;
}

Bytes save(const State& state) {
  return parts_of(state).joined();
}

Result<State> load_state(std::span<const std::byte> data) {
  const auto refuse = [](const char* why) { return input_error(std::string("checkpoint ") + why); };
  if (data.size() < sizeof k_magic + 16) return refuse("is cut off");
  const auto content = data.first(data.size() - 16);
  ByteReader tail(data.last(16));
  const Hash128 said{tail.read<std::uint64_t>(), tail.read<std::uint64_t>()};
  if (hash_bytes(content) != said) return refuse("is damaged: its content hash does not match");
  ByteReader in(content);
  const auto magic = in.read_span(sizeof k_magic);
  if (!in.ok() || std::memcmp(magic.data(), k_magic, sizeof k_magic) != 0) return refuse("has another version");
  State state;
  state.frame = static_cast<int>(in.read<std::int64_t>());
  state.time = in.read<double>();
  const auto blocks = in.read<std::uint64_t>();
  for (std::uint64_t b = 0; b < blocks && in.ok(); ++b) {
    StateBlock block;
    block.name = in.read_string();
    block.values = in.read_array<double>(in.read<std::uint64_t>());
    state.blocks.push_back(std::move(block));
  }
  if (!in.ok() || in.remaining() != 0) return refuse("does not have the length that it states");
  return state;
}

}  // namespace ft
