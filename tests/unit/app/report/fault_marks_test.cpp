#include "report/fault_marks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "report/gnuplot.h"
#include "report/pictures.h"
#include "support/meshes/shapes.h"
#include "support/scratch.h"

namespace thimble::report {
namespace {

render::TriangleMesh open_box() {
  render::TriangleMesh mesh = support::box({1, 1, 1});
  mesh.triangles.pop_back();
  return mesh;
}

TEST(FaultMarks, MarkNothingOnAGoodMesh) {
  const render::MeshFindings found = render::check_mesh(support::box({1, 1, 1}));
  EXPECT_FALSE(has_marks(found));
  EXPECT_TRUE(fault_clauses(found, "x.dat").empty());
  EXPECT_TRUE(fault_legend(found, 0, 0).empty());
}

TEST(FaultMarks, ShowEveryOpenEdgeWithALegend) {
  const render::TriangleMesh mesh = open_box();
  const render::MeshFindings found = render::check_mesh(mesh);
  ASSERT_TRUE(has_marks(found));
  const MeshView view(mesh, view_directions()[0], {0, 0, 0}, 2.4, 200);
  std::istringstream table(fault_table(found, mesh, view, 0.01));
  // The hole is the triangle 1-7-5 of the front: pieces of all three edges, none outside it.
  double length = 0;
  std::string line;
  double u_before = 0, v_before = 0;
  bool joined = false;
  while (std::getline(table, line)) {
    double u = 0, v = 0;
    std::istringstream numbers(line);
    if (!(numbers >> u >> v)) {
      joined = false;
      continue;
    }
    EXPECT_LE(std::max(std::abs(u), std::abs(v)), 1 + 1e-9);
    if (joined) length += std::hypot(u - u_before, v - v_before);
    u_before = u;
    v_before = v;
    joined = true;
  }
  EXPECT_NEAR(length, 2 + 2 + 2 * std::sqrt(2.0), 1e-6);
  EXPECT_NE(fault_legend(found, 0.05, 0.9).find("3 open edges"), std::string::npos);
}

TEST(FaultMarks, AreDrawnWithAMeshThatHasThem) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const render::TriangleMesh mesh = open_box();
  const render::MeshFindings found = render::check_mesh(mesh);
  const std::filesystem::path folder = support::scratch_folder();
  ASSERT_TRUE(draw_mesh(mesh, folder / "plain.svg", "box", "m").ok());
  ASSERT_TRUE(draw_mesh(mesh, folder / "marked.svg", "box", "m", &found).ok());
  const auto text = [](const std::filesystem::path& file) {
    std::ostringstream all;
    all << std::ifstream(file).rdbuf();
    return all.str();
  };
  EXPECT_EQ(text(folder / "plain.svg").find("open edges"), std::string::npos);
  EXPECT_NE(text(folder / "marked.svg").find("3 open edges"), std::string::npos);
}

}  // namespace
}  // namespace thimble::report
