#include "events/event_log.h"

#include <exception>
#include <utility>

#include "events/event_words.h"
#include "log/logger.h"
#include "text/counted.h"

namespace thimble::session {
namespace {

// Chosen: short enough for a user who follows the log.
constexpr std::chrono::milliseconds kCheckInterval(50);

}  // namespace

EventLog::EventLog(LoggedRun run, const driver::Device& device)
    : run_(std::move(run)),
      device_(device),
      log_(scene::run_logger(run_.name)),
      clock_began_(std::chrono::system_clock::now() - std::chrono::nanoseconds(run_.now_ns)),
      counters_(device),
      watch_(counters_, run_.period_ns, ring_) {
  log_->info("The arm is open: {}.", run_.what);
  if (!run_.limits.empty()) log_->info("{}", run_.limits);
  if (!run_.real_time) return;
  writer_ = std::thread([this] {
    while (!stop_.load()) {
      serve();
      std::this_thread::sleep_for(kCheckInterval);
    }
  });
}

EventLog::~EventLog() {
  stop_.store(true);
  if (writer_.joinable()) writer_.join();
  serve();  // Makes room for the events of `finish`.
  watch_.finish();
  serve();
  if (device_.zero_assured()) {
    log_->info("The run is over; the arm accepted zero force.");
  } else {
    log_->warn(
        "The run is over, but the arm did not accept zero force: its watchdog must switch the "
        "motors off. Keep clear of it.");
  }
}

void EventLog::take(const driver::TickRecord& record) noexcept {
  watch_.take(record);
  if (!run_.real_time) serve();
}

void EventLog::serve() noexcept {
  try {
    // Two rounds, because events that wrap around the end of the ring are in two pieces.
    for (int piece = 0; piece < 2; ++piece) {
      const auto events = ring_.front();
      if (events.empty()) break;
      for (const TickEvent& event : events) write(event);
      ring_.drop(events.size());
    }
    const std::uint64_t lost = watch_.lost();
    if (lost == lost_reported_) return;
    log_->warn("{} lost because the log could not keep up.",
               scene::counted(lost - lost_reported_, "event") +
                   (lost - lost_reported_ == 1 ? " was" : " were"));
    lost_reported_ = lost;
  } catch (const std::exception&) {
    // Out of memory: drops the events. An event that cannot be logged must not end the run.
    ring_.drop(ring_.front().size());
  }
}

void EventLog::write(const TickEvent& event) {
  const auto level = level_of(event);
  if (!log_->should_log(level)) return;
  const std::string words = words_of(event, run_.objects);
  if (is_notice(event)) {
    bool& given = given_[event.kind == EventKind::kForceChanged ? 1 : 0]
                        [static_cast<std::size_t>(event.activity)];
    if (!given) scene::logger().warn("{}: {}", run_.name, words);
    given = true;
  }
  if (!run_.real_time) return log_->log(level, words);
  using std::chrono::system_clock;
  const auto when = clock_began_ + std::chrono::nanoseconds(event.time_ns);
  log_->log(std::chrono::time_point_cast<system_clock::duration>(when), {}, level, words);
}

}  // namespace thimble::session
