// `validate`: runs the physics conformance table and prints it; exit code 4 when a row fails.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "baker/commands/command_line.h"
#include "baker/core/file.h"
#include "baker/core/parallel.h"
#include "baker/record/report_json.h"
#include "solvers/validation/validation.h"

namespace ft::inline baker {
namespace {

struct ValidateArguments {
  std::string only;
  std::filesystem::path json;
  int threads = 0;
  bool list = false;
};

Json json_of(const std::vector<ValidationCase>& cases) {
  Json rows = Json::array();
  for (const ValidationCase& c : cases)
    rows.push_back({{"name", c.name},
                    {"what", c.what},
                    {"value", c.value},
                    {"reference", c.reference},
                    {"tolerance", c.tolerance},
                    {"unit", c.unit},
                    {"passed", c.passed},
                    {"source", c.source}});
  return Json{{"cases", std::move(rows)}};
}

int run(const ValidateArguments& a) {
  if (a.list) {
    for (const ValidationScene& scene : validation_scenes())
      std::printf("%-28s %s%s\n", std::string(scene.name).c_str(), std::string(scene.title).c_str(),
                  scene.slow ? " (slow)" : "");
    return 0;
  }
  const ThreadLimit limit(a.threads);
  std::printf("%-26s %-44s %12s %12s %10s %-8s verdict\n", "scene", "quantity", "value", "reference", "tolerance",
              "unit");
  const auto cases = run_validation(a.only, [](const ValidationScene& scene) {
    std::fprintf(stderr, "running %s\n", std::string(scene.name).c_str());
  });
  int failed = 0;
  for (const ValidationCase& c : cases) {
    std::printf("%-26s %-44s %12.6g %12.6g %10.3g %-8s %s\n", c.name.c_str(), c.what.c_str(), c.value, c.reference,
                c.tolerance, c.unit.c_str(), c.passed ? "ok" : "FAILED");
    failed += !c.passed;
  }
  if (cases.empty()) {
    complain("no scene has \"" + a.only + "\" in its name (validate --list names them)");
    return exit_code(ErrorKind::k_usage);
  }
  if (!a.json.empty())
    if (const Status written = write_text_durably(a.json, to_text(json_of(cases))); !written) {
      complain(written.error().text());
      return exit_code(written.error().kind);
    }
  std::printf("%zu rows, %d failed\n", cases.size(), failed);
  return failed == 0 ? 0 : exit_code(ErrorKind::k_quality);
}

}  // namespace

void add_validate_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("validate", "Runs the physics conformance table and prints it");
  auto a = std::make_shared<ValidateArguments>();
  command->add_option("--only", a->only, "Only scenes with this in their name")->type_name("NAME");
  command->add_option("--json", a->json, "Write the table as JSON")->type_name("FILE");
  command->add_option("--threads", a->threads, "Threads; 0 takes all cores")->check(CLI::Range(0, 1024));
  command->add_flag("--list", a->list, "Name the scenes and run nothing");
  command->callback([a, &exit_code] { exit_code = run(*a); });
}

}  // namespace ft::inline baker
