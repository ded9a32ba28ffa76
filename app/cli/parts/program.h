#pragma once

#include <vector>

namespace CLI {
class App;
}

namespace thimble::cli {

/// Adds a command (commands.h).
using AddCommand = void (*)(CLI::App& app, int& exit_code);

/// A program: `thimble`, or the program of a part, which `thimble` starts.
struct Program {
  const char* name;   ///< Name of its manual page.
  const char* about;  ///< Purpose, without a full stop.
  std::vector<AddCommand> commands;
  /// Called without arguments, before the help is printed; null: the help only. It may replace this
  /// process.
  void (*without_arguments)() = nullptr;
};

/// Runs a program with the arguments of `main`, and returns its exit code (exit_code.h).
int run_program(int argc, char** argv, const Program& program);

}  // namespace thimble::cli
