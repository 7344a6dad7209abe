// `advise SHOT.toml`: measures the interaction in a coarse one-way pass and recommends a coupling, with its reasons.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "baker/commands/command_line.h"
#include "baker/core/file.h"
#include "baker/judge/advice_pass.h"

namespace ft::inline baker {
namespace {

struct AdviseArguments {
  AdviceOptions options;
  std::string context;
  std::filesystem::path json;
};

void print(const AdvicePass& pass, const std::vector<Advice>& advice) {
  for (const std::string& note : pass.notes) std::printf("note: %s\n", note.c_str());
  for (const std::string& line : pass.primary_lines) std::printf("primary %s\n", line.c_str());
  for (std::size_t i = 0; i < advice.size(); ++i) {
    const Evidence& e = pass.pairs[i];
    const std::string also = advice[i].also ? std::string(" (or ") + name(*advice[i].also) + ")" : std::string();
    std::printf("\"%s\" on \"%s\": %s%s\n", e.secondary.c_str(), e.primary.c_str(), name(advice[i].coupling),
                also.c_str());
    for (const std::string& reason : advice[i].reasons) std::printf("  %s\n", reason.c_str());
    if (advice[i].coupling == Coupling::k_one_way) continue;
    const std::vector<std::string> table = e.stand_in_table();
    if (!table.empty())
      std::printf("  a stand-in fitted to these forces, which explains %.0f %% of them:\n", 100 * e.damping_r2);
    for (const std::string& line : table) std::printf("    %s\n", line.c_str());
  }
  std::printf("One-way forces are upper bounds: a primary that yields is pushed less.\n");
  std::printf("measured %d of %d frames in %.1f s; a final one-way bake would take about %.0f s\n", pass.frames,
              pass.shot_frames, pass.seconds, pass.final_seconds);
}

int run(const AdviseArguments& a) {
  Context context = Context::k_none;
  if (!a.context.empty()) context = context_from(a.context).value();  // the command line knows the names
  ShotFaults faults;
  auto pass = run_advice_pass(a.options, {import_primary, make_group_solver}, faults);
  if (!pass) {
    if (faults.messages.empty()) complain(pass.error().text());
    for (const std::string& fault : faults.messages) complain(fault);
    return exit_code(pass.error().kind);
  }
  const AdviceThresholds thresholds;
  std::vector<Advice> advice;
  for (const Evidence& e : pass->pairs) advice.push_back(advise(e, context, thresholds));
  print(*pass, advice);
  if (a.json.empty()) return 0;
  Json out{{"shot", a.options.shot_file.filename().string()},
           {"measured", {{"frames", pass->frames}, {"of", pass->shot_frames}, {"seconds", pass->seconds}}},
           {"final_seconds", pass->final_seconds},
           {"thresholds", to_json(thresholds)},
           {"notes", pass->notes}};
  out["pairs"] = Json::array();
  for (std::size_t i = 0; i < advice.size(); ++i) out["pairs"].push_back(to_json(pass->pairs[i], advice[i]));
  if (const Status written = write_text_durably(a.json, to_text(out)); !written) {
    complain(written.error().text());
    return exit_code(written.error().kind);
  }
  return 0;
}

}  // namespace

void add_advise_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("advise", "Measures the forces on the primaries and recommends a coupling");
  auto a = std::make_shared<AdviseArguments>();
  command->add_option("shot", a->options.shot_file, "The shot file (TOML)")->required()->type_name("SHOT.toml");
  command->add_option("--set", a->options.overrides, "Override a value of the shot file; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  command->add_option("--seconds", a->options.seconds, "Time for the measuring pass [s]")->check(CLI::Range(0.1, 1e5));
  command
      ->add_option("--context", a->context,
                   "How it is seen: background, far and occluded need no answer of the primary; hero does")
      ->type_name("CONTEXT")
      ->check(CLI::IsMember(context_names()));
  command->add_option("--json", a->json, "Write advice, evidence and thresholds to this file")->type_name("FILE");
  command->callback([a, &exit_code] { exit_code = run(*a); });
}

}  // namespace ft::inline baker
