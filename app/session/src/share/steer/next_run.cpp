#include "share/steer/next_run.h"

#include <utility>
#include <vector>

#include "log/logger.h"
#include "setup.h"
#include "share/shared_run.h"
#include "thimble/scene/scene_file.h"

namespace thimble::session {

void NextRun::begin(Session& session) {
  end_.store(false);
  session_ = nullptr;
  if (session.shared() == nullptr || session.setup().any_real()) return;
  session_ = &session;
  scene_ = session.setup().scene_path();
  last_order_ = 0;
  session.shared()->set_pace(speed_, loop_);
  if (!reload_) return;
  std::vector<std::filesystem::path> files{scene_, session.scene().arm_file};
  for (const scene::SceneArm& arm : session.scene().more_arms) files.push_back(arm.arm_file);
  files_ = FileWatch(files);
}

bool NextRun::prepare(const std::filesystem::path& scene) {
  auto prepared = prepare_(scene);
  if (prepared) {
    next_ = std::move(prepared).value();
    end_.store(true);
    return true;
  }
  scene::logger().error("{}", prepared.error().message);
  session_->shared()->set_notice(prepared.error().message);
  return false;
}

void NextRun::step(bool stop) {
  if (stop) end_.store(true);
  if (session_ == nullptr || end_.load()) return;
  SharedRun& shared = *session_->shared();
  loop_ = shared.loop_asked();
  speed_ = shared.speed_wanted().value_or(speed_);
  if (const auto order = shared.restart_order_after(last_order_)) {
    last_order_ = order->number;
    scene::logger().info("A viewer asks for {}.",
                         order->scene.empty() ? "the run from its first tick" : order->scene);
    if (prepare(order->scene.empty() ? scene_ : std::filesystem::path(order->scene))) return;
  }
  if (!reload_ || !files_.step()) return;
  if (files_.as_at_first()) {  // what runs lies there again
    shared.set_notice("");
    return;
  }
  scene::logger().info("{} or its arm's file has changed.", scene_.string());
  prepare(scene_);
}

std::unique_ptr<Session> NextRun::take(driver::ServoEnd end, bool stop) {
  if (stop || session_ == nullptr) return nullptr;
  loop_ = session_->shared()->loop_asked();
  // After a fault somebody is to look first.
  if (!next_ && loop_ && end == driver::ServoEnd::kDone && !prepare(scene_)) return nullptr;
  session_ = nullptr;
  return std::move(next_);
}

}  // namespace thimble::session
