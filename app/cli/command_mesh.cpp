#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/options/json_option.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "disk_paging/page_file.h"
#include "log/printed_text.h"
#include "log/progress.h"
#include "mesh/contact_mesh.h"
#include "mesh/file/off_text.h"
#include "mesh/repair/orient_mesh.h"
#include "mesh/repair/touching_parts.h"
#include "meshes/object_mesh.h"
#include "output/output_file.h"
#include "output/output_plan.h"
#include "report/json_text.h"
#include "report/mesh_json.h"
#include "report/pictures.h"
#include "text/counted.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/repair_mesh.h"
#include "thimble/render/mesh/thicken_sheets.h"

namespace thimble::cli {
namespace {

struct MeshOptions {
  std::string file;
  std::string picture;
  std::string repair;
  std::string output;
  double thicken = 0;  // in the file's unit; 0: keep open meshes open
};

using Json = nlohmann::ordered_json;

void print(const render::MeshFindings& found) {
  const Eigen::Vector3d size = found.box_max - found.box_min;
  scene::print_format("  triangles   %zu\n  vertices    %zu", found.triangles, found.vertices);
  if (found.unused_vertices > 0) scene::print_format(" (%zu unused)", found.unused_vertices);
  scene::print_format("\n  edges       %zu, %.4g to %.4g long, %.4g on average\n", found.edges,
                      found.edge_min, found.edge_max, found.edge_mean);
  scene::print_format("  components  %zu, Euler characteristic %ld\n", found.components,
                      found.euler_characteristic);
  scene::print_format(
      "  box         (%.4g, %.4g, %.4g) to (%.4g, %.4g, %.4g), %.4g x %.4g x %.4g\n",
      found.box_min.x(), found.box_min.y(), found.box_min.z(), found.box_max.x(), found.box_max.y(),
      found.box_max.z(), size.x(), size.y(), size.z());
  scene::print_format("  area        %.4g\n", found.area);
  if (found.touchable()) scene::print_format("  volume      %.4g\n", found.volume);
}

// Prints what the maps of a scene can use of a file (`map: uv`, `stiffness_map`, `friction_map`).
// `error`: why it cannot be read; empty if it can.
void print_maps(const render::MeshAttributes& attributes, const std::string& error, Json& json) {
  const bool coordinates = !attributes.uv.empty(), colours = !attributes.colours.empty();
  json["texture_coordinates"] = coordinates;
  json["vertex_colours"] = colours;
  if (!error.empty()) {
    scene::print_format("  maps        not readable: %s\n", error.c_str());
    return;
  }
  scene::print_format("  maps        %s\n", coordinates && colours
                                                ? "texture coordinates, vertex colours"
                                            : coordinates ? "texture coordinates"
                                            : colours     ? "vertex colours"
                                                      : "no texture coordinates or vertex colours");
}

// Size from which a mesh without a unit is probably in mm, m: `run` reports it for the largest
// reach of the shipped arms.
constexpr double kLargeForArms = scene::kReachesReported * 0.2;

// Prints which parts of a mesh overlap or touch.
void print_touching(const render::TriangleMesh& mesh, Json& json) {
  const render::TouchingParts touching = render::find_touching_parts(mesh);
  json["touching_pairs"] = touching.pairs;
  const std::string parts = render::describe(touching);
  if (!parts.empty()) scene::print_format("  note        %s\n", parts.c_str());
}

// Prints whether a mesh can be touched, and if not, why.
int print_verdict(const render::TriangleMesh& mesh, const render::MeshFindings& found, Json& json) {
  json["touchable"] = true;
  json["turned_on_load"] = 0;
  if (found.touchable()) {
    scene::print_format("Mesh OK: watertight and consistently oriented.\n");
    return kExitDone;
  }
  const auto contact = render::ContactMesh::build(mesh);
  scene::print_format(contact ? "The mesh can be touched. A scene corrects it on loading:\n"
                              : "The mesh cannot be touched:\n");
  for (const render::MeshFault& fault : found.faults) {
    scene::print_format("  - %s\n", render::describe(fault).c_str());
  }
  if (contact) {
    json["turned_on_load"] = contact->orientation().turned_triangles;
    scene::print_format("  %s\n", render::describe(contact->orientation()).c_str());
    return kExitDone;
  }
  json["touchable"] = false;
  // A one-sided surface has only faults of orientation.
  const bool only_winding =
      std::all_of(found.faults.begin(), found.faults.end(), [](const render::MeshFault& fault) {
        return fault.kind == render::MeshFault::Kind::kFlippedEdge ||
               fault.kind == render::MeshFault::Kind::kInsideOut;
      });
  if (only_winding) scene::print_format("  %s\n", contact.error().message.c_str());
  return kExitBadInput;
}

void print(const std::vector<render::RepairChange>& changes) {
  for (const render::RepairChange& change : changes) {
    scene::print_format("  - %s\n", render::describe(change).c_str());
  }
}

// Thickens open parts into thin bodies. Returns a sentence that describes the change.
std::string thicken(render::TriangleMesh& mesh, double thickness, Json& json) {
  render::ThickenedMesh thick = render::thicken_sheets(mesh, thickness);
  mesh = std::move(thick.mesh);
  render::orient_mesh(mesh);
  json["sheet_triangles"] = thick.report.triangles;
  return render::describe(thick.report, "(file's unit)");
}

// Tries the repairs on a mesh that cannot be touched, and prints which one helps.
void print_remedy(const render::TriangleMesh& mesh, const render::MeshFindings& found, Json& json) {
  render::RepairedMesh repaired = render::repair_mesh(mesh);
  json["remedy"] = {{"options", nullptr}};
  Json& remedy = json["remedy"];
  if (repaired.mesh.triangles.empty()) {
    scene::print_format("All triangles have zero area, so there is no surface to touch.\n");
    return;
  }
  remedy["changes"] = report::changes_json(repaired.changes);
  if (render::ContactMesh::build(repaired.mesh)) {
    remedy["options"] = {"--repair"};
    scene::print_format(
        "It can be repaired: use --repair OUT.off, or `repair: true` in a scene.\n");
    print(repaired.changes);
    return;
  }
  const double thickness = 0.01 * (found.box_max - found.box_min).maxCoeff();
  const std::string sheets = thicken(repaired.mesh, thickness, remedy);
  if (!render::ContactMesh::build(repaired.mesh)) {
    scene::print_format(
        "Neither --repair nor --thicken can correct it. Repair it in a mesh editor.\n");
    return;
  }
  remedy["options"] = {"--repair", "--thicken"};
  remedy["thickness"] = thickness;
  scene::print_format(
      "Its open parts can become sheets: use --repair OUT.off --thicken %.1g, or `repair: true` "
      "and `open: {thickness: 0.001}` in a scene.\n",
      thickness);
  print(repaired.changes);
  scene::print_format("  - %s\n", sheets.c_str());
}

/// Progress of the steps of this command.
class MeshSteps {
 public:
  explicit MeshSteps(bool repairs) : all_(repairs ? 9 : 4), progress_("mesh") {}
  void begin(const char* step) {
    progress_.set_share(begun_++, all_);
    progress_.set_state(step);
  }
  void end() { progress_.set_share(1.0); }

 private:
  std::size_t begun_ = 0, all_;
  scene::Progress progress_;
};

constexpr const char* kCheckStep = "checking edges";
constexpr const char* kTouchingStep = "searching for parts that touch";
constexpr const char* kContactStep = "preparing contact";

int repair(const render::TriangleMesh& mesh, const MeshOptions& options, MeshSteps& steps,
           Json& json) {
  steps.begin("repairing");
  render::RepairedMesh repaired = render::repair_mesh(mesh);
  json["changes"] = report::changes_json(repaired.changes);
  std::string sheets;
  if (options.thicken > 0 && !repaired.mesh.triangles.empty()) {
    sheets = thicken(repaired.mesh, options.thicken, json);
  }
  steps.begin("writing");
  const std::string text = render::off_text(repaired.mesh);
  if (auto saved = output::write_file(options.repair, output::kMesh, text); !saved) {
    return report_error(saved.error(), kExitTrouble);
  }
  scene::print_format("Repaired: %s\n", options.repair.c_str());
  if (repaired.changes.empty() && sheets.empty()) scene::print_format("  no changes\n");
  print(repaired.changes);
  if (!sheets.empty()) scene::print_format("  - %s\n", sheets.c_str());
  steps.begin(kCheckStep);
  const render::MeshFindings found = render::check_mesh(repaired.mesh);
  json.update(report::mesh_json(found));
  print(found);
  steps.begin(kTouchingStep);
  print_touching(repaired.mesh, json);
  steps.begin(kContactStep);
  const int verdict = print_verdict(repaired.mesh, found, json);
  steps.end();
  if (verdict != kExitDone) print_remedy(repaired.mesh, found, json);
  return verdict;
}

// Describes a page file; its triangles are checked one page at a time, if at all.
int describe_pages(const MeshOptions& options, Json& json) {
  const auto pages = render::PageFile::open(options.file);
  if (!pages) return report_error(pages.error(), kExitBadInput);
  if (!options.picture.empty() || !options.repair.empty()) {
    return report_error(
        {options.file + ": --picture and --repair cannot be used with a page file. Use the mesh "
                        "from which it was made."},
        kExitBadInput);
  }
  const double step = pages->lattice().step;
  Eigen::Vector3d low, high;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[static_cast<Eigen::Index>(axis)] = double{pages->whole().min[axis]};
    high[static_cast<Eigen::Index>(axis)] = double{pages->whole().max[axis]};
  }
  low = pages->lattice().origin + step * low;
  high = pages->lattice().origin + step * high;
  const Eigen::Vector3d size = high - low;
  scene::print_format(
      "%s (page file, lengths in m)\n  triangles   %d\n  pages       %zu of up to %d\n",
      options.file.c_str(), pages->triangle_count(), pages->boxes().size(), render::kPageTriangles);
  scene::print_format(
      "  box         (%.4g, %.4g, %.4g) to (%.4g, %.4g, %.4g), %.4g x %.4g x %.4g\n", low.x(),
      low.y(), low.z(), high.x(), high.y(), high.z(), size.x(), size.y(), size.z());
  std::vector<render::PackedTriangle> records(render::kPageTriangles);
  std::size_t damaged = 0;
  for (std::size_t page = 0; page < pages->boxes().size(); ++page) {
    damaged += pages->read_page(static_cast<std::int32_t>(page), records) == 0;
  }
  json["triangles"] = pages->triangle_count();
  json["pages"] = pages->boxes().size();
  json["damaged_pages"] = damaged;
  json["touchable"] = damaged == 0;
  if (damaged > 0) {
    scene::print_format(
        "%s and would be holes in the surface. Write the file again.\n",
        (scene::counted(damaged, "page") + (damaged == 1 ? " is damaged" : " are damaged"))
            .c_str());
    return kExitBadInput;
  }
  scene::print_format("Page file OK: all pages are intact.\n");
  return kExitDone;
}

int describe_mesh_file(const MeshOptions& options, Json& json) {
  if (!options.repair.empty() && std::filesystem::path(options.repair).extension() != ".off") {
    return report_error({"--repair: " + options.repair +
                         ": meshes are written as OFF. Use a file name that ends in .off."},
                        kExitBadInput);
  }
  if (options.file.starts_with("cgal:")) {
    return report_error({options.file + ": names with cgal: can be used only in scenes. Give the "
                                        "path of the file; `thimble doctor` prints the folders."},
                        kExitBadInput);
  }
  output::OutputPlan plan;
  plan.read(options.file);
  plan.write("--picture", options.picture, output::kind_of_name(options.picture));
  plan.write("--repair", options.repair, output::kMesh);
  plan.write("--output", options.output, output::kJson);
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  json["file"] = options.file;
  if (render::is_page_file(options.file)) return describe_pages(options, json);
  render::MeshFileInfo info;
  render::MeshAttributes attributes;
  MeshSteps steps(!options.repair.empty());
  steps.begin("reading");
  auto mesh = render::load_mesh_with_attributes(options.file, attributes, &info);
  std::string without_maps;
  if (!mesh) {
    // The shape may be readable although texture coordinates or colours are not.
    without_maps = mesh.error().message;
    mesh = render::load_mesh(options.file, &info);
  }
  if (!mesh) return report_error(mesh.error(), kExitBadInput);
  steps.begin(kCheckStep);
  const render::MeshFindings found = render::check_mesh(*mesh);
  scene::print_format("%s (lengths in the file's unit)\n", options.file.c_str());
  json.update(report::mesh_json(found));
  json["unit_m"] = info.unit ? Json(*info.unit) : Json(nullptr);
  json["up"] = info.up != 0 ? Json(std::string(1, info.up)) : Json(nullptr);
  json["notes"] = info.notes;
  print(found);
  print_maps(attributes, without_maps, json);
  if (info.unit) scene::print_format("  unit        %g m\n", *info.unit);
  if (info.up != 0) scene::print_format("  up          %c\n", info.up);
  const double side = (found.box_max - found.box_min).maxCoeff();
  json["unit_doubtful"] = !info.unit && side > kLargeForArms;
  if (json["unit_doubtful"]) {
    scene::print_format("  size        %.4g m large in a scene without scale or size; %s\n", side,
                        scene::unit_advice(info.kind).c_str());
  }
  for (const std::string& note : info.notes)
    scene::print_format("  note        %s\n", note.c_str());
  steps.begin(kTouchingStep);
  print_touching(*mesh, json);
  if (!options.picture.empty()) {
    const std::string title = std::filesystem::path(options.file).filename().string();
    if (const auto drawn =
            report::draw_mesh(*mesh, options.picture, title, "unit of the file", &found);
        !drawn) {
      return report_error(drawn.error(), kExitTrouble);
    }
    scene::print_format("Picture: %s\n", options.picture.c_str());
  }
  steps.begin(kContactStep);
  const int verdict = print_verdict(*mesh, found, json);
  if (!options.repair.empty()) {
    json["repaired"] = {{"file", options.repair}};
    return repair(*mesh, options, steps, json["repaired"]);
  }
  steps.end();
  if (verdict != kExitDone) print_remedy(*mesh, found, json);
  return verdict;
}

// Describes the mesh on the terminal, and optionally as JSON and in a file.
int describe_mesh(const MeshOptions& options) {
  Json json;
  const int verdict = describe_mesh_file(options, json);
  // Without findings (bad arguments, an unreadable file) no file is written.
  if (!json.contains("touchable")) return verdict;
  print_json("mesh", json);
  if (options.output.empty()) return verdict;
  const std::string text = report::json_text(json, 2) + "\n";
  if (auto saved = output::write_file(options.output, output::kJson, text); !saved) {
    return report_error(saved.error(), kExitTrouble);
  }
  return verdict;
}

}  // namespace

void add_mesh_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("mesh", "Check and repair a mesh file");
  auto options = std::make_shared<MeshOptions>();
  command->add_option("FILE", options->file,
                      std::string("Mesh: ") + render::kMeshEndings + ", or a page file");
  command
      ->add_option("--picture", options->picture,
                   "Draw three views with the faults marked (PNG, SVG)")
      ->option_text("FILE");
  command->add_option("--repair", options->repair, "Write the repaired mesh (OFF)")
      ->option_text("FILE");
  command->add_option("--output", options->output, "Write the findings as JSON to a file")
      ->option_text("FILE");
  add_json_option(*command);
  command
      ->add_option("--thicken", options->thicken,
                   "Give open parts this thickness (unit of the file)")
      ->check(CLI::PositiveNumber)
      ->needs("--repair");
  add_mesh_page_command(*command, exit_code);
  add_mesh_cache_command(*command, exit_code);
  add_mesh_generate_command(*command, exit_code);
  add_example(*command, "thimble mesh scan.ply --repair scan.off",
              "The exit code is 2 if the mesh cannot be touched.\n"
              "--repair welds vertices within 1e-5 of the size of the mesh; removes triangles\n"
              "that have no area or occur twice; closes seams; separates bodies that share an\n"
              "edge; fills holes up to half of the area of a part; orients triangles outwards.\n"
              "--thicken requires --repair.");
  // Otherwise a word that a sub-command rejects would be parsed as FILE without an error.
  command->parse_complete_callback([command, options] {
    if (!command->get_subcommands().empty() && !options->file.empty()) {
      throw CLI::ExtrasError({options->file});
    }
  });
  command->callback([command, options, &exit_code] {
    if (!command->get_subcommands().empty()) return;
    if (options->file.empty()) throw CLI::RequiredError("FILE");
    exit_code = describe_mesh(*options);
  });
}

}  // namespace thimble::cli
