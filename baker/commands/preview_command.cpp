// `preview DIR`: options of baker/commands/preview.h from the command line.
#include <CLI/CLI.hpp>
#include <memory>

#include "baker/commands/command_line.h"
#include "baker/commands/preview.h"

namespace ft::inline baker {

void add_preview_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("preview", "Writes one self-contained page with a player and plots");
  auto o = std::make_shared<PreviewOptions>();
  command
      ->add_option("folders", o->folders,
                   "Bake folders; of several the paths of the primaries are drawn over each other")
      ->required()
      ->type_name("DIR");
  command->add_option("-o,--out", o->output, "The page; without it preview.html in the first folder")
      ->type_name("FILE");
  command
      ->add_option("--curve-megabytes", o->curve_megabytes,
                   "What curves such as hair may take of the page; of more a share of the strands is drawn")
      ->check(CLI::PositiveNumber)
      ->capture_default_str()
      ->type_name("MB");
  command->callback([o, &exit_code] { exit_code = run_preview(*o); });
}

}  // namespace ft::inline baker
