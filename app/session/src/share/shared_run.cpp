#include "share/shared_run.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <limits>
#include <new>
#include <span>
#include <string_view>

#include "mesh/contact_mesh.h"
#include "share/layout/shared_layout_hash.h"
#include "share/shared_geometry.h"

namespace thimble::session {
namespace {

template <std::size_t N>
void put(const std::string& text, SharedText<N>& to) {
  to.fill(0);
  std::copy_n(text.begin(), std::min(text.size(), N - 1), to.begin());
}

/// Clears a request that a viewer did not finish because it was killed. Precondition: no viewer is
/// writing now.
template <class T>
void clear_if_torn(driver::Snapshot<T>& snapshot) noexcept {
  T value;
  if (snapshot.count() > 0 && !snapshot.load(value, 1)) snapshot.store({});
}

/// Sets the position of every table in `head`; returns the total size.
std::uint64_t lay_out(const SharedScene& scene, std::size_t ring_ticks, SharedHead& head) {
  std::uint64_t end = kSharedTablesOffset;
  const auto lay = [&end](SharedTable& table, std::size_t count, std::size_t size) {
    table = {.offset = end, .count = count};
    end = (end + count * size + 63) / 64 * 64;
  };
  std::size_t shaped = 0, splits = 0;
  for (const auto& object : scene.objects) {
    if (!object.shaped) continue;
    shaped += object.vertex_count + object.max_splits;
    splits += object.max_splits;
  }
  lay(head.objects, scene.objects.size(), sizeof(SharedObject));
  lay(head.knobs, scene.knobs.size(), sizeof(SharedKnob));
  lay(head.vertices, scene.vertices.size(), sizeof(SharedVertex));
  lay(head.triangles, scene.triangles.size(), sizeof(SharedTriangle));
  lay(head.map_values, scene.map_values.size(), sizeof(float));
  lay(head.field, std::min(scene.field.size(), kFieldSamplesMax), sizeof(SharedFieldSample));
  lay(head.shaped, shaped, sizeof(SharedShaped));
  lay(head.splits, splits, sizeof(SharedSplit));
  lay(head.ring, ring_ticks, sizeof(SharedRingSlot));
  return end;
}

template <class T>
std::span<T> table_in(std::span<std::byte> memory, const SharedTable& table) {
  return {reinterpret_cast<T*>(memory.data() + table.offset), table.count};
}

std::array<double, 3> plain(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

void put_arm(const SharedScene::Arm& arm, SharedArm& to) {
  put(arm.name, to.name);
  put(arm.device, to.device);
  put(arm.in_scene, to.in_scene);
  put_geometry(arm.geometry, to);
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(to.R_WB.data()) = arm.R_WB;
  to.p_WB = plain(arm.p_WB);
  to.min_W = plain(arm.min_W);
  to.max_W = plain(arm.max_W);
}

}  // namespace

driver::Result<std::unique_ptr<SharedRun>> SharedRun::create(const std::string& name,
                                                             const SharedScene& scene,
                                                             std::size_t ring_ticks) {
  return make(name, nullptr, scene, ring_ticks);
}

driver::Result<std::unique_ptr<SharedRun>> SharedRun::create_next(SharedRun& before,
                                                                  const SharedScene& scene,
                                                                  std::size_t ring_ticks) {
  const std::string& name = before.name();
  auto made = make(name, name.empty() ? nullptr : &before.memory(), scene, ring_ticks);
  if (!made || name.empty()) return made;
  if (auto taken = (*made)->memory_->take_name(*before.memory_); !taken) return taken.error();
  return made;
}

driver::Result<void> check_object_count(std::size_t count) {
  if (count <= kObjectsMax) return {};
  return driver::Error{
      "A scene with more than " + std::to_string(kObjectsMax) +
      " objects cannot be shown or drawn; run it with --no-view and without pictures."};
}

driver::Result<std::unique_ptr<SharedRun>> SharedRun::make(const std::string& name,
                                                           const SharedMemory* before,
                                                           const SharedScene& scene,
                                                           std::size_t ring_ticks) {
  if (auto fits = check_object_count(scene.objects.size()); !fits) return fits.error();
  SharedHead head{};
  const std::uint64_t bytes = lay_out(scene, ring_ticks, head);
  if (!name.empty()) remove_dead_runs();
  auto memory = name.empty()        ? SharedMemory::create_nameless(bytes)
                : before != nullptr ? SharedMemory::create_next(*before, bytes)
                                    : SharedMemory::create(name, bytes);
  if (!memory) return memory.error();
  std::unique_ptr<SharedRun> run(new SharedRun(std::move(memory).value()));
  run->write(scene, ring_ticks);
  return run;
}

void SharedRun::write(const SharedScene& scene, std::size_t ring_ticks) {
  const std::span<std::byte> memory = memory_->bytes();
  // Touches every page before the first tick.
  std::memset(memory.data(), 0, memory.size());
  head_ = new (memory.data()) SharedHead{};
  head_->pid = getpid();
  live_ = new (memory.data() + kSharedLiveOffset) SharedLive{};

  head_->layout = shared_layout_hash();
  head_->total_bytes = lay_out(scene, ring_ticks, *head_);
  std::timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  head_->began_ns = now.tv_sec * 1'000'000'000 + now.tv_nsec;
  head_->period_ns = period_ns_ = scene.period_ns;
  head_->force_max = scene.force_max;
  head_->tip_radius = scene.tip_radius;
  head_->duration = scene.duration;
  head_->wall_clock = scene.wall_clock ? 1 : 0;
  head_->hand_by_mouse = scene.hand_by_mouse ? 1 : 0;
  head_->hold_by_key = scene.hold_by_key ? 1 : 0;
  head_->paced = scene.paced ? 1 : 0;
  head_->restarts = scene.restarts ? 1 : 0;
  last_hand_.p_WH.fill(std::numeric_limits<double>::quiet_NaN());
  live_->requests.speed.store(kSpeedUnset);
  live_->requests.loop.store(kLoopUnset);
  put(scene.name, head_->scene);
  put(scene.file, head_->scene_file);
  head_->arm_count = std::min(scene.arms.size(), kArmsMax);
  for (std::size_t i = 0; i < head_->arm_count; ++i) put_arm(scene.arms[i], head_->arms[i]);

  const auto objects = table_in<SharedObject>(memory, head_->objects);
  std::uint64_t shaped = 0, splits = 0;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const SharedScene::Object& object = scene.objects[i];
    SharedObject& to = objects[i];
    put(object.name, to.name);
    to.kind = static_cast<std::uint32_t>(object.kind);
    to.colour = object.colour;
    to.moves = object.moves ? 1 : 0;
    to.dents = object.dents ? 1 : 0;
    to.shaped = object.shaped ? 1 : 0;
    to.first_vertex = object.first_vertex;
    to.vertex_count = object.vertex_count;
    to.first_triangle = object.first_triangle;
    to.triangle_count = object.triangle_count;
    to.collider_first_vertex = object.collider_first_vertex;
    to.collider_vertex_count = object.collider_vertex_count;
    to.collider_first_triangle = object.collider_first_triangle;
    to.collider_triangle_count = object.collider_triangle_count;
    to.first_shaped = shaped;
    to.first_split = splits;
    if (object.shaped) {
      to.max_splits = object.max_splits;
      shaped += object.vertex_count + object.max_splits;
      splits += object.max_splits;
    }
    to.crease_angle = object.crease_angle;
    put(object.texture, to.texture);
    put(object.friction, to.friction);
    put(object.map.quantity, to.map_quantity);
    put(object.map.unit, to.map_unit);
    to.map_parts = object.map.parts;
    to.map_min = object.map.min;
    to.map_max = object.map.max;
    to.first_map_value = object.map.first_value;
  }
  const auto knobs = table_in<SharedKnob>(memory, head_->knobs);
  knobs_.assign(scene.knobs.begin(),
                scene.knobs.begin() + static_cast<std::ptrdiff_t>(knobs.size()));
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    put(knobs_[i].name, knobs[i].name);
    put(knobs_[i].unit, knobs[i].unit);
    knobs[i].min = knobs_[i].min;
    knobs[i].max = knobs_[i].max;
    knobs[i].initial = knobs_[i].initial;
    live_->knobs[i].wanted.store(knobs_[i].initial);
    live_->knobs[i].now.store(knobs_[i].initial);
  }
  const auto vertices = table_in<SharedVertex>(memory, head_->vertices);
  for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = plain(scene.vertices[i]);
  const auto triangles = table_in<SharedTriangle>(memory, head_->triangles);
  std::copy(scene.triangles.begin(), scene.triangles.end(), triangles.begin());
  const auto map_values = table_in<float>(memory, head_->map_values);
  std::copy(scene.map_values.begin(), scene.map_values.end(), map_values.begin());
  const auto field = table_in<SharedFieldSample>(memory, head_->field);
  for (std::size_t i = 0; i < field.size(); ++i) {
    field[i] = {.p_W = plain(scene.field[i].p_W), .f_W = plain(scene.field[i].f_W)};
  }
  shaped_ = table_in<SharedShaped>(memory, head_->shaped).data();
  shaped_count_ = head_->shaped.count;
  splits_ = table_in<SharedSplit>(memory, head_->splits).data();
  splits_count_ = head_->splits.count;
  ring_ = table_in<SharedRingSlot>(memory, head_->ring).data();
  ring_count_ = head_->ring.count;

  head_->hash = shared_hash(*head_, objects, knobs, vertices, triangles, map_values);
  head_->ready.store(kSharedReady, std::memory_order_release);
}

SharedRun::~SharedRun() {
  set_state(RunState::kEnded);
}

void SharedRun::store_tick(const driver::TickRecord& record) noexcept {
  // In real time the loop continues during a pause; periods skipped then are not counted as missed.
  const bool idle = head_->wall_clock == 1 && live_->state.load(std::memory_order_relaxed) ==
                                                  static_cast<std::uint32_t>(RunState::kPaused);
  if (idle) {
    live_->paused.store(live_->paused.load(std::memory_order_relaxed) + 1,
                        std::memory_order_relaxed);
  } else if (stored_ > 0) {
    const std::int64_t skipped = (record.due_ns - last_due_ns_) / period_ns_ - 1;
    if (skipped > 0) {
      live_->missed.store(
          live_->missed.load(std::memory_order_relaxed) + static_cast<std::uint64_t>(skipped),
          std::memory_order_relaxed);
    }
  }
  last_due_ns_ = record.due_ns;
  ring_[stored_ % ring_count_].store({.serial = stored_ + 1, .record = record});
  live_->ticks.store(++stored_, std::memory_order_release);
}

void SharedRun::store_vertex(std::size_t shaped, const Eigen::Vector3d& p_W) noexcept {
  if (shaped >= shaped_count_) return;
  shaped_[shaped].store(plain(p_W));
  live_->shape_moves.store(live_->shape_moves.load(std::memory_order_relaxed) + 1,
                           std::memory_order_release);
}

void SharedRun::store_split(std::size_t number, const render::EdgeSplit& split) noexcept {
  if (number >= splits_count_) return;
  SharedSplit& shared = splits_[number];
  const auto [kept, lost] = split.ends;
  shared.kept = static_cast<std::uint32_t>(kept);
  shared.lost = static_cast<std::uint32_t>(lost);
  shared.triangles = {static_cast<std::uint32_t>(split.triangles[0]),
                      static_cast<std::uint32_t>(split.triangles[1])};
  shared.ready.store(1, std::memory_order_release);
  live_->shape_moves.store(live_->shape_moves.load(std::memory_order_relaxed) + 1,
                           std::memory_order_release);
}

void SharedRun::set_recording(bool on, std::uint64_t dropped) noexcept {
  live_->recording.store(on ? 1 : 0, std::memory_order_relaxed);
  live_->record_dropped.store(dropped, std::memory_order_relaxed);
}

void SharedRun::set_recording_path(const std::string& path) noexcept {
  SharedText<1024> text{};
  put(path, text);
  live_->recording_path.store(text);
}

std::optional<double> SharedRun::knob_wanted(std::size_t knob) const noexcept {
  const double wanted = live_->knobs[knob].wanted.load(std::memory_order_relaxed);
  // Written so that NaN is no request.
  if (wanted >= knobs_[knob].min && wanted <= knobs_[knob].max) return wanted;
  return {};
}

bool SharedRun::hand(SharedHand& hand) const noexcept {
  SharedHand seen;
  if (!live_->requests.hand.load(seen, 1)) return false;
  for (const double x : seen.p_WH) {
    if (!std::isfinite(x)) return false;
  }
  hand = seen;
  return true;
}

std::optional<SharedRun::RecordRequest> SharedRun::record_request_after(
    std::uint64_t number) const {
  const std::uint64_t newest = live_->requests.record_number.load(std::memory_order_acquire);
  if (newest <= number) return {};
  RecordRequest order{.number = newest, .record = newest % 2 == 1, .path = {}};
  if (!order.record) return order;
  SharedText<1024> path{};
  // An incomplete path is ignored: a viewer is still writing it, or has died and watch_viewers
  // clears it.
  if (!live_->requests.record_path.load(path)) return {};
  order.path.assign(path.data(), strnlen(path.data(), path.size() - 1));
  return order;
}

std::optional<double> SharedRun::speed_wanted() const noexcept {
  const double wanted = live_->requests.speed.load(std::memory_order_relaxed);
  // Written so that NaN is no request.
  if (wanted >= kSpeedMin && wanted <= kSpeedMax) return wanted;
  return {};
}

void SharedRun::set_pace(double speed, bool loop) noexcept {
  double unset_speed = kSpeedUnset;
  live_->requests.speed.compare_exchange_strong(unset_speed, speed);
  std::uint32_t unset_loop = kLoopUnset;
  live_->requests.loop.compare_exchange_strong(unset_loop, loop ? 1 : 0);
}

void SharedRun::close() noexcept {
  live_->closed.store(1);
  // Pairs with SharedReader::check_accepted: either this sees the request, or the viewer sees that
  // the run is closed.
  std::atomic_thread_fence(std::memory_order_seq_cst);
}

void SharedRun::set_notice(const std::string& notice) noexcept {
  SharedText<1024> text{};
  put(notice, text);
  live_->notice.store(text);
}

std::optional<SharedRun::RestartRequest> SharedRun::restart_request_after(
    std::uint64_t number) const {
  const std::uint64_t newest = live_->requests.restart_number.load(std::memory_order_acquire);
  SharedRestart order;
  if (newest <= number || !live_->requests.restart.load(order) || order.number != newest) return {};
  return RestartRequest{
      .number = newest,
      .scene = {order.scene.data(), strnlen(order.scene.data(), order.scene.size() - 1)}};
}

std::vector<std::uint64_t> SharedRun::viewers() const {
  std::vector<std::uint64_t> pids;
  for (const auto& place : live_->requests.viewers) {
    if (const std::uint64_t pid = place.load(); pid != 0) pids.push_back(pid);
  }
  return pids;
}

bool SharedRun::is_viewer_alive(std::uint64_t place) const noexcept {
  return place < kViewersMax &&
         memory_->locked_elsewhere(kFirstViewerByte + static_cast<std::int64_t>(place));
}

bool SharedRun::watch_viewers() noexcept {
  for (std::size_t place = 0; place < kViewersMax; ++place) {
    auto& viewer = live_->requests.viewers[place];
    std::uint64_t pid = viewer.load();
    if (pid != 0 && !is_viewer_alive(place)) viewer.compare_exchange_strong(pid, 0);
  }
  // If a viewer holds the turn, it is alive and will finish its request.
  if (memory_->lock(kTurnByte)) {
    clear_if_torn(live_->requests.restart);
    clear_if_torn(live_->requests.record_path);
    release_hand();
    memory_->unlock(kTurnByte);
  }
  return end_pause_of_dead();
}

void SharedRun::release_hand() noexcept {
  SharedHand seen;
  if (live_->requests.hand.load(seen, 1)) {
    last_hand_ = seen;
    // A viewer without a place has number 0.
    if (seen.active != 1 || is_viewer_alive(seen.viewer - 1)) return;
  } else if (live_->requests.hand.count() == 0) {
    return;  // no viewer has moved the hand
  }
  last_hand_.active = 0;
  live_->requests.hand.store(last_hand_);
}

bool SharedRun::end_pause_of_dead() noexcept {
  std::uint32_t pause = live_->requests.pause.load();
  if (head_->wall_clock == 1 || !is_pause(pause) || pause == kPausedWithoutPlace ||
      is_viewer_alive(pause - 1)) {
    return false;
  }
  return live_->requests.pause.compare_exchange_strong(pause, kNotPaused);
}

}  // namespace thimble::session
