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

/// What of a tick is drawn over time.
enum class Channel : std::uint8_t {
  kForce,   ///< On the hand, N.
  kDepth,   ///< Of the tip, m; 0 where nothing is touched.
  kWork,    ///< How long the tick computed, s: nothing where time is virtual.
  kPeriod,  ///< Since the tick before, s.
  kSpeed,   ///< Of the tip, m/s.
  kX,       ///< Of the tip in W, m.
  kY,       ///< As kX.
  kZ,       ///< As kX.
};
inline constexpr std::size_t kChannels = 8;

/// Returns what a channel is called.
const char* name_of(Channel channel) noexcept;

/// A part of the time of a run, s.
struct TimeRange {
  double begin = 0, end = 0;

  double width() const { return end - begin; }
};

/// Returns `range` made wider by `factor` about `at`, within `all`, and not so narrow that numbers
/// no longer tell its ends apart (0.1 ms).
TimeRange zoomed(const TimeRange& range, double at, double factor, const TimeRange& all);

/// Returns `range` moved by `by` s, within `all`.
TimeRange shifted(const TimeRange& range, double by, const TimeRange& all);

/// Keeps the ticks of a run, those of the last seconds or all, and draws them over time, into a
/// part of the screen. Real-time: never from the servo thread.
class Plots {
 public:
  static constexpr double kSeconds = 60;      ///< What is kept of a run: as much as a MomentRing.
  static constexpr double kShownSeconds = 8;  ///< What is shown of it if nothing else is asked.
  /// Ticks kept of a run at most: a minute at 8 kHz, 23 MB. [chosen]
  static constexpr std::size_t kSamplesMost = 480'000;

  /// Keeps the last minute.
  Plots() = default;
  /// Keeps all that it gets: of a recording, which is in memory as a whole.
  static Plots of_recording();

  /// Takes one tick; one that is older than the last begins anew.
  void add(const driver::TickRecord& tick);
  void clear();

  /// Returns from when to when ticks are kept, s; both 0 if there is none.
  TimeRange kept() const;
  /// Returns what is shown if nothing else is asked: the last kShownSeconds.
  TimeRange newest() const;
  /// Returns a channel's value (SI) at the last tick that is no later than `time` (s); none before
  /// the first and after the last.
  std::optional<double> value_at(Channel channel, double time) const;

  /// The least and the most of a channel, SI.
  struct Extent {
    float least = std::numeric_limits<float>::infinity();
    float most = -std::numeric_limits<float>::infinity();
    bool empty() const { return most < least; }
  };
  /// Returns what lies between in a range of time, its ends included.
  Extent extent(Channel channel, const TimeRange& range) const;

  /// What is marked in a plot beside its line.
  struct Marks {
    std::optional<double> cursor;  ///< Where the mouse is, s: its value is told.
    std::optional<double> looked;  ///< The moment that is looked at, s.
    bool times = true;             ///< The numbers of the time axis, below.
  };

  // To be called between ImGui's NewFrame and Render.

  /// Draws a channel over a range of time, with axes, numbers and the value at the cursor, else the
  /// newest of the range.
  void draw(ImDrawList& list, const ScreenPart& part, Channel channel, const TimeRange& range,
            const Marks& marks) const;
  /// Draws how often periods lasted how long about the wanted one (ns).
  void draw_periods(ImDrawList& list, const ScreenPart& part, const TimeRange& range,
                    std::int64_t period_ns) const;
  /// Returns where in `part` the lines are: right of the numbers, below the title. `times` as in
  /// Marks.
  static ScreenPart lines_of(const ScreenPart& part, bool times);

 private:
  struct Sample {
    double time;                         // s
    std::array<float, kChannels> value;  // SI
  };
  // So many samples at once are known by their least and most: a minute is drawn 60 times a second.
  static constexpr std::uint64_t kBlock = 64;
  using Block = std::array<Extent, kChannels>;

  std::size_t first_at(double time) const;  // the first sample that is no earlier
  Extent extent(Channel channel, std::size_t from, std::size_t to) const;
  void draw_line(ImDrawList& list, const ScreenPart& inner, Channel channel, const TimeRange& range,
                 const AxisTicks& axis, double per_si) const;

  double seconds_ = kSeconds;
  std::size_t samples_most_ = kSamplesMost;
  std::uint64_t dropped_ = 0;   // samples that were kept once, before the first
  std::deque<Sample> samples_;  // sample i is number dropped_ + i, of block number / kBlock
  std::deque<Block> blocks_;    // the first is the block of the first sample
};

}  // namespace thimble::view
