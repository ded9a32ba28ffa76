#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "disk_paging/page_file.h"
#include "log/printed_text.h"
#include "output/output_file.h"
#include "studies/resident_memory.h"
#include "studies/ring_pages.h"

namespace thimble::cli {
namespace {

struct GenerateOptions {
  std::string out;
  double triangles = 1e6;
  double size = 0.1;
};

int generate_mesh(const GenerateOptions& options) {
  studies::BumpyRing ring;
  const double scale = options.size / (2 * ring.half_size());
  ring.ring_radius *= scale;
  ring.tube_radius *= scale;
  const studies::RingGrid grid =
      studies::ring_grid(ring, static_cast<std::int64_t>(options.triangles));
  auto file = output::OutputFile::open(options.out, output::kPageFile);
  if (!file) return report_error(file.error(), kExitBadInput);
  if (const auto written = studies::write_ring(ring, grid, file->part()); !written) {
    return report_error(file->named(written.error()), kExitTrouble);
  }
  if (const auto done = file->commit(); !done) return report_error(done.error(), kExitTrouble);
  scene::print_format("%s: bumpy ring, %d triangles in %d pages; peak memory %.0f MiB.\n",
                      options.out.c_str(), grid.triangle_count(),
                      grid.triangle_count() / render::kPageTriangles,
                      static_cast<double>(studies::resident_memory().peak) / (1 << 20));
  return kExitDone;
}

}  // namespace

void add_mesh_generate_command(CLI::App& mesh_command, int& exit_code) {
  CLI::App* command = mesh_command.add_subcommand(
      "generate", "Write a large test mesh (bumpy ring) as a page file");
  auto options = std::make_shared<GenerateOptions>();
  command->add_option("OUT", options->out, "Page file to write")->required();
  command
      ->add_option("--triangles", options->triangles,
                   "Approximate number of triangles, 64 bytes each")
      ->check(CLI::Range(1024.0, 2.5e8))
      ->capture_default_str();
  command->add_option("--size", options->size, "Width of the ring, m")
      ->check(CLI::Range(1e-3, 2.0))
      ->capture_default_str();
  add_example(*command, "thimble mesh generate ring.pages --triangles 1e6");
  command->callback([options, &exit_code] { exit_code = generate_mesh(*options); });
}

}  // namespace thimble::cli
