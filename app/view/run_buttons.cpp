#include "view/run_buttons.h"

#include <epoxy/gl.h>
// After the header above, which includes OpenGL.
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "share/steer/save_knobs.h"
#include "text/counted.h"
#include "view/panel_flow.h"

namespace thimble::view {
namespace {

constexpr double kFaster = 1.25;  // factor of one key press

/// Draws a button, which is grey if `why` says why it is disabled; returns whether it was pressed.
bool button(Flow& flow, const char* label, const char* what, const std::string& why) {
  flow.next(ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x);
  ImGui::BeginDisabled(!why.empty());
  const bool pressed = ImGui::Button(label);
  ImGui::EndDisabled();
  explain(what, why);
  return pressed;
}

std::string why_no_step_now(const session::SharedReader& reader) {
  std::string why = reader.why_no_step();
  if (why.empty() && reader.state() != session::RunState::kPaused) why = "Pause the run first.";
  return why;
}

}  // namespace

std::string why_no_restart_now(const session::SharedReader& reader) {
  std::string why = reader.why_no_restart();
  if (why.empty() || reader.state() != session::RunState::kEnded) return why;
  const auto& arms = reader.scene().arms;
  const bool real = std::any_of(arms.begin(), arms.end(), [](const session::SharedScene::Arm& arm) {
    return arm.device != "sim";
  });
  if (!real) return why;
  return "A real arm is started in a terminal, where its questions are answered: thimble run SCENE "
         "--device auto";
}

bool RunButtons::offers_run_again(const session::SharedReader& reader) const {
  return can_run_again_ && reader.state() == session::RunState::kEnded &&
         reader.why_no_restart().empty();
}

std::string counted(const session::SharedReader::Counters& counters) {
  std::string line = scene::counted(counters.ticks, "tick") + ", " +
                     scene::counted(counters.missed, "period") + " missed";
  if (counters.paused > 0) line += ", " + std::to_string(counters.paused) + " paused";
  return line;
}

void explain(const char* what, const std::string& why) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(22 * ImGui::GetFontSize());
  ImGui::TextUnformatted(what);
  if (!why.empty()) ImGui::TextDisabled("%s", why.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void RunButtons::keep_error(const driver::Result<void>& asked) {
  if (!asked) message_ = asked.error().message;
}

std::string RunButtons::take_message() {
  return std::exchange(message_, {});
}

bool RunButtons::take_run_again() {
  return std::exchange(run_again_, false);
}

void RunButtons::restart(session::SharedReader& reader) {
  if (offers_run_again(reader)) {
    run_again_ = true;
  } else if (std::string why = why_no_restart_now(reader); !why.empty()) {
    message_ = std::move(why);
  } else {
    keep_error(reader.ask_restart());
  }
}

void RunButtons::step(session::SharedReader& reader, bool shift, bool ctrl) {
  keep_error(reader.ask_steps(ctrl ? 100 : shift ? 10 : 1));
}

void RunButtons::save(const session::SharedReader& reader) {
  const auto saved = session::save_knobs(reader);
  message_ = saved ? "Saved: " + saved->text() : saved.error().message;
}

void RunButtons::draw(session::SharedReader& reader) {
  const std::string no_restart = reader.why_no_restart();
  const ImGuiIO& io = ImGui::GetIO();
  Flow flow;
  if (button(flow, "Restart", "Restarts the run from its first tick (B)",
             why_no_restart_now(reader))) {
    restart(reader);
  }
  if (button(flow, "Step",
             "Advances a paused run by one tick; with shift by 10, with ctrl by 100 (N)",
             why_no_step_now(reader))) {
    step(reader, io.KeyShift, io.KeyCtrl);
  }
  bool loop = reader.loop_asked();
  flow.next(ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x +
            ImGui::CalcTextSize("loop").x);
  ImGui::BeginDisabled(!no_restart.empty());
  if (ImGui::Checkbox("loop", &loop)) keep_error(reader.ask_loop(loop));
  ImGui::EndDisabled();
  explain("Restarts the run when it ends (L)", no_restart);
  if (button(flow, "Scene...", "Runs another scene instead of this one (O)", no_restart)) {
    scenes_.toggle();
  }
  if (button(flow, "Save knobs",
             "Writes the scene with its current knobs to a new file in the same folder (K)",
             reader.scene().knobs.empty() ? "This run has no knobs." : "")) {
    save(reader);
  }
  if (std::string message = scenes_.draw(reader); !message.empty()) message_ = std::move(message);
}

void RunButtons::take_key(int key, bool shift, bool ctrl, session::SharedReader& reader) {
  switch (key) {
    case GLFW_KEY_B:
      restart(reader);
      break;
    case GLFW_KEY_N:
      step(reader, shift, ctrl);
      break;
    case GLFW_KEY_L:
      keep_error(reader.ask_loop(!reader.loop_asked()));
      break;
    case GLFW_KEY_PERIOD:
      keep_error(reader.ask_speed(reader.speed_asked() * kFaster));
      break;
    case GLFW_KEY_COMMA:
      keep_error(reader.ask_speed(reader.speed_asked() / kFaster));
      break;
    case GLFW_KEY_O:
      if (std::string why = reader.why_no_restart(); why.empty()) {
        scenes_.toggle();
      } else {
        message_ = std::move(why);
      }
      break;
    case GLFW_KEY_K:
      save(reader);
      break;
    default:
      break;
  }
}

}  // namespace thimble::view
