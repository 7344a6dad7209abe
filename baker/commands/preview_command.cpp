// `preview DIR`: options of baker/commands/preview.h from the command line.
#include <CLI/CLI.hpp>
#include <memory>

#include "baker/commands/command_line.h"
#include "baker/commands/preview.h"

namespace ft {

void add_preview_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("preview", "Writes one self-contained page with a player and plots");
  auto o = std::make_shared<PreviewOptions>();
  command->add_option("folder", o->folder, "Bake folder")->required()->type_name("DIR");
  command->add_option("-o,--out", o->output, "The page; without it preview.html in the folder")->type_name("FILE");
  command->callback([o, &exit_code] { exit_code = run_preview(*o); });
}

}  // namespace ft
