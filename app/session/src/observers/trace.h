#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Ticks of a run, for plots and files. All memory is allocated and touched by the constructor, so
/// that no page fault occurs later.
class Trace final : public TickObserver {
 public:
  static constexpr std::size_t kDefaultRowsMax = 1'000'000;

  /// Allocates memory for a run of `expected_ticks` (0: unknown) in at most `rows_max` rows (> 0).
  /// Keeps every n-th tick with the smallest n that fits. Real-time: never from the servo thread.
  explicit Trace(std::uint64_t expected_ticks, std::size_t rows_max = kDefaultRowsMax);

  /// Stores a record if it is an n-th one and there is room. Real-time: safe.
  void take(const driver::TickRecord& record) noexcept override;

  /// Returns the stored records, oldest first.
  std::span<const driver::TickRecord> rows() const noexcept { return {rows_.data(), kept_}; }

  /// Returns n if every n-th tick is kept.
  std::uint64_t stride() const noexcept { return stride_; }

  /// Returns the number of records that did not fit because the run was longer than expected.
  std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  std::vector<driver::TickRecord> rows_;
  std::size_t kept_ = 0;
  std::uint64_t stride_ = 1;
  std::uint64_t until_next_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace thimble::session
