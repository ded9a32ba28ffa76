// Work of a smooth surface around closed paths. The felt normal is blended, so it is not exactly
// the gradient of the depth, and a closed path gains or loses work on irregular triangles.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "mesh/contact_mesh.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "support/tip_at.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/mesh/mesh_file.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::tip_at;

constexpr double kStiffness = 800;

/// Work around closed paths, in shares of the energy that goes in and out.
struct Work {
  std::vector<double> shares;
  double mean = 0;
};

/// Leads a tip around circles of 3 mm, 0.9 to 1.5 mm below random triangles of a mesh scaled to
/// 0.1 m. The second round counts. Paths on which contact ends are left out.
Work work_around(TriangleMesh mesh, TrackerChoice tracker, int paths) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& v : mesh.vertices) box.extend(v);
  for (Vector3d& v : mesh.vertices) v = 0.1 / box.sizes().maxCoeff() * (v - box.center());
  const ContactMesh surface = ContactMesh::build(mesh).value();
  const auto touch =
      build_object_touch(mesh, {.tracker = tracker}, {.spring = {.stiffness = kStiffness}}).value();
  support::Random random(730);
  Work work;
  constexpr int kSteps = 4000;
  for (int path = 0; path < paths; ++path) {
    const auto t = static_cast<std::int32_t>(
        random.uniform(0, static_cast<double>(mesh.triangles.size()) - 1e-9));
    const Vector3d n = surface.cell(t).face.n, u = n.unitOrthogonal(), v = n.cross(u);
    const Vector3d c =
        (surface.position(t, 0) + surface.position(t, 1) + surface.position(t, 2)) / 3;
    const auto at = [&](int step) -> Vector3d {
      const double a = 2 * std::numbers::pi * step / kSteps;
      return c + 0.003 * ((std::cos(a) - 1) * u + std::sin(a) * v) -
             (0.0012 - 0.0003 * std::cos(2 * a)) * n;
    };
    const Vector3d above = c + 0.02 * n;
    touch->update(tip_at(Vector3d::Constant(NAN)));
    for (int i = 0; i <= 300; ++i) touch->update(tip_at(above + i / 300.0 * (at(0) - above)));
    double sum = 0, exchanged = 0;
    bool whole = true;
    driver::ForceCommand before;
    for (int i = 0; i <= 2 * kSteps && whole; ++i) {
      const driver::ForceCommand now = touch->update(tip_at(at(i)));
      whole = now.touch.in_contact && now.touch.depth < 0.0035;
      if (i > kSteps) {
        const double one = (now.f_T_W + before.f_T_W).dot(at(i) - at(i - 1)) / 2;
        sum += one;
        exchanged += std::abs(one) / 2;
      }
      before = now;
    }
    if (whole) work.shares.push_back(std::abs(sum) / exchanged);
  }
  for (const double share : work.shares) {
    work.mean += share / static_cast<double>(work.shares.size());
  }
  return work;
}

TEST(SmoothWork, IsBelowHalfAPercentOnAFineRing) {
  const TriangleMesh ring = support::torus(0.04, 0.02, 96, 48);
  for (const TrackerChoice tracker : {TrackerChoice::kOffset, TrackerChoice::kPacked}) {
    const Work work = work_around(ring, tracker, 40);
    EXPECT_GT(work.shares.size(), 20u);
    EXPECT_LT(work.mean, 0.005) << kTrackerNames[static_cast<std::size_t>(tracker)];
  }
}

/// The figures of accuracy.md.
TEST(SmoothWork, IsSomePercentOnScans) {
  struct Row {
    const char* file;
    double least, most;
  };
  for (const Row& row : {Row{"bunny00.off", 0.002, 0.05}, Row{"elephant.off", 0.02, 0.3}}) {
    const auto file = std::filesystem::path(THIMBLE_MESHES) / row.file;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "run app/fetch_meshes.sh first";
    const TriangleMesh mesh = load_mesh(file).value();
    for (const TrackerChoice tracker : {TrackerChoice::kOffset, TrackerChoice::kPacked}) {
      const Work work = work_around(mesh, tracker, 200);
      std::printf("%s, %s: %zu paths, mean %.2g, largest %.2g of the energy\n", row.file,
                  std::string(kTrackerNames[static_cast<std::size_t>(tracker)]).c_str(),
                  work.shares.size(), work.mean,
                  *std::max_element(work.shares.begin(), work.shares.end()));
      EXPECT_GT(work.shares.size(), 20u);
      EXPECT_GT(work.mean, row.least);
      EXPECT_LT(work.mean, row.most);
    }
  }
}

}  // namespace
}  // namespace thimble::render
