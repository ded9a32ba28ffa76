#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/contact_mesh.h"
#include "search/make_search.h"
#include "studies/accuracy/axes/axes.h"
#include "studies/cost/cost_subjects.h"
#include "thimble/render/contact_choice.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;
using render::SearchChoice;

constexpr int kAcross[] = {8, 16, 32, 64, 96};
constexpr int kDefaultAcross = 32;
constexpr int kQuestions = 500;

/// A ring to be searched. The search keeps a reference to the mesh, whose address must not change.
struct Searched {
  Searched(int across, SearchChoice choice)
      : mesh(build(across)), search(render::make_search(mesh, choice)) {}

  static render::ContactMesh build(int across) {
    // A ring is closed, so this cannot fail.
    return render::ContactMesh::build(kCostRing.mesh(2 * across, across)).value();
  }

  render::ContactMesh mesh;
  std::shared_ptr<const render::ContactSearch> search;
};

// Returns the path of a hand at 0.3 m/s that passes close to the ring; some paths enter it.
std::pair<Vector3d, Vector3d> way(int question) {
  const double around = 0.37 * question;
  const double across = 0.11 * question;
  return {kCostRing.at(around, across, 5e-4),
          kCostRing.at(around + 0.004, across, question % 3 == 0 ? -2e-4 : 3e-4)};
}

// Returns the answers that differ from an exhaustive search, in percent.
double error_of(int across, SearchChoice choice) {
  const Searched some(across, choice);
  const Searched all(across, SearchChoice::kLinear);
  int wrong = 0;
  for (int i = 0; i < kQuestions; ++i) {
    const auto [from, to] = way(i);
    const render::Entry a = some.search->first_entry(from, to);
    const render::Entry b = all.search->first_entry(from, to);
    wrong += a.triangle != b.triangle || a.parameter != b.parameter ? 1 : 0;
  }
  return 100.0 * wrong / kQuestions;
}

Stroke work_of(int across, SearchChoice choice) {
  const auto searched = std::make_shared<const Searched>(across, choice);
  return [searched] {
    double sum = 0;
    for (int i = 0; i < kQuestions; ++i) {
      const auto [from, to] = way(i);
      sum += searched->search->first_entry(from, to).parameter;
    }
    return sum;
  };
}

}  // namespace

AccuracyAxis search_axis() {
  AccuracyAxis axis;
  axis.name = "search";
  axis.title = "Contact search while the tip is free: cost over the size of the mesh";
  axis.knob = "triangles";
  axis.metric = "results that differ from a test of every triangle";
  axis.unit = std::string("%");
  axis.truth = "A test of every triangle, with exact crossings.";
  axis.felt_words = "The search cannot be felt: all searches give the same results.";
  axis.per = "question";
  axis.over_cost = false;
  axis.over_knob = false;
  axis.cost_over_knob = true;
  axis.default_words =
      "Only smaller meshes are cheaper. On this mesh the grid is equally fast: the "
      "product uses it for fewer than 8,000 evenly distributed triangles, and a tree "
      "otherwise.";
  axis.left_out =
      "The error, because it is zero: all searches give the same results, ties "
      "included. Tracking during contact, which moves from neighbour to neighbour "
      "and whose cost does not grow with the mesh.";
  for (std::size_t k = 0; k < render::kSearchNames.size(); ++k) {
    const std::string name(render::kSearchNames[k]);
    AccuracyLine line{.name = name, .title = name, .exact = true};
    const auto choice = static_cast<SearchChoice>(k);
    for (const int across : kAcross) {
      AccuracyPoint point{.name = std::to_string(across),
                          .knob = 4.0 * across * across,
                          .error = [=] { return error_of(across, choice); },
                          .prepare = [=] { return work_of(across, choice); }};
      point.ticks = kQuestions;
      point.is_default = choice == SearchChoice::kTree && across == kDefaultAcross;
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

}  // namespace thimble::studies
