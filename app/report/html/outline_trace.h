#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "report/extremes.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/tick_observer.h"

namespace thimble::report {

/// A reduced record of a run that is too long to keep every tick. It keeps the ticks in contact,
/// while there is room. Of each stretch of all ticks it keeps those with the minimum and maximum of
/// force, requested force, depth, period, computing time and each coordinate of the tip. Each has
/// the time since the previous tick. All memory is allocated and touched by the constructor.
class OutlineTrace final : public session::TickObserver {
 public:
  /// Maximum number of ticks kept, 110 MB. [chosen]
  static constexpr std::size_t kRowsMax = 400'000;
  /// Maximum number of ticks in contact kept in addition. [chosen: more than a page shows]
  static constexpr std::size_t kTouchRowsMax = 100'000;

  /// Allocates memory for a run of `expected_ticks` (> 0). Real-time: never from the servo thread.
  explicit OutlineTrace(std::uint64_t expected_ticks);

  /// Takes a tick. Real-time: safe.
  void take(const driver::TickRecord& tick) noexcept override;

  /// Sorts the kept ticks. Call after the last tick. Real-time: never from the servo thread.
  void finish();

  /// Returns the ticks, oldest first. After `finish`.
  std::span<const driver::TickRecord> ticks() const noexcept { return {ticks_.data(), kept_}; }
  /// Returns the time since the previous tick of each, ns. After `finish`.
  std::span<const std::int64_t> periods_ns() const noexcept { return {periods_ns_.data(), kept_}; }
  /// Returns the number of ticks of the run.
  std::uint64_t seen() const noexcept { return seen_; }

 private:
  static constexpr std::size_t kOutlined = 8;
  /// The first and the last tick of a stretch, and the ticks before and after its first change of
  /// contact; in addition the minimum and the maximum of each column.
  static constexpr std::size_t kFixed = 4;
  static constexpr std::size_t kPerStretch = kFixed + 2 * kOutlined;

  struct Row {
    driver::TickRecord tick;
    std::int64_t period_ns = 0;
  };

  void end_stretch() noexcept;
  void keep(const Row& row) noexcept;

  std::vector<driver::TickRecord> ticks_;
  std::vector<std::int64_t> periods_ns_;
  std::size_t kept_ = 0, touch_rows_ = 0;
  std::uint64_t stretch_ = 1, in_stretch_ = 0, seen_ = 0;
  std::array<Row, kFixed> own_{};  // first, last, before and after a change of contact
  Extremes<kOutlined, Row> extremes_;
  bool changed_ = false;
  bool finished_ = false;
};

}  // namespace thimble::report
