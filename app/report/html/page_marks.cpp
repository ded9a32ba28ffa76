#include "report/html/page_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <utility>

#include "events/event_words.h"

namespace thimble::report {
namespace {

using session::Activity;
using session::EventKind;
using session::TickEvent;

PageMark::Kind kind_of(const TickEvent& event) noexcept {
  if (event.kind == EventKind::kFault) return PageMark::Kind::kFault;
  if (event.kind != EventKind::kActivityBegan && event.kind != EventKind::kActivityEnded) {
    return PageMark::Kind::kNote;
  }
  switch (event.activity) {
    case Activity::kSoftStart:
    case Activity::kForceCut:
    case Activity::kRiseCut:
    case Activity::kDamped:
    case Activity::kBounded:
    case Activity::kPower:
    case Activity::kCalmed:
    case Activity::kWall:
      return PageMark::Kind::kGate;
    case Activity::kMissedTicks:
    case Activity::kHeat:
    case Activity::kStall:
    case Activity::kRejected:
    case Activity::kJumped:
    case Activity::kRefused:
      break;
  }
  return PageMark::Kind::kWarning;
}

// Removes the time at the start of a log line, because the page shows the time itself.
std::string words_of(const TickEvent& event) {
  return session::words_of(event, {}).substr(session::at_tick(event.tick, event.time_ns).size());
}

// Numbered marks; the oldest may be discarded.
class MarkList {
 public:
  explicit MarkList(std::size_t max_marks = SIZE_MAX) : max_marks_(max_marks) {}

  std::uint64_t push(PageMark mark) {
    marks_.push_back(std::move(mark));
    if (marks_.size() > max_marks_) {
      marks_.pop_front();
      ++oldest_;
    }
    return end() - 1;
  }
  PageMark* at(std::uint64_t number) {
    return number >= oldest_ && number < end() ? &marks_[number - oldest_] : nullptr;
  }
  std::uint64_t oldest() const { return oldest_; }
  std::uint64_t end() const { return oldest_ + marks_.size(); }

 private:
  std::size_t max_marks_;
  std::deque<PageMark> marks_;
  std::uint64_t oldest_ = 0;
};

constexpr std::uint64_t kNone = UINT64_MAX;

using OpenMarks =
    std::array<std::uint64_t, session::kActivities>;  // the marks of current activities

// An activity has two events, its begin and its end, but only one mark. Returns its number; kNone
// for a touch, which has none.
std::uint64_t add(const TickEvent& event, MarkList& marks, OpenMarks& open_marks) {
  if (event.kind == EventKind::kTouchBegan || event.kind == EventKind::kTouchEnded) return kNone;
  auto& open = open_marks[static_cast<std::size_t>(event.activity)];
  if (event.kind == EventKind::kActivityEnded && open != kNone) {
    const std::uint64_t number = std::exchange(open, kNone);
    PageMark* mark = marks.at(number);
    if (mark == nullptr) return kNone;
    mark->end_ns = mark->begin_ns + event.lasted_ns;
    mark->words = words_of(event);
    return number;
  }
  const std::uint64_t number =
      marks.push({event.time_ns, event.time_ns, kind_of(event), words_of(event)});
  if (event.kind == EventKind::kActivityBegan) open = number;
  return number;
}

std::vector<PageMark> drain(session::SpscRing<TickEvent>& ring) {
  MarkList list;
  OpenMarks open_marks;
  open_marks.fill(kNone);
  for (auto events = ring.front(); !events.empty(); events = ring.front()) {
    for (const TickEvent& event : events) add(event, list, open_marks);
    ring.drop(events.size());
  }
  std::vector<PageMark> marks;
  for (std::uint64_t i = 0; i < list.end(); ++i) marks.push_back(*list.at(i));
  return marks;
}

void add_lost_mark(std::uint64_t lost, std::vector<PageMark>& marks) {
  if (lost == 0 || marks.empty()) return;
  marks.push_back({marks.back().end_ns, marks.back().end_ns, PageMark::Kind::kWarning,
                   fmt::format("{} more events are not shown on this page.", lost)});
}

// Counters that recordings do not contain; always zero.
class NoCounters final : public session::EventCounters {
 public:
  std::uint64_t changes() const noexcept override { return 0; }
  session::ActivityCounts activities() const noexcept override { return {}; }
  std::uint64_t links_replaced() const noexcept override { return 0; }
};

bool gate_acted(const driver::TickRecord& tick) noexcept {
  if (tick.stage != driver::DeviceStage::kActive) return false;
  double max_difference = 0, along = 0, sent = 0, off = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double difference = tick.f_sent_W[k] - tick.f_wanted_W[k];
    max_difference = std::max(max_difference, std::abs(difference));
    along += difference * tick.f_sent_W[k];
    sent += tick.f_sent_W[k] * tick.f_sent_W[k];
    off += difference * difference;
  }
  if (!(max_difference > 1e-6)) return false;  // N: rounding errors of the arm's frames are smaller
  // An arm with one or two motors gives the projection of the force, so the rest is at a right
  // angle to it. That is no effect of the gate.
  return !(sent > 0 && along * along <= 1e-18 * sent * off);
}

// Intervals in which the gate changed the force, merged across gaps of up to EventWatch::kQuiet_ns.
class GateTimes {
 public:
  /// Takes a tick. Returns whether it belongs to the interval of `mark`.
  bool take(const driver::TickRecord& tick) {
    if (!gate_acted(tick)) return false;
    began_ = count_ == 0 || tick.time_ns - newest_ns_ > session::EventWatch::kQuiet_ns;
    if (began_) {
      count_ = 0;
      begin_ns_ = tick.time_ns;
    }
    ++count_;
    newest_ns_ = tick.time_ns;
    return true;
  }
  /// Returns whether that interval began with its last tick.
  bool began() const { return began_; }
  PageMark mark() const {
    return {
        begin_ns_, newest_ns_, PageMark::Kind::kGate,
        fmt::format("The sent force differed from the requested force, {} tick{} within {:.3f} s.",
                    count_, count_ == 1 ? "" : "s",
                    1e-9 * static_cast<double>(newest_ns_ - begin_ns_))};
  }

 private:
  bool began_ = false;
  std::uint64_t count_ = 0;
  std::int64_t begin_ns_ = 0, newest_ns_ = 0;
};

void add_gate(std::span<const driver::TickRecord> ticks, std::vector<PageMark>& marks) {
  GateTimes times;
  bool any = false;
  for (const driver::TickRecord& tick : ticks) {
    const GateTimes before = times;
    if (!times.take(tick)) continue;
    if (any && times.began()) marks.push_back(before.mark());
    any = true;
  }
  if (any) marks.push_back(times.mark());
}

}  // namespace

const char* name_of(PageMark::Kind kind) noexcept {
  switch (kind) {
    case PageMark::Kind::kFault:
      return "fault";
    case PageMark::Kind::kWarning:
      return "warning";
    case PageMark::Kind::kGate:
      return "gate";
    case PageMark::Kind::kNote:
      break;
  }
  return "note";
}

EventKeeper::EventKeeper(const driver::Device& device, std::int64_t period_ns)
    : counters_(device), watch_(counters_, period_ns, ring_) {}

std::vector<PageMark> EventKeeper::finish() {
  watch_.finish();
  auto marks = drain(ring_);
  add_lost_mark(watch_.lost(), marks);
  return marks;
}

std::vector<PageMark> marks_of_ticks(std::span<const driver::TickRecord> ticks,
                                     std::int64_t period_ns) {
  const NoCounters counters;
  const auto ring = std::make_unique<session::SpscRing<TickEvent>>(EventKeeper::kEventsMax);
  session::EventWatch watch(counters, std::max<std::int64_t>(1, period_ns), *ring);
  for (const driver::TickRecord& tick : ticks) watch.take(tick);
  watch.finish();
  auto marks = drain(*ring);
  add_lost_mark(watch.lost(), marks);
  add_gate(ticks, marks);
  std::stable_sort(marks.begin(), marks.end(),
                   [](const PageMark& a, const PageMark& b) { return a.begin_ns < b.begin_ns; });
  return marks;
}

struct LiveMarks::Parts {
  explicit Parts(std::int64_t period_ns)
      : watch(counters, std::max<std::int64_t>(1, period_ns), ring) {
    open_marks.fill(kNone);
  }

  NoCounters counters;
  session::SpscRing<TickEvent> ring{64};  // a tick has fewer events
  session::EventWatch watch;
  MarkList marks{kMax};
  OpenMarks open_marks{};
  GateTimes gate;
  std::uint64_t gate_mark = kNone;
};

LiveMarks::LiveMarks(std::int64_t period_ns) : parts_(std::make_unique<Parts>(period_ns)) {}

LiveMarks::~LiveMarks() = default;

std::vector<std::uint64_t> LiveMarks::take(std::span<const driver::TickRecord> ticks) {
  Parts& parts = *parts_;
  std::vector<std::uint64_t> changed;
  bool gate_changed = false;
  for (const driver::TickRecord& tick : ticks) {
    parts.watch.take(tick);
    for (auto events = parts.ring.front(); !events.empty(); events = parts.ring.front()) {
      for (const TickEvent& event : events) {
        const std::uint64_t number = add(event, parts.marks, parts.open_marks);
        if (number != kNone) changed.push_back(number);
      }
      parts.ring.drop(events.size());
    }
    if (!parts.gate.take(tick)) continue;
    if (parts.gate.began()) {
      parts.gate_mark = parts.marks.push(parts.gate.mark());
      changed.push_back(parts.gate_mark);
    } else if (PageMark* mark = parts.marks.at(parts.gate_mark)) {
      mark->end_ns = tick.time_ns;
      gate_changed = true;
    }
  }
  // Its text changes with every tick, so it is updated once after all of these.
  if (gate_changed) {
    if (PageMark* mark = parts.marks.at(parts.gate_mark)) *mark = parts.gate.mark();
    changed.push_back(parts.gate_mark);
  }
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  return changed;
}

const PageMark* LiveMarks::mark(std::uint64_t number) const noexcept {
  return parts_->marks.at(number);
}
std::uint64_t LiveMarks::oldest() const noexcept {
  return parts_->marks.oldest();
}
std::uint64_t LiveMarks::end() const noexcept {
  return parts_->marks.end();
}

}  // namespace thimble::report
