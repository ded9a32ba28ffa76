#pragma once

#include <string>

namespace thimble::view {

/// What the start window, or a window on the runs of other processes, shows.
enum class StartStage {
  kWaiting,   ///< A page, until a run of another process can be shown.
  kChoosing,  ///< The cards.
  kStarting,  ///< The cards, while a run is started.
  kShown,     ///< A run, also after its end, or a recording.
};

/// The course of the start window: choosing, starting, showing, again. A run that does not start
/// leads back to the cards with its error, so that the window is never without content.
class StartFlow {
 public:
  /// Returns the course of a window that first waits for a run of another process.
  static StartFlow waiting();

  StartStage stage() const { return stage_; }
  /// Returns whether the shown run has ended, and can be started again.
  bool ended() const { return ended_; }
  /// Returns the message to show with the cards; empty: none.
  const std::string& message() const { return message_; }
  void set_message(std::string message) { message_ = std::move(message); }

  /// Reports whether the shown run, of another process, has ended and its name is free. Ignored
  /// while a process that this window started runs.
  void other_run_over(bool over);
  /// The process of a run was started.
  void run_started();
  /// The run, or a recording, can be shown.
  void shown();
  /// The process of the run has ended, with its exit code and its text on standard error.
  void run_ended(int code, const std::string& errors);
  /// The user returns to the cards. Returns whether a run that was started must be ended.
  bool back();
  /// The user restarts an ended run. Returns whether its process must be started.
  bool run_again();

 private:
  StartStage stage_ = StartStage::kChoosing;
  bool running_ = false;
  bool ended_ = false;
  std::string message_;
};

/// Returns the last line of a text that is not blank, without the name of the program before it.
std::string last_line(const std::string& text);

}  // namespace thimble::view
