#include "thimble/session/session.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "body/shape/body_shape.h"
#include "build_info.h"
#include "share/describe_scene.h"
#include "text_file.h"
#include "thimble/scene/energy_choice.h"
#include "thimble/scene/hand_route.h"
#include "thimble/scene/real_arm.h"
#include "thimble/scene/watch_choice.h"

namespace thimble::session {
namespace {

// What a viewer's plots can look back on, and how much memory that may take: 32 MB. Chosen.
constexpr double kShownSeconds = 8;
constexpr std::size_t kShownTicksMost = 100'000;
constexpr int kRunsOfAScene = 100;  // at the same time; chosen

// Rows of the trace of a run whose end nobody knows: 80 MB, 5 min at 1 kHz. Chosen.
constexpr std::size_t kRowsOfEndless = 300'000;

/// Finds the first point of the hand's way that the arm cannot reach.
driver::Result<void> check_reach(const scene::HandRoute& route, const scene::ArmFile& arm) {
  for (const auto& [time, p_WH] : route) {
    const bool in_box = (p_WH.array() >= arm.workspace.min_W.array()).all() &&
                        (p_WH.array() <= arm.workspace.max_W.array()).all();
    if (!in_box || !scene::joint_angles_at(arm, p_WH)) {
      char text[200];
      std::snprintf(text, sizeof text,
                    "At %.3f s the hand would be at (%.3f, %.3f, %.3f) m, outside the arm's "
                    "workspace; move that waypoint or the object.",
                    time, p_WH.x(), p_WH.y(), p_WH.z());
      return driver::Error{text};
    }
  }
  return {};
}

}  // namespace

driver::Result<std::unique_ptr<Session>> Session::open(const std::filesystem::path& scene_file,
                                                       const SessionOptions& options) {
  auto session = prepare(scene_file, options);
  if (!session) return session;
  if (auto opened = (*session)->open_arm(); !opened) return opened.error();
  if (!options.real_arm) return session;
  const std::string trouble =
      (*session)->start_pose().trouble((*session)->device().state().p_WT, !options.homed);
  if (!trouble.empty()) return driver::Error{trouble};
  if (auto activated = (*session)->activate(); !activated) return activated.error();
  return session;
}

driver::Result<std::unique_ptr<Session>> Session::prepare(const std::filesystem::path& scene_file,
                                                          const SessionOptions& options) {
  if (options.real_arm && !options.terms) {
    return driver::Error{"A real arm is used on terms only (terms_for)."};
  }
  auto scene = scene::read_scene(scene_file, options.mesh_folder,
                                 options.real_arm ? options.terms->arm.path : options.arm_file);
  if (!scene) return scene.error();

  std::unique_ptr<Session> session(new Session);
  session->scene_ = std::move(scene).value();
  if (options.adjust) options.adjust(session->scene_);
  if (options.real_arm) {
    session->start_pose_ = StartPose::of(session->scene_.arm, options.real_arm->kind);
    auto told = scene::put_on_terms(session->scene_, scene_file, *options.terms);
    if (!told) return told.error();
    session->told_ = std::move(told).value();
    session->feel_check_ = options.terms->feel_check;
  }

  auto objects = scene::SceneObjects::build(session->scene_);
  if (!objects) return objects.error();
  session->objects_ = std::move(objects).value();
  if (session->objects_->moving().size() > scene::ScenePoses::kMost) {
    return driver::Error{scene_file.string() + ": at most " +
                         std::to_string(scene::ScenePoses::kMost) + " objects may move."};
  }
  session->seed_ = options.seed.value_or(session->scene_.seed);
  session->period_ns_ = std::llround(1e9 / session->scene_.rate);
  const double duration = options.duration.value_or(session->scene_.duration);
  session->hand_by_mouse_ = options.hand_by_mouse;
  // Led by a person it goes on until he has enough, unless he says how long.
  if (!options.hand_by_mouse || options.duration) {
    session->ticks_ = static_cast<std::uint64_t>(
        std::ceil(duration * 1e9 / static_cast<double>(session->period_ns_)));
  }
  session->statistics_ = std::make_unique<RunStatistics>();
  session->trace_ = std::make_unique<Trace>(
      session->ticks_, session->ticks_ == 0 ? kRowsOfEndless : Trace::kDefaultRowsMax);
  const auto dents = [](const scene::SceneObject& object) { return object.body.dent.has_value(); };
  if (std::any_of(session->scene_.objects.begin(), session->scene_.objects.end(), dents)) {
    session->dents_ = std::make_unique<DentRecord>(session->period_ns_);
  }

  if (!options.real_arm) {
    if (auto planned = session->plan_simulation(scene_file, options.firmware); !planned) {
      return planned.error();
    }
  }
  session->by_thread_ = options.clock == ClockKind::kWall || options.real_arm.has_value();
  if (session->by_thread_) session->objects_->start_loaders();
  session->scene_file_ = scene_file;
  session->real_arm_ = options.real_arm;
  session->firmware_ = options.firmware;
  session->open_link_ = options.open_link;
  session->device_name_ = options.real_arm ? options.real_arm->name() : "sim";
  session->black_box_ = std::make_unique<BlackBox>(session->scene_.rate);
  if (!options.record.empty()) {
    if (auto begun = session->begin_recording(options.record); !begun) return begun.error();
  }
  if (options.share || options.share_out) {
    const auto shared = session->share(options);
    if (!shared && !options.share_if_possible) return shared.error();
    if (!shared) {
      std::fprintf(stderr, "thimble: nobody can watch: %s\n", shared.error().message.c_str());
      session->control_.reset();
    }
  }
  return session;
}

driver::Result<void> Session::open_arm() {
  const scene::ArmFile& arm = scene_.arm;
  // The clock starts last, so that the arm's time begins with the session's. A real arm knows only
  // the time of the world.
  if (by_thread_) {
    clock_ = std::make_unique<driver::WallClock>();
  } else {
    clock_ = std::make_unique<driver::VirtualClock>();
  }
  std::unique_ptr<driver::ArmLink> link;
  if (real_arm_) {
    auto opened = open_link_ ? open_link_(arm, *clock_)
                             : scene::open_link(*real_arm_, arm, firmware_, *clock_);
    if (!opened) return opened.error();
    link = std::move(opened).value();
  } else {
    link = simulation_->link(*clock_);
  }
  driver::MotionWatchSettings motion = scene::motion_settings(arm, scene_.rate);
  // A simulated hand that a mouse holds does not tremble, and its arm sends no old positions.
  constexpr double kAnyTime = 1e9;  // s
  if (hand_by_mouse_) motion.hold_most = kAnyTime;
  driver::HeatSettings heat = arm.heat;
  if (real_arm_ && heat.named()) {
    const scene::KnownHeat known = scene::load_heat(real_arm_->name(), heat, scene::world_time());
    if (!known.note.empty()) std::fprintf(stderr, "thimble: %s\n", known.note.c_str());
    heat.at_start = known.heat;
  }
  auto device =
      driver::Device::open(std::move(link),
                           {.R_WB = arm.R_WB,
                            .p_WB = arm.p_WB,
                            .limits = arm.limits,
                            .energy = scene::energy_settings(arm, scene_.rate, scene_.energy),
                            .motion = motion,
                            .heat = heat,
                            .velocity_corner_frequency = arm.velocity_corner_frequency},
                           clock_->now_ns());
  if (!device) return device.error();
  device_ = std::move(device).value();
  if (real_arm_ && heat.named()) {
    heat_keeper_ = std::make_unique<scene::HeatKeeper>(real_arm_->name(), *device_);
  }
  return real_arm_ ? driver::Result<void>() : device_->activate();
}

driver::Result<void> Session::begin_recording(const std::filesystem::path& path) {
  constexpr double kLongest = 86400;  // s, of a run without an end; chosen
  const auto ticks_max =
      ticks_ > 0 ? ticks_ : static_cast<std::uint64_t>(std::ceil(kLongest * scene_.rate));
  may_record_ = true;
  if (shared_) shared_->set_recording_path(std::filesystem::absolute(path).string());
  return recording_.begin(path, recording_info(), ticks_max, by_thread_);
}

driver::Result<void> Session::share(const SessionOptions& options) {
  SharedScene scene = describe_scene(scene_, *objects_, device_name_);
  scene.file = std::filesystem::absolute(scene_file_).lexically_normal().string();
  scene.period_ns = period_ns_;
  scene.wall_clock = by_thread_;
  scene.hand_by_mouse = hand_by_mouse_;
  control_ = std::make_unique<LiveControl>(scene_, touch(), simulation_.get(), by_thread_);
  scene.knobs = control_->knobs().described();
  std::size_t first = 0;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (!scene.objects[i].shaped) continue;
    shaped_.push_back({i, first});
    first += scene.objects[i].vertex_count;
  }
  const auto ring = static_cast<std::size_t>(std::ceil(kShownSeconds * scene_.rate));
  const std::string asked = options.share_name.empty() ? scene_.name : options.share_name;
  const std::string name = options.share_out ? run_name_of(asked) : "";
  auto shared = SharedRun::create(name, scene, std::min(ring, kShownTicksMost));
  // Where the scene gives the name, a second run of it is another one.
  for (int number = 2; !shared && options.share_name.empty() && number < kRunsOfAScene; ++number) {
    if (!run_name_taken(name)) break;
    std::string next = name;
    next += '-' + std::to_string(number);
    shared = SharedRun::create(next, scene, std::min(ring, kShownTicksMost));
  }
  if (!shared) return shared.error();
  shared_ = std::move(shared).value();
  may_record_ = true;
  if (const Recorder* recorder = recording_.recorder()) {
    shared_->set_recording_path(std::filesystem::absolute(recorder->path()).string());
  }
  return {};
}

RecordingInfo Session::recording_info() const {
  return {.scene = scene_.name,
          .scene_file = std::filesystem::absolute(scene_file_).lexically_normal().string(),
          .scene_text = scene::text_of(scene_file_),
          .arm = scene_.arm.name,
          .arm_file = std::filesystem::absolute(scene_.arm_file).lexically_normal().string(),
          .arm_text = scene::text_of(scene_.arm_file),
          .device = device_name_,
          .clock = by_thread_ ? "wall" : "virtual",
          .program = scene::program_name(),
          .rate = scene_.rate,
          .seed = seed_};
}

driver::Result<void> Session::plan_simulation(const std::filesystem::path& scene_file,
                                              const std::filesystem::path& firmware) {
  const scene::ArmFile& arm = scene_.arm;
  std::vector<render::TriangleMesh> meshes_W;
  for (std::size_t i = 0; i < scene_.objects.size(); ++i) meshes_W.push_back(objects_->mesh_W(i));
  std::vector<scene::NamedMesh> named;
  for (std::size_t i = 0; i < meshes_W.size(); ++i) {
    const scene::SceneObject& object = scene_.objects[i];
    if (!object.build_field && !object.paged) named.push_back({object.name, &meshes_W[i]});
  }
  auto route = scene::plan_hand(scene_.hand, named);
  if (!route) return driver::Error{scene_file.string() + ": " + route.error().message};
  if (auto reach = check_reach(*route, arm); !reach) {
    return driver::Error{scene_file.string() + ": " + reach.error().message};
  }
  if (hand_by_mouse_) route->resize(1);  // waits where the planned way begins
  auto simulation = scene::ArmSimulation::make(arm, *route, firmware, seed_);
  if (!simulation)
    return driver::Error{scene_.arm_file.string() + ": " + simulation.error().message};
  simulation_ = std::move(simulation).value();
  return {};
}

driver::ServoEnd Session::run(const std::atomic<bool>& stop) noexcept {
  for (;;) {
    if (const auto end = step(stop)) return *end;
  }
}

std::optional<driver::ServoEnd> Session::step(const std::atomic<bool>& stop) noexcept {
  if (!loop_) begin(stop);
  const auto end = loop_->tick(stop);
  if (!end || ended_) return end;
  ended_ = true;
  if (simulation_) simulation_->settle(clock_->now_ns());
  if (shared_) shared_->set_state(RunState::kEnded);
  return end;
}

void Session::begin(const std::atomic<bool>& stop) noexcept {
  if (shared_) {
    control_->join(*shared_, hand_by_mouse_, stop);
    shared_->set_state(RunState::kRunning);
  }
  const driver::ForceLaw own = shared_ ? driver::ForceLaw(*control_) : driver::ForceLaw(touch());
  loop_.emplace(*device_, *clock_, law_.value_or(own), driver::TickSink(*this),
                driver::ServoSettings{
                    .period_ns = period_ns_, .ticks = ticks_, .outlive_faults = !simulation_});
}

driver::Result<void> Session::set_law(driver::ForceLaw law) {
  if (by_thread_) {
    return driver::Error{
        "A force law of one's own runs in virtual time alone; in real time nothing may wait for "
        "it. "
        "For that write it in C++ (app/examples/04_own_effect.cpp)."};
  }
  if (loop_) return driver::Error{"The run has begun with another force law; begin a new one."};
  law_ = law;
  return {};
}

void Session::operator()(const driver::TickRecord& record) noexcept {
  snapshot_.store(record);
  (*statistics_)(record);
  (*trace_)(record);
  (*black_box_)(record);
  const bool drawn = dents_ && dents_->take(record, touch());
  if (!objects_->moving().empty()) store_poses(record.tick);
  if (shared_) {
    shared_->store_tick(record);
    if (drawn) shared_->store_patch(dents_->drawn());
    if (!objects_->moving().empty()) shared_->store_poses(poses_now_);
    if (!shaped_.empty()) store_shapes();
    control_->take(record);
  }
  if (may_record_) recording_(record);
  if (by_thread_) return;
  // In virtual time a tick lasts as long as it computes: the disk is as fast as one could wish, and
  // every run is the same.
  objects_->serve_pages();
  if (may_record_) recording_.serve_if_half_full();
}

render::TriangleMesh Session::bent_mesh_W() const {
  if (!dents_ || dents_->deepest().triangle_count == 0) return objects_->mesh_W();
  const render::BodyPatch& patch = dents_->deepest();
  return bent(objects_->mesh_W(), objects_->place(static_cast<std::size_t>(patch.object)), patch);
}

void Session::store_shapes() noexcept {
  for (const ShapedPlace& place : shaped_) {
    for (const render::VertexMove& move : touch().object(place.object).shape()->moves()) {
      shared_->store_vertex(place.first + static_cast<std::size_t>(move.vertex), move.p_W);
    }
  }
}

void Session::store_poses(std::uint64_t tick) noexcept {
  const auto moving = objects_->moving();
  poses_now_.tick = tick;
  poses_now_.count = static_cast<std::uint32_t>(moving.size());
  for (std::size_t i = 0; i < moving.size(); ++i) {
    poses_now_.object[i] = static_cast<std::int32_t>(moving[i]);
    poses_now_.pose[i] = touch().object(moving[i]).pose();
  }
  poses_.store(poses_now_);
}

}  // namespace thimble::session
