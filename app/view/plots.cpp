#include "view/plots.h"

#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thimble::app::view {
namespace {

ImU32 packed(const Colour& colour, float cover = 1) {
  return ImGui::ColorConvertFloat4ToU32({colour[0], colour[1], colour[2], cover});
}

/// Finds the round number (1, 2 or 5 times a power of ten) that is no less.
double round_up(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (value <= step * power * (1 + 1e-9)) return step * power;
  }
  return 10 * power;
}

/// Draws the box of a plot, its title and the two ends of its axis; gives the inner part.
ScreenPart draw_box(ImDrawList& list, const ScreenPart& part, const char* title,
                    const std::string& top, const char* unit) {
  const float line = ImGui::GetFontSize();
  const float pad = 0.35F * line;
  const ScreenPart inner = {part.x, part.y + 1.5F * line, part.width, part.height - 1.5F * line};
  list.AddRectFilled({inner.x, inner.y}, {inner.x + inner.width, inner.y + inner.height},
                     ImGui::GetColorU32(ImGuiCol_PopupBg));
  list.AddText({part.x, part.y + 0.2F * line}, ImGui::GetColorU32(ImGuiCol_Text), title);
  const std::string text = fmt::format("{} {}", top, unit);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  list.AddText({part.x + part.width - size.x, part.y + 0.2F * line},
               ImGui::GetColorU32(ImGuiCol_TextDisabled), text.c_str());
  for (int k = 1; k < 4; ++k) {
    const float y = inner.y + inner.height * static_cast<float>(k) / 4;
    list.AddLine({inner.x, y}, {inner.x + inner.width, y}, packed(kGridColour, 0.25F));
  }
  list.AddLine({inner.x, inner.y + inner.height}, {inner.x + inner.width, inner.y + inner.height},
               packed(kGridColour));
  return {inner.x, inner.y + pad, inner.width, inner.height - pad};
}

}  // namespace

/// How a line looks, and up to where its axis goes.
struct Plots::Look {
  const char* title;
  const char* unit;
  const Colour& colour;
  double top;
};

void Plots::clear() {
  samples_.clear();
}

void Plots::add(const driver::TickRecord& tick) {
  const double time = static_cast<double>(tick.time_ns) * 1e-9;
  if (!samples_.empty() && time < samples_.back().time) clear();
  const auto& f = tick.f_sent_W;
  const auto last = samples_.empty() ? time : samples_.back().time;
  samples_.push_back({time, static_cast<float>(std::hypot(f[0], f[1], f[2])),
                      static_cast<float>(tick.in_contact ? tick.depth * 1e3 : 0),
                      static_cast<float>(static_cast<double>(tick.work_ns) * 1e-3),
                      static_cast<float>((time - last) * 1e6)});
  while (samples_.front().time < time - kSeconds) samples_.pop_front();
}

void Plots::draw_line(ImDrawList& list, const ScreenPart& part, const Look& look,
                      float Sample::*value) const {
  const std::string top = fmt::format("{:g}", look.top);
  const ScreenPart inner = draw_box(list, part, look.title, top, look.unit);
  if (samples_.empty()) return;
  // From the least to the most within each column of pixels, so that no spike is lost.
  const double end = std::max(samples_.back().time, samples_.front().time + kSeconds);
  const auto columns = static_cast<std::size_t>(std::max(1.0F, inner.width));
  struct Span {
    float least = 1e30F, most = -1e30F;
  };
  std::vector<Span> spans(columns);
  for (const Sample& sample : samples_) {
    const double share = 1 - (end - sample.time) / kSeconds;
    const auto column = static_cast<std::ptrdiff_t>(share * static_cast<double>(columns));
    if (column < 0) continue;
    Span& span = spans[std::min(static_cast<std::size_t>(column), columns - 1)];
    span.least = std::min(span.least, sample.*value);
    span.most = std::max(span.most, sample.*value);
  }
  const auto y = [&](float v) {
    const float share = std::clamp(v / static_cast<float>(look.top), 0.0F, 1.0F);
    return inner.y + inner.height * (1 - share);
  };
  std::vector<ImVec2> line;
  for (std::size_t i = 0; i < columns; ++i) {
    if (spans[i].most < spans[i].least) continue;
    const float x = inner.x + static_cast<float>(i) + 0.5F;
    line.push_back({x, y(spans[i].least)});
    if (spans[i].most > spans[i].least) line.push_back({x, y(spans[i].most)});
    list.AddLine({x, inner.y + inner.height}, {x, y(spans[i].most)}, packed(look.colour, 0.10F));
  }
  list.AddPolyline(line.data(), static_cast<int>(line.size()), packed(look.colour), 0,
                   std::max(1.5F, ImGui::GetFontSize() / 9));
}

void Plots::draw_force(ImDrawList& list, const ScreenPart& part, double force_limit) const {
  float most = 0.5F;
  for (const Sample& sample : samples_) most = std::max(most, sample.force);
  draw_line(list, part,
            {"force, last 8 s", "N", kForceColour, std::min(round_up(most), round_up(force_limit))},
            &Sample::force);
}

void Plots::draw_depth(ImDrawList& list, const ScreenPart& part) const {
  float most = 1;
  for (const Sample& sample : samples_) most = std::max(most, sample.depth);
  draw_line(list, part, {"depth", "mm", kDepthColour, round_up(most)}, &Sample::depth);
}

void Plots::draw_work(ImDrawList& list, const ScreenPart& part) const {
  float most = 10;
  for (const Sample& sample : samples_) most = std::max(most, sample.work);
  draw_line(list, part, {"time a tick computes", "us", kEdgePlaneColour, round_up(most)},
            &Sample::work);
}

void Plots::draw_periods(ImDrawList& list, const ScreenPart& part, std::int64_t period_ns) const {
  const double wanted = static_cast<double>(period_ns) * 1e-3;
  constexpr std::size_t kBins = 61;
  std::array<int, kBins> count{};
  double reach = 0.02 * wanted;
  for (const Sample& sample : samples_) {
    if (sample.period > 0) reach = std::max(reach, std::abs(sample.period - wanted));
  }
  reach = std::min(round_up(reach), wanted);
  for (const Sample& sample : samples_) {
    if (!(sample.period > 0)) continue;
    const double share = 0.5 + 0.5 * (sample.period - wanted) / reach;
    const double last = kBins - 1;
    ++count[static_cast<std::size_t>(std::lround(std::clamp(share * last, 0.0, last)))];
  }
  const std::string range = fmt::format("{:g} +/- {:g}", wanted, reach);
  const ScreenPart inner = draw_box(list, part, "period", range, "us");
  const int most = std::max(1, *std::max_element(count.begin(), count.end()));
  for (std::size_t i = 0; i < kBins; ++i) {
    if (count[i] == 0) continue;
    // By the logarithm: one late tick in ten thousand must be seen.
    const double share = (std::log(count[i]) + 1) / (std::log(most) + 1);
    const float width = inner.width / kBins;
    const float x = inner.x + width * static_cast<float>(i);
    const float top = inner.y + inner.height * static_cast<float>(1 - share);
    list.AddRectFilled({x, top}, {x + std::max(1.0F, width - 1), inner.y + inner.height},
                       packed(kDepthColour, 0.8F));
  }
}

}  // namespace thimble::app::view
