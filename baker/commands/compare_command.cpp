// `compare A B`: options of baker/commands/compare.h from the command line.
#include <CLI/CLI.hpp>
#include <memory>

#include "baker/commands/command_line.h"
#include "baker/commands/compare.h"

namespace ft::inline baker {

void add_compare_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("compare", "Compares two caches of any formats, or the caches of two bakes");
  auto o = std::make_shared<CompareOptions>();
  command->add_option("a", o->a, "Cache or bake folder")->required()->type_name("A");
  command->add_option("b", o->b, "Cache or bake folder")->required()->type_name("B");
  command
      ->add_option("--tolerance", o->tolerance,
                   "Distance that still counts as equal, in metres; of scalars of vertices the number")
      ->check(CLI::NonNegativeNumber)
      ->type_name("METRES");
  command->add_option("--degrees", o->degrees, "Rotation of an instance that still counts as equal, in degrees")
      ->check(CLI::NonNegativeNumber)
      ->type_name("DEGREES");
  command->add_option("--json", o->json, "Write the report as JSON")->type_name("FILE");
  command->add_option("--html", o->html, "Write the report as a page")->type_name("FILE");
  command->add_option("--junit", o->junit, "Write the report as JUnit XML")->type_name("FILE");
  command->callback([o, &exit_code] { exit_code = run_compare(*o); });
}

}  // namespace ft::inline baker
