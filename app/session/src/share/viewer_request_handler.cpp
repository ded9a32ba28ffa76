#include "share/viewer_request_handler.h"

#include <unistd.h>

#include <ctime>
#include <utility>

#include "events/event_words.h"
#include "log/logger.h"
#include "output/output_file.h"
#include "recording/recording_layout.h"
#include "run_records.h"
#include "setup.h"
#include "signals.h"
#include "thimble/scene/scene_file.h"

namespace thimble::session {
namespace {

/// Returns a file name made of the scene and the time.
std::string recording_name(const std::string& scene) {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char time[32];
  std::strftime(time, sizeof time, "-%Y%m%d-%H%M%S.h5", &local);
  return run_name_of(scene) + time;
}

/// Fails if a recording cannot be started under this name.
driver::Result<void> check_new_recording(const Session& session, const std::string& path) {
  for (std::size_t arm = 0; arm < session.arms(); ++arm) {
    const auto file = file_of_arm(path, session.arm_name(arm));
    const auto place = output::resolve_output(file);
    if (!place) return place.error();
    auto may = output::check_replaceable(file, *place, kRecordingOutput, false);
    if (!may) return may;
  }
  return {};
}

}  // namespace

void ViewerRequestHandler::record(const SharedRun::RecordRequest& order) {
  last_request_ = order.number;
  const std::string path = order.path.empty() ? recording_name(session_.scene().name) : order.path;
  if (order.record) {
    // Checked before the current recording is ended.
    if (auto may = check_new_recording(session_, path); !may) {
      return scene::logger().error("{}", may.error().message);
    }
  }
  if (auto stopped = session_.end_recording(); !stopped) {
    scene::logger().error("{}", stopped.error().message);
  }
  if (!order.record) return;
  if (auto begun = session_.begin_recording(path); !begun) {
    scene::logger().error("{}", begun.error().message);
  }
}

void ViewerRequestHandler::handle_record_requests() {
  if (const auto order = session_.shared()->record_request_after(last_request_)) record(*order);
}

void ViewerRequestHandler::handle_stop_request() {
  const bool closed = viewer_ && viewer_->closed();
  if (closed && !ends_with_viewer_ && next_ != nullptr && next_->loops()) {
    viewer_.reset();  // so that the user is informed only once
    scene::logger().warn(
        "The window is closed; the run continues and restarts until Ctrl-C. `thimble view {}` "
        "shows it again.",
        session_.shared()->name());
  }
  if (!session_.shared()->stop_asked() && !(closed && ends_with_viewer_)) return;
  if (!ended_) scene::logger().info("The run was ended by a viewer.");
  ended_ = true;
  scene::ask_to_stop();
}

void ViewerRequestHandler::step() {
  SharedRun& shared = *session_.shared();
  const RecordingSwitch& recording = session_.records().recording;
  if (shared.watch_viewers()) {
    scene::logger().warn("The viewer that paused the run has died; the run continues.");
    watch_.forget_pause();
  }
  driver::TickRecord newest;
  if (session_.newest().load(newest)) watch_.step(at_tick(newest.tick, newest.time_ns));
  handle_record_requests();
  shared.set_recording(recording.on(), recording.dropped());
  handle_stop_request();
  if (next_ == nullptr) return;
  next_->step(scene::stop_asked());
  if (shared.closed()) handle_record_requests();  // requests made before the run was closed
}

void ViewerRequestHandler::close() {
  SharedRun& shared = *session_.shared();
  shared.close();
  handle_stop_request();
  const auto order = shared.record_request_after(last_request_);
  if (!order || !order->record) return;
  const std::string message = "No recording was started: the run had already ended.";
  scene::logger().error("{}", message);
  shared.set_notice(message);
}

std::unique_ptr<ViewerRequestHandler> open_viewer_requests(
    Session& session, ViewerChoice choice, bool ends_with_viewer,
    const std::vector<std::string>& arguments, NextRun* next) {
  if (session.shared() == nullptr) return nullptr;
  std::unique_ptr<ViewerProcess> viewer;
  const bool watchable = session.real_time() || session.setup().paced();
  if (opens_viewer(choice, watchable, has_display(), isatty(STDERR_FILENO) != 0)) {
    auto started = ViewerProcess::start(session.shared()->name(), arguments);
    if (started) {
      viewer = std::move(started).value();
    } else {
      scene::logger().error("{}", started.error().message);
    }
  } else if (choice == ViewerChoice::kAsked && scene::verbosity() != scene::Verbosity::kQuiet) {
    scene::terminal().info("No display (DISPLAY, WAYLAND_DISPLAY): watch with `thimble view {}`.",
                           session.shared()->name());
  }
  return std::make_unique<ViewerRequestHandler>(session, std::move(viewer), ends_with_viewer, next);
}

}  // namespace thimble::session
