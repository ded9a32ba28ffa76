#include <cstdio>
#include <memory>
#include <string>

#include "commands.h"
#include "exit_code.h"
#include "pictures.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/load_mesh.h"

namespace thimble::app {
namespace {

struct MeshOptions {
  std::string file;
  std::string picture;
};

void print(const render::MeshFindings& found) {
  const Eigen::Vector3d size = found.box_max - found.box_min;
  std::printf("  triangles   %zu\n  vertices    %zu", found.triangles, found.vertices);
  if (found.unused_vertices > 0) std::printf(" (%zu unused)", found.unused_vertices);
  std::printf("\n  edges       %zu, %.4g to %.4g long, %.4g on average\n", found.edges,
              found.edge_min, found.edge_max, found.edge_mean);
  std::printf("  components  %zu, Euler characteristic %ld\n", found.components,
              found.euler_characteristic);
  std::printf("  box         (%.4g, %.4g, %.4g) to (%.4g, %.4g, %.4g), %.4g x %.4g x %.4g\n",
              found.box_min.x(), found.box_min.y(), found.box_min.z(), found.box_max.x(),
              found.box_max.y(), found.box_max.z(), size.x(), size.y(), size.z());
  std::printf("  area        %.4g\n", found.area);
  if (found.touchable()) std::printf("  volume      %.4g\n", found.volume);
}

int tell_mesh(const MeshOptions& options) {
  const auto mesh = render::load_mesh(options.file);
  if (!mesh) {
    std::fprintf(stderr, "thimble: %s\n", mesh.error().message.c_str());
    return kExitBadInput;
  }
  const render::MeshFindings found = render::check_mesh(*mesh);
  std::printf("%s (lengths in the file's unit)\n", options.file.c_str());
  print(found);
  if (!options.picture.empty()) {
    if (const auto drawn = draw_mesh(*mesh, options.picture); !drawn) {
      std::fprintf(stderr, "thimble: %s\n", drawn.error().message.c_str());
      return kExitTrouble;
    }
    std::printf("Picture: %s\n", options.picture.c_str());
  }
  if (found.touchable()) {
    std::printf("The mesh is closed and wound alike: it can be touched.\n");
    return kExitDone;
  }
  std::printf("The mesh cannot be touched:\n");
  for (const render::MeshFault& fault : found.faults) {
    std::printf("  - %s\n", render::describe(fault).c_str());
  }
  return kExitBadInput;
}

}  // namespace

void add_mesh_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("mesh", "Tell what a mesh is and what is wrong with it (exit code 2)");
  auto options = std::make_shared<MeshOptions>();
  command->add_option("FILE", options->file, "Mesh: OFF, OBJ, STL or PLY")->required();
  command->add_option("--picture", options->picture, "Draw the mesh from three sides (PNG)");
  command->callback([options, &exit_code] { exit_code = tell_mesh(*options); });
}

}  // namespace thimble::app
