#include "view/playback/plot_panel.h"

#include <cmath>
#include <optional>

#include "screenless.h"

namespace thimble::view {
namespace {

/// A recording of 10 s in plots, and a mouse over them.
class PlotPanelUsed : public Screenless {
 protected:
  PlotPanelUsed() : Screenless(500, 700) {
    for (int i = 0; i <= 10'000; ++i) {
      driver::TickRecord tick;
      tick.time_ns = i * std::int64_t{1'000'000};
      tick.f_sent_W = {0, 0, 1e-4 * i};
      plots.add(tick);
    }
  }

  void look(const ImVec2& mouse, bool left = false, float wheel = 0) {
    frame(mouse, left, wheel, [this] {
      ImGui::SetNextWindowPos({0, 0});
      ImGui::SetNextWindowSize({500, 700});
      ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
      const float x = ImGui::GetCursorScreenPos().x;
      inner = Plots::lines_of({x, 0, ImGui::GetContentRegionAvail().x, 100}, false);
      if (const auto clicked = panel.draw(plots, time, 600)) asked = clicked;
      ImGui::End();
    });
  }
  // Over the first plot, at that time if everything is shown.
  ImVec2 at(double seconds) const {
    return {inner.x + inner.width * static_cast<float>(seconds / 10), 90};
  }
  void rest(const ImVec2& mouse) {
    for (int i = 0; i < 3; ++i) look(mouse);
  }
  TimeRange range() const { return panel.range(plots, time); }

  Plots plots = Plots::of_recording();
  PlotTime time{.looked = 1.0, .recorded = true};
  PlotPanel panel;
  ScreenPart inner;
  std::optional<double> asked;
};

TEST_F(PlotPanelUsed, WheelZoomsAndDoubleClickResets) {
  rest(at(4));
  look(at(4), false, 1);
  EXPECT_NEAR(range().begin, 4 - 0.8 * 4, 0.1);
  EXPECT_NEAR(range().end, 4 + 0.8 * 6, 0.1);
  look(at(4), false, -5);
  EXPECT_NEAR(range().width(), 10, 1e-9);
  look(at(4), false, 3);
  EXPECT_LT(range().width(), 6);
  rest(at(4));
  for (const bool down : {true, false, true, false}) look(at(4), down);
  EXPECT_FALSE(panel.is_zoomed());
  EXPECT_NEAR(range().width(), 10, 1e-9);
}

TEST_F(PlotPanelUsed, ShowsThePartThatADragChooses) {
  rest(at(2));
  look(at(2), true);
  look(at(3), true);
  look(at(5), true);
  look(at(5), false);
  EXPECT_NEAR(range().begin, 2, 0.1);
  EXPECT_NEAR(range().end, 5, 0.1);
  EXPECT_EQ(asked, std::nullopt);
}

TEST_F(PlotPanelUsed, AsksForTheMomentOfAClick) {
  rest(at(7));
  look(at(7), true);
  look(at(7), false);
  ASSERT_TRUE(asked);
  EXPECT_NEAR(*asked, 7, 0.1);
  EXPECT_FALSE(panel.is_zoomed());
}

TEST_F(PlotPanelUsed, EndsZoomOfForgottenTime) {
  rest(at(2));
  look(at(2), false, 5);
  EXPECT_TRUE(panel.is_zoomed());
  plots.clear();
  driver::TickRecord tick;
  tick.time_ns = 90'000'000'000;
  plots.add(tick);
  rest(at(2));
  EXPECT_FALSE(panel.is_zoomed());
}

TEST_F(PlotPanelUsed, ShowsTheWholeDurationOfARun) {
  time = {.looked = std::nullopt, .recorded = false, .duration = 25};
  EXPECT_EQ(range().begin, 0);
  EXPECT_EQ(range().end, 25);
  time.looked = 1.5;  // and the same while looking back
  EXPECT_EQ(range().end, 25);
}

TEST_F(PlotPanelUsed, FollowsRunThatIsLongerThanKept) {
  time = {.looked = std::nullopt, .recorded = false, .duration = 3600};
  EXPECT_NEAR(range().begin, 10 - Plots::kShownSeconds, 1e-9);
  time.duration = 9;  // it was longer than planned
  EXPECT_NEAR(range().begin, 10 - Plots::kShownSeconds, 1e-9);
}

TEST_F(PlotPanelUsed, FollowsRunUnlessLookingBack) {
  time = {.looked = std::nullopt, .recorded = false};
  EXPECT_NEAR(range().begin, 10 - Plots::kShownSeconds, 1e-9);
  time.looked = 1.5;
  EXPECT_NEAR(range().begin, 0, 1e-9);
  EXPECT_NEAR(range().end, 10, 1e-9);
}

TEST_F(PlotPanelUsed, ShowsTheWholeTimeLineOfSeveralRecordings) {
  Comparison comparison;
  comparison.runs.resize(2);
  for (ComparedRun& run : comparison.runs) run.plots = &plots;
  comparison.span = {0, 20};
  time.compared = &comparison;
  EXPECT_EQ(range().end, 20);
  rest(at(4));
  look(at(4), true);  // at 8 s of 20 s
  look(at(4), false);
  ASSERT_TRUE(asked);
  EXPECT_NEAR(*asked, 8, 0.1);
  look(at(4), false, 1);
  EXPECT_NEAR(range().begin, 8 - 0.8 * 8, 0.1);
  EXPECT_NEAR(range().end, 8 + 0.8 * 12, 0.1);
}

}  // namespace
}  // namespace thimble::view
