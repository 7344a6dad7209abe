// make_set chair --out FOLDER, and so for swing, flags, drapes, runner: builds a set of the samples, and who moves in
// it. In metres, Y up.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "baker/core/file.h"
#include "io/cache/cache.h"
#include "io/shot/mesh_file.h"
#include "samples/tools/chair.h"
#include "samples/tools/panels.h"
#include "samples/tools/runner.h"
#include "samples/tools/swing.h"

namespace ft::sets {
namespace {

/// swing.obj and swing.pc2, which moves it; frame.obj; child.bvh.
Status write_swing(const std::filesystem::path& folder, const SwingSettings& settings) {
  if (Status status = write_obj(folder / "frame.obj", make_swing_frame(settings)); !status) return status;
  const std::vector<double> angles = swing_angles(settings);
  CacheInfo info;
  info.system = "swing";
  info.mesh = make_swing(settings, angles[0]);
  info.fps = settings.fps;
  info.frame_count = static_cast<int>(angles.size());
  if (Status status = write_obj(folder / "swing.obj", info.mesh); !status) return status;
  auto writer = find_cache_format("pc2")->open_writer(folder / "swing.pc2", info, 0);
  if (!writer) return writer.error();
  for (const double angle : angles)
    if (Status status = (*writer)->write_frame(make_swing(settings, angle).positions, {}); !status) return status;
  if (Status status = (*writer)->close(); !status) return status;
  return write_text_durably(folder / "child.bvh", child_bvh(settings));
}

/// chair.obj; sitter.bvh.
Status write_chair(const std::filesystem::path& folder, const ChairSettings& chair) {
  if (Status status = write_obj(folder / "chair.obj", make_chair(chair)); !status) return status;
  return write_text_durably(folder / "sitter.bvh", sitter_bvh({}, chair));
}

/// A flag for each mast: flag.obj, banner.obj, pennant.obj.
Status write_flags(const std::filesystem::path& folder) {
  FlagSettings banner, pennant;
  banner.length = 1.0;
  banner.height = 1.8;
  pennant.length = 2.2;
  pennant.height = 0.7;
  for (const auto& [name, settings] :
       {std::pair("flag.obj", FlagSettings()), {"banner.obj", banner}, {"pennant.obj", pennant}})
    if (Status status = write_obj(folder / name, make_flag(settings)); !status) return status;
  return {};
}

int told(const Status& status) {
  if (status) return 0;
  fmt::print(stderr, "make_set: {}\n", status.error().text());
  return exit_code(status.error().kind);
}

int main_checked(int argc, char** argv) {
  CLI::App app{"Builds the sets of the samples, and who moves in them."};
  app.require_subcommand(1);
  std::string out;
  const CLI::App* swing = app.add_subcommand("swing", "a swing, its frame, and a child on it: four files");
  app.add_subcommand("chair", "a chair, and somebody who sits down on it: two files");
  const CLI::App* flags = app.add_subcommand("flags", "three flags: three files");
  const CLI::App* runner = app.add_subcommand("runner", "somebody who runs: one file");
  const CLI::App* drapes = app.add_subcommand("drapes", "a curtain: one file");
  for (CLI::App* set : app.get_subcommands({})) set->add_option("--out", out, "folder to write into")->required();
  CLI11_PARSE(app, argc, argv);
  if (flags->parsed()) return told(write_flags(out));
  if (drapes->parsed()) return told(write_obj(std::filesystem::path(out) / "curtain.obj", make_curtain({})));
  if (runner->parsed()) return told(write_text_durably(std::filesystem::path(out) / "runner.bvh", runner_bvh({})));
  return told(swing->parsed() ? write_swing(out, {}) : write_chair(out, {}));
}

}  // namespace
}  // namespace ft::sets

int main(int argc, char** argv) {
  return ft::sets::main_checked(argc, argv);
}
