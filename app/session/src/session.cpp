#include "thimble/session/session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bent_mesh.h"
#include "events/event_log.h"
#include "figures/figures_of.h"
#include "log/logger.h"
#include "more_arms.h"
#include "observers/page_server.h"
#include "output/output_file.h"
#include "print.h"
#include "recording/recording_layout.h"
#include "recording/write_black_box.h"
#include "run_law.h"
#include "run_loop.h"
#include "run_records.h"
#include "setup.h"
#include "share/held_knobs.h"
#include "share/live_control.h"
#include "share/run_sharing.h"
#include "share/share_run.h"

namespace thimble::session {
namespace {

bool dents(const scene::SceneObject& object) {
  return object.body.dent.has_value();
}

}  // namespace

/// The parts of a session: what is run, the loop over it, and the observers of its ticks.
struct Session::Parts {
  explicit Parts(std::unique_ptr<Setup> prepared)
      : setup(std::move(prepared)),
        records(setup->ticks(), setup->scene().rate, setup->keep()),
        law(setup->objects().touch(), setup->arm_file(0)),
        more_arms(*setup) {}

  void add_records();
  void add_knobs();
  driver::Result<void> share(const SessionOptions& options, SharedRun* before = nullptr);
  void record_changes() noexcept;
  void begin(const std::atomic<bool>& stop) noexcept;
  RunRecords& records_of(std::size_t arm) noexcept {
    return arm == 0 ? records : more_arms.run(arm).records;
  }
  void end() noexcept;

  std::unique_ptr<Setup> setup;
  RunRecords records;
  std::unique_ptr<PageServer> pages;  // in virtual time, if objects lie on the disk
  std::unique_ptr<SharedRun> shared;
  std::unique_ptr<RunSharing> sharing;   // if it is shared, as is control
  std::unique_ptr<LiveControl> control;  // what viewers ask for
  std::unique_ptr<HeldKnobs> knobs;      // that who holds the session turns
  bool log = false;                      // what happens in the run goes into the log
  std::unique_ptr<EventLog> event_log;   // once the arm is open, if so
  RunLaw law;                            // of the first arm
  RunLoop loop;
  MoreArms more_arms;  // after the first
};

void Session::Parts::add_records() {
  render::SceneTouch& touch = setup->objects().touch();
  const auto& objects = setup->scene().objects;
  const bool all = setup->keep() == Keep::kRun;
  if (all && std::any_of(objects.begin(), objects.end(), dents)) {
    records.dents = std::make_unique<DentRecord>(touch, setup->period_ns());
  }
  if (const auto moving = setup->objects().moving(); all && !moving.empty()) {
    records.poses = std::make_unique<PoseRecord>(touch, moving);
  }
  records.join(loop);
  if (records.dents) loop.add(*records.dents);
  if (records.poses) loop.add(*records.poses);
  loop.add(records.recording);
  if (!setup->real_time() && setup->objects().paging()) {
    pages = std::make_unique<PageServer>(setup->objects());
    loop.add(*pages);
  }
}

void Session::Parts::add_knobs() {
  knobs = std::make_unique<HeldKnobs>(setup->scene(), setup->objects().touch());
  law.scene().set_program_knobs(*knobs);
  loop.add(*knobs);
}

driver::Result<void> Session::Parts::share(const SessionOptions& options, SharedRun* before) {
  if (setup->keep() == Keep::kNewest) {
    return driver::Error{"A session that keeps its newest tick alone cannot be watched."};
  }
  auto own = std::make_unique<LiveControl>(setup->scene(), setup->objects().touch(),
                                           setup->simulation(), setup->real_time());
  auto made = share_run(*setup, own->knobs(), options, before);
  if (!made) return made.error();
  shared = std::move(made).value();
  control = std::move(own);
  law.scene().set_viewers(*control, true);
  sharing = std::make_unique<RunSharing>(
      *shared, RunSharing::Moving{.dent = records.dents ? &records.dents->drawn() : nullptr,
                                  .poses = records.poses ? &records.poses->now() : nullptr,
                                  .shaped = shaped_objects(*setup)});
  loop.add(*sharing);
  loop.add(*control);
  more_arms.share(*shared, *control);
  if (const Recorder* recorder = records.recording.recorder()) {
    shared->set_recording_path(std::filesystem::absolute(recorder->path()).string());
  }
  return {};
}

void Session::Parts::record_changes() noexcept {
  const LawChange* change = law.change();
  if (change == nullptr) return;
  for (std::size_t i = 0; i < setup->arms(); ++i) records_of(i).recording.watch(*change);
}

void Session::Parts::begin(const std::atomic<bool>& stop) noexcept {
  record_changes();
  if (shared) {
    control->join(*shared, setup->hand_by_mouse(), stop, setup->pace());
    shared->set_state(RunState::kRunning);
  }
  const bool go_on_with_the_others =
      setup->arms() > 1 && setup->scene().faults == scene::FaultRule::kApart;
  const driver::ServoSettings settings{
      .period_ns = setup->period_ns(),
      .ticks = setup->ticks(),
      .outlive_faults = setup->any_real() || setup->endless() || go_on_with_the_others,
      .prepare_ns = setup->real_time() ? driver::ServoSettings::kPrepare_ns : 0};
  if (setup->arms() > 1) law.stop_in_fault(setup->device());
  loop.begin(setup->device(), setup->clock(), law.law(), settings);
  more_arms.begin(settings);
}

void Session::Parts::end() noexcept {
  for (std::size_t i = 0; i < setup->arms(); ++i) {
    scene::ArmSimulation* arm = setup->simulation(i);
    if (arm != nullptr) arm->settle(setup->clock().now_ns());
  }
  if (shared) shared->set_state(RunState::kEnded);
}

Session::Session() = default;
Session::~Session() = default;

driver::Result<std::unique_ptr<Session>> Session::prepare(const std::filesystem::path& scene,
                                                          const SessionOptions& options) {
  auto setup = Setup::prepare(scene, options);
  if (!setup) return setup.error();
  std::unique_ptr<Session> session(new Session);
  session->parts_ = std::make_unique<Parts>(std::move(setup).value());
  session->parts_->log = options.log;
  session->parts_->add_records();
  if (options.knobs && session->arms() == 1) session->parts_->add_knobs();
  if (!options.record.empty()) {
    if (auto begun = session->begin_recording(options.record, options.overwrite); !begun)
      return begun.error();
  }
  if (options.share || options.share_out) {
    const auto shared = session->parts_->share(options);
    if (!shared && !options.share_if_possible) return shared.error();
    if (!shared) scene::logger().warn("nobody can watch: {}", shared.error().message);
  }
  return session;
}

driver::Result<std::unique_ptr<Session>> Session::open(const std::filesystem::path& scene,
                                                       const SessionOptions& options) {
  auto session = prepare(scene, options);
  if (!session) return session;
  if (auto opened = (*session)->open_arm(); !opened) return opened.error();
  if (!(*session)->setup().any_real()) return session;
  if (auto placed = (*session)->setup().check_start_pose(); !placed) return placed.error();
  if (auto activated = (*session)->activate(); !activated) return activated.error();
  return session;
}

driver::Result<std::unique_ptr<Session>> Session::open_like(const Session& other,
                                                            std::uint64_t seed) {
  auto setup = Setup::prepare_like(other.setup(), seed);
  if (!setup) return setup.error();
  std::unique_ptr<Session> session(new Session);
  session->parts_ = std::make_unique<Parts>(std::move(setup).value());
  session->parts_->log = other.parts_->log;
  session->parts_->add_records();
  if (other.parts_->knobs) session->parts_->add_knobs();
  if (auto opened = session->open_arm(); !opened) return opened.error();
  return session;
}

driver::Result<void> Session::open_arm() {
  if (auto opened = parts_->setup->open_arm(); !opened) return opened;
  if (parts_->log) {
    parts_->event_log =
        std::make_unique<EventLog>(logged_run(*parts_->setup, 0), parts_->setup->device());
    parts_->loop.add(*parts_->event_log);
  }
  parts_->more_arms.open(parts_->log);
  return {};
}

driver::Result<void> Session::activate() {
  return parts_->setup->activate();
}

driver::Result<void> Session::set_law(driver::ForceLaw law) {
  if (parts_->setup->real_time()) {
    return driver::Error{
        "A force law of one's own runs in virtual time alone; in real time nothing may wait for "
        "it. For that write it in C++ (app/examples/04_own_effect.cpp)."};
  }
  return set_servo_law(law);
}

driver::Result<void> Session::set_servo_law(driver::ForceLaw law) {
  if (arms() > 1) {
    return driver::Error{fmt::format(
        "A force law of one's own is for one arm, and the scene has {}; take a scene of one.",
        arms())};
  }
  if (parts_->loop.begun()) {
    return driver::Error{"The run has begun with another force law; begin a new one."};
  }
  parts_->law.set_caller(law);
  return {};
}

driver::ForceLaw Session::own_law() noexcept {
  return parts_->law.scene().law();
}

driver::Result<void> Session::add_observer(TickObserver& observer, std::size_t arm) {
  if (parts_->loop.begun()) {
    return driver::Error{"The run has begun; add the observer to a new one before its first tick."};
  }
  (arm == 0 ? parts_->loop : parts_->more_arms.run(arm).loop).add(observer);
  return {};
}

driver::ServoEnd Session::run(const std::atomic<bool>& stop) noexcept {
  for (;;) {
    if (const auto end = step(stop)) return *end;
  }
}

std::optional<driver::ServoEnd> Session::step(const std::atomic<bool>& stop) noexcept {
  RunLoop& loop = parts_->loop;
  if (!loop.begun()) parts_->begin(stop);
  const bool ended_before = loop.end().has_value();
  auto end = loop.tick(stop);
  if (!parts_->more_arms.empty()) end = parts_->more_arms.tick(loop, end, stop);
  if (end && !ended_before) parts_->end();
  return end;
}

bool Session::lead_hand(const Eigen::Vector3d& p_WH) noexcept {
  return parts_->setup->simulation()->lead(p_WH);
}

std::vector<Knob> Session::knobs() const {
  return parts_->knobs ? parts_->knobs->list() : std::vector<Knob>();
}

driver::Result<void> Session::turn_knob(const std::string& name, double value) {
  if (parts_->knobs) return parts_->knobs->turn(name, value);
  return driver::Error{arms() > 1 ? "Knobs are turned where the scene has one arm; this one has " +
                                        std::to_string(arms()) + "."
                                  : "The session was opened without knobs."};
}

const scene::Scene& Session::scene() const noexcept {
  return parts_->setup->scene();
}
render::SceneTouch& Session::touch() noexcept {
  return parts_->setup->objects().touch();
}
const render::SceneTouch& Session::touch() const noexcept {
  return parts_->setup->objects().touch();
}
std::size_t Session::arms() const noexcept {
  return parts_->setup->arms();
}
const std::string& Session::arm_name(std::size_t arm) const noexcept {
  return parts_->setup->arm_name(arm);
}
driver::Device& Session::device(std::size_t arm) noexcept {
  return parts_->setup->device(arm);
}
const driver::Device& Session::device(std::size_t arm) const noexcept {
  return parts_->setup->device(arm);
}
scene::ArmSimulation* Session::simulation(std::size_t arm) noexcept {
  return parts_->setup->simulation(arm);
}
const scene::ArmSimulation* Session::simulation(std::size_t arm) const noexcept {
  return parts_->setup->simulation(arm);
}
bool Session::real_time() const noexcept {
  return parts_->setup->real_time();
}
const std::vector<std::string>& Session::told() const noexcept {
  return parts_->setup->told();
}

const driver::Snapshot<driver::TickRecord>& Session::newest(std::size_t arm) const noexcept {
  return parts_->records_of(arm).latest.snapshot();
}
std::span<const driver::TickRecord> Session::ticks(std::size_t arm) const noexcept {
  const KeptTicks* kept = parts_->records_of(arm).kept.get();
  return kept ? kept->trace.rows() : std::span<const driver::TickRecord>();
}
std::uint64_t Session::stride() const noexcept {
  return parts_->records.kept ? parts_->records.kept->trace.stride() : 1;
}
std::uint64_t Session::carry_withdrawn(std::size_t arm) const noexcept {
  return (arm == 0 ? parts_->law : parts_->more_arms.run(arm).law).carry_withdrawn();
}
const RunStatistics& Session::statistics() const noexcept {
  static const RunStatistics kNone;
  return parts_->records.kept ? parts_->records.kept->statistics : kNone;
}

RunFigures Session::figures(const driver::RealTimeGrant& grant, std::size_t arm) const {
  const RunLoop& loop = arm == 0 ? parts_->loop : parts_->more_arms.run(arm).loop;
  auto end = loop.end().value_or(driver::ServoEnd::kStopped);
  // The loop that comes to its end first stops the others.
  if (parts_->more_arms.end() == driver::ServoEnd::kDone) end = driver::ServoEnd::kDone;
  RunFigures figures = figures_of(*parts_->setup, arm, parts_->records_of(arm), end, grant);
  figures.carry_withdrawn = carry_withdrawn(arm);
  return figures;
}

std::optional<int> Session::find_object(const std::string& name) const {
  const auto& objects = scene().objects;
  const auto found = std::find_if(objects.begin(), objects.end(),
                                  [&](const auto& object) { return object.name == name; });
  if (found == objects.end()) return {};
  return static_cast<int>(found - objects.begin());
}

render::TriangleMesh Session::mesh_now(int object) const {
  return parts_->setup->objects().mesh_now(object);
}

std::optional<render::TriangleMesh> Session::deepest_dent() const {
  const DentRecord* dents = parts_->records.dents.get();
  if (dents == nullptr || dents->deepest().triangle_count == 0) return {};
  const render::BodyPatch& patch = dents->deepest();
  const scene::SceneObjects& objects = parts_->setup->objects();
  return bent(objects.mesh_W(), objects.place(static_cast<std::size_t>(patch.object)), patch);
}

driver::Result<void> Session::begin_recording(const std::filesystem::path& path, bool overwrite) {
  constexpr double kLongest = 86400;  // s, of a run without an end; chosen
  const Setup& setup = *parts_->setup;
  const auto ticks_most =
      setup.ticks() > 0 ? setup.ticks()
                        : static_cast<std::uint64_t>(std::ceil(kLongest * setup.scene().rate));
  // All files before the first is begun. A single one is checked where it is opened.
  for (std::size_t arm = 0; arms() > 1 && arm < arms(); ++arm) {
    const auto file = file_of_arm(path, arm_name(arm));
    const auto place = output::resolve_output(file);
    if (!place) return place.error();
    auto may = output::check_replaceable(file, *place, kRecordingOutput, overwrite);
    if (!may) return may;
  }
  if (parts_->shared) {
    parts_->shared->set_recording_path(std::filesystem::absolute(path).string());
  }
  for (std::size_t arm = 0; arm < arms(); ++arm) {
    auto begun = parts_->records_of(arm).recording.begin(file_of_arm(path, arm_name(arm)),
                                                         setup.recording_info(arm), ticks_most,
                                                         setup.real_time(), overwrite);
    if (!begun) return begun;
  }
  return {};
}

driver::Result<std::optional<std::filesystem::path>> Session::end_recording() {
  std::optional<std::filesystem::path> first;
  std::optional<driver::Error> trouble;
  for (std::size_t arm = 0; arm < arms(); ++arm) {
    RecordingSwitch& recording = parts_->records_of(arm).recording;
    const Recorder* recorder = recording.recorder();
    if (recorder != nullptr && !first) first = recorder->path();
    auto stopped = recording.stop();
    if (!stopped && !trouble) trouble = stopped.error();
  }
  if (trouble) return *trouble;
  return first;
}

driver::Result<std::optional<std::filesystem::path>> Session::keep_black_box() {
  auto kept = keep_black_boxes(true);
  if (!kept) return kept.error();
  if (kept->empty()) return std::optional<std::filesystem::path>();
  return std::optional(kept->front());
}

driver::Result<std::vector<std::filesystem::path>> Session::keep_black_boxes(bool run_is_over) {
  std::vector<std::filesystem::path> files;
  for (std::size_t arm = 0; arm < arms(); ++arm) {
    KeptTicks* kept = parts_->records_of(arm).kept.get();
    // The servo fills one that is not full; it may be full for one arm and not for another.
    if (kept == nullptr || !(run_is_over || kept->black_box.full())) continue;
    const auto ticks = kept->black_box.release();
    if (ticks.empty()) continue;
    RecordingInfo info = parts_->setup->recording_info(arm);
    if (arms() > 1) info.scene += "_" + arm_name(arm);
    auto written = write_black_box(ticks, info);
    if (!written) return written.error();
    files.push_back(std::move(written).value());
  }
  return files;
}

RecordingInfo Session::recording_info(std::size_t arm) const {
  return parts_->setup->recording_info(arm);
}

Setup& Session::setup() noexcept {
  return *parts_->setup;
}
const Setup& Session::setup() const noexcept {
  return *parts_->setup;
}
RunRecords& Session::records() noexcept {
  return parts_->records;
}
const RunRecords& Session::records() const noexcept {
  return parts_->records;
}
RunRecords& Session::records(std::size_t arm) noexcept {
  return parts_->records_of(arm);
}
driver::Result<void> Session::share(const SessionOptions& options, SharedRun* before) {
  return parts_->share(options, before);
}
SharedRun* Session::shared() noexcept {
  return parts_->shared.get();
}

}  // namespace thimble::session
