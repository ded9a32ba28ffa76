#include "studies/integrators/study_integrators.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <utility>

#include "body/spring/mesh_springs.h"
#include "files/scanned_meshes.h"
#include "log/printed_text.h"
#include "log/progress.h"
#include "report/gnuplot.h"
#include "report/picture_style.h"
#include "studies/integrators/membrane.h"
#include "studies/integrators/poked_body.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::studies {
namespace {

using render::SpringScheme;

constexpr int kFrames = 100;
// Half of the just noticeable difference of force, which is 7 % [PHYSICS 6, after Pang, Tan,
// Durlach 1991].
constexpr double kFelt = 0.035;

// The scan: small, closed, with irregular triangles; scaled to hand size.
constexpr const char* kScan = "elephant.off";
constexpr double kScanSize = 0.1;        // m, the longest side of its box
constexpr double kScanMass = 0.1;        // kg in total
constexpr int kReferenceSubsteps = 512;  // per frame: 8 times finer than the finest of its order

struct Line {
  SpringScheme scheme;
  double order;
  std::vector<int> substeps;
};

std::vector<Line> lines(bool membrane) {
  std::vector<Line> all{{SpringScheme::kSymplecticEuler, 1, {1, 2, 4, 8, 16, 32, 64}},
                        {SpringScheme::kVerlet, 2, {1, 2, 4, 8, 16, 32, 64}},
                        {SpringScheme::kImplicitEuler, 1, {1, 2, 4, 8, 16, 32}},
                        {SpringScheme::kTrapezoid, 2, {1, 2, 4, 8, 16, 32}},
                        {SpringScheme::kExplicitEuler, 1, {1, 4, 16, 64, 256}}};
  if (!membrane) return all;
  // Cheap enough to continue until orders are visible.
  for (Line& line : all) {
    const int more = line.scheme == SpringScheme::kImplicitEuler ? 4 : 2;
    for (int i = 0; i < more; ++i) line.substeps.push_back(2 * line.substeps.back());
  }
  return all;
}

PokedBody<1> poked_membrane() {
  const Membrane membrane;
  PokedBody<1> body{.network = membrane_network(membrane), .poked = membrane.poked(), .truth = {}};
  body.force = PokedBody<1>::Vector(membrane.force);
  body.poke_frames = static_cast<int>(std::lround(membrane.poke / kFrame));
  for (int frame = 1; frame <= kFrames; ++frame) {
    std::vector<PokedBody<1>::Vector> truth;
    for (const double height : membrane_truth(membrane, frame * kFrame)) truth.emplace_back(height);
    body.truth.push_back(std::move(truth));
  }
  return body;
}

driver::Result<PokedBody<3>> poked_scan() {
  const auto scan = scene::find_scan(kScan);
  if (!scan) return scan.error();
  auto mesh = render::load_mesh(*scan);
  if (!mesh) return mesh.error();
  Eigen::Vector3d low = mesh->vertices[0];
  Eigen::Vector3d high = low;
  for (const Eigen::Vector3d& p : mesh->vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (Eigen::Vector3d& p : mesh->vertices) p *= kScanSize / (high - low).maxCoeff();
  // A soft skin: edges of 300 N/m with axial springs, 10 N/m to the base points, and dampers in a
  // fixed ratio to all springs.
  constexpr double kShare = 2e-5;  // s
  const render::MeshSpringSettings settings{kScanMass / static_cast<double>(mesh->vertices.size()),
                                            10,
                                            10 * kShare,
                                            300,
                                            300 * kShare,
                                            true};
  auto network = render::join_vertices(*mesh, settings);
  if (!network) return network.error();
  PokedBody<3> body{.network = *std::move(network), .poked = mesh->triangles[0][0], .truth = {}};
  const auto corner = [&](std::size_t k) {
    return mesh->vertices[static_cast<std::size_t>(mesh->triangles[0][k])];
  };
  body.force = -0.3 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
  auto reference = motion_of(body, SpringScheme::kVerlet, kReferenceSubsteps);
  if (!reference) return reference.error();
  for (int frame = 0; frame < kFrames; ++frame) {
    if (frame < body.poke_frames) reference->push(body.poked, body.force);
    reference->step();
    body.truth.emplace_back(reference->u().begin(), reference->u().end());
  }
  return body;
}

struct Diagram {
  std::string name;   // file name of the picture
  std::string title;  // title
  std::vector<std::vector<WorkPoint>> lines;
};

template <int kDof>
driver::Result<Diagram> measure_all(const PokedBody<kDof>& body, bool membrane, Diagram diagram) {
  std::size_t all = 0, done = 0;
  for (const Line& line : lines(membrane)) all += line.substeps.size();
  scene::Progress progress("study integrators: " + diagram.name);
  for (const Line& line : lines(membrane)) {
    std::vector<WorkPoint> points;
    for (const int substeps : line.substeps) {
      auto point = measure(body, line.scheme, substeps);
      if (!point) return point.error();
      points.push_back(*std::move(point));
      progress.set_share(++done, all);
    }
    diagram.lines.push_back(std::move(points));
  }
  if (auto modal = measure_modal(body)) diagram.lines.push_back({*std::move(modal)});
  return diagram;
}

std::string csv_of(const std::vector<Diagram>& diagrams) {
  std::ostringstream csv;
  csv << "body,integrator,substeps_per_frame,us_per_frame,largest_error,diverged\n";
  for (const Diagram& diagram : diagrams) {
    for (const auto& line : diagram.lines) {
      for (const WorkPoint& point : line) {
        csv << diagram.name << ',' << point.integrator << ',' << point.substeps << ',';
        if (point.diverged) {
          csv << ",,1\n";
        } else {
          csv << point.frame_us << ',' << point.error << ",0\n";
        }
      }
    }
  }
  return csv.str();
}

std::string spoken(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

// Errors below this fraction are rounding, and are drawn at it so that they do not compress the
// axis.
constexpr double kFloor = 1e-7;

report::Plot work_precision(const Diagram& diagram) {
  // Colours that colour-blind people can distinguish [M Okabe and Ito].
  constexpr std::array kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8a919c", "#30343b"};
  constexpr std::array kMarks{7, 5, 9, 13, 11, 3};
  std::ostringstream text;
  std::string plots;
  text << report::quiet_style();
  for (std::size_t i = 0; i < diagram.lines.size(); ++i) {
    text << "$line" << i << " << EOD\n";
    int points = 0;
    for (const WorkPoint& point : diagram.lines[i]) {
      if (point.diverged) continue;
      text << report::number(point.frame_us) << ' '
           << report::number(100 * std::max(point.error, kFloor)) << ' ' << point.substeps << '\n';
      ++points;
    }
    text << "EOD\n";
    if (points == 0) continue;
    plots += ", $line" + std::to_string(i) + " using 1:2 with linespoints lw 2.4 pt " +
             std::to_string(kMarks[i]) + " ps 1.2 lc rgb '" + kColours[i] + "' title " +
             report::quote(spoken(diagram.lines[i][0].integrator)
                               .append(diagram.lines[i][0].error < kFloor ? " (exact)" : ""));
  }
  text << "set title " << report::quote(diagram.title) << "\nset logscale xy\n"
       << "set xlabel 'work per tick of 1 ms [µs]'\n"
       << "set ylabel 'largest error [% of the largest motion]'\n"
       << "set format x '10^{%L}'\nset format y '10^{%L}'\n"
       << "set key outside right center Left reverse samplen 2\n"
       << "set arrow 1 from graph 0, first " << report::number(100 * kFelt) << " to graph 1, first "
       << report::number(100 * kFelt) << " nohead dt '-' lc rgb '" << report::kFaintInk << "'\n"
       << "set label 1 'below: not noticeable' at graph 0.01, first " << report::number(100 * kFelt)
       << " left offset 0,-0.8 tc rgb '" << report::kFaintInk << "'\n"
       << "set label 2 'a tick' at first 1000, graph 0.03 rotate left offset 0.8,0 tc rgb '"
       << report::kFaintInk
       << "'\nset arrow 2 from first 1000, graph 0 to first 1000, graph 1 nohead dt '-' "
       << "lc rgb '" << report::kFaintInk << "'\nplot " << plots.substr(2) << '\n';
  return {.name = diagram.name, .width = 1600, .height = 900, .commands = text.str()};
}

// Returns the slope over the two finest steps, as an order.
double order_of(const std::vector<WorkPoint>& line) {
  const WorkPoint& fine = line[line.size() - 1];
  const WorkPoint& coarse = line[line.size() - 2];
  if (fine.diverged || coarse.diverged) return NAN;
  return std::log(coarse.error / fine.error) /
         std::log(static_cast<double>(fine.substeps) / coarse.substeps);
}

double order_named(const std::string& integrator) {
  for (const Line& line : lines(true)) {
    if (render::name_of(line.scheme) == integrator) return line.order;
  }
  return NAN;
}

void add_figures(const Diagram& diagram, bool with_orders, std::vector<session::Figure>& figures) {
  for (const auto& line : diagram.lines) {
    const std::string name = diagram.name + ", " + spoken(line[0].integrator);
    const WorkPoint* cheapest = nullptr;
    for (const WorkPoint& point : line) {
      if (point.diverged || !(point.error <= kFelt)) continue;
      if (cheapest == nullptr || point.frame_us < cheapest->frame_us) cheapest = &point;
    }
    if (cheapest != nullptr) {
      figures.push_back({.name = name + ": time for an error of 3.5 %",
                         .value = cheapest->frame_us,
                         .unit = "us/tick",
                         .goal = {}});
    }
    if (line.size() == 1) {
      figures.push_back({.name = name + ": largest error",
                         .value = line[0].error,
                         .unit = "of the largest motion",
                         .goal = "< 1e-9"});
    } else if (with_orders) {
      figures.push_back({.name = name + ": order off by",
                         .value = std::abs(order_of(line) - order_named(line[0].integrator)),
                         .unit = "",
                         .goal = "<= 0.2"});
    }
  }
}

}  // namespace

driver::Result<std::vector<session::Figure>> study_integrators(
    const std::filesystem::path& folder) {
  std::vector<Diagram> diagrams;
  auto membrane =
      measure_all(poked_membrane(), true,
                  {"integrators_membrane",
                   "A membrane of 32 x 32 nodes, poked for 50 ms, against its exact motion",
                   {}});
  if (!membrane) return membrane.error();
  diagrams.push_back(*std::move(membrane));
  if (const auto scan = poked_scan()) {
    auto measured =
        measure_all(*scan, false,
                    {"integrators_scan",
                     "A scanned elephant of " + std::to_string(scan->network.node_count()) +
                         " vertices, poked for 50 ms, against a much finer step",
                     {}});
    if (!measured) return measured.error();
    diagrams.push_back(*std::move(measured));
  } else {
    scene::print_format("The scanned mesh was skipped: %s\n", scan.error().message.c_str());
  }
  if (auto written = report::write_text(csv_of(diagrams), folder / "integrators.csv"); !written) {
    return written.error();
  }
  if (report::has_gnuplot()) {
    if (auto made = report::make_picture_folder(folder); !made) return made.error();
    for (const Diagram& diagram : diagrams) {
      if (auto drawn = report::draw_plot(work_precision(diagram), folder); !drawn)
        return drawn.error();
    }
  }
  std::vector<session::Figure> figures;
  for (const Diagram& diagram : diagrams) add_figures(diagram, &diagram == &diagrams[0], figures);
  return figures;
}

}  // namespace thimble::studies
