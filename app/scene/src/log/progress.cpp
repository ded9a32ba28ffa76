#include "log/progress.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "log/console.h"

namespace thimble::scene {
namespace {

constexpr double kQuietTime = 2;      // s, work below it shows nothing at a terminal [chosen]
constexpr double kRedrawEvery = 0.2;  // s [chosen: five times a second can be read]
constexpr double kLineEvery = 1;      // s, min. between separate lines [chosen]
constexpr int kLineShares = 10;       // shares that are worth a separate line [chosen]
constexpr double kLineAtLatest = 30;  // s [chosen: build servers end silent jobs after minutes]
constexpr double kEstimateShare = 0.03, kEstimateTime = 2;  // before an estimate [chosen]
constexpr double kShareRounding = 1e-9;  // of a quotient of sums [chosen: far above its rounding]
constexpr double kAllDone = 1 - kShareRounding;
constexpr std::size_t kBarWidth = 24;    // characters [chosen]
constexpr std::size_t kUsualWidth = 80;  // of a terminal that does not report it

std::atomic<ProgressChoice> progress_choice{ProgressChoice::kNever};
std::atomic<const Progress*> shown_progress{nullptr};

bool stderr_is_terminal() {
  const char* const kind = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && !(kind != nullptr && std::string_view(kind) == "dumb");
}

std::size_t terminal_width() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : kUsualWidth;
}

/// Returns the text without its end, at most `max` bytes and no partial UTF-8 character.
std::string cut_to_fit(std::string text, std::size_t max) {
  if (text.size() <= max) return text;
  while (max > 0 && (static_cast<unsigned char>(text[max]) & 0xc0) == 0x80) --max;
  text.resize(max);
  return text;
}

/// Returns how many of `parts` equal parts are done.
int whole_parts(double share, int parts) {
  return static_cast<int>(parts * share + kShareRounding);  // 0.29 is 29 %
}

}  // namespace

void choose_progress(ProgressChoice choice) noexcept {
  progress_choice.store(choice);
}

std::string duration_text(double seconds) {
  // Written so that NaN is 0.
  const auto whole = seconds > 0 ? std::llround(std::min(seconds, 3.6e9)) : 0LL;
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  const auto minutes = (whole + 30) / 60;
  if (minutes < 60) return fmt::format("{} min", minutes);
  return fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

ProgressMeter::ProgressMeter(std::string name, Form form, std::size_t width, double first)
    : name_(std::move(name)),
      form_(form),
      width_(width),
      first_(first > 0 ? std::min(first, 1.0) : 0),
      share_(first_),
      shown_share_(first_) {}

void ProgressMeter::take(double share, double now) {
  known_ = known_ || share >= 0;
  if (!(share > share_)) return;
  share_ = std::min(share, 1.0);
  at_ = now;
}

bool ProgressMeter::is_due(double now) const {
  if (form_ == Form::kReplacedLine) {
    return now >= kQuietTime && (!shown_at_ || now - *shown_at_ >= kRedrawEvery);
  }
  const double since = now - shown_at_.value_or(0);
  if (share_ >= kAllDone) return false;  // `end` has that line
  return since >= kLineAtLatest ||
         (since >= kLineEvery &&
          whole_parts(share_, kLineShares) > whole_parts(shown_share_, kLineShares));
}

std::optional<double> ProgressMeter::left(double now) const {
  const double gained = share_ - first_;
  if (!(gained >= kEstimateShare) || !(at_ >= kEstimateTime)) return std::nullopt;
  return std::max(0.0, at_ * (1 - share_) / gained - (now - at_));
}

std::optional<std::string> ProgressMeter::update(double share, std::string_view state, double now) {
  take(share, now);
  if (!is_due(now)) return std::nullopt;
  shown_at_ = now;
  shown_share_ = share_;
  std::string text;
  if (known_) text = fmt::format("{} %", whole_parts(share_, 100));
  if (const auto rest = left(now)) text += ", " + duration_text(*rest) + " left";
  if (!state.empty()) text += (text.empty() ? "" : "  ") + std::string(state);
  if (form_ == Form::kLines) return name_ + ": " + text;
  std::string bar;
  if (known_) {
    const auto full = static_cast<std::size_t>(static_cast<double>(kBarWidth) * share_);
    bar = '[' + std::string(full, '#') + std::string(kBarWidth - full, '.') + "] ";
  }
  // A line of the full width would wrap at some terminals, and could not be erased.
  const std::size_t room = width_ > 0 ? width_ - 1 : 0;
  const std::string head = name_ + "  ";
  const bool bar_fits = head.size() + bar.size() + text.size() <= room;
  return cut_to_fit(head + (bar_fits ? bar : std::string()) + text, room);
}

std::optional<std::string> ProgressMeter::end(double share, double now) {
  take(share, now);
  if (form_ != Form::kLines || !(share_ >= kAllDone)) return std::nullopt;
  return name_ + ": 100 %, took " + duration_text(now);
}

Progress::Progress(std::string name, double first) : share_(first), begin_(Clock::now()) {
  const ProgressChoice choice = progress_choice.load();
  if (choice == ProgressChoice::kNever) return;
  on_terminal_ = stderr_is_terminal();
  if (!on_terminal_ && choice != ProgressChoice::kAlways) return;
  const Progress* none = nullptr;
  if (!shown_progress.compare_exchange_strong(none, this)) return;
  meter_.emplace(std::move(name),
                 on_terminal_ ? ProgressMeter::Form::kReplacedLine : ProgressMeter::Form::kLines,
                 terminal_width(), first);
  try {
    thread_ = std::thread([this] { draw_until_ended(); });
  } catch (const std::system_error&) {
    shown_progress.store(nullptr);  // too many threads: an arm may be open, and needs no progress
  }
}

Progress::~Progress() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_one();
  thread_.join();
  if (on_terminal_) {
    console().show("");
  } else if (const auto last = meter_->end(share_.load(), now())) {
    console().write(*last);
  }
  shown_progress.store(nullptr);
}

void Progress::set_state(std::string state) {
  const std::lock_guard lock(mutex_);
  state_ = std::move(state);
}

void Progress::draw_until_ended() {
  // The thread that begins real work may have real-time priority, which this one must not inherit.
  const sched_param ordinary{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &ordinary);
  std::unique_lock lock(mutex_);
  const auto every = std::chrono::duration<double>(kRedrawEvery / 2);
  while (!changed_.wait_for(lock, every, [this] { return ended_; })) {
    const auto text = meter_->update(share_.load(std::memory_order_relaxed), state_, now());
    if (!text) continue;
    if (on_terminal_) {
      console().show(*text);
    } else {
      console().write(*text);
    }
  }
}

}  // namespace thimble::scene
