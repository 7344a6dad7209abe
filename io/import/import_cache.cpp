#include "io/import/import_cache.h"

#include "baker/core/file.h"
#include "io/import/files/read_character.h"
#include "io/import/import_child.h"

namespace ft::inline io {
namespace {

bool dependencies_unchanged(const std::filesystem::path& file, const Character& character) {
  for (const Dependency& d : character.dependencies) {
    const auto content = hash_file(file.parent_path() / d.path);
    if (!content || content->hash != d.hash) return false;
  }
  return true;
}

Hash128 content_hash(const Hash128& file, const Character& character) {
  Hasher hasher;
  hasher.number(file.low).number(file.high);
  for (const Dependency& d : character.dependencies) hasher.text(d.path).number(d.hash.low).number(d.hash.high);
  return hasher.digest();
}

}  // namespace

Result<LoadedCharacter> load_character(const std::filesystem::path& file, const std::filesystem::path& cache_folder,
                                       const ImportLimits& limits) {
  const auto content = hash_file(file);
  if (!content) return content.error();
  const Hash128 file_hash = content->hash;
  LoadedCharacter out;
  std::filesystem::path entry;
  if (!cache_folder.empty()) {
    Hasher key;
    key.text(k_importer_version).text(file.extension().string()).number(file_hash.low).number(file_hash.high);
    entry = cache_folder / (key.digest().hex() + ".character");
    std::error_code ignored;
    if (std::filesystem::exists(entry, ignored))
      if (const auto bytes = read_file(entry))
        if (auto cached = load_character_bytes(*bytes); cached && dependencies_unchanged(file, *cached)) {
          out.content = content_hash(file_hash, *cached);
          out.character = std::move(*cached);
          out.from_cache = true;
          return out;
        }
  }
  auto imported = import_in_child(file, limits);
  if (!imported) return imported.error();
  out.character = std::move(*imported);
  out.content = content_hash(file_hash, out.character);
  if (!entry.empty()) {
    Status written = make_folders(cache_folder);
    if (written) written = write_file_durably(entry, save_character(out.character));
    if (!written) out.character.notes.push_back("import was not cached: " + written.error().text());
  }
  return out;
}

}  // namespace ft::inline io
