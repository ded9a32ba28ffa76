#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "view/compare/signal_curve.h"
#include "view/gl/palette.h"
#include "view/playback/curve_plot.h"
#include "view/playback/plots.h"

namespace thimble::view {

/// One of the recordings on a time line.
struct ComparedRun {
  std::string name;  ///< Name of its file.
  Colour colour{};
  const Plots* plots = nullptr;  ///< Its ticks, on the clock of its loop.
  double offset = 0;             ///< By how much that clock is later than the time line, s.
  double end = 0;                ///< Time of its last tick on the time line, s.
  bool in_picture = true;        ///< Its arms are drawn; otherwise it is of another scene.
  // At the shown moment:
  bool ended = false;       ///< It has ended, and stands at its last tick.
  driver::TickRecord tick;  ///< The tick of its first arm.
};

/// One plot of own signals: those of one name and unit, one curve per file.
struct ComparedSignal {
  CurveLook look;
  std::vector<std::unique_ptr<SignalCurve>> curves;
  std::vector<Colour> colours;  ///< One per curve.
};

/// Several recordings and the user's own signals on one time line that begins at 0 s, the first
/// tick of each recording. Real-time: never from the servo thread.
struct Comparison {
  std::vector<ComparedRun> runs;
  std::vector<ComparedSignal> signals;
  TimeRange span;                     ///< The whole time line, s.
  std::size_t drawn = 0;              ///< The run whose scene is drawn.
  std::optional<std::size_t> wanted;  ///< The run whose scene the user asks for.

  /// Returns whether there is more than one recording, so that they need colours and names.
  bool several() const { return runs.size() > 1; }
  /// Returns whether a run is of another scene than the drawn one.
  bool scenes_differ() const {
    for (const ComparedRun& run : runs) {
      if (!run.in_picture) return true;
    }
    return false;
  }
};

/// Returns the curves of a channel of all runs, which refer to `comparison`, and how they are
/// drawn.
struct ChannelCurves {
  ChannelCurves(const Comparison& comparison, Channel channel);

  std::vector<std::unique_ptr<Curve>> curves;
  std::vector<DrawnCurve> drawn;
};

/// Returns the curves of a plot of own signals.
std::vector<DrawnCurve> drawn_curves(const ComparedSignal& signal);

/// Groups the signals of files into plots, in the order of the files and their columns: signals of
/// one name and unit share a plot. If there are as many files as runs, and several, the k-th file
/// has the colour of the k-th run. Takes the values out of `files`.
std::vector<ComparedSignal> signals_of(std::vector<OwnSignals> files, std::size_t runs);

}  // namespace thimble::view
