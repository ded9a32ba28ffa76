#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>

#include "thimble/driver/tick_record.h"
#include "view/playback/axis_ticks.h"
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

/// A range of the time of a run, s.
struct TimeRange {
  double begin = 0, end = 0;

  double width() const { return end - begin; }
};

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
  struct Extent {
    float min = std::numeric_limits<float>::infinity();
    float max = -std::numeric_limits<float>::infinity();
    bool empty() const { return max < min; }
  };
  /// Returns the extent within a range of time, including its ends.
  Extent extent(Channel channel, const TimeRange& range) const;

  /// Marks in a plot in addition to its line.
  struct Marks {
    std::optional<double> cursor;  ///< Time of the mouse, s, whose value is shown.
    std::optional<double> looked;  ///< The moment that is shown, s.
    bool times = true;             ///< Whether the numbers of the time axis are drawn.
  };

  // Call between ImGui's NewFrame and Render.

  /// Draws a channel over a range of time, with axes, numbers and the value at the cursor, or the
  /// newest value of the range.
  void draw(ImDrawList& list, const ScreenPart& part, Channel channel, const TimeRange& range,
            const Marks& marks) const;
  /// Draws a histogram of the loop's periods about the nominal one (ns).
  void draw_periods(ImDrawList& list, const ScreenPart& part, const TimeRange& range,
                    std::int64_t period_ns) const;
  /// Returns the area of the lines in `part`: right of the numbers, below the title. `times` as in
  /// Marks.
  static ScreenPart lines_of(const ScreenPart& part, bool times);

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
  Extent extent(Channel channel, std::size_t from, std::size_t to) const;
  void draw_line(ImDrawList& list, const ScreenPart& inner, Channel channel, const TimeRange& range,
                 const AxisTicks& axis, double per_si) const;

  double seconds_ = kSeconds;
  std::size_t samples_max_ = kSamplesMax;
  std::uint64_t dropped_ = 0;   // number of samples discarded before the first
  std::deque<Sample> samples_;  // sample i has number dropped_ + i and is in block number / kBlock
  std::deque<Block> blocks_;    // blocks_[0] is the block of samples_[0]
};

}  // namespace thimble::view
