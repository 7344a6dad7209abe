// `bake SHOT.toml`: options -> BakeOptions, the real importer and solver, progress, exit code.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "baker/commands/command_line.h"
#include "baker/commands/volumes.h"
#include "baker/core/parallel.h"
#include "baker/run/bake.h"
#include "baker/run/profile_text.h"

namespace ft::inline baker {
namespace {

struct BakeArguments {
  BakeOptions options;
  std::string frames, progress, log_json, quality;
  int threads = 0;
  bool profile = false;
};

int run(BakeArguments& a) {
  if (!a.frames.empty()) {
    std::string fault;
    if (!parse_frames(a.frames, a.options.frames.emplace(), fault)) {
      complain("--frames: " + fault);
      return exit_code(ErrorKind::k_usage);
    }
  }
  if (!a.quality.empty()) a.options.overrides.push_back("shot.quality=" + a.quality);
  std::vector<std::unique_ptr<Progress>> sinks;
  auto progress = make_progress(a.progress, stdout);
  if (!progress) {
    complain(progress.error().text());
    return exit_code(progress.error().kind);
  }
  sinks.push_back(std::move(*progress));
  if (!a.log_json.empty()) {
    auto log = make_json_log(a.log_json);
    if (!log) {
      complain(log.error().text());
      return exit_code(log.error().kind);
    }
    sinks.push_back(std::move(*log));
  }
  ProfileText profile;
  sinks.push_back(profile.listener());
  const auto all = combine(std::move(sinks));

  const ThreadLimit limit(a.threads);
  const BakeResult result = bake(a.options, {import_primary, make_group_solver}, *all);
  for (const std::string& line : result.lines) std::printf("%s\n", line.c_str());
  if (a.profile)
    for (const std::string& line : profile.lines()) std::printf("%s\n", line.c_str());
  for (const std::string& fault : result.faults) complain(fault);
  if (result.volumes.empty()) return result.exit_code;
  const int written = run_volumes({.folder = result.volumes, .output = {}, .keep = true});
  return result.exit_code != 0 ? result.exit_code : written;
}

}  // namespace

void add_bake_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("bake", "Bakes the cloth of a shot; skips what is up to date");
  auto a = std::make_shared<BakeArguments>();
  command->add_option("shot", a->options.shot_file, "The shot file (TOML)")->required()->type_name("SHOT.toml");
  command->add_option("--out,-o", a->options.folder, "Output folder; without it SHOT.bake beside the shot file")
      ->type_name("DIR");
  command->add_option("--frames", a->frames, "Bake these frames of the shot only, with a pre-roll of their own")
      ->type_name("A-B");
  command
      ->add_option("--quality", a->quality,
                   "preview: about four times as fast, on garments with a fifth of the vertices; final: as they are")
      ->type_name("QUALITY")
      ->check(CLI::IsMember({"preview", "final"}));
  command->add_option("--threads", a->threads, "Threads; 0 takes all cores. The result does not depend on it")
      ->check(CLI::Range(0, 1024));
  auto* resume = command->add_flag("--resume", a->options.resume, "Go on with an interrupted bake");
  command->add_flag("--force", a->options.force, "Bake even when up to date")->excludes(resume);
  command->add_flag("--dry-run", a->options.dry_run, "Check everything and print the plan; bake nothing");
  command->add_flag("--explain", a->options.explain, "Say whether the bake is up to date, and why not; bake nothing");
  command
      ->add_option("--set", a->options.overrides,
                   "Override a value of the shot file, as cloth.dress.fabric=denim; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  command->add_option("--progress", a->progress, "bar, plain, json, tractor, deadline, openjd or none")
      ->type_name("MODE");
  command->add_option("--log-json", a->log_json, "Write one JSON object per event to this file")->type_name("FILE");
  command->add_flag("--profile", a->profile, "Print where the time went");
  command->callback([a, &exit_code] { exit_code = run(*a); });
}

}  // namespace ft::inline baker
