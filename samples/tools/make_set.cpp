// make_set chair --out FOLDER, make_set swing --out FOLDER: builds a set of the samples, and who moves in it. In
// metres, Y up.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>

#include "io/cache/cache.h"
#include "io/shot/mesh_file.h"
#include "samples/tools/chair.h"
#include "samples/tools/swing.h"

namespace ft::sets {
namespace {

Status write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text << std::flush;
  if (!stream) return output_error("cannot be written", file.string());
  return {};
}

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
  return write_text(folder / "child.bvh", child_bvh(settings));
}

/// chair.obj; sitter.bvh.
Status write_chair(const std::filesystem::path& folder, const ChairSettings& chair) {
  if (Status status = write_obj(folder / "chair.obj", make_chair(chair)); !status) return status;
  return write_text(folder / "sitter.bvh", sitter_bvh({}, chair));
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
  ChairSettings chair;
  CLI::App* chairs = app.add_subcommand("chair", "a chair, and somebody who sits down on it: two files");
  chairs->add_option("--out", out, "folder to write into")->required();
  chairs->add_option("--seat", chair.seat, "height of the seat, metres")->check(CLI::Range(0.1, 1.0));
  chairs->add_option("--width", chair.width, "metres")->check(CLI::Range(0.2, 2.0));
  chairs->add_option("--depth", chair.depth, "metres")->check(CLI::Range(0.2, 2.0));
  chairs->add_option("--back", chair.back, "height of the back, metres")->check(CLI::Range(0.3, 2.0));
  SwingSettings swing;
  CLI::App* swings = app.add_subcommand("swing", "a swing, its frame, and a child on it: four files");
  swings->add_option("--out", out, "folder to write into")->required();
  swings->add_option("--seconds", swing.seconds, "of motion")->check(CLI::Range(1.0, 60.0));
  swings->add_option("--length", swing.length, "of the ropes, metres")->check(CLI::Range(1.5, 4.0));
  swings->add_option("--swing", swing.swing_deg, "how far it swings, degrees")->check(CLI::Range(10.0, 60.0));
  CLI11_PARSE(app, argc, argv);
  if (swings->parsed()) return told(write_swing(out, swing));
  return told(write_chair(out, chair));
}

}  // namespace
}  // namespace ft::sets

int main(int argc, char** argv) {
  return ft::sets::main_checked(argc, argv);
}
