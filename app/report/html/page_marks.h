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

/// An event of a run, as marked on a page.
struct PageMark {
  /// Importance of an event.
  enum class Kind : std::uint8_t { kFault, kWarning, kGate, kNote };

  std::int64_t begin_ns = 0;  ///< On the loop's clock.
  std::int64_t end_ns = 0;    ///< Its end; `begin_ns` if it has no duration.
  Kind kind = Kind::kNote;    ///< The most important kind within it.
  std::string words;          ///< A sentence.
};

/// Returns the name of a kind on the page: fault, warning, gate, note.
const char* name_of(PageMark::Kind kind) noexcept;

/// Collects the events of a run on one arm until it is over.
class EventKeeper final : public session::TickObserver {
 public:
  /// Maximum number of events kept, 500 kB; later ones are counted as lost. [chosen: a page shows a
  /// hundred at a time]
  static constexpr std::size_t kEventsMax = 8192;

  /// Observes ticks due every `period_ns` on `device`, which must be open and outlive this.
  /// Real-time: never from the servo thread.
  EventKeeper(const driver::Device& device, std::int64_t period_ns);

  /// Takes one tick. Real-time: safe.
  void take(const driver::TickRecord& tick) noexcept override { watch_.take(tick); }

  /// Ends current activities and returns all events except touches, in order. Call once, after the
  /// last tick.
  std::vector<PageMark> finish();

 private:
  session::DeviceCounters counters_;
  session::SpscRing<session::TickEvent> ring_{kEventsMax};
  session::EventWatch watch_;
};

/// Finds the marks of `marks_of_ticks` during a run, as its ticks arrive; the oldest marks are
/// discarded. Real-time: never from the servo thread.
class LiveMarks {
 public:
  /// Maximum number of marks kept. [chosen: the length of a page's list]
  static constexpr std::size_t kMax = 500;

  /// Observes ticks due every `period_ns`.
  explicit LiveMarks(std::int64_t period_ns);
  ~LiveMarks();

  /// Takes the next ticks. Returns the numbers of new and changed marks; numbers start at 0.
  std::vector<std::uint64_t> take(std::span<const driver::TickRecord> ticks);
  /// Returns a mark; null if it was discarded.
  const PageMark* mark(std::uint64_t number) const noexcept;
  /// Returns the number of the oldest mark that is kept, and one above that of the newest.
  std::uint64_t oldest() const noexcept;
  std::uint64_t end() const noexcept;  ///< As above.

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Returns the events that the ticks of a recording show: the arm's stages, faults, missed ticks,
/// and when the force sent differed from the requested one. Recordings do not contain the gate's
/// reason. Real-time: never from the servo thread.
std::vector<PageMark> marks_of_ticks(std::span<const driver::TickRecord> ticks,
                                     std::int64_t period_ns);

}  // namespace thimble::report
