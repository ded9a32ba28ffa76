#pragma once

#include <gtest/gtest.h>
#include <imgui.h>

#include <functional>

namespace thimble::view {

/// ImGui without a screen. Tests write mouse input into its state.
class Screenless : public ::testing::Test {
 protected:
  Screenless(float width, float height) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {width, height};
    io.IniFilename = nullptr;
    unsigned char* pixels = nullptr;
    int pixels_x = 0;
    int pixels_y = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &pixels_x, &pixels_y);
  }
  ~Screenless() override { ImGui::DestroyContext(); }

  /// Draws one frame with the mouse at this position.
  static void frame(const ImVec2& mouse, bool left, float wheel,
                    const std::function<void()>& draw) {
    ImGuiIO& io = ImGui::GetIO();
    io.DeltaTime = 0.02F;
    io.MousePos = mouse;
    io.MouseDown[0] = left;
    io.MouseWheel = wheel;
    ImGui::NewFrame();
    draw();
    ImGui::EndFrame();
  }
};

}  // namespace thimble::view
