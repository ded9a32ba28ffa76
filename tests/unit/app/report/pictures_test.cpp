#include "report/pictures.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "report/gnuplot.h"
#include "report/mesh_view.h"
#include "report/picture_style.h"
#include "support/scratch.h"

namespace thimble::report {
namespace {

// A tetrahedron with a corner at the origin and legs of 50 mm, oriented outwards.
render::TriangleMesh tetrahedron() {
  render::TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.05, 0, 0}, {0, 0.05, 0}, {0, 0, 0.05}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

std::vector<driver::TickRecord> stroke() {
  std::vector<driver::TickRecord> rows(2000);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto x = static_cast<double>(i) / 2000;
    rows[i].time_ns = static_cast<std::int64_t>(i) * 1'000'000;
    rows[i].work_ns = 5000 + static_cast<std::int64_t>(i % 100) * 10;
    rows[i].in_contact = i > 500 && i < 1500;
    rows[i].p_WT = rows[i].p_WP = {0.05 * x, 0.01, 0.06 - 0.05 * x};
    rows[i].f_sent_W = {0, 0, rows[i].in_contact ? std::sin(3 * x) : 0};
    rows[i].f_wanted_W = rows[i].f_sent_W;
    rows[i].depth = rows[i].in_contact ? 0.001 : 0;
  }
  return rows;
}

std::pair<int, int> png_size(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(24, '\0');
  stream.read(head.data(), 24);
  if (!stream || head.substr(1, 3) != "PNG" || head.substr(12, 4) != "IHDR") return {0, 0};
  const auto number = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value = value * 256 + static_cast<unsigned char>(head[at + i]);
    return value;
  };
  return {number(16), number(20)};
}

TEST(ForcePicture, KeepsPeaksOfRequestedForceAndDepth) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const std::filesystem::path folder = support::scratch_folder() / "peaks";
  std::filesystem::create_directories(folder / "data");
  std::vector<driver::TickRecord> rows(100'000);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].time_ns = static_cast<std::int64_t>(i) * 1'000'000;
    rows[i].in_contact = true;
    rows[i].f_sent_W = {0, 0, 1 + 0.1 * std::sin(0.1 * static_cast<double>(i))};
    rows[i].f_wanted_W = {0, 0, i == 34'567 ? 54.0 : 5.0};
    rows[i].depth = i == 76'543 ? 0.02 : 0.001;
  }
  ASSERT_TRUE(draw_force_and_depth(rows, {.title = "peaks"}, folder));
  std::ifstream table(folder / "data/force_and_depth.dat");
  std::string line;
  double wanted_max = 0, depth_max = 0;
  while (std::getline(table, line)) {
    double time = 0, wanted = 0, sent = 0, depth = 0;
    if (!(std::istringstream(line) >> time >> wanted >> sent >> depth)) continue;
    wanted_max = std::max(wanted_max, wanted);
    depth_max = std::max(depth_max, depth);
  }
  EXPECT_DOUBLE_EQ(wanted_max, 54);
  EXPECT_DOUBLE_EQ(depth_max, 20);
}

TEST(MeshView, HidesPointsBehindTheMeshOnly) {
  const auto& front = view_directions()[0];
  const MeshView view(tetrahedron(), front, {0.02, 0.02, 0.02}, 0.08, 200);
  EXPECT_TRUE(view.hides({-0.03, 0.01, 0.01}, 0.001));
  EXPECT_FALSE(view.hides({0.06, 0.01, 0.01}, 0.001));
  EXPECT_FALSE(view.hides({-0.03, 0.045, 0.045}, 0.001));
  EXPECT_FALSE(view.hides({-0.03, 10, 0.01}, 0.001));
  EXPECT_FALSE(view.hides({NAN, NAN, NAN}, 0.001));
}

TEST(MeshView, HidesNothingOnAFaceThatIsSeenEdgeOn) {
  // The face x = 0 of the tetrahedron is seen edge-on from the left side, at the picture's left.
  const auto& side = view_directions()[1];
  const MeshView view(tetrahedron(), side, {0.02, 0.02, 0.02}, 0.08, 200);
  EXPECT_FALSE(view.hides({0, 0.03, 0.01}, 0.001));
  EXPECT_TRUE(view.hides({0.01, 0.03, 0.01}, 0.001));
}

TEST(MeshView, CoversTheTrianglesShareOfThePicture) {
  // Seen from the front the tetrahedron is a right triangle of 50 x 50 mm in a window of 80 x 80
  // mm.
  const MeshView view(tetrahedron(), view_directions()[0], {0.02, 0.02, 0.02}, 0.08, 200);
  int covered = 0;
  for (std::size_t i = 0; i < view.rgb().size(); i += 3) covered += view.rgb()[i] < 250 ? 1 : 0;
  EXPECT_NEAR(covered / 40000.0, 0.5 * 0.05 * 0.05 / (0.08 * 0.08), 0.005);
}

TEST(MeshView, LooksAlongThreeRightHandedFrames) {
  for (const ViewDirection& direction : view_directions()) {
    EXPECT_LT((direction.u_W.cross(direction.v_W) - direction.w_W).norm(), 1e-15) << direction.name;
  }
}

TEST(Pictures, AreWrittenAsPngAndSvg) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const std::filesystem::path folder = support::scratch_folder() / "thimble's pictures";
  std::filesystem::remove_all(folder);
  const std::vector<driver::TickRecord> rows = stroke();
  const auto done = draw_pictures(rows, tetrahedron(),
                                  {.title = "it's_a \"test\"", .virtual_time = false}, folder);
  ASSERT_TRUE(done.ok()) << done.error().message;
  for (const std::string name : {"force_and_depth", "path_on_mesh", "period_histogram"}) {
    const auto [width, height] = png_size(folder / (name + ".png"));
    EXPECT_GE(width, 1600) << name;
    EXPECT_GE(height, 600) << name;
    EXPECT_GT(std::filesystem::file_size(folder / (name + ".png")), 15'000U) << name;
    EXPECT_GT(std::filesystem::file_size(folder / (name + ".svg")), 5'000U) << name;
    EXPECT_FALSE(std::filesystem::exists(folder / "data" / (name + ".log"))) << name;
  }
}

TEST(Pictures, HaveNoPeriodHistogramInVirtualTime) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const std::filesystem::path folder = support::scratch_folder() / "virtual_pictures";
  std::filesystem::remove_all(folder);
  ASSERT_TRUE(
      draw_pictures(stroke(), tetrahedron(), {.title = "test", .virtual_time = true}, folder).ok());
  EXPECT_TRUE(std::filesystem::exists(folder / "force_and_depth.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "period_histogram.png"));
}

TEST(Pictures, AreDrawnOfARunWithoutContactToo) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  std::vector<driver::TickRecord> rows(3);
  for (std::size_t i = 0; i < 3; ++i) rows[i].time_ns = static_cast<std::int64_t>(i) * 1'000'000;
  const std::filesystem::path folder = support::scratch_folder() / "thimble_empty";
  EXPECT_TRUE(draw_pictures(rows, tetrahedron(), {}, folder).ok());
  EXPECT_TRUE(draw_pictures({}, tetrahedron(), {}, folder).ok());
}

TEST(Pictures, ShowOnlyTheForceWithoutContact) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const std::filesystem::path folder = support::scratch_folder() / "untouched_pictures";
  std::filesystem::remove_all(folder);
  std::vector<driver::TickRecord> rows = stroke();
  for (const bool touched : {true, false}) {
    for (driver::TickRecord& row : rows) row.in_contact = row.in_contact && touched;
    ASSERT_TRUE(draw_pictures(rows, {}, {.title = "test"}, folder).ok());
    std::stringstream script;
    script << std::ifstream(folder / "data/force_and_depth.gp").rdbuf();
    EXPECT_EQ(script.str().find("depth of the tip") != std::string::npos, touched);
    EXPECT_EQ(script.str().find("tip in contact") != std::string::npos, touched);
  }
}

TEST(Pictures, LabelsNeverOverlapOrLeaveThePicture) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const std::filesystem::path folder = support::scratch_folder() / "labels";
  for (const double size : {1e-4, 70.0}) {
    std::filesystem::remove_all(folder);
    render::TriangleMesh mesh = tetrahedron();
    for (auto& vertex : mesh.vertices)
      vertex = vertex * (size / 0.05) - Eigen::Vector3d(size, 0, 0);
    ASSERT_TRUE(draw_pictures(stroke(), mesh, {.title = std::string(300, 'M')}, folder).ok());
    std::stringstream script;
    script << std::ifstream(folder / "data/path_on_mesh.gp").rdbuf();
    std::istringstream lines(script.str());
    double left = 0;   // position of the panel, as a fraction of the picture's width
    double right = 0;  // of the previous panel
    double name_at = 0;
    for (std::string line; std::getline(lines, line) && line != "unset output";) {  // of the PNG
      if (line.starts_with("set lmargin")) {
        right = left > 0 ? left : 0;
        left = std::stod(line.substr(line.rfind(' ')));
        EXPECT_GT(left, right);
      }
      if (line.starts_with("set label 1 ")) {  // the title ends before the legend
        EXPECT_LT(std::count(line.begin(), line.end(), 'M'), 60);
      }
      if (line.starts_with("set label 50 ")) {
        name_at = std::stod(line.substr(line.find("screen") + 6));
      }
      if (!line.starts_with("set ytics (")) continue;
      std::size_t longest = 0;
      for (std::size_t at = line.find('\''); at != std::string::npos;) {
        const std::size_t end = line.find('\'', at + 1);
        longest = std::max(longest, end - at - 1);
        at = line.find('\'', end + 1);
      }
      // The name of the panel is in the next lines; that of the previous panel is on its left.
      EXPECT_GE(left * 1800, static_cast<double>(longest) * 14 + 30) << line;
      EXPECT_LT(name_at, left);
    }
  }
}

TEST(Pictures, TruncateALongTitleAtACharacter) {
  EXPECT_EQ(fitted("box, vintage_phantom", 1000, 22), "box, vintage_phantom");
  const std::string cut = fitted("Ölöffel und Öl", 150, 17);
  EXPECT_EQ(cut, "Ölöffel u…");
  EXPECT_LE(text_width(cut), 150);
  EXPECT_EQ(text_width("Öl"), text_width("Ol"));
}

TEST(Pictures, WriteNoNegativeZeroOnAnAxis) {
  for (const double sign : {1.0, -1.0}) {
    const NamedTics tics = named_tics(-0.06, 0.06, sign, 6);
    EXPECT_EQ(tics.list.find("'-0'"), std::string::npos) << tics.list;
    EXPECT_NE(tics.list.find("'0' 0"), std::string::npos) << tics.list;
    EXPECT_NEAR(tics.width, text_width("-0.04"), 1e-9);
  }
}

TEST(Pictures, ReportTheErrorOfGnuplot) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const std::filesystem::path folder = support::scratch_folder() / "thimble_wrong";
  std::filesystem::create_directories(folder / "data");
  const auto done = draw_plot({"wrong", 400, 300, "plot nonsense(x)\n"}, folder);
  ASSERT_FALSE(done.ok());
  EXPECT_NE(done.error().message.find("undefined function"), std::string::npos)
      << done.error().message;
}

TEST(MeshPicture, IsWrittenToTheRequestedFile) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const std::filesystem::path folder = support::scratch_folder();
  ASSERT_TRUE(draw_mesh(tetrahedron(), folder / "tetrahedron.png", "tetrahedron", "m").ok());
  EXPECT_GT(png_size(folder / "tetrahedron.png").first, 1000);
  EXPECT_FALSE(draw_mesh(tetrahedron(), folder / "tetrahedron.jpg").ok());
  EXPECT_FALSE(draw_mesh({}, folder / "nothing.png").ok());
}

}  // namespace
}  // namespace thimble::report
