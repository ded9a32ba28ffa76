#include "run_attendance.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "log/logger.h"
#include "setup.h"
#include "thimble/driver/heat_guard.h"

namespace thimble::session {

std::string run_state(const driver::TickRecord& record, double total) {
  const double force = Eigen::Map<const Eigen::Vector3d>(record.f_sent_W.data()).norm();
  return fmt::format("{:.1f} {}s   {:<8}  force {:5.2f} N   depth {:5.2f} mm",
                     static_cast<double>(record.time_ns) * 1e-9,
                     total > 0 ? fmt::format("of {:.1f} ", total) : "",
                     record.stage == driver::DeviceStage::kWaiting ? "not held"
                     : record.in_contact                           ? "touching"
                                                                   : "free",
                     force, record.depth * 1e3);
}

std::string HeatWarning::check(const driver::TickRecord& record) {
  const double heat = *std::max_element(record.heat.begin(), record.heat.end());
  if (given_ || !(heat >= driver::HeatGuard::kWarning)) return {};
  given_ = true;
  return fmt::format(
      "A motor is at {:.0f} % of its heat limit; the force is reduced until it cools. Press less "
      "hard or rest.",
      100 * heat);
}

void keep_black_boxes(Session& session, bool run_is_over) {
  const auto kept = session.keep_black_boxes(run_is_over);
  if (!kept) {
    scene::logger().error("{}", kept.error().message);
    return;
  }
  for (const auto& file : *kept) {
    scene::logger().warn("the last seconds before the fault are saved in {}", file.string());
  }
}

RunAttendance::RunAttendance(Session& session, ReplugWatches* watch, ViewerRequestHandler* handler,
                             bool shows_progress)
    : session_(session),
      watch_(watch),
      handler_(handler),
      total_(static_cast<double>(session.setup().ticks()) *
             static_cast<double>(session.setup().period_ns()) * 1e-9),
      withdrawn_(session.arms()) {
  if (shows_progress) progress_.emplace("run", total_ > 0 ? 0 : std::nan(""));
}

void RunAttendance::warn_of_compensation() {
  for (std::size_t arm = 0; arm < withdrawn_.size(); ++arm) {
    const std::uint64_t now = session_.carry_withdrawn(arm);
    if (now == withdrawn_[arm]) continue;
    withdrawn_[arm] = now;
    const std::string& arm_name = session_.arm_name(arm);
    scene::logger().warn(
        "{}Gravity compensation is switched off until the tip rests, because the tip moves along "
        "its force. If no hand moved it, correct gravity_compensation in the arm file: see "
        "`thimble identify`.",
        arm_name.empty() ? "" : arm_name + ": ");
  }
}

void RunAttendance::step() {
  if (watch_ != nullptr) watch_->step();
  if (handler_ != nullptr) handler_->step();
  keep_black_boxes(session_, false);
  warn_of_compensation();
  driver::TickRecord record;
  if (!session_.newest().load(record)) return;
  if (const std::string hot = heat_.check(record); !hot.empty()) {
    scene::logger().warn("{}", hot);
  }
  show(record);
}

void RunAttendance::show(const driver::TickRecord& record) {
  if (!progress_ || !progress_->is_shown()) return;
  const std::int64_t until_ns = record.time_ns + session_.setup().period_ns();
  if (total_ > 0) progress_->set_share(1e-9 * static_cast<double>(until_ns) / total_);
  progress_->set_state(run_state(record, total_));
}

void RunAttendance::clear() {
  driver::TickRecord last;
  if (session_.newest().load(last)) show(last);
  progress_.reset();
}

}  // namespace thimble::session
