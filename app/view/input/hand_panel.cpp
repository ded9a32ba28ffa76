#include "view/input/hand_panel.h"

#include <epoxy/gl.h>
// After the header above, which includes OpenGL.
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "view/panel_flow.h"

namespace thimble::view {
namespace {

constexpr float kGhost = 0.45F;  // radius of the target's ring, in heights of a letter

constexpr std::array kNames = {"mouse", "keyboard", "gamepad", "SpaceMouse"};
constexpr std::array kHelp = {
    "drag: move, wheel: push (H swaps the drags)",
    "arrows, page up / down: away, near\n+ / -: speed, shift: slow, backspace: "
    "release",
    "left stick; triggers: right away, left near\nshoulders: slow; B: release; up "
    "/ down: speed",
    "push the cap; left button: slow\nright button: release; + / -: speed"};

ImU32 packed(const Colour& colour, float alpha) {
  return ImGui::ColorConvertFloat4ToU32({colour[0], colour[1], colour[2], alpha});
}

/// Returns whether a key is held, or was pressed and released since the last picture.
bool held(const std::vector<int>& pressed, int key) {
  return ImGui::IsKeyDown(key) || std::find(pressed.begin(), pressed.end(), key) != pressed.end();
}

bool pressed_one(const std::vector<int>& pressed, int key, int other) {
  return std::find(pressed.begin(), pressed.end(), key) != pressed.end() ||
         std::find(pressed.begin(), pressed.end(), other) != pressed.end();
}

HandKeys hand_keys(const std::vector<int>& pressed) {
  if (ImGui::GetIO().WantTextInput) return {};
  return {.left = held(pressed, GLFW_KEY_LEFT),
          .right = held(pressed, GLFW_KEY_RIGHT),
          .up = held(pressed, GLFW_KEY_UP),
          .down = held(pressed, GLFW_KEY_DOWN),
          .nearer = held(pressed, GLFW_KEY_PAGE_DOWN),
          .farther = held(pressed, GLFW_KEY_PAGE_UP),
          .slow = ImGui::GetIO().KeyShift,
          .let_go = held(pressed, GLFW_KEY_BACKSPACE)};
}

}  // namespace

HandPush HandPanel::read_gamepad() {
  for (int id = GLFW_JOYSTICK_1; id <= GLFW_JOYSTICK_LAST; ++id) {
    GLFWgamepadstate pad;
    if (glfwGetGamepadState(id, &pad) == GLFW_FALSE) continue;
    const auto button = [&pad](int which) { return pad.buttons[which] == GLFW_PRESS; };
    const bool up = button(GLFW_GAMEPAD_BUTTON_DPAD_UP);
    const bool down = button(GLFW_GAMEPAD_BUTTON_DPAD_DOWN);
    if (up != down && !speed_held_) input_.change_speed(up);
    speed_held_ = up || down;
    return push_of({.left = {static_cast<double>(pad.axes[GLFW_GAMEPAD_AXIS_LEFT_X]),
                             static_cast<double>(pad.axes[GLFW_GAMEPAD_AXIS_LEFT_Y])},
                    .left_trigger = static_cast<double>(pad.axes[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER]),
                    .right_trigger = static_cast<double>(pad.axes[GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER]),
                    .slow = button(GLFW_GAMEPAD_BUTTON_LEFT_BUMPER) ||
                            button(GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER),
                    .let_go = button(GLFW_GAMEPAD_BUTTON_B)});
  }
  trouble_ = "No gamepad. Plug one in; it is detected automatically.";
  for (int id = GLFW_JOYSTICK_1; id <= GLFW_JOYSTICK_LAST; ++id) {
    if (glfwJoystickPresent(id) == GLFW_FALSE) continue;
    trouble_ = std::string(glfwGetJoystickName(id)) +
               " is unknown to GLFW. Set its axes in SDL_GAMECONTROLLERCONFIG.";
  }
  return {};
}

HandPush HandPanel::read(const std::vector<int>& keys) {
  trouble_.clear();
  switch (input_.source()) {
    case HandSource::kMouse:
      break;
    case HandSource::kKeyboard:
      return push_of(hand_keys(keys));
    case HandSource::kGamepad:
      return read_gamepad();
    case HandSource::kSpaceMouse: {
      const auto state = space_mouse_.read();
      trouble_ = space_mouse_.trouble();
      if (state) return push_of(*state);
      break;
    }
  }
  return {};
}

void HandPanel::step(const std::vector<int>& keys, const Camera& camera,
                     const Eigen::Vector3d& p_WT, const Eigen::AlignedBox3d& reach, double dt,
                     bool moves) {
  if (input_.source() != HandSource::kMouse) {
    if (pressed_one(keys, GLFW_KEY_EQUAL, GLFW_KEY_KP_ADD)) input_.change_speed(true);
    if (pressed_one(keys, GLFW_KEY_MINUS, GLFW_KEY_KP_SUBTRACT)) input_.change_speed(false);
  }
  const HandPush push = read(keys);
  if (!trouble_.empty()) input_.let_go();  // its device was unplugged
  if (moves || push.let_go) input_.step(push, camera, p_WT, reach, dt);
}

void HandPanel::draw_target(const MouseHandTarget& hand, const Eigen::Vector3d& p_WT,
                            const Camera& camera, const ScreenPart& part) const {
  const auto behind = [&camera](const Eigen::Vector3d& p_W) {
    return !((p_W - camera.p_WEye()).dot(camera.towards_eye()) < 0);
  };
  if (!hand.holds || behind(hand.p_WH) || behind(p_WT)) return;
  const auto on_screen = [&](const Eigen::Vector3d& p_W) {
    const Eigen::Vector2f at = camera.pixel(p_W, part.width, part.height).cast<float>();
    return ImVec2(part.x + at.x(), part.y + at.y());
  };
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float letter = ImGui::GetFontSize();
  const ImVec2 target = on_screen(hand.p_WH);
  const ImVec2 tip = on_screen(p_WT);
  list.PushClipRect({part.x, part.y}, {part.x + part.width, part.y + part.height}, true);
  // A pale outline below, for any background.
  list.AddLine(tip, target, packed(kGroundColour, 0.8F), 0.25F * letter);
  list.AddCircle(target, kGhost * letter, packed(kGroundColour, 0.8F), 0, 0.3F * letter);
  list.AddLine(tip, target, packed(kDepthColour, 0.9F), 0.1F * letter);
  list.AddCircleFilled(target, kGhost * letter, packed(kDepthColour, 0.25F));
  list.AddCircle(target, kGhost * letter, packed(kDepthColour, 0.9F), 0, 0.12F * letter);
  list.PopClipRect();
}

bool HandPanel::draw_box(bool held, const ScreenPart& part) {
  const float letter = ImGui::GetFontSize();
  // Above the caption.
  ImGui::SetNextWindowPos({part.x + 0.7F * letter, part.y + part.height - 2.4F * letter},
                          ImGuiCond_Always, {0, 1});
  ImGui::Begin("hand", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav);
  int chosen = static_cast<int>(input_.source());
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("hand");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(8 * letter);
  const bool another = ImGui::Combo("##source", &chosen, kNames.data(), kNames.size());
  if (another) input_.choose(static_cast<HandSource>(chosen));
  ImGui::SameLine();
  if (held) {
    ImGui::TextColored(shown_colour(kDepthColour), "held");
  } else {
    ImGui::TextDisabled("free");
  }
  if (input_.source() != HandSource::kMouse) {
    ImGui::SameLine();
    ImGui::TextDisabled("%.0f mm/s", 1e3 * input_.speed());
  }
  if (trouble_.empty()) {
    ImGui::TextDisabled("%s", kHelp[static_cast<std::size_t>(input_.source())]);
  } else {
    ImGui::PushTextWrapPos(24 * letter);
    ImGui::TextColored({kForceColour[0], kForceColour[1], kForceColour[2], 1}, "%s",
                       trouble_.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
  return another;
}

}  // namespace thimble::view
