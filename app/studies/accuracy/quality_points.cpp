#include "studies/accuracy/quality_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <numbers>
#include <optional>
#include <utility>

#include "quality/quality_table.h"
#include "studies/accuracy/axes/axes.h"
#include "studies/accuracy/measure_axis.h"
#include "studies/accuracy/stroked_ring.h"
#include "studies/cost/cost_subjects.h"
#include "thimble/scene/build_info.h"

namespace thimble::studies {
namespace {

using render::BlendingChoice;
using render::TrackerChoice;

// Thresholds of perception [PHYSICS 6], as in the diagrams of tessellation.
constexpr double kForceShareFelt = 0.035;
constexpr double kAngleFelt = 5 * std::numbers::pi / 180;

constexpr std::array kFinenesses{24, 32, 48, 64};  // edges around the tube
constexpr int kSubstepsMax = 8;

struct TouchedBy {
  const char* name;
  const char* tracker;
  const char* blending;  // name in the source of the table
  const char* curved;
  render::ContactChoice choice;
};

render::ContactChoice way(TrackerChoice tracker, std::optional<BlendingChoice> blending,
                          std::optional<bool> curved) {
  render::ContactChoice choice;
  choice.tracker = tracker;
  choice.blending = blending;
  choice.curved_depth = curved;
  return choice;
}

const TouchedBy kTouchedBy[] = {
    {"flat", "kEdgePlanes", "kFlat", "false",
     way(TrackerChoice::kEdgePlanes, BlendingChoice::kFlat, false)},
    {"band", "kEdgePlanes", "kSizedBand", "false",
     way(TrackerChoice::kEdgePlanes, BlendingChoice::kSizedBand, false)},
    {"phong", "kEdgePlanes", "kPhong", "false",
     way(TrackerChoice::kEdgePlanes, BlendingChoice::kPhong, false)},
    {"curved", "kEdgePlanes", "kPhong", "true",
     way(TrackerChoice::kEdgePlanes, BlendingChoice::kPhong, true)},
    {"offset", "kOffset", "{}", "{}", way(TrackerChoice::kOffset, {}, {})},
    {"compact", "kPacked", "{}", "{}", way(TrackerChoice::kPacked, {}, {})}};

double worst_over_felt(const RingTouch& ring) {
  const RingErrors errors = ring_errors(ring);
  return std::max({errors.force / kForceShareFelt, errors.direction_p99 / kAngleFelt,
                   errors.jump / kAngleFelt});
}

// Returns Linux' name of the processor; empty if it has none.
std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (!line.starts_with("model name")) continue;
    const auto colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "a processor without a name";
}

const MeasuredLine& named(const MeasuredAxis& axis, std::string_view name) {
  return *std::find_if(axis.lines.begin(), axis.lines.end(),
                       [&](const MeasuredLine& line) { return line.line->name == name; });
}

std::string contact_rows() {
  const MeasuredAxis axis = measure_axis(contact_points_axis(), {.count = false});
  std::string text = "constexpr ContactPoint kContacts[] = {\n";
  for (std::size_t i = 0; i < axis.lines.size(); ++i) {
    const TouchedBy& by = kTouchedBy[i];
    for (const MeasuredPoint& point : axis.lines[i].points) {
      text += fmt::format("    {{{}, {}, {}, {:.5g}, {:.5g}, {:.3g}}},\n", by.tracker, by.blending,
                          by.curved, point.point->knob, point.error, point.ns);
    }
  }
  return text + "};\n";
}

std::string ring_rows() {
  const MeasuredAxis axis = measure_axis(rings_axis(), {.count = false});
  std::string text = "constexpr RingsPoint kRings[] = {\n";
  for (const MeasuredPoint& point : named(axis, "even").points) {
    text += fmt::format("    {{{:g}, {:.5g}, {:.3g}}},\n", point.point->knob,
                        point.error / *axis.axis.threshold, point.ns);
  }
  return text + "};\n";
}

// Returns the rows of the schemes that are stable on any dent.
std::string step_rows() {
  AccuracyAxis steps = deformable_axis();
  std::erase_if(steps.lines, [](const AccuracyLine& line) {
    return line.name != "implicit" && line.name != "trapezoid";
  });
  for (AccuracyLine& line : steps.lines) {
    std::erase_if(line.points,
                  [](const AccuracyPoint& point) { return std::stoi(point.name) > kSubstepsMax; });
  }
  const MeasuredAxis axis = measure_axis(std::move(steps), {.count = false});
  const double unit = named(axis, "implicit").points.front().ns;
  std::string text = "constexpr StepsPoint kSteps[] = {\n";
  for (const MeasuredLine& line : axis.lines) {
    const bool implicit = line.line->name == "implicit";
    for (const MeasuredPoint& point : line.points) {
      text += fmt::format("    {{{}, {}, {:.5g}, {:.3g}}},\n",
                          implicit ? "kImplicitEuler" : "kTrapezoid", point.point->name,
                          point.error / *axis.axis.threshold, point.ns / unit);
    }
  }
  return text + "};\n";
}

}  // namespace

AccuracyAxis contact_points_axis() {
  AccuracyAxis axis;
  axis.name = "quality_contact";
  for (const TouchedBy& by : kTouchedBy) {
    AccuracyLine line{.name = by.name, .title = by.name};
    for (const int across : kFinenesses) {
      const RingTouch ring{.choice = by.choice, .across = across};
      const auto mesh = render::ContactMesh::build(kCostRing.mesh(2 * across, across)).value();
      AccuracyPoint point{.name = std::to_string(across),
                          .knob = scene::typical_turn(mesh),
                          .error = [ring] { return worst_over_felt(ring); },
                          .prepare = [ring] { return ring_work(ring); }};
      point.ticks = kRingTicks;
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

std::string quality_table_text() {
  const scene::BuildInfo build = scene::build_info();
  return fmt::format(
             "// Made by `thimble study accuracy --table FILE`; times are of the machine named.\n"
             "// clang-format off\n"
             "constexpr int kVersion = {};\n"
             "constexpr std::string_view kMeasured = \"{}, thimble {}, {}\";\n",
             scene::quality_table().version + 1, processor(), build.version, build.compiler) +
         contact_rows() + ring_rows() + step_rows();
}

}  // namespace thimble::studies
