// In place of the commands that measure, in a program without THIMBLE_STUDIES.
#include "cli/commands.h"

namespace thimble::cli {

void add_study_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "study", "Measure and draw accuracy, cost and stability",
                     "THIMBLE_STUDIES");
}

void add_bench_command(CLI::App& app, int& exit_code) {
  add_absent_command(app, exit_code, "bench",
                     "Is this machine good enough for a scene at 1, 4 and 8 kHz?",
                     "THIMBLE_STUDIES");
}

void add_cost_probe_command(CLI::App& /*app*/, int& /*exit_code*/) {}

void add_mesh_generate_command(CLI::App& mesh_command, int& exit_code) {
  add_absent_command(mesh_command, exit_code, "generate",
                     "Write a page file of any number of triangles", "THIMBLE_STUDIES");
}

}  // namespace thimble::cli
