// Drawing of plots; their data are in plots.cpp.
#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "view/playback/channel_curve.h"
#include "view/playback/plot_parts.h"
#include "view/playback/plots.h"

namespace thimble::view {

const CurveLook& look_of(Channel channel) {
  // The minimum range of each axis is chosen.
  static const std::array<CurveLook, kChannels> looks = {{
      {"force", Quantity::kForce, "", true, 1e-3},
      {"depth", Quantity::kLength, "", true, 1e-6},
      {"time a tick computes", Quantity::kTime, "", true, 10e-6},
      {"period", Quantity::kTime, "", false, 20e-6},
      {"speed", Quantity::kSpeed, "", true, 1e-4},
      {"x", Quantity::kLength, "", false, 1e-5},
      {"y", Quantity::kLength, "", false, 1e-5},
      {"z", Quantity::kLength, "", false, 1e-5},
  }};
  return looks[static_cast<std::size_t>(channel)];
}

Colour colour_of_channel(Channel channel) {
  switch (channel) {
    case Channel::kForce:
      return kForceColour;
    case Channel::kDepth:
    case Channel::kPeriod:
      return kDepthColour;
    case Channel::kWork:
    case Channel::kSpeed:
      return kEdgePlaneColour;
    case Channel::kX:
    case Channel::kY:
    case Channel::kZ:
      break;
  }
  return kTipColour;
}

const char* name_of(Channel channel) noexcept {
  return look_of(channel).name.c_str();
}

void Plots::draw(ImDrawList& list, const ScreenPart& part, Channel channel, const TimeRange& range,
                 const Marks& marks) const {
  const ChannelCurve curve(*this, channel);
  const DrawnCurve drawn{&curve, colour_of_channel(channel)};
  draw_curves(list, part, look_of(channel), std::span(&drawn, 1), range, marks);
}

void Plots::draw_periods(ImDrawList& list, const ScreenPart& part, const TimeRange& range,
                         std::int64_t period_ns) const {
  const double wanted = static_cast<double>(period_ns) * 1e-9;
  constexpr std::size_t kBins = 61;
  std::array<int, kBins> count{};
  const std::size_t from = first_at(range.begin);
  const std::size_t to = first_at(range.end);
  const auto period = [&](std::size_t i) {
    return static_cast<double>(samples_[i].value[static_cast<std::size_t>(Channel::kPeriod)]);
  };
  double reach = 0.02 * wanted;
  for (std::size_t i = from; i < to; ++i) {
    if (period(i) > 0) reach = std::max(reach, std::abs(period(i) - wanted));
  }
  reach = std::min(reach, wanted);
  for (std::size_t i = from; i < to; ++i) {
    if (!(period(i) > 0)) continue;
    const double share = 0.5 + 0.5 * (period(i) - wanted) / reach;
    const double last = kBins - 1;
    ++count[static_cast<std::size_t>(std::lround(std::clamp(share * last, 0.0, last)))];
  }
  const ScreenPart inner = lines_of(part, true);
  draw_plot_frame(list, inner);
  write_plot_title(list, part, "how often which period, us", {});
  const AxisTicks axis = ticks_within(1e6 * (wanted - reach), 1e6 * (wanted + reach), 5);
  for (std::size_t i = 0; i < axis.count; ++i) {
    const auto share = static_cast<float>(0.5 + 0.5 * (1e-6 * axis.at(i) - wanted) / reach);
    write_small(list, inner.x + share * inner.width,
                inner.y + inner.height + 0.15F * small_text_size(),
                share < 0.04F   ? 0
                : share > 0.94F ? 1
                                : 0.5F,
                axis.text(i));
  }
  const int max = std::max(1, *std::max_element(count.begin(), count.end()));
  for (std::size_t i = 0; i < kBins; ++i) {
    if (count[i] == 0) continue;
    // Logarithmic: one late tick in ten thousand must be visible.
    const double share = (std::log(count[i]) + 1) / (std::log(max) + 1);
    const float width = inner.width / kBins;
    const float x = inner.x + width * static_cast<float>(i);
    const float top = inner.y + inner.height * static_cast<float>(1 - share);
    list.AddRectFilled({x, top}, {x + std::max(1.0F, width - 1), inner.y + inner.height},
                       plot_colour(colour_in_theme(kDepthColour), 0.8F));
  }
}

}  // namespace thimble::view
