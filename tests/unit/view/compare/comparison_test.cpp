#include "view/compare/comparison.h"

#include <gtest/gtest.h>

#include "view/compare/run_colours.h"
#include "view/compare/same_objects.h"

namespace thimble::view {
namespace {

OwnSignals signals(const std::vector<std::string>& names, float value) {
  OwnSignals made;
  made.time = std::make_shared<std::vector<double>>(std::vector{0.0, 1.0});
  for (const std::string& name : names) made.signals.push_back({name, "mV", {value, value}});
  return made;
}

std::vector<OwnSignals> two_files() {
  std::vector<OwnSignals> files;
  files.push_back(signals({"a", "b"}, 1));
  files.push_back(signals({"b", "c"}, 2));
  return files;
}

TEST(ComparedSignals, OneNameIsOnePlot) {
  const auto plots = signals_of(two_files(), 1);
  ASSERT_EQ(plots.size(), 3U);
  EXPECT_EQ(plots[0].look.name, "a");
  EXPECT_EQ(plots[1].look.name, "b");
  EXPECT_EQ(plots[1].look.unit, "mV");
  EXPECT_EQ(plots[2].look.name, "c");
  ASSERT_EQ(plots[1].curves.size(), 2U);
  EXPECT_EQ(plots[1].curves[0]->value(0), 1);
  EXPECT_EQ(plots[1].curves[1]->value(0), 2);
  EXPECT_NE(plots[1].colours[0], plots[1].colours[1]);
}

TEST(ComparedSignals, OtherUnitIsAnotherPlot) {
  std::vector<OwnSignals> files = two_files();
  files[1].signals[0].unit = "V";
  EXPECT_EQ(signals_of(std::move(files), 1).size(), 4U);
}

TEST(ComparedSignals, HaveTheColoursOfAsManyRecordings) {
  const auto plots = signals_of(two_files(), 2);
  EXPECT_EQ(plots[1].colours, (std::vector<Colour>{kRunColours[0], kRunColours[1]}));
  // Otherwise they do not look as if they belonged to a recording.
  for (const std::size_t runs : {1U, 3U}) {
    for (const auto& plot : signals_of(two_files(), runs)) {
      for (const Colour& colour : plot.colours) {
        EXPECT_EQ(std::count(kRunColours.begin(), kRunColours.end(), colour), 0);
      }
    }
  }
}

TEST(SameObjects, DependOnNamesAndMeshesOnly) {
  DrawnScene a;
  a.objects.resize(1);
  a.objects[0].name = "ball";
  a.objects[0].mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  a.objects[0].mesh.triangles = {{0, 1, 2}};
  DrawnScene b = a;
  b.name = "softer";
  b.objects[0].friction = "bristle";
  EXPECT_TRUE(have_same_objects(a, b));
  b.objects[0].mesh.vertices[1].x() = 1.5;
  EXPECT_FALSE(have_same_objects(a, b));
  b = a;
  b.objects[0].name = "cube";
  EXPECT_FALSE(have_same_objects(a, b));
  b = a;
  b.objects.emplace_back();
  EXPECT_FALSE(have_same_objects(a, b));
  EXPECT_FALSE(have_same_objects(b, a));
}

}  // namespace
}  // namespace thimble::view
