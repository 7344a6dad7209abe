#include "io/import/import_child.h"

#include <cstring>

#include "baker/core/file.h"
#include "io/import/files/read_character.h"
#include "io/import/import.h"
#include "io/reading/guarded_child.h"
#include "io/reading/reading_step.h"

namespace ft::inline io {

Result<Character> import_in_child(const std::filesystem::path& file, const ImportLimits& limits) {
  ChildTask task;
  task.file = file, task.first = {"--import-child"};
  const auto bytes = read_in_child(task, limits);
  if (!bytes) return bytes.error();
  auto character = load_character_bytes(*bytes);
  if (character) return character;
  const Error& e = character.error();
  return damaged_child_result(task, (e.where.empty() ? "" : e.where + ": ") + e.what);
}

int import_child_main(int argc, char** argv) {
  if (argc != 4 || std::strcmp(argv[1], "--import-child") != 0) return 64;
  return child_exit_code(argv[3], [&]() -> Status {
    reading_step("its first bytes");
    auto character = read_character(argv[2]);
    if (!character) return character.error();
    reading_step("what its reader made of it, to check it");
    if (Status checked = check_character(*character); !checked) return checked;
    return write_file_durably(argv[3], save_character(*character));
  });
}

}  // namespace ft::inline io
