#include "baker/commands/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>

#include "baker/record/version.h"
#include "io/shot/words.h"

namespace ft::inline baker {
namespace {

/// The first word that names neither a command nor an option of its command, and what was probably meant; empty: none.
std::string unknown_word(const CLI::App& app, int argc, char** argv) {
  const CLI::App* command = nullptr;
  for (int i = 1; i < argc; ++i) {
    std::string word = argv[i];
    if (command == nullptr && !word.starts_with("-")) {
      std::vector<std::string> known;
      for (const CLI::App* one : app.get_subcommands({})) {
        known.push_back(one->get_name());
        if (known.back() == word) command = one;
      }
      if (command == nullptr)
        return "there is no command \"" + printable(word) + "\" (" + suggestion(word, known) + ")";
    } else if (command != nullptr && word.starts_with("--") && word.size() > 2) {
      word = word.substr(0, word.find('='));
      if (command->get_option_no_throw(word) != nullptr) continue;
      std::vector<std::string> known;
      for (const CLI::Option* one : command->get_options())
        for (const std::string& name : one->get_lnames()) known.push_back("--" + name);
      return command->get_name() + " has no option " + printable(word) + " (" + suggestion(word, known) + ")";
    }
  }
  return {};
}

}  // namespace

void complain(const std::string& text) {
  std::fflush(stdout);
  std::fprintf(stderr, "followthrough: %s\n", text.c_str());
}

int run_command_line(int argc, char** argv) {
  CLI::App app{
      "Followthrough bakes what moves because an animated character does: cloth, hair, leaves, nets, ropes and water."};
  app.name("followthrough");
  app.set_version_flag("--version", "followthrough " + program_version());
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::help);
  int exit_code = 0;
  add_bake_command(app, exit_code);
  add_info_command(app, exit_code);
  add_compare_command(app, exit_code);
  add_check_command(app, exit_code);
  add_preview_command(app, exit_code);
  add_volumes_command(app, exit_code);
  add_advise_command(app, exit_code);
  add_validate_command(app, exit_code);
  try {
    app.parse(argc, argv);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      complain("cannot write to the standard output");
      return exit_code == 0 ? 6 : exit_code;
    }
    return exit_code;
  } catch (const CLI::Success& answer) {
    return app.exit(answer);  // --help, --version
  } catch (const CLI::ParseError& fault) {
    const std::string unknown = unknown_word(app, argc, argv);
    complain((unknown.empty() ? std::string(fault.what()) : unknown) +
             " (followthrough --help lists the commands, followthrough COMMAND --help their options)");
    return 2;
  } catch (const std::bad_alloc&) {
    complain("out of memory");
    return 3;
  } catch (const std::exception& fault) {
    complain(std::string("internal error: ") + fault.what() + "; please report it with the shot file");
    return 70;
  }
}

}  // namespace ft::inline baker
