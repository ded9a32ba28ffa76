#include "view/playback/plot_panel.h"

#include <imgui.h>
// After the header above, which it needs.
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

namespace thimble::view {
namespace {

constexpr double kWheel = 0.8;       // range left by one step of the wheel; chosen
constexpr float kClickPixels = 4;    // a drag is longer; chosen
constexpr float kPlotHeight = 4.6F;  // minimum, in heights of the font; chosen

ImU32 veil() {
  return ImGui::ColorConvertFloat4ToU32({kDepthColour[0], kDepthColour[1], kDepthColour[2], 0.15F});
}

}  // namespace

TimeRange PlotPanel::range(const Plots& plots, const PlotTime& time) const {
  if (zoom_) return *zoom_;
  const TimeRange all = plots.kept();
  if (time.recorded) return all.width() > 0 ? all : TimeRange{all.begin, all.begin + 1};
  if (const auto whole = plots.whole_run(time.duration)) return *whole;
  // Shows the position in the minute while looking back.
  return time.looked ? TimeRange{all.begin, std::max(all.end, all.begin + Plots::kShownSeconds)}
                     : plots.newest();
}

void PlotPanel::draw_choice() {
  if (ImGui::SmallButton("channels")) ImGui::OpenPopup("channels of plots");
  ImGui::SameLine();
  ImGui::TextDisabled("%s", zoom_ ? "double click: all of it" : "wheel, drag: closer");
  if (!ImGui::BeginPopup("channels of plots")) return;
  for (std::size_t i = 0; i < kChannels; ++i) {
    ImGui::Checkbox(name_of(static_cast<Channel>(i)), &shown_[i]);
  }
  ImGui::Checkbox("how often which period", &periods_);
  ImGui::EndPopup();
}

void PlotPanel::use_mouse(const ScreenPart& inner, const TimeRange& range, const TimeRange& all) {
  const ImGuiIO& io = ImGui::GetIO();
  const auto per_pixel = range.width() / static_cast<double>(inner.width);
  const double under =
      std::clamp(range.begin + per_pixel * static_cast<double>(io.MousePos.x - inner.x),
                 range.begin, range.end);
  const bool hovered = ImGui::IsItemHovered();
  if (hovered || ImGui::IsItemActive()) next_cursor_ = under;
  ImGui::SetItemUsingMouseWheel();
  if (hovered && io.MouseWheel != 0) {
    zoom_ = zoomed(range, under, std::pow(kWheel, static_cast<double>(io.MouseWheel)), all);
  }
  if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
    zoom_.reset();
    drag_from_.reset();
    return;
  }
  if (ImGui::IsItemActivated() && ImGui::IsMouseDown(ImGuiMouseButton_Left)) drag_from_ = under;
  if (ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Right, 0)) {
    zoom_ = shifted(range, -per_pixel * static_cast<double>(io.MouseDelta.x), all);
  }
  if (!ImGui::IsItemDeactivated() || !drag_from_) return;
  const double from = *drag_from_;
  drag_from_.reset();
  if (std::abs(under - from) > static_cast<double>(kClickPixels) * per_pixel) {
    const TimeRange part{std::min(from, under), std::max(from, under)};
    zoom_ = zoomed(part, part.begin, 1, all);
  } else if (!ImGui::IsMouseReleased(ImGuiMouseButton_Right)) {
    asked_ = from;
  }
}

void PlotPanel::draw_one(const Plots& plots, const PlotTime& time, const ScreenPart& part,
                         Channel channel, bool last) {
  const TimeRange shown = range(plots, time);
  const TimeRange all = plots.kept();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  plots.draw(list, part, channel, shown, {cursor_, time.looked, last});
  const ScreenPart inner = Plots::lines_of(part, last);
  if (drag_from_ && cursor_) {
    const auto x = [&](double t) {
      return inner.x + inner.width * static_cast<float>((t - shown.begin) / shown.width());
    };
    list.AddRectFilled({x(std::min(*drag_from_, *cursor_)), inner.y},
                       {x(std::max(*drag_from_, *cursor_)), inner.y + inner.height}, veil());
  }
  const ImVec2 back = ImGui::GetCursorScreenPos();
  ImGui::SetCursorScreenPos({inner.x, inner.y});
  ImGui::PushID(static_cast<int>(channel));
  ImGui::InvisibleButton("plot", {inner.width, inner.height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  if (all.width() > 0) use_mouse(inner, shown, all);
  ImGui::PopID();
  ImGui::SetCursorScreenPos(back);
}

std::optional<double> PlotPanel::draw(const Plots& plots, const PlotTime& time, float height) {
  asked_.reset();
  cursor_ = next_cursor_;
  next_cursor_.reset();
  // The zoomed range may be outside of the kept ticks or belong to a previous run.
  const TimeRange all = plots.kept();
  if (zoom_ && (zoom_->end < all.begin || zoom_->begin > all.end)) zoom_.reset();
  const float top = ImGui::GetCursorPosY();
  draw_choice();
  const float width = ImGui::GetContentRegionAvail().x;
  const float spacing = ImGui::GetStyle().ItemSpacing.y;
  const float room = height - (ImGui::GetCursorPosY() - top);
  const float min = kPlotHeight * ImGui::GetFontSize() + spacing;
  const auto wanted = std::count(shown_.begin(), shown_.end(), true) + (periods_ ? 1 : 0);
  const auto fit = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(room / min), 1,
                                              std::max<std::ptrdiff_t>(wanted, 1));
  const float each = std::max(room / static_cast<float>(fit), min) - spacing;
  const auto next = [&] {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    return ScreenPart{at.x, at.y, width, each};
  };
  const bool with_periods = periods_ && fit == wanted;
  std::ptrdiff_t left = fit - (with_periods ? 1 : 0);
  for (std::size_t i = 0; i < kChannels && left > 0; ++i) {
    if (!shown_[i]) continue;
    --left;
    draw_one(plots, time, next(), static_cast<Channel>(i), left == 0);
    ImGui::Dummy({width, each});
  }
  if (with_periods) {
    plots.draw_periods(*ImGui::GetWindowDrawList(), next(), range(plots, time), time.period_ns);
    ImGui::Dummy({width, each});
  }
  return asked_;
}

}  // namespace thimble::view
