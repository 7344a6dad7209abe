#include "baker/commands/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>

#include "baker/version.h"

namespace ft {

void complain(const std::string& text) {
  std::fflush(stdout);
  std::fprintf(stderr, "followthrough: %s\n", text.c_str());
}

int run_command_line(int argc, char** argv) {
  CLI::App app{"Followthrough bakes cloth that follows an imported character animation."};
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
    complain(std::string(fault.what()) +
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

}  // namespace ft
