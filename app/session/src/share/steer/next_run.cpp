#include "share/steer/next_run.h"

#include <utility>
#include <vector>

#include "log/logger.h"
#include "setup.h"
#include "share/shared_run.h"
#include "thimble/scene/scene_file.h"

namespace thimble::session {
namespace {

// Follows the error of a scene that cannot be used.
constexpr const char* kContinues = "The run continues with the scene as it was read before.";

}  // namespace

void NextRun::begin(Session& session) {
  end_.store(false);
  session_ = nullptr;
  if (session.shared() == nullptr || session.setup().any_real()) return;
  session_ = &session;
  scene_ = session.setup().scene_path();
  last_request_ = 0;
  session.shared()->set_pace(speed_, loop_);
  if (pause_) session.shared()->begin_paused();
  pause_ = false;
  session.shared()->set_notice(notice_);
  notice_.clear();
  if (!reload_) return;
  std::vector<std::filesystem::path> files{scene_};
  for (const scene::SceneArm& arm : session.scene().arms) files.push_back(arm.arm_file);
  files_ = FileWatch(files);
}

bool NextRun::prepare(const std::filesystem::path& scene, bool continues) {
  auto prepared = prepare_(scene);
  if (prepared) {
    next_ = std::move(prepared).value();
    notice_.clear();
    last_error_.clear();
    return true;
  }
  const std::string& error = prepared.error().message;
  notice_ = continues ? error + ' ' + kContinues : error;
  session_->shared()->set_notice(notice_);
  // A loop tries the same file after each run.
  if (error == last_error_) return false;
  last_error_ = error;
  scene::logger().error("{}", error);
  if (continues) scene::logger().warn("{}", kContinues);
  return false;
}

/// Prepares the scene as the current run has read it. Returns whether it succeeded.
bool NextRun::prepare_as_read() {
  auto prepared = Session::prepare_like(*session_, session_->setup().seed());
  if (!prepared) {
    scene::logger().error("The loop ends, because the scene cannot be built again as it was: {}",
                          prepared.error().message);
    return false;
  }
  next_ = std::move(prepared).value();
  return true;
}

/// Prepares the run that a viewer has requested since the last check, if any. Returns whether it
/// succeeded. `continues`: as of `prepare`.
bool NextRun::prepare_requested(bool continues) {
  const auto order = session_->shared()->restart_request_after(last_request_);
  if (!order) return false;
  last_request_ = order->number;
  scene::logger().info("A viewer requests {}.", order->scene.empty() ? "a restart" : order->scene);
  return prepare(order->scene.empty() ? scene_ : std::filesystem::path(order->scene), continues);
}

/// Prepares the scene again if its files have changed. Returns whether it succeeded.
bool NextRun::prepare_changed() {
  if (!reload_ || !files_.step()) return false;
  if (files_.as_at_first()) {  // the files are as in the current run again
    session_->shared()->set_notice("");
    last_error_.clear();
    return false;
  }
  scene::logger().info("{} or the file of its arm has changed.", scene_.string());
  return prepare(scene_, true);
}

void NextRun::update_pace() {
  loop_ = session_->shared()->loop_asked();
  speed_ = session_->shared()->speed_wanted().value_or(speed_);
}

void NextRun::step(bool stop) {
  if (stop) end_.store(true);
  if (session_ == nullptr || end_.load()) return;
  update_pace();
  if (!prepare_requested(true) && !prepare_changed()) return;
  session_->shared()->close();
  prepare_requested(false);  // a request made during the preparation
  end_.store(true);
}

std::unique_ptr<Session> NextRun::take(driver::ServoEnd end, bool stop) {
  if (stop || session_ == nullptr) return nullptr;
  SharedRun& shared = *session_->shared();
  shared.close();
  update_pace();
  if (shared.stop_asked()) return nullptr;
  // After a fault the run is not restarted, so that the user checks the cause first.
  const bool fault = end == driver::ServoEnd::kFault;
  if (fault && shared.restart_request_after(last_request_)) {
    shared.set_notice(
        "The run is not restarted because it ended with a fault; check the fault first.");
  }
  const bool loops = loop_ && end == driver::ServoEnd::kDone;
  if (!fault) prepare_requested(loops);
  pause_ = end == driver::ServoEnd::kDone && shared.pause_asked();
  if (!next_ && loops && !prepare(scene_, true) && !prepare_as_read()) {
    failed_ = true;
    return nullptr;
  }
  session_ = nullptr;
  return std::move(next_);
}

}  // namespace thimble::session
