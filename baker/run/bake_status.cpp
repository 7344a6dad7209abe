#include "baker/run/bake_status.h"

#include <fmt/format.h>

#include "baker/core/file.h"
#include "baker/record/version.h"

namespace ft::inline baker {
namespace {

/// What happened to a file since it was written; empty: nothing.
std::string damage(const std::filesystem::path& folder, const std::string& file, std::uint64_t size,
                   const std::string& content) {
  std::error_code error;
  const auto now = std::filesystem::file_size(folder / file, error);
  if (error) return file + " is gone";
  if (now == size)
    if (const auto found = hash_file(folder / file); found && found->hash.hex() == content) return {};
  return file + " was changed after the bake";
}

/// What happened to the files of a complete bake since; empty: nothing.
std::vector<std::string> damage(const BakeFolder& folder, const Manifest& manifest) {
  std::vector<std::string> out;
  for (const ManifestSystem& system : manifest.systems) {
    std::error_code error;
    if (!std::filesystem::exists(folder.path / system.topology, error)) out.push_back(system.topology + " is gone");
    for (const ManifestCache& cache : system.caches)
      if (std::string fault = damage(folder.path, cache.file, cache.bytes, cache.content); !fault.empty())
        out.push_back(std::move(fault));
  }
  for (const ManifestFile& file : manifest.files)
    if (std::string fault = damage(folder.path, file.file, file.bytes, file.content); !fault.empty())
      out.push_back(std::move(fault));
  return out;
}

}  // namespace

Manifest manifest_of(const BakeInputs& inputs) {
  Manifest m;
  m.version = program_version();
  m.build = program_build();
  m.fingerprint = inputs.fingerprint.hex();
  m.shot = inputs.shot.file.filename().string();
  m.first_frame = inputs.shot.first_frame;
  m.last_frame = inputs.shot.last_frame;
  m.first_written = inputs.shot.write_preroll ? inputs.shot.first_frame - inputs.shot.preroll : inputs.shot.first_frame;
  m.fps = inputs.shot.fps;
  m.preroll = inputs.shot.preroll;
  for (const InputRecord& file : inputs.files)
    m.inputs.push_back({file.role, file.path.filename().string(), file.content.hex()});
  m.settings = inputs.settings;
  return m;
}

BakeStatus find_bake_status(const BakeFolder& folder, const Manifest& now) {
  BakeStatus out;
  std::error_code error;
  if (!std::filesystem::exists(folder.manifest(), error)) return out;
  auto before = read_manifest(folder.path);
  if (!before) {
    out.kind = BakeStatus::Kind::k_stale;
    out.reasons.push_back("the manifest cannot be read: " + before.error().what);
    return out;
  }
  out.before = std::move(*before);
  out.reasons = stale_reasons(out.before, now);
  if (!out.reasons.empty()) {
    out.kind = BakeStatus::Kind::k_stale;
  } else if (!out.before.complete) {
    out.kind = BakeStatus::Kind::k_unfinished;
    out.reasons.push_back("an earlier bake was not finished");
  } else {
    out.reasons = damage(folder, out.before);
    out.kind = out.reasons.empty() ? BakeStatus::Kind::k_up_to_date : BakeStatus::Kind::k_stale;
  }
  return out;
}

std::string describe(const BakeStatus& status, const BakeFolder& folder) {
  std::string reasons;
  for (const std::string& reason : status.reasons) reasons += (reasons.empty() ? "" : "; ") + reason;
  switch (status.kind) {
    case BakeStatus::Kind::k_absent: return "not baked: there is nothing in " + folder.path.string();
    case BakeStatus::Kind::k_up_to_date:
      return fmt::format("up to date: {}, {} frames in {}", status.before.shot, status.before.written_count(),
                         folder.path.string());
    case BakeStatus::Kind::k_stale: return "stale: " + reasons;
    case BakeStatus::Kind::k_unfinished: return "unfinished: " + reasons;
  }
  return {};
}

}  // namespace ft::inline baker
