// The commands of the program. Each command is one file beside this one with a function that adds it, and one line in
// the list in command_line.cpp. Exit codes: 0 done, 1 compare found a difference, 2 wrong usage or shot file, 3 input
// missing or unreadable, 4 quality gate failed, 5 diverged, 6 output or disk, 130/143 interrupted, resumable, 70 our
// own bug.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace ft::inline baker {

int run_command_line(int argc, char** argv);

/// Prints "followthrough: TEXT" on stderr.
void complain(const std::string& text);

// Each adds its subcommand; when that is parsed it runs and leaves its exit code.
void add_bake_command(CLI::App& app, int& exit_code);
void add_info_command(CLI::App& app, int& exit_code);
void add_compare_command(CLI::App& app, int& exit_code);
void add_check_command(CLI::App& app, int& exit_code);
void add_preview_command(CLI::App& app, int& exit_code);
void add_volumes_command(CLI::App& app, int& exit_code);
void add_advise_command(CLI::App& app, int& exit_code);
void add_validate_command(CLI::App& app, int& exit_code);

}  // namespace ft::inline baker
