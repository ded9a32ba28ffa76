#include "view/scene_mouse.h"

#include <imgui.h>

#include <cmath>

namespace thimble::view {
namespace {

constexpr double kTurn = 4.0;        // rad for a drag over the scene's height
constexpr double kZoom = 1.12;       // factor of one step of the wheel
constexpr double kWheelPush = 1e-3;  // m along the line of sight, per step of the wheel

}  // namespace

void SceneMouse::begin(const Eigen::Vector3d& p_WT, bool hand_first) {
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
    if (io.KeyShift) {
      drag_ = Drag::kPan;
    } else if (io.KeyCtrl != hand_first && p_WT.allFinite()) {
      drag_ = Drag::kHand;
      p_WGrip_ = p_WT;
      grip_ = {io.MousePos.x, io.MousePos.y};
    } else {
      drag_ = Drag::kOrbit;
    }
  } else if (ImGui::IsMouseClicked(ImGuiMouseButton_Right) ||
             ImGui::IsMouseClicked(ImGuiMouseButton_Middle)) {
    drag_ = Drag::kPan;
  }
}

// Moves the hand in the plane through the grip across the line of sight: by the distance of the
// rays through the mouse and through the click.
void SceneMouse::lead(const Camera& camera, const ScreenPart& part) {
  const ImGuiIO& io = ImGui::GetIO();
  p_WGrip_ -= kWheelPush * static_cast<double>(io.MouseWheel) * camera.towards_eye();
  const double away = (camera.p_WEye() - p_WGrip_).dot(camera.towards_eye());
  const double pixel = 2 * away * std::tan(camera.opening / 2) / static_cast<double>(part.height);
  hand_.p_WH = p_WGrip_ +
               pixel * (static_cast<double>(io.MousePos.x) - grip_.x()) * camera.right() -
               pixel * (static_cast<double>(io.MousePos.y) - grip_.y()) * camera.up();
  hand_.holds = true;
}

void SceneMouse::step(Camera& camera, const Eigen::Vector3d& p_WT, const ScreenPart& part,
                      bool hand_first) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool over = !io.WantCaptureMouse && io.MousePos.x >= part.x &&
                    io.MousePos.x < part.x + part.width && io.MousePos.y >= part.y &&
                    io.MousePos.y < part.y + part.height;
  if (over && drag_ == Drag::kNone) begin(p_WT, hand_first);
  if (!io.MouseDown[0] && !io.MouseDown[1] && !io.MouseDown[2]) drag_ = Drag::kNone;
  hand_.holds = false;
  const auto right = static_cast<double>(io.MouseDelta.x / part.height);
  const auto down = static_cast<double>(io.MouseDelta.y / part.height);
  switch (drag_) {
    case Drag::kOrbit:
      camera.orbit(-kTurn * right, kTurn * down);
      break;
    case Drag::kPan:
      camera.pan(right, -down);
      break;
    case Drag::kHand:
      lead(camera, part);
      return;
    case Drag::kNone:
      break;
  }
  if (over && io.MouseWheel != 0) {
    camera.zoom(std::pow(kZoom, static_cast<double>(io.MouseWheel)));
  }
}

}  // namespace thimble::view
