#include "thimble/session/session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "apply_patch.h"
#include "events/event_log.h"
#include "figures/figures_of.h"
#include "log/logger.h"
#include "more_arms.h"
#include "observers/virtual_time_pager.h"
#include "output/output_file.h"
#include "print.h"
#include "recording/recording_layout.h"
#include "recording/write_black_box.h"
#include "run_law.h"
#include "run_loop.h"
#include "run_records.h"
#include "setup.h"
#include "share/live_control.h"
#include "share/program_knobs.h"
#include "share/run_sharing.h"
#include "share/share_run.h"

namespace thimble::session {
namespace {

bool dents(const scene::SceneObject& object) {
  return object.body.dent.has_value();
}

}  // namespace

/// Parts of a session: configuration, loop, and observers of the ticks.
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
  std::unique_ptr<VirtualTimePager> pages;  // set in virtual time if an object is paged from disk
  std::unique_ptr<SharedRun> shared;
  std::unique_ptr<RunSharing> sharing;   // set if the run is shared; also `control`
  std::unique_ptr<LiveControl> control;  // requests of viewers
  std::unique_ptr<ProgramKnobs> knobs;   // changed by the caller
  bool log = false;                      // true to log the events of the run
  std::unique_ptr<EventLog> event_log;   // created once the arm is open, if `log`
  RunLaw law;                            // law of the first arm
  RunLoop loop;
  MoreArms more_arms;  // arms after the first
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
    pages = std::make_unique<VirtualTimePager>(setup->objects());
    loop.add(*pages);
  }
}

void Session::Parts::add_knobs() {
  knobs = std::make_unique<ProgramKnobs>(setup->scene(), setup->objects().touch());
  law.scene().set_program_knobs(*knobs);
  loop.add(*knobs);
}

driver::Result<void> Session::Parts::share(const SessionOptions& options, SharedRun* before) {
  if (setup->keep() == Keep::kNewest) {
    return driver::Error{"A session that keeps only its newest tick cannot have viewers."};
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
  const bool continue_with_others =
      setup->arms() > 1 && setup->scene().faults == scene::FaultRule::kApart;
  const driver::ServoSettings settings{
      .period_ns = setup->period_ns(),
      .ticks = setup->ticks(),
      .continue_after_faults = setup->any_real() || setup->endless() || continue_with_others,
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
  return from_setup(Setup::prepare(scene, options), options);
}

driver::Result<std::unique_ptr<Session>> Session::prepare(const scene::SceneBuilder& scene,
                                                          const SessionOptions& options) {
  if (options.share || options.share_out) {
    return driver::Error{
        "A scene made in code cannot have viewers, which read its file; save it "
        "(SceneBuilder::save) "
        "and open the file."};
  }
  return from_setup(Setup::prepare(scene, options), options);
}

driver::Result<std::unique_ptr<Session>> Session::from_setup(
    driver::Result<std::unique_ptr<Setup>> setup, const SessionOptions& options) {
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
    if (!shared) scene::logger().warn("viewers cannot attach: {}", shared.error().message);
  }
  return session;
}

driver::Result<std::unique_ptr<Session>> Session::open(const std::filesystem::path& scene,
                                                       const SessionOptions& options) {
  return open_prepared(prepare(scene, options));
}

driver::Result<std::unique_ptr<Session>> Session::open(const scene::SceneBuilder& scene,
                                                       const SessionOptions& options) {
  return open_prepared(prepare(scene, options));
}

driver::Result<std::unique_ptr<Session>> Session::open_prepared(
    driver::Result<std::unique_ptr<Session>> session) {
  if (!session) return session;
  if (auto opened = (*session)->open_arm(); !opened) return opened.error();
  if (!(*session)->setup().any_real()) return session;
  if (auto placed = (*session)->setup().check_start_pose(); !placed) return placed.error();
  if (auto activated = (*session)->activate(); !activated) return activated.error();
  return session;
}

driver::Result<std::unique_ptr<Session>> Session::prepare_like(const Session& other,
                                                               std::uint64_t seed) {
  auto setup = Setup::prepare_like(other.setup(), seed);
  if (!setup) return setup.error();
  std::unique_ptr<Session> session(new Session);
  session->parts_ = std::make_unique<Parts>(std::move(setup).value());
  session->parts_->log = other.parts_->log;
  session->parts_->add_records();
  if (other.parts_->knobs) session->parts_->add_knobs();
  return session;
}

driver::Result<std::unique_ptr<Session>> Session::open_like(const Session& other,
                                                            std::uint64_t seed) {
  if (other.setup().real_time()) {
    return driver::Error{"Session::open_like requires a session with virtual time."};
  }
  auto session = prepare_like(other, seed);
  if (!session) return session;
  if (auto opened = (*session)->open_arm(); !opened) return opened.error();
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
        "A custom force law requires virtual time, because the loop may not wait for it in real "
        "time. For real time, write it in C++ (app/examples/04_own_effect.cpp)."};
  }
  return set_servo_law(law);
}

driver::Result<void> Session::set_servo_law(driver::ForceLaw law) {
  if (arms() > 1) {
    return driver::Error{fmt::format(
        "A custom force law supports one arm, and the scene has {}; use a scene with one arm.",
        arms())};
  }
  if (parts_->loop.begun()) {
    return driver::Error{
        "The run has started; set the force law of a new run before its first tick."};
  }
  parts_->law.set_caller(law);
  return {};
}

driver::ForceLaw Session::own_law() noexcept {
  return parts_->law.scene().law();
}

driver::Result<void> Session::add_observer(TickObserver& observer, std::size_t arm) {
  if (parts_->loop.begun()) {
    return driver::Error{
        "The run has started; add the observer to a new run before its first tick."};
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

bool Session::hold_buttons(std::uint16_t buttons) noexcept {
  scene::ArmSimulation* const simulation = parts_->setup->simulation();
  if (simulation == nullptr || !parts_->setup->buttons_allowed()) return false;
  simulation->hold_buttons(buttons);
  return true;
}

std::vector<Knob> Session::knobs() const {
  return parts_->knobs ? parts_->knobs->list() : std::vector<Knob>();
}

driver::Result<void> Session::turn_knob(const std::string& name, double value) {
  if (parts_->knobs) return parts_->knobs->turn(name, value);
  return driver::Error{arms() > 1
                           ? "Knobs require a scene with one arm; this scene has " +
                                 std::to_string(arms()) + "."
                           : "The session was opened without knobs (SessionOptions::knobs)."};
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
const std::vector<std::string>& Session::warnings() const noexcept {
  return parts_->setup->warnings();
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
  // The loop that ends first stops the others.
  if (parts_->more_arms.end() == driver::ServoEnd::kDone) end = driver::ServoEnd::kDone;
  RunFigures figures = figures_of(*parts_->setup, arm, parts_->records_of(arm), end, grant);
  figures.carry_withdrawn = carry_withdrawn(arm);
  return figures;
}

std::vector<RunFigures::Tracker> Session::trackers() const {
  return trackers_of(*parts_->setup);
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
  return apply_patch(objects.mesh_W(), objects.place(static_cast<std::size_t>(patch.object)),
                     patch);
}

driver::Result<void> Session::begin_recording(const std::filesystem::path& path, bool overwrite) {
  constexpr double kLongest = 86400;  // s, for a run of unknown duration; chosen
  const Setup& setup = *parts_->setup;
  const auto max_ticks = setup.ticks() > 0
                             ? setup.ticks()
                             : static_cast<std::uint64_t>(std::ceil(kLongest * setup.scene().rate));
  // Checks all files before the first recording starts. A single file is checked when it is opened.
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
                                                         setup.recording_info(arm), max_ticks,
                                                         setup.real_time(), overwrite);
    if (!begun) return begun;
  }
  return {};
}

driver::Result<std::optional<std::filesystem::path>> Session::end_recording() {
  std::optional<std::filesystem::path> first;
  std::optional<driver::Error> first_error;
  for (std::size_t arm = 0; arm < arms(); ++arm) {
    RecordingSwitch& recording = parts_->records_of(arm).recording;
    const Recorder* recorder = recording.recorder();
    if (recorder != nullptr && !first) first = recorder->path();
    auto stopped = recording.stop();
    if (!stopped && !first_error) first_error = stopped.error();
  }
  if (first_error) return *first_error;
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
    // The servo still writes to a black box that is not full. It may be full for only some of the
    // arms.
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
// In the order in which a tick uses it first.
void Session::list_memory(std::vector<std::span<const std::byte>>& memory) const {
  if (setup().simulation() != nullptr) setup().simulation()->list_memory(memory);
  memory.push_back(std::as_bytes(std::span(this, 1)));
  memory.push_back(std::as_bytes(std::span(parts_.get(), 1)));
  memory.push_back(std::as_bytes(std::span(parts_->loop.observers())));
  setup().objects().touch().list_memory(memory);
  setup().device().list_memory(memory);
}
SharedRun* Session::shared() noexcept {
  return parts_->shared.get();
}

}  // namespace thimble::session
