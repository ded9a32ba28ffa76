#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "events/event_watch.h"
#include "events/tick_event.h"
#include "spsc_ring.h"
#include "thimble/driver/device.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/tick_observer.h"

namespace thimble::report {

/// Something that happened in a run, as a page marks it.
struct PageMark {
  /// How much it matters.
  enum class Kind : std::uint8_t { kFault, kWarning, kGate, kNote };

  std::int64_t begin_ns = 0;  ///< On the loop's clock.
  std::int64_t end_ns = 0;    ///< When it was over; `begin_ns` if it took no time.
  Kind kind = Kind::kNote;    ///< Of the worst of it.
  std::string words;          ///< A sentence.
};

/// Names a kind as the page does: fault, warning, gate, note.
const char* name_of(PageMark::Kind kind) noexcept;

/// The events of a run on one arm, kept until it is over.
class EventKeeper final : public session::TickObserver {
 public:
  /// Events that are kept: the first so many, 500 kB. [chosen: a page shows a hundred at a time]
  static constexpr std::size_t kEventsMost = 8192;

  /// Watches ticks due every `period_ns` on `device`, which must be open and outlive it.
  /// Real-time: never from the servo thread.
  EventKeeper(const driver::Device& device, std::int64_t period_ns);

  /// Takes one tick. Real-time: safe.
  void take(const driver::TickRecord& tick) noexcept override { watch_.take(tick); }

  /// Ends what goes on and returns everything that happened but touches, in order. After the last
  /// tick, once.
  std::vector<PageMark> finish();

 private:
  session::DeviceCounters counters_;
  session::SpscRing<session::TickEvent> ring_{kEventsMost};
  session::EventWatch watch_;
};

/// What the ticks of a run tell as they come of what `marks_of_ticks` tells at its end; the oldest
/// marks are forgotten. Real-time: never from the servo thread.
class MarksAsTheyCome {
 public:
  /// Marks that are kept. [chosen: what a page lists]
  static constexpr std::size_t kMost = 500;

  /// Watches ticks due every `period_ns`.
  explicit MarksAsTheyCome(std::int64_t period_ns);
  ~MarksAsTheyCome();

  /// Takes the next ticks. Returns the numbers of the marks that are new or that have changed; they
  /// count from 0 on.
  std::vector<std::uint64_t> take(std::span<const driver::TickRecord> ticks);
  /// Returns a mark; null if it is forgotten.
  const PageMark* mark(std::uint64_t number) const noexcept;
  /// Returns the number of the oldest mark that is kept, and one above that of the newest.
  std::uint64_t oldest() const noexcept;
  std::uint64_t end() const noexcept;  ///< As above.

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Returns what the ticks of a recording tell of the same: the arm's stages, faults, ticks missed,
/// and when the force that was sent was not the one that was asked for; why the gate did that no
/// recording tells. Real-time: never from the servo thread.
std::vector<PageMark> marks_of_ticks(std::span<const driver::TickRecord> ticks,
                                     std::int64_t period_ns);

}  // namespace thimble::report
