#include "baker/run/checkpoint.h"

#include "baker/record/report_json.h"

namespace ft::inline baker {
namespace {

constexpr std::uint64_t k_magic = 0x3330454b41425446;  // "FTBAKE03"

}  // namespace

ByteParts parts_of(const Checkpoint& checkpoint) {
  ByteParts out;
  out.write(k_magic).write(checkpoint.fingerprint.low).write(checkpoint.fingerprint.high);
  out.write(static_cast<std::int64_t>(checkpoint.stage)).write(static_cast<std::int64_t>(checkpoint.frame));
  out.write(static_cast<std::uint64_t>(checkpoint.states.size()));
  for (const State& state : checkpoint.states) {
    ByteParts parts = parts_of(state);
    out.write(static_cast<std::uint64_t>(parts.size())).append(std::move(parts));
  }
  Json reports = Json::array();
  for (const FrameReport& report : checkpoint.reports) {
    Json row = to_json(report);
    row["profile"] = to_json(report.profile);
    reports.push_back(std::move(row));
  }
  out.write_string(checkpoint.manifest);
  out.write(static_cast<std::uint64_t>(checkpoint.before.size()));
  for (const std::vector<float>& numbers : checkpoint.before)
    out.write(static_cast<std::uint64_t>(numbers.size())).view_array(std::span<const float>(numbers));
  out.write_string(reports.dump(-1, ' ', false, Json::error_handler_t::replace));
  const Hash128 content = hash_bytes(out.parts());
  out.write(content.low).write(content.high);
  return out;
}

Bytes save(const Checkpoint& checkpoint) {
  return parts_of(checkpoint).joined();
}

Result<Checkpoint> load_checkpoint(std::span<const std::byte> data) {
  const auto refuse = [](const char* why) { return input_error(std::string("the checkpoint ") + why); };
  if (data.size() < 16) return refuse("is cut off");
  const auto content = data.first(data.size() - 16);
  ByteReader tail(data.last(16));
  const Hash128 said{tail.read<std::uint64_t>(), tail.read<std::uint64_t>()};
  if (hash_bytes(content) != said) return refuse("is damaged");
  ByteReader in(content);
  if (in.read<std::uint64_t>() != k_magic) return refuse("has another version");
  Checkpoint out;
  out.fingerprint.low = in.read<std::uint64_t>();
  out.fingerprint.high = in.read<std::uint64_t>();
  out.stage = static_cast<int>(in.read<std::int64_t>());
  out.frame = static_cast<int>(in.read<std::int64_t>());
  const auto count = in.read<std::uint64_t>();
  for (std::uint64_t i = 0; i < count && in.ok(); ++i) {
    auto state = load_state(in.read_span(in.read<std::uint64_t>()));
    if (!state) return state.error();
    out.states.push_back(std::move(*state));
  }
  out.manifest = in.read_string();
  const auto systems = in.read<std::uint64_t>();
  for (std::uint64_t i = 0; i < systems && in.ok(); ++i)
    out.before.push_back(in.read_array<float>(in.read<std::uint64_t>()));
  auto reports = parse_json(in.read_string(), "checkpoint");
  if (!in.ok() || in.remaining() != 0 || !reports || !reports->is_array())
    return refuse("does not hold what it states");
  for (const Json& row : *reports) {
    auto report = frame_report_from_json(row);
    if (!report) return report.error();
    auto profile = frame_profile_from_json(row.value("profile", Json::object()));
    if (!profile) return profile.error();
    report->profile = *profile;
    out.reports.push_back(std::move(*report));
  }
  return out;
}

}  // namespace ft::inline baker
