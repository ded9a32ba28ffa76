#pragma once

#include <vector>

namespace CLI {
class App;
}

namespace thimble::cli {

/// Adds a command (commands.h).
using AddCommand = void (*)(CLI::App& app, int& exit_code);

/// A program: `thimble`, or that of a part, which `thimble` starts.
struct Program {
  const char* name;   ///< Of its manual page.
  const char* about;  ///< What it is for, without a full stop.
  std::vector<AddCommand> commands;
};

/// Runs a program with the arguments of `main`, and returns its exit code (exit_code.h).
int run_program(int argc, char** argv, const Program& program);

}  // namespace thimble::cli
