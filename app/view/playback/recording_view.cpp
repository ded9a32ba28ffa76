#include "view/playback/recording_view.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "recording/replay_watch.h"
#include "share/describe_scene.h"
#include "text/counted.h"
#include "view/drawn_from_shared.h"

namespace thimble::view {
namespace {

std::int64_t in_ns(double time) {
  return std::llround(1e9 * time);
}

// Returns the last of some times that is no later than `time_ns`, or the first.
template <class Times, class Key>
std::size_t place_of(const Times& times, std::int64_t time_ns, const Key& key) {
  const auto after =
      std::upper_bound(times.begin(), times.end(), time_ns,
                       [&](std::int64_t time, const auto& one) { return time < key(one); });
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - times.begin() - 1));
}

std::size_t tick_at(const std::vector<driver::TickRecord>& ticks, std::int64_t time_ns) {
  return place_of(ticks, time_ns, [](const auto& tick) { return tick.time_ns; });
}

Eigen::Quaterniond turn_of(const render::BodyPose& pose) {
  const auto& q = pose.q_WB;
  return {q[0], q[1], q[2], q[3]};
}

render::BodyPose between(const render::BodyPose& a, const render::BodyPose& b, double share) {
  render::BodyPose pose;
  for (std::size_t k = 0; k < 3; ++k) pose.p_WB[k] = std::lerp(a.p_WB[k], b.p_WB[k], share);
  const Eigen::Quaterniond q = turn_of(a).slerp(share, turn_of(b)).normalized();
  pose.q_WB = {q.w(), q.x(), q.y(), q.z()};
  return pose;
}

}  // namespace

driver::Result<std::vector<session::Recording>> read_recordings(
    const std::vector<std::filesystem::path>& files) {
  std::vector<session::Recording> recordings;
  for (const std::filesystem::path& file : files) {
    auto read = session::read_recording(file);
    if (!read) return read.error();
    if (read->ticks.empty()) {
      return driver::Error{file.string() + ": the recording has no ticks."};
    }
    recordings.push_back(std::move(read).value());
  }
  return recordings;
}

driver::Result<std::unique_ptr<RecordingView>> RecordingView::open(
    const std::vector<std::filesystem::path>& files) {
  auto recordings = read_recordings(files);
  if (!recordings) return recordings.error();
  return of(std::move(recordings).value());
}

driver::Result<std::unique_ptr<RecordingView>> RecordingView::of(
    std::vector<session::Recording> recordings) {
  std::unique_ptr<RecordingView> view(new RecordingView);
  view->arms_ = std::move(recordings);
  if (auto touched = view->touch_again(); !touched) return touched.error();
  return view;
}

driver::Result<void> RecordingView::touch_again() {
  const auto replays = session::replay_together(arms_, {}, &film_);
  if (!replays) return replays.error();
  std::vector<session::Recording> in_order(arms_.size());
  for (session::Recording& one : arms_) in_order[film_.arm_of(one.info)] = std::move(one);
  arms_ = std::move(in_order);
  rate_ = arms_.front().info.rate;
  std::vector<std::string> devices;
  for (const session::Recording& arm : arms_) devices.push_back(arm.info.device);
  shared_ = session::describe_scene(film_.scene(), film_.objects(), devices);
  shared_.period_ns = in_ns(1 / rate_);
  drawn_ = drawn_scene_of(shared_);
  for (const driver::TickRecord& tick : ticks()) plots_.add(tick);
  describe(*replays);
  return {};
}

void RecordingView::describe(std::span<const session::Replay> replays) {
  const session::RecordingInfo& info = arms_.front().info;
  about_.push_back(fmt::format("Recorded on {} ({}), {:g} Hz, {} time; {}.", info.arm, info.device,
                               info.rate, info.clock == "virtual" ? "virtual" : "real",
                               scene::counted(ticks().size(), "tick")));
  if (arms() > 1) about_.push_back("The plots show the first arm, " + info.arm_in_scene + ".");
  const bool cut = std::any_of(arms_.begin(), arms_.end(),
                               [](const session::Recording& arm) { return !arm.complete; });
  if (cut) about_.push_back("The recording is incomplete: its end is missing.");
  std::uint64_t differing = 0;
  for (const session::Replay& replay : replays) differing += replay.compared.differing;
  if (differing > 0) {
    about_.push_back(
        fmt::format("The scene responds differently from the recording in {}. Force and tip "
                    "are as recorded; objects and dents are those of the current scene.",
                    scene::counted(differing, "tick")));
  }
  if (ticks().front().tick > 0 && (film_.bodies() != nullptr || film_.shapes())) {
    about_.push_back(
        "The recording starts after the run: earlier motion and shaping of objects is "
        "missing.");
  }
  if (film_.shapes()) {
    about_.push_back(fmt::format("Permanent shapes are shown at steps of {:g} s.", film_.step()));
  }
  const auto frames = film_.dents() == nullptr ? 0 : film_.dents()->frames().size();
  if (frames > session::DentTrace::kFramesMax / 2) {
    about_.push_back("Only some of the dents are stored.");
  }
}

TimeRange RecordingView::time() const {
  return {1e-9 * static_cast<double>(ticks().front().time_ns),
          1e-9 * static_cast<double>(ticks().back().time_ns)};
}

double RecordingView::time_of_step(double time, int steps) const {
  const auto at = static_cast<std::ptrdiff_t>(tick_at(arms_.front().ticks, in_ns(time))) + steps;
  const auto last = static_cast<std::ptrdiff_t>(ticks().size()) - 1;
  const auto place = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, last));
  return 1e-9 * static_cast<double>(ticks()[place].time_ns);
}

const driver::TickRecord& RecordingView::tick_at_time(double time) const {
  return ticks()[tick_at(arms_.front().ticks, in_ns(time))];
}

void RecordingView::show_bodies(std::int64_t time_ns, DrawnMoment& moment) const {
  moment.poses.assign(drawn_.objects.size(), {});
  const session::BodyTrace* const bodies = film_.bodies();
  if (bodies == nullptr || bodies->times_ns().empty()) return;
  const auto times = bodies->times_ns();
  const std::size_t i = place_of(times, time_ns, [](std::int64_t time) { return time; });
  const std::size_t j = std::min(i + 1, times.size() - 1);
  const double share = j > i ? std::clamp(static_cast<double>(time_ns - times[i]) /
                                              static_cast<double>(times[j] - times[i]),
                                          0.0, 1.0)
                             : 0;
  const std::size_t count = bodies->moving().size();
  for (std::size_t k = 0; k < count; ++k) {
    moment.poses[bodies->moving()[k]] =
        between(bodies->poses()[i * count + k], bodies->poses()[j * count + k], share);
  }
}

void RecordingView::show_dent(std::int64_t time_ns, DrawnMoment& moment) const {
  render::BodyPatch& patch = moment.patch;
  patch = {};
  const session::DentTrace* const dents = film_.dents();
  if (dents == nullptr || dents->frames().empty()) return;
  const auto frames = dents->frames();
  if (time_ns < frames.front().time_ns) return;
  const auto& frame =
      frames[place_of(frames, time_ns, [](const auto& one) { return one.time_ns; })];
  patch.object = frame.object;
  patch.point_count = frame.points;
  patch.triangle_count = frame.triangles;
  for (std::size_t i = 0; i < frame.points; ++i) {
    render::BodyPatch::Point& point = patch.points[i];
    const std::size_t from = frame.point + i;
    for (std::size_t k = 0; k < 3; ++k) {
      point.p[k] = static_cast<double>(dents->points()[from][k]);
      point.n[k] = static_cast<float>(dents->normals()[from][k]) / 32767;
    }
    point.vertex = dents->vertices()[from];
  }
  for (std::size_t i = 0; i < frame.triangles; ++i) {
    patch.triangles[i] = dents->triangles()[frame.triangle + i];
    patch.source[i] = static_cast<std::int32_t>(dents->sources()[frame.triangle + i]);
  }
}

void RecordingView::show(double time, DrawnMoment& moment) const {
  // A rounding error of half a nanosecond must not show the tick before.
  const std::int64_t time_ns = in_ns(time);
  moment.tick = ticks()[tick_at(arms_.front().ticks, time_ns)];
  show_bodies(moment.tick.time_ns, moment);
  show_dent(moment.tick.time_ns, moment);
  moment.shapes.resize(drawn_.objects.size());
  for (std::size_t i = 0; i < drawn_.objects.size(); ++i) {
    moment.shapes[i] = film_.shape_at(i, moment.tick.time_ns);
  }
  moment.arm = rods_of(shared_.arms.front(), moment.tick);
  moment.others.clear();
  for (std::size_t i = 1; i < arms(); ++i) moment.others.push_back(arm_at(i, time_ns));
}

DrawnArm RecordingView::arm_at(std::size_t arm, std::int64_t time_ns) const {
  DrawnArm drawn;
  drawn.name = shared_.arms[arm].in_scene;
  drawn.tick = ticks(arm)[tick_at(arms_[arm].ticks, time_ns)];
  drawn.rods = rods_of(shared_.arms[arm], drawn.tick);
  return drawn;
}

void RecordingView::add_arms(double time, std::vector<DrawnArm>& arms) const {
  for (std::size_t i = 0; i < arms_.size(); ++i) arms.push_back(arm_at(i, in_ns(time)));
}

}  // namespace thimble::view
