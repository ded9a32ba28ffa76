#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "compact_mesh/packed_surface.h"
#include "disk_paging/page_file.h"
#include "log/printed_text.h"
#include "log/progress.h"
#include "mesh/contact_mesh.h"
#include "output/output_file.h"
#include "output/output_plan.h"
#include "text/counted.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::cli {
namespace {

struct PageOptions {
  std::string in, out;
};

int page_mesh(const PageOptions& options) {
  output::OutputPlan plan;
  plan.read(options.in);
  plan.write("OUT", options.out, output::kPageFile);
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  scene::Progress progress("mesh page");
  auto begin_step = [&progress, step = std::size_t{0}](const char* name) mutable {
    constexpr std::size_t kSteps = 4;
    progress.set_share(step++, kSteps);
    progress.set_state(name);
  };
  begin_step("reading");
  const auto mesh = render::load_mesh(options.in);
  if (!mesh) return report_error(mesh.error(), kExitBadInput);
  begin_step("checking edges");
  const auto checked = render::ContactMesh::build(*mesh);
  if (!checked) return report_error({options.in + ": " + checked.error().message}, kExitBadInput);
  begin_step("packing triangles");
  const auto surface = render::PackedSurface::build(*checked);
  if (!surface) return report_error({options.in + ": " + surface.error().message}, kExitBadInput);
  auto file = output::OutputFile::open(options.out, output::kPageFile);
  if (!file) return report_error(file.error(), kExitTrouble);
  begin_step("writing");
  if (const auto written = render::write_page_file(*surface, file->part()); !written) {
    return report_error(file->named(written.error()), kExitTrouble);
  }
  if (const auto done = file->commit(); !done) return report_error(done.error(), kExitTrouble);
  progress.set_share(1.0);
  const auto pages =
      (surface->triangle_count() + render::kPageTriangles - 1) / render::kPageTriangles;
  scene::print_format("%s: %s in %s.\n", options.out.c_str(),
                      scene::counted(surface->triangle_count(), "triangle").c_str(),
                      scene::counted(pages, "page").c_str());
  return kExitDone;
}

}  // namespace

void add_mesh_page_command(CLI::App& mesh_command, int& exit_code) {
  CLI::App* command = mesh_command.add_subcommand(
      "page", "Convert a mesh to a page file, to load only pages near the tip");
  auto options = std::make_shared<PageOptions>();
  command->add_option("IN", options->in, std::string("Mesh: ") + render::kMeshEndings)->required();
  command->add_option("OUT", options->out, "Page file to write")->required();
  add_example(*command, "thimble mesh page scan.ply scan.pages");
  command->callback([options, &exit_code] { exit_code = page_mesh(*options); });
}

}  // namespace thimble::cli
