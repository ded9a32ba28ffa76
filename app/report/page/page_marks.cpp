#include "report/page/page_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

#include "events/event_words.h"

namespace thimble::app {
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

// Takes away what a line of the log begins with: a page says when by itself.
std::string words_of(const TickEvent& event) {
  return session::words_of(event, {}).substr(session::at_tick(event.tick, event.time_ns).size());
}

// An activity is told twice, when it begins and when it is over: that is one mark.
void add(const TickEvent& event, std::vector<PageMark>& marks,
         std::array<std::size_t, session::kActivities>& going_on) {
  if (event.kind == EventKind::kTouchBegan || event.kind == EventKind::kTouchEnded) return;
  auto& open = going_on[static_cast<std::size_t>(event.activity)];
  if (event.kind == EventKind::kActivityEnded && open < marks.size()) {
    marks[open].end_ns = marks[open].begin_ns + event.lasted_ns;
    marks[open].words = words_of(event);
    open = SIZE_MAX;
    return;
  }
  if (event.kind == EventKind::kActivityBegan) open = marks.size();
  marks.push_back({event.time_ns, event.time_ns, kind_of(event), words_of(event)});
}

std::vector<PageMark> drain(session::SpscRing<TickEvent>& ring) {
  std::vector<PageMark> marks;
  std::array<std::size_t, session::kActivities> going_on;
  going_on.fill(SIZE_MAX);
  for (auto events = ring.front(); !events.empty(); events = ring.front()) {
    for (const TickEvent& event : events) add(event, marks, going_on);
    ring.drop(events.size());
  }
  return marks;
}

void tell_of_lost(std::uint64_t lost, std::vector<PageMark>& marks) {
  if (lost == 0 || marks.empty()) return;
  marks.push_back({marks.back().end_ns, marks.back().end_ns, PageMark::Kind::kWarning,
                   fmt::format("{} more events found no room on this page.", lost)});
}

// What no recording keeps did not happen, as far as it tells.
class NoCounters final : public session::EventCounters {
 public:
  std::uint64_t changes() const noexcept override { return 0; }
  session::ActivityCounts activities() const noexcept override { return {}; }
  std::uint64_t wires_taken() const noexcept override { return 0; }
};

bool gate_acted(const driver::TickRecord& tick) noexcept {
  if (tick.stage != driver::DeviceStage::kActive) return false;
  double most = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    most = std::max(most, std::abs(tick.f_sent_W[k] - tick.f_wanted_W[k]));
  }
  return most > 1e-6;  // N: what the frames of the arm round is less
}

void add_gate(std::span<const driver::TickRecord> ticks, std::vector<PageMark>& marks) {
  std::uint64_t count = 0;
  std::int64_t begin_ns = 0, newest_ns = 0;
  const auto end = [&] {
    if (count == 0) return;
    marks.push_back({begin_ns, newest_ns, PageMark::Kind::kGate,
                     fmt::format("The force sent was not the one asked for, {} tick{} within "
                                 "{:.3f} s.",
                                 count, count == 1 ? "" : "s",
                                 1e-9 * static_cast<double>(newest_ns - begin_ns))});
    count = 0;
  };
  for (const driver::TickRecord& tick : ticks) {
    if (count > 0 && tick.time_ns - newest_ns > session::EventWatch::kQuiet_ns) end();
    if (!gate_acted(tick)) continue;
    if (count++ == 0) begin_ns = tick.time_ns;
    newest_ns = tick.time_ns;
  }
  end();
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
  tell_of_lost(watch_.lost(), marks);
  return marks;
}

std::vector<PageMark> marks_of_ticks(std::span<const driver::TickRecord> ticks,
                                     std::int64_t period_ns) {
  const NoCounters counters;
  const auto ring = std::make_unique<session::SpscRing<TickEvent>>(EventKeeper::kEventsMost);
  session::EventWatch watch(counters, std::max<std::int64_t>(1, period_ns), *ring);
  for (const driver::TickRecord& tick : ticks) watch.take(tick);
  watch.finish();
  auto marks = drain(*ring);
  tell_of_lost(watch.lost(), marks);
  add_gate(ticks, marks);
  std::stable_sort(marks.begin(), marks.end(),
                   [](const PageMark& a, const PageMark& b) { return a.begin_ns < b.begin_ns; });
  return marks;
}

}  // namespace thimble::app
