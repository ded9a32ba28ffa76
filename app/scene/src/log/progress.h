#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "thimble/driver/export.h"

namespace thimble::scene {

/// When the program shows the progress of long work, on standard error.
enum class ProgressChoice {
  kNever,       ///< Never; the default, so that libraries print nothing.
  kIfTerminal,  ///< As one line that is replaced, if standard error is a terminal.
  kAlways       ///< As that; without a terminal as separate lines.
};

/// Sets when this process shows progress; call it before work begins.
THIMBLE_EXPORT void choose_progress(ProgressChoice choice) noexcept;

/// Returns a duration (s) as text: "12 s", "3 min 20 s", "2 h 5 min".
THIMBLE_EXPORT std::string duration_text(double seconds);

/// The text of a progress and the times at which it is due. All times are those of the caller, in
/// seconds since the work began, and never decrease.
class THIMBLE_EXPORT ProgressMeter {
 public:
  enum class Form { kReplacedLine, kLines };

  /// `first`: share that was done earlier, 0 to 1. `width`: columns of the terminal.
  ProgressMeter(std::string name, Form form, std::size_t width, double first = 0);

  /// Returns the text to show at time `now`; none if none is due. `share`: share of the work that
  /// is done; NaN if it is unknown. The shown share never decreases. `state`: further text.
  std::optional<std::string> update(double share, std::string_view state, double now);

  /// Returns the last line of `Form::kLines`; none unless all work is done.
  std::optional<std::string> end(double share, double now);

  /// Returns the time left, s; none before 3 % and 2 s.
  std::optional<double> left(double now) const;

 private:
  void take(double share, double now);
  bool is_due(double now) const;

  std::string name_;
  Form form_;
  std::size_t width_;
  double first_;
  double share_;
  double at_ = 0;       // time of the last increase of the share
  bool known_ = false;  // whether the share is known
  std::optional<double> shown_at_;
  double shown_share_;
};

/// Shows the progress of long work until it is destroyed. A separate thread draws, so that the
/// caller only stores numbers, and the time left decreases during a long step. Shows nothing in the
/// first two seconds at a terminal, and nothing while another Progress of the process is shown.
/// Real-time: constructor, `set_state` and destructor never from the servo thread.
class THIMBLE_EXPORT Progress {
 public:
  /// `name`: the work, for example "replay". `first`: share that was done earlier.
  explicit Progress(std::string name, double first = 0);
  /// Removes the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Sets the share of the work that is done, 0 to 1; NaN: unknown. From any thread. Real-time:
  /// yes.
  void set_share(double share) noexcept { share_.store(share, std::memory_order_relaxed); }
  /// Sets the share to `done` of `all` steps.
  void set_share(std::size_t done, std::size_t all) noexcept {
    set_share(all > 0 ? static_cast<double>(done) / static_cast<double>(all) : 0);
  }
  /// Sets a text that follows the share, for example the present step.
  void set_state(std::string state);
  /// Returns whether this progress is shown, so that its state is worth computing.
  bool is_shown() const { return thread_.joinable(); }

 private:
  using Clock = std::chrono::steady_clock;

  void draw_until_ended();
  double now() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  std::atomic<double> share_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;  // guarded by mutex_, as state_ and meter_
  std::string state_;
  std::optional<ProgressMeter> meter_;
  bool on_terminal_ = false;
  Clock::time_point begin_;
  std::thread thread_;
};

}  // namespace thimble::scene
