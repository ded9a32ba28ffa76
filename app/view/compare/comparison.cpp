#include "view/compare/comparison.h"

#include <algorithm>
#include <array>
#include <utility>

#include "view/compare/run_colours.h"
#include "view/playback/channel_curve.h"

namespace thimble::view {
namespace {

// Colours of signals that belong to no recording: darker than those of recordings, so that they are
// not taken for theirs. [chosen]
constexpr std::array kSignalColours = {colour_of(0x4A3F8F), colour_of(0x7A5230),
                                       colour_of(0x2F6B6B), colour_of(0x8A3B5A)};

}  // namespace

ChannelCurves::ChannelCurves(const Comparison& comparison, Channel channel) {
  for (const ComparedRun& run : comparison.runs) {
    curves.push_back(std::make_unique<ChannelCurve>(*run.plots, channel, run.offset));
    drawn.push_back(
        {curves.back().get(), comparison.several() ? run.colour : colour_of_channel(channel)});
  }
}

std::vector<DrawnCurve> drawn_curves(const ComparedSignal& signal) {
  std::vector<DrawnCurve> drawn;
  for (std::size_t i = 0; i < signal.curves.size(); ++i) {
    drawn.push_back({signal.curves[i].get(), signal.colours[i]});
  }
  return drawn;
}

std::vector<ComparedSignal> signals_of(std::vector<OwnSignals> files, std::size_t runs) {
  std::vector<ComparedSignal> plots;
  for (std::size_t file = 0; file < files.size(); ++file) {
    const Colour colour = runs > 1 && files.size() == runs
                              ? kRunColours[file % kRunColours.size()]
                              : kSignalColours[file % kSignalColours.size()];
    for (OwnSignal& signal : files[file].signals) {
      auto plot = std::find_if(plots.begin(), plots.end(), [&](const ComparedSignal& one) {
        return one.look.name == signal.name && one.look.unit == signal.unit;
      });
      if (plot == plots.end()) {
        plots.emplace_back();
        plot = std::prev(plots.end());
        plot->look.name = signal.name;
        plot->look.unit = signal.unit;
      }
      plot->curves.push_back(
          std::make_unique<SignalCurve>(files[file].time, std::move(signal.values)));
      plot->colours.push_back(colour);
    }
  }
  return plots;
}

}  // namespace thimble::view
