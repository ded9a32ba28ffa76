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

/// Returns the range in which there are data.
TimeRange all_of(const Plots& plots, const PlotTime& time) {
  return time.compared != nullptr ? time.compared->span : plots.kept();
}

ImU32 veil() {
  return ImGui::ColorConvertFloat4ToU32({kDepthColour[0], kDepthColour[1], kDepthColour[2], 0.15F});
}

}  // namespace

TimeRange PlotPanel::range(const Plots& plots, const PlotTime& time) const {
  if (zoom_) return *zoom_;
  const TimeRange all = all_of(plots, time);
  if (time.recorded) return all.width() > 0 ? all : TimeRange{all.begin, all.begin + 1};
  if (const auto whole = plots.whole_run(time.duration)) return *whole;
  // Shows the position in the minute while looking back.
  return time.looked ? TimeRange{all.begin, std::max(all.end, all.begin + Plots::kShownSeconds)}
                     : plots.newest();
}

// Own signals follow force and depth: without room for all, they are drawn first.
std::vector<PlotPanel::Row> PlotPanel::rows(const PlotTime& time) const {
  std::vector<Row> rows;
  const auto add = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      if (shown_[i]) rows.push_back({static_cast<Channel>(i), nullptr});
    }
  };
  const auto before = static_cast<std::size_t>(Channel::kWork);
  add(0, before);
  if (time.compared != nullptr) {
    for (const ComparedSignal& signal : time.compared->signals) {
      if (!hidden_.contains(signal.look.name)) rows.push_back({Channel::kForce, &signal});
    }
  }
  add(before, kChannels);
  return rows;
}

bool PlotPanel::shows_periods(const PlotTime& time) const {
  return periods_ && time.compared == nullptr;
}

void PlotPanel::draw_choice(const PlotTime& time) {
  if (ImGui::SmallButton("channels")) ImGui::OpenPopup("channels of plots");
  ImGui::SameLine();
  ImGui::TextDisabled("%s", zoom_ ? "double click: all of it" : "wheel, drag: closer");
  if (!ImGui::BeginPopup("channels of plots")) return;
  for (std::size_t i = 0; i < kChannels; ++i) {
    ImGui::Checkbox(name_of(static_cast<Channel>(i)), &shown_[i]);
  }
  if (time.compared == nullptr) {
    ImGui::Checkbox("how often which period", &periods_);
  } else {
    for (const ComparedSignal& signal : time.compared->signals) {
      bool shown = !hidden_.contains(signal.look.name);
      if (!ImGui::Checkbox(signal.look.name.c_str(), &shown)) continue;
      if (shown) {
        hidden_.erase(signal.look.name);
      } else {
        hidden_.insert(signal.look.name);
      }
    }
  }
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

void PlotPanel::draw_row(const Plots& plots, const PlotTime& time, const ScreenPart& part,
                         const Row& row, int id, bool last) {
  const TimeRange shown = range(plots, time);
  const TimeRange all = all_of(plots, time);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const PlotMarks marks{cursor_, time.looked, last};
  if (row.signal != nullptr) {
    draw_curves(list, part, row.signal->look, drawn_curves(*row.signal), shown, marks);
  } else if (time.compared != nullptr) {
    const ChannelCurves curves(*time.compared, row.channel);
    draw_curves(list, part, look_of(row.channel), curves.drawn, shown, marks);
  } else {
    plots.draw(list, part, row.channel, shown, marks);
  }
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
  ImGui::PushID(id);
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
  const TimeRange all = all_of(plots, time);
  if (zoom_ && (zoom_->end < all.begin || zoom_->begin > all.end)) zoom_.reset();
  const float top = ImGui::GetCursorPosY();
  draw_choice(time);
  const float width = ImGui::GetContentRegionAvail().x;
  const float spacing = ImGui::GetStyle().ItemSpacing.y;
  const float room = height - (ImGui::GetCursorPosY() - top);
  const float min = kPlotHeight * ImGui::GetFontSize() + spacing;
  const std::vector<Row> chosen = rows(time);
  const bool periods = shows_periods(time);
  const auto wanted = static_cast<std::ptrdiff_t>(chosen.size()) + (periods ? 1 : 0);
  const auto fit = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(room / min), 1,
                                              std::max<std::ptrdiff_t>(wanted, 1));
  const float each = std::max(room / static_cast<float>(fit), min) - spacing;
  const auto next = [&] {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    return ScreenPart{at.x, at.y, width, each};
  };
  const bool with_periods = periods && fit == wanted;
  const auto drawn =
      std::min(chosen.size(), static_cast<std::size_t>(fit - (with_periods ? 1 : 0)));
  for (std::size_t i = 0; i < drawn; ++i) {
    draw_row(plots, time, next(), chosen[i], static_cast<int>(i), i + 1 == drawn);
    ImGui::Dummy({width, each});
  }
  if (with_periods) {
    plots.draw_periods(*ImGui::GetWindowDrawList(), next(), range(plots, time), time.period_ns);
    ImGui::Dummy({width, each});
  }
  return asked_;
}

}  // namespace thimble::view
