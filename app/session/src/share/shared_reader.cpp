#include "share/shared_reader.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include "share/shared_edge_split.h"
#include "system/printable_text.h"

namespace thimble::session {
namespace {

/// Makes a bool valid after any byte was copied into it: reading a value other than 0 and 1 as a
/// bool is undefined.
void make_valid(bool& value) noexcept {
  unsigned char byte = 0;
  std::memcpy(&byte, &value, 1);
  byte = byte == 1 ? 1 : 0;
  std::memcpy(&value, &byte, 1);
}

template <std::size_t N>
bool finite(const std::array<double, N>& numbers) noexcept {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

template <std::size_t N>
std::string printable(const SharedText<N>& shared, bool lines = false) {
  const std::string_view text(shared.data(), strnlen(shared.data(), shared.size() - 1));
  return lines ? driver::printable(text) : driver::printable_name(text);
}

template <class T>
std::span<T> table_in(std::span<std::byte> memory, const SharedTable& table) {
  return {reinterpret_cast<T*>(memory.data() + table.offset), table.count};
}

}  // namespace

driver::Result<std::unique_ptr<SharedReader>> SharedReader::attach(const std::string& name) {
  std::string chosen = name;
  if (chosen.empty()) {
    const auto runs = running_runs();
    if (runs.empty()) {
      return driver::Error{
          "No run is shared; start one with `thimble run SCENE --view`, or wait with `thimble view "
          "NAME`."};
    }
    chosen = runs.front().name;
  }
  auto memory = SharedMemory::open(chosen);
  if (!memory) return memory.error();
  return over(std::move(memory).value());
}

driver::Result<std::unique_ptr<SharedReader>> SharedReader::over(
    std::unique_ptr<SharedMemory> memory) {
  auto scene = read_shared_scene(memory->bytes());
  if (!scene) return scene.error();
  const std::span<std::byte> bytes = memory->bytes();
  return std::unique_ptr<SharedReader>(
      new SharedReader(std::move(memory), bytes, std::move(scene).value()));
}

driver::Result<std::unique_ptr<SharedReader>> SharedReader::over(std::span<std::byte> memory) {
  auto scene = read_shared_scene(memory);
  if (!scene) return scene.error();
  return std::unique_ptr<SharedReader>(new SharedReader(nullptr, memory, std::move(scene).value()));
}

SharedReader::SharedReader(std::unique_ptr<SharedMemory> memory, std::span<std::byte> bytes,
                           SharedScene scene)
    : memory_(std::move(memory)),
      name_(memory_ ? memory_->run() : ""),
      scene_(std::move(scene)),
      live_(reinterpret_cast<SharedLive*>(bytes.data() + kSharedLiveOffset)),
      shaped_(table_in<const SharedShaped>(bytes, scene_.shaped)),
      splits_(table_in<const SharedSplit>(bytes, scene_.splits)),
      ring_(table_in<const SharedRingSlot>(bytes, scene_.ring)) {
  sign_in();
}

SharedReader::~SharedReader() {
  if (!place_) return;
  // The pause of a viewer that exits remains; the pause of one that dies ends.
  std::uint32_t own = static_cast<std::uint32_t>(*place_) + 1;
  live_->requests.pause.compare_exchange_strong(own, kPausedWithoutPlace);
  live_->requests.viewers[*place_].store(0);
  memory_->unlock(kFirstViewerByte + static_cast<std::int64_t>(*place_));
}

void SharedReader::sign_in() noexcept {
  if (!memory_) return;
  // First tries free places, then places of viewers that died and that the run has not cleared yet.
  for (const bool cleared : {true, false}) {
    for (std::size_t place = 0; place < kViewersMax; ++place) {
      auto& viewer = live_->requests.viewers[place];
      if (cleared && viewer.load() != 0) continue;
      if (!memory_->lock(kFirstViewerByte + static_cast<std::int64_t>(place))) continue;
      viewer.store(static_cast<std::uint64_t>(getpid()));
      place_ = place;
      return;
    }
  }
}

RunState SharedReader::state() const {
  const std::uint32_t state = live_->state.load(std::memory_order_acquire);
  if (state > static_cast<std::uint32_t>(RunState::kEnded) || died()) return RunState::kEnded;
  return static_cast<RunState>(state);
}

bool SharedReader::died() const {
  if (memory_ && memory_->broken()) return true;
  if (live_->state.load() == static_cast<std::uint32_t>(RunState::kEnded)) return false;
  return memory_ && !memory_->maker_alive();
}

bool SharedReader::newest(driver::TickRecord& record) const noexcept {
  // In a short ring the writer may overwrite this tick meanwhile; then there is a newer one.
  for (int attempt = 0; attempt < 100; ++attempt) {
    const std::uint64_t stored = live_->ticks.load(std::memory_order_acquire);
    if (stored == 0) return false;
    SharedTick tick;
    if (!ring_[(stored - 1) % ring_.size()].load(tick) || tick.serial != stored) continue;
    if (!sound(tick.record)) return false;
    record = tick.record;
    return true;
  }
  return false;
}

bool SharedReader::newest_of(std::size_t arm, driver::TickRecord& record) const noexcept {
  if (arm < 1 || arm >= scene_.arms.size()) return false;
  driver::TickRecord tick;
  if (!live_->others[arm - 1].load(tick) || !sound(tick)) return false;
  record = tick;
  return true;
}

std::uint64_t SharedReader::ticks_since(std::uint64_t& serial,
                                        std::vector<driver::TickRecord>& ticks) const {
  const std::uint64_t stored = live_->ticks.load(std::memory_order_acquire);
  if (stored <= serial) return 0;
  const std::uint64_t oldest = stored > ring_.size() ? stored - ring_.size() : 0;
  std::uint64_t lost = serial > 0 && oldest > serial ? oldest - serial : 0;
  for (std::uint64_t i = std::max(serial, oldest); i < stored; ++i) {
    SharedTick tick;
    if (ring_[i % ring_.size()].load(tick, 10) && tick.serial == i + 1 && sound(tick.record)) {
      ticks.push_back(tick.record);
    } else {
      ++lost;
    }
  }
  serial = stored;
  return lost;
}

bool SharedReader::poses(ScenePoses& poses) const noexcept {
  ScenePoses seen;
  if (!live_->poses.load(seen) || !sound(seen)) return false;
  poses = seen;
  return true;
}

bool SharedReader::patch(render::BodyPatch& patch) const noexcept {
  if (!live_->patch.load(patch)) return false;
  if (sound(patch)) return true;
  patch.point_count = 0;
  patch.triangle_count = 0;
  patch.object = -1;
  return false;
}

void SharedReader::shape(std::size_t object, render::TriangleMesh& mesh) const {
  const SharedScene::Object& o = scene_.objects[object];
  if (!o.shaped || mesh.vertices.size() < o.vertex_count) return;
  for (std::size_t n = mesh.vertices.size() - o.vertex_count; n < o.max_splits; ++n) {
    const SharedSplit& split = splits_[o.first_split + n];
    if (split.ready.load(std::memory_order_acquire) != 1) break;
    if (!split_edge(mesh, split.kept, split.lost, split.triangles)) {
      ++rejected_;
      break;
    }
  }
  auto& vertices = mesh.vertices;
  const std::size_t count = std::min(vertices.size(), o.vertex_count + o.max_splits);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<double, 3> p{};
    if (!shaped_[o.first_shaped + i].load(p, 10)) continue;
    if (finite(p)) {
      vertices[i] = {p[0], p[1], p[2]};
    } else {
      ++rejected_;
    }
  }
}

SharedReader::Counters SharedReader::counters() const noexcept {
  return {.ticks = live_->ticks.load(),
          .missed = live_->missed.load(),
          .paused = live_->paused.load(),
          .recording = live_->recording.load() == 1,
          .record_dropped = live_->record_dropped.load()};
}

std::string SharedReader::recording_path() const {
  SharedText<1024> path{};
  return live_->recording_path.load(path) ? printable(path) : std::string();
}

std::string SharedReader::notice() const {
  SharedText<1024> notice{};
  return live_->notice.load(notice) ? printable(notice, true) : std::string();
}

double SharedReader::knob(std::size_t knob) const noexcept {
  const double now = live_->knobs[knob].now.load();
  const SharedScene::Knob& bounds = scene_.knobs[knob];
  return now >= bounds.min && now <= bounds.max ? now : bounds.initial;
}

double SharedReader::knob_wanted(std::size_t knob) const noexcept {
  const double wanted = live_->knobs[knob].wanted.load();
  const SharedScene::Knob& bounds = scene_.knobs[knob];
  return wanted >= bounds.min && wanted <= bounds.max ? wanted : bounds.initial;
}

void SharedReader::turn_knob(std::size_t knob, double value) noexcept {
  if (std::isnan(value)) return;
  const SharedScene::Knob& bounds = scene_.knobs[knob];
  live_->knobs[knob].wanted.store(std::clamp(value, bounds.min, bounds.max));
}

void SharedReader::ask_pause(bool pause) noexcept {
  const std::uint32_t own =
      place_ ? static_cast<std::uint32_t>(*place_) + 1 : std::uint32_t{kPausedWithoutPlace};
  live_->requests.pause.store(pause ? own : kNotPaused);
}

bool SharedReader::take_turn() noexcept {
  return !memory_ || memory_->lock(kTurnByte);
}

void SharedReader::end_turn() noexcept {
  if (memory_) memory_->unlock(kTurnByte);
}

bool SharedReader::ask_record(const std::string& path) noexcept {
  if (!take_turn()) return false;
  SharedText<1024> text{};
  std::copy_n(path.begin(), std::min(path.size(), text.size() - 1), text.begin());
  live_->requests.record_path.store(text);
  const std::uint64_t number = live_->requests.record_number.load();
  live_->requests.record_number.store(number + (number % 2 == 0 ? 1 : 2));
  end_turn();
  return true;
}

bool SharedReader::ask_record_stop() noexcept {
  if (!take_turn()) return false;
  const std::uint64_t number = live_->requests.record_number.load();
  live_->requests.record_number.store(number + (number % 2 == 0 ? 2 : 1));
  end_turn();
  return true;
}

bool SharedReader::lead_hand(const Eigen::Vector3d& p_WH, bool holds) noexcept {
  if (!p_WH.allFinite() || (memory_ && !place_) || !take_turn()) return false;
  live_->requests.hand.store({.p_WH = {p_WH.x(), p_WH.y(), p_WH.z()},
                              .active = holds ? std::uint64_t{1} : 0,
                              .viewer = place_ ? *place_ + 1 : 0});
  end_turn();
  return true;
}

bool SharedReader::sound(driver::TickRecord& record) const noexcept {
  make_valid(record.in_contact);
  make_valid(record.fresh);
  make_valid(record.has_gripper);
  make_valid(record.home_needed);
  // A faulty arm may report positions that are not finite. They are replaced by 0, so that its
  // fault is still shown.
  for (auto* numbers : {&record.q, &record.p_WT, &record.v_WT, &record.p_WP, &record.n_W,
                        &record.f_wanted_W, &record.f_sent_W, &record.heat}) {
    for (double& x : *numbers) x = std::isfinite(x) ? x : 0;
  }
  for (float& x : record.q_WT) x = std::isfinite(x) ? x : 0;
  for (float& x : record.gimbal) x = std::isfinite(x) ? x : 0;
  if (!std::isfinite(record.gripper)) record.gripper = 0;
  if (!std::isfinite(record.depth)) record.depth = 0;
  const bool known = record.stage <= driver::kLastStage && record.fault <= driver::kLastFault &&
                     record.link <= driver::kLastLinkState && record.object >= -1 &&
                     record.object < static_cast<int>(scene_.objects.size());
  if (!known) ++rejected_;
  return known;
}

bool SharedReader::sound(ScenePoses& poses) const noexcept {
  bool good = poses.count <= ScenePoses::kMax;
  for (std::size_t i = 0; good && i < poses.count; ++i) {
    good = poses.object[i] >= 0 &&
           static_cast<std::size_t>(poses.object[i]) < scene_.objects.size() &&
           finite(poses.pose[i].p_WB) && finite(poses.pose[i].q_WB);
  }
  if (!good) ++rejected_;
  return good;
}

bool SharedReader::sound(render::BodyPatch& patch) const noexcept {
  make_valid(patch.complete);
  if (patch.triangle_count == 0 && patch.point_count == 0) {
    patch.object = -1;
    return true;
  }
  bool good = patch.point_count <= render::BodyPatch::kPointsMax &&
              patch.triangle_count <= render::BodyPatch::kTrianglesMax && patch.object >= 0 &&
              static_cast<std::size_t>(patch.object) < scene_.objects.size();
  if (good) {
    const SharedScene::Object& object = scene_.objects[static_cast<std::size_t>(patch.object)];
    const auto below = [](std::int32_t number, std::size_t count) {
      return number >= 0 && static_cast<std::size_t>(number) < count;
    };
    for (std::size_t i = 0; good && i < patch.point_count; ++i) {
      const render::BodyPatch::Point& point = patch.points[i];
      good = finite(point.p) && std::isfinite(point.n[0]) && std::isfinite(point.n[1]) &&
             std::isfinite(point.n[2]) &&
             (point.vertex == -1 || below(point.vertex, object.vertex_count));
    }
    for (std::size_t t = 0; good && t < patch.triangle_count; ++t) {
      good = below(patch.source[t], object.triangle_count);
      for (const std::uint16_t corner : patch.triangles[t]) good &= corner < patch.point_count;
    }
  }
  if (!good) ++rejected_;
  return good;
}

}  // namespace thimble::session
