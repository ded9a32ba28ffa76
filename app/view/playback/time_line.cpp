#include "view/playback/time_line.h"

#include <epoxy/gl.h>
// After the header above, which includes OpenGL.
#include <GLFW/glfw3.h>
#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "view/compare/comparison.h"
#include "view/playback/channel_curve.h"
#include "view/run_buttons.h"

namespace thimble::view {
namespace {

constexpr float kOneRow = 34;     // minimum width for one row, in heights of the font
constexpr double kBigStep = 1.0;  // s, with shift; chosen

ImU32 packed(const Colour& colour, float cover = 1) {
  return ImGui::ColorConvertFloat4ToU32({colour[0], colour[1], colour[2], cover});
}

// Symbol of a button. It is drawn, because the font lacks these characters.
enum class Sign { kStart, kBack, kPlay, kStop, kForward, kEnd };

void draw_sign(ImDrawList& list, Sign sign, const ImVec2& middle, float r) {
  const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
  const auto arrow = [&](float at, float way) {
    list.AddTriangleFilled({middle.x + at - 0.5F * way * r, middle.y - r},
                           {middle.x + at - 0.5F * way * r, middle.y + r},
                           {middle.x + at + way * r, middle.y}, ink);
  };
  const auto bar = [&](float at, float half) {
    list.AddRectFilled({middle.x + at - half, middle.y - r}, {middle.x + at + half, middle.y + r},
                       ink);
  };
  switch (sign) {
    case Sign::kStart:
      bar(-0.8F * r, 0.16F * r);
      arrow(0.35F * r, -1);
      break;
    case Sign::kBack:
      arrow(-0.1F * r, -0.75F);
      bar(0.7F * r, 0.16F * r);
      break;
    case Sign::kPlay:
      arrow(-0.1F * r, 1);
      break;
    case Sign::kStop:
      bar(-0.45F * r, 0.26F * r);
      bar(0.45F * r, 0.26F * r);
      break;
    case Sign::kForward:
      bar(-0.7F * r, 0.16F * r);
      arrow(0.1F * r, 0.75F);
      break;
    case Sign::kEnd:
      arrow(-0.35F * r, 1);
      bar(0.8F * r, 0.16F * r);
      break;
  }
}

/// Plays or stops. A run that has ended is played from its oldest moment on.
void play_or_stop(PlayHead& head) {
  if (head.live()) head.to_start();
  head.toggle();
}

bool sign_button(const char* id, Sign sign, const char* about) {
  const float side = ImGui::GetFrameHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool pressed = ImGui::Button(id, {1.15F * side, side});
  draw_sign(*ImGui::GetWindowDrawList(), sign, {at.x + 0.575F * side, at.y + 0.5F * side},
            0.26F * side);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", about);
  ImGui::SameLine(0, 0.25F * ImGui::GetFontSize());
  return pressed;
}

/// Returns the run whose pause and speed the time line sets: the one at its newest moment.
session::SharedReader* live_run(TouchSource& source) {
  session::SharedReader* const reader = source.reader();
  const bool live =
      reader != nullptr && source.head().live() && reader->state() != session::RunState::kEnded;
  return live ? reader : nullptr;
}

void draw_pause(TouchSource& source) {
  PlayHead& head = source.head();
  if (session::SharedReader* const run = live_run(source)) {
    const bool paused = run->pause_asked();
    const char* about = paused ? "continue the run (space)"
                        : run->scene().wall_clock
                            ? "pause the run (space): fades the force out; the arm's time "
                              "continues, and its ticks count as paused"
                            : "pause the run (space)";
    if (sign_button("##play", paused ? Sign::kPlay : Sign::kStop, about)) run->ask_pause(!paused);
    return;
  }
  const Sign sign = head.plays() ? Sign::kStop : Sign::kPlay;
  if (sign_button("##play", sign, head.plays() ? "stop (space)" : "play (space)")) {
    play_or_stop(head);
  }
}

void draw_buttons(TouchSource& source) {
  PlayHead& head = source.head();
  const bool run = head.of_a_run();
  if (sign_button("##start", Sign::kStart, run ? "oldest stored moment (Home)" : "start (Home)")) {
    head.to_start();
  }
  if (sign_button("##back", Sign::kBack, run ? "one frame back (left)" : "one tick back (left)")) {
    head.stop_at(source.time_of_step(-1));
  }
  draw_pause(source);
  if (sign_button("##on", Sign::kForward,
                  run ? "one frame forward (right)" : "one tick forward (right)")) {
    head.stop_at(source.time_of_step(1));
  }
  if (sign_button("##end", Sign::kEnd, run ? "now (End)" : "end (End)")) head.to_end();
}

std::string draw_speed(TouchSource& source) {
  static constexpr std::array kSpeeds = {0.1, 0.25, 0.5, 1.0, 2.0, 4.0};
  PlayHead& head = source.head();
  session::SharedReader* const run = live_run(source);
  const std::string refused = run == nullptr ? "" : run->why_no_speed();
  const double now = run == nullptr ? head.speed() : run->speed_asked();
  std::string message;
  ImGui::BeginDisabled(!refused.empty());
  ImGui::SetNextItemWidth(5.2F * ImGui::GetFontSize());
  if (ImGui::BeginCombo("##speed", fmt::format("{:.3g} x", now).c_str())) {
    for (const double speed : kSpeeds) {
      if (!ImGui::Selectable(fmt::format("{:g} x", speed).c_str(), speed == now)) continue;
      if (run == nullptr) {
        head.set_speed(speed);
      } else if (const auto asked = run->ask_speed(speed); !asked) {
        message = asked.error().message;
      }
    }
    ImGui::EndCombo();
  }
  ImGui::EndDisabled();
  explain(run == nullptr ? "Speed of the playback (, and .)"
                         : "Speed of the run; the ticks stay bit-identical (, and .)",
          refused);
  return message;
}

bool one_row(float width) {
  return width >= kOneRow * ImGui::GetFontSize();
}

/// Marks the times with contact.
void draw_contacts(const ScreenPart& part, const Curve& depth, const PlayHead& head,
                   const Colour& colour) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto columns = static_cast<int>(part.width);
  for (int i = 0; i < columns; ++i) {
    const double width = (head.end() - head.begin()) / columns;
    const double begin = head.begin() + width * i;
    const Extent extent = depth.extent(TimeRange{begin, begin + width});
    if (extent.empty() || !(extent.max > 0)) continue;
    const float x = part.x + static_cast<float>(i);
    list.AddRectFilled({x, part.y}, {x + 1, part.y + part.height}, packed(colour, 0.45F));
  }
}

/// Draws each recording in a lane: as long as it lasts, with its times of contact.
void draw_runs(const ScreenPart& part, const Comparison& runs, const PlayHead& head) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float lane = part.height / static_cast<float>(runs.runs.size());
  const double span = head.end() - head.begin();
  for (std::size_t i = 0; i < runs.runs.size(); ++i) {
    const ComparedRun& run = runs.runs[i];
    const Colour colour = runs.several() ? run.colour : kDepthColour;
    const ScreenPart own{part.x, part.y + lane * static_cast<float>(i), part.width, lane};
    const auto share = static_cast<float>((run.end - head.begin()) / span);
    list.AddRectFilled({own.x, own.y}, {own.x + share * own.width, own.y + lane},
                       packed(colour, 0.2F));
    draw_contacts(own, ChannelCurve(*run.plots, Channel::kDepth, run.offset), head, colour);
  }
}

void draw_bar(const ScreenPart& bar, TouchSource& source) {
  PlayHead& head = source.head();
  const std::string kept = source.kept();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImGui::SetCursorScreenPos({bar.x, bar.y});
  ImGui::InvisibleButton("bar", {bar.width, bar.height});
  const double span = head.end() - head.begin();
  if (ImGui::IsItemActive() && span > 0) {
    const double share = static_cast<double>((ImGui::GetIO().MousePos.x - bar.x) / bar.width);
    head.go(head.begin() + span * std::clamp(share, 0.0, 1.0));
  }
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive() && !kept.empty()) {
    ImGui::SetTooltip("%s", kept.c_str());
  }
  const float middle = bar.y + 0.5F * bar.height;
  const float half = 0.2F * bar.height;
  const float round = half;
  list.AddRectFilled({bar.x, middle - half}, {bar.x + bar.width, middle + half},
                     packed(kGridColour, 0.35F), round);
  if (!(span > 0)) return;
  if (const Comparison* const runs = source.comparison()) {
    draw_runs({bar.x, middle - half, bar.width, 2 * half}, *runs, head);
  } else {
    draw_contacts({bar.x, middle - half, bar.width, 2 * half},
                  ChannelCurve(source.plots(), Channel::kDepth), head, kDepthColour);
  }
  const auto share = static_cast<float>((head.time() - head.begin()) / span);
  const float x = bar.x + share * bar.width;
  list.AddLine({x, bar.y + 0.12F * bar.height}, {x, bar.y + 0.88F * bar.height},
               ImGui::GetColorU32(ImGuiCol_Text), 2);
  list.AddCircleFilled({x, middle}, 0.3F * bar.height,
                       packed(head.live() ? kEdgePlaneColour : kProxyColour));
  list.AddCircle({x, middle}, 0.3F * bar.height, ImGui::GetColorU32(ImGuiCol_Text), 0, 1.5F);
}

}  // namespace

std::string words_of(const PlayHead& head) {
  if (!head.of_a_run())
    return fmt::format("{:.3f} of {:.3f} s", head.time() - head.begin(), head.end() - head.begin());
  return head.live() ? "now" : fmt::format("{:.1f} s behind", head.behind());
}

float TimeLine::height(float width) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float row = ImGui::GetFrameHeight();
  const float pad = 0.5F * style.WindowPadding.y;
  return 2 * pad + (one_row(width) ? row : 2 * row + style.ItemSpacing.y);
}

bool TimeLine::take_key(int key, TouchSource& source, bool arrows) {
  if (!arrows && (key == GLFW_KEY_LEFT || key == GLFW_KEY_RIGHT)) return false;
  PlayHead& head = source.head();
  const auto go = [&](int steps) {
    head.stop_at(ImGui::GetIO().KeyShift ? head.time() + steps * kBigStep
                                         : source.time_of_step(steps));
  };
  switch (key) {
    case GLFW_KEY_LEFT:
      go(-1);
      return true;
    case GLFW_KEY_RIGHT:
      go(1);
      return true;
    case GLFW_KEY_HOME:
      head.to_start();
      return true;
    case GLFW_KEY_END:
      head.to_end();
      return true;
    case GLFW_KEY_SPACE:
      // With --hold-to-run key it enables the force.
      if (source.reader() != nullptr && source.reader()->scene().hold_by_key) return false;
      if (live_run(source) != nullptr) return false;
      play_or_stop(head);
      return true;
    case GLFW_KEY_COMMA:
    case GLFW_KEY_PERIOD:
      if (live_run(source) != nullptr) return false;
      head.set_speed(key == GLFW_KEY_COMMA ? head.speed() / 2 : head.speed() * 2);
      return true;
    default:
      return false;
  }
}

std::string TimeLine::draw(const ScreenPart& part, TouchSource& source) {
  PlayHead& head = source.head();
  const ImGuiStyle& style = ImGui::GetStyle();
  const ImVec2 pad{style.WindowPadding.x, 0.5F * style.WindowPadding.y};
  ImGui::SetNextWindowPos({part.x, part.y});
  ImGui::SetNextWindowSize({part.width, part.height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, pad);
  ImGui::Begin("time line", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::PopStyleVar();
  draw_buttons(source);
  std::string message = draw_speed(source);
  const bool narrow = !one_row(part.width);
  const float row = ImGui::GetFrameHeight();
  const std::string words = words_of(head);
  // Width of the longest text, so that the bar does not move.
  const float words_width =
      std::max(ImGui::CalcTextSize("60.0 s behind").x, ImGui::CalcTextSize(words.c_str()).x);
  const float right = part.x + part.width - pad.x;
  ImGui::SameLine(0, ImGui::GetFontSize());
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float words_x = right - words_width;
  const float words_y = narrow ? at.y + row + style.ItemSpacing.y : at.y;
  const ScreenPart bar =
      narrow ? ScreenPart{part.x + pad.x + 0.3F * row, at.y + row + style.ItemSpacing.y,
                          words_x - part.x - pad.x - 0.6F * row, row}
             : ScreenPart{at.x, at.y, std::max(1.0F, words_x - at.x - ImGui::GetFontSize()), row};
  const ImU32 ink =
      head.of_a_run() && !head.live() ? packed(kForceColour) : ImGui::GetColorU32(ImGuiCol_Text);
  ImGui::GetWindowDrawList()->AddText({words_x, words_y + style.FramePadding.y}, ink,
                                      words.c_str());
  draw_bar(bar, source);
  ImGui::End();
  return message;
}

}  // namespace thimble::view
