#include "view/side_panel.h"

#include <cmath>

#include "screenless.h"

namespace thimble::app::view {
namespace {

class SidePanel : public Screenless {
 protected:
  SidePanel() : Screenless(600, 100) {}

  /// Presses the mouse on the slider, a share of its length from the left, and returns the value.
  static double pressed(const session::SharedScene::Knob& knob, float share) {
    double value = knob.initial;
    for (int i = 0; i < 4; ++i) {
      // The grab is a few points wide, and its middle follows the mouse.
      frame({16 + share * 500, 50}, i > 1, 0, [&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({600, 100});
        ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
        ImGui::SetCursorPos({16, 42});
        ImGui::SetNextItemWidth(500);
        knob_slider(knob, value);
        ImGui::End();
      });
    }
    return value;
  }
};

session::SharedScene::Knob knob(double least, double most) {
  session::SharedScene::Knob made;
  made.name = "one";
  made.unit = "m";
  made.least = least;
  made.most = most;
  made.initial = least;
  return made;
}

TEST_F(SidePanel, TurnsAKnobOfAnySizeByItsLogarithm) {
  for (const double least : {1e-2, 1e-5, 2e-7, 1e-9}) {
    const auto wide = knob(least, 1000 * least);
    for (const float share : {0.25F, 0.5F, 0.75F}) {
      EXPECT_NEAR(std::log10(pressed(wide, share) / least), 3 * share, 0.1) << least;
    }
  }
}

TEST_F(SidePanel, TurnsANarrowKnobInProportion) {
  EXPECT_NEAR(pressed(knob(0, 2000), 0.25F), 500, 20);
  EXPECT_NEAR(pressed(knob(100, 300), 0.5F), 200, 4);
  EXPECT_EQ(pressed(knob(100, 300), 0.999F), 300);
}

}  // namespace
}  // namespace thimble::app::view
