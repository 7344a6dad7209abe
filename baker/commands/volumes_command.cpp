// `volumes DIR`: options of baker/commands/volumes.h from the command line.
#include <CLI/CLI.hpp>
#include <memory>

#include "baker/commands/command_line.h"
#include "baker/commands/volumes.h"

namespace ft::inline baker {

void add_volumes_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("volumes", "Writes the water of a bake as OpenVDB files, one for each frame");
  auto o = std::make_shared<VolumesOptions>();
  command->add_option("folder", o->folder, "Bake folder")->required()->type_name("DIR");
  command->add_option("-o,--out", o->output, "Folder for the files; without it the bake's")->type_name("DIR");
  command->add_option("--voxel", o->voxel, "Size of a voxel [m]; without it that of the water's cells")
      ->check(CLI::PositiveNumber)
      ->type_name("M");
  command->callback([o, &exit_code] { exit_code = run_volumes(*o); });
}

}  // namespace ft::inline baker
