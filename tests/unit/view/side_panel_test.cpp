#include "view/side_panel.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <cmath>

namespace thimble::app::view {
namespace {

/// ImGui without a screen: what a person would do with the mouse is written into its state.
class SidePanel : public ::testing::Test {
 protected:
  SidePanel() {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {600, 100};
    io.IniFilename = nullptr;
    unsigned char* pixels = nullptr;
    int width = 0;
    int height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  }
  ~SidePanel() override { ImGui::DestroyContext(); }

  /// Presses the mouse on the slider, a share of its length from the left, and returns the value.
  static double pressed(const session::SharedScene::Knob& knob, float share) {
    double value = knob.initial;
    for (int frame = 0; frame < 4; ++frame) {
      ImGuiIO& io = ImGui::GetIO();
      io.DeltaTime = 0.02F;
      // The grab is a few points wide, and its middle follows the mouse.
      io.MousePos = {16 + share * 500, 50};
      io.MouseDown[0] = frame > 1;
      ImGui::NewFrame();
      ImGui::SetNextWindowPos({0, 0});
      ImGui::SetNextWindowSize({600, 100});
      ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration);
      ImGui::SetCursorPos({16, 42});
      ImGui::SetNextItemWidth(500);
      knob_slider(knob, value);
      ImGui::End();
      ImGui::EndFrame();
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
