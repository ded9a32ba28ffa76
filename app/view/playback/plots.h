#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>

#include "thimble/driver/tick_record.h"
#include "view/playback/curve.h"
#include "view/playback/curve_plot.h"
#include "view/text_style.h"

struct ImDrawList;

namespace thimble::view {

/// The quantities of a tick that are drawn over time.
enum class Channel : std::uint8_t {
  kForce,   ///< Force on the hand, N.
  kDepth,   ///< Depth of the tip, m; 0 without contact.
  kWork,    ///< Computing time of the tick, s; none in virtual time.
  kPeriod,  ///< Time since the tick before, s.
  kSpeed,   ///< Speed of the tip, m/s.
  kX,       ///< Position of the tip in W, m.
  kY,       ///< As kX.
  kZ,       ///< As kX.
};
inline constexpr std::size_t kChannels = 8;

/// Returns the name of a channel.
const char* name_of(Channel channel) noexcept;
/// Returns how a channel is drawn, and its colour if there is one run.
const CurveLook& look_of(Channel channel);
Colour colour_of_channel(Channel channel);

/// Returns `range` scaled by `factor` about `at`, within `all`. It does not become narrower than
/// 0.1 ms, because the numbers at its axis could not be distinguished.
TimeRange zoomed(const TimeRange& range, double at, double factor, const TimeRange& all);

/// Returns `range` moved by `by` s, within `all`.
TimeRange shifted(const TimeRange& range, double by, const TimeRange& all);

/// Keeps the ticks of a run, those of the last seconds or all, and draws them over time into a part
/// of the screen. Real-time: never from the servo thread.
class Plots {
 public:
  static constexpr double kSeconds = 60;      ///< Kept duration of a run, as in MomentRing.
  static constexpr double kShownSeconds = 8;  ///< Duration shown of a longer run.
  /// Maximum number of ticks kept of a run: a minute at 8 kHz, 23 MB. [chosen]
  static constexpr std::size_t kSamplesMax = 480'000;

  /// Keeps the last minute.
  Plots() = default;
  /// Keeps all ticks, for a recording, which is in memory as a whole.
  static Plots of_recording();

  /// Takes one tick. A tick older than the last one means a new run and clears the plots.
  void add(const driver::TickRecord& tick);
  void clear();

  /// Returns the time range of the kept ticks, s; both ends 0 if there is none.
  TimeRange kept() const;
  /// Returns the last kShownSeconds.
  TimeRange newest() const;
  /// Returns the range of a whole run of a planned duration (s), so that the axis does not move;
  /// none if it is longer than kSeconds, or if ticks are outside of it.
  std::optional<TimeRange> whole_run(double duration) const;
  /// Returns a channel's value (SI) at the last tick that is no later than `time` (s); none before
  /// the first and after the last.
  std::optional<double> value_at(Channel channel, double time) const;

  /// The smallest and the largest value of a channel, SI.
  using Extent = view::Extent;
  /// Returns the extent within a range of time, including its ends.
  Extent extent(Channel channel, const TimeRange& range) const;

  // The samples of the kept ticks, oldest first.
  std::size_t size() const { return samples_.size(); }
  /// Returns the time of a sample, s.
  double time(std::size_t i) const { return samples_[i].time; }
  /// Returns a channel's value (SI) of a sample.
  float value(Channel channel, std::size_t i) const {
    return samples_[i].value[static_cast<std::size_t>(channel)];
  }
  /// Returns the extent of the samples from `from` up to, and without, `to`.
  Extent extent(Channel channel, std::size_t from, std::size_t to) const;

  using Marks = PlotMarks;

  // Call between ImGui's NewFrame and Render.

  /// Draws a channel over a range of time, with axes, numbers and the value at the cursor, or the
  /// newest value of the range.
  void draw(ImDrawList& list, const ScreenPart& part, Channel channel, const TimeRange& range,
            const Marks& marks) const;
  /// Draws a histogram of the loop's periods about the nominal one (ns).
  void draw_periods(ImDrawList& list, const ScreenPart& part, const TimeRange& range,
                    std::int64_t period_ns) const;
  /// As view::lines_of.
  static ScreenPart lines_of(const ScreenPart& part, bool times) {
    return view::lines_of(part, times);
  }

 private:
  struct Sample {
    double time;                         // s
    std::array<float, kChannels> value;  // SI
  };
  // Size of a block of samples with precomputed extent: a minute of samples is drawn 60 times a
  // second.
  static constexpr std::uint64_t kBlock = 64;
  using Block = std::array<Extent, kChannels>;

  std::size_t first_at(double time) const;  // index of the first sample that is not earlier

  double seconds_ = kSeconds;
  std::size_t samples_max_ = kSamplesMax;
  std::uint64_t dropped_ = 0;   // number of samples discarded before the first
  std::deque<Sample> samples_;  // sample i has number dropped_ + i and is in block number / kBlock
  std::deque<Block> blocks_;    // blocks_[0] is the block of samples_[0]
};

}  // namespace thimble::view
