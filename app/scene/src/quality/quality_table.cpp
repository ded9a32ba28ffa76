#include "quality/quality_table.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "math/elementary.h"
#include "mesh/smooth_normals.h"

namespace thimble::scene {
namespace {

using enum render::TrackerChoice;
using enum render::BlendingChoice;
using enum render::SpringScheme;

#include "quality/quality_table.inc"

}  // namespace

const QualityTable& quality_table() {
  static constexpr QualityTable table{kVersion, kMeasured, kContacts, kRings, kSteps};
  return table;
}

double typical_turn(const render::ContactMesh& mesh) {
  constexpr double kShare =
      0.9;  // fraction of the edges [chosen: a few bad edges do not decide the feel]
  std::vector<double> turns;
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (const std::int32_t other : mesh.cell(t).neighbours) {
      if (other < t) continue;
      const Eigen::Vector3d& n = mesh.cell(t).face.n;
      const Eigen::Vector3d& m = mesh.cell(other).face.n;
      const double turn = math::atan2(n.cross(m).norm(), n.dot(m));
      if (turn < render::kCreaseAngle) turns.push_back(turn);
    }
  }
  if (turns.empty()) return 0;
  const auto at =
      turns.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(turns.size() - 1));
  std::nth_element(turns.begin(), at, turns.end());
  return *at;
}

}  // namespace thimble::scene
