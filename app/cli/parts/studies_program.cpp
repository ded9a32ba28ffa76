// `thimble-studies`: the commands of the package of that name, which `thimble` starts.
#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/parts/program.h"

namespace {

void add_mesh_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("mesh", "Write meshes for studies");
  command->require_subcommand(1);
  thimble::cli::add_mesh_generate_command(*command, exit_code);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace thimble::cli;
  return run_program(argc, argv,
                     {.name = "thimble-studies",
                      .about = "measure accuracy, cost and stability of haptic rendering",
                      .commands = {add_study_command, add_bench_command, ::add_mesh_command,
                                   add_cost_probe_command}});
}
