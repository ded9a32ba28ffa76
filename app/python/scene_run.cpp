#include "scene_run.h"

#include <fmt/format.h>

#include <cmath>

#include "hold_key.h"
#include "log/logger.h"
#include "thimble/scene/quality.h"
#include "thimble/scene/real_arm.h"
#include "thimble/scene/shipped_files.h"
#include "thimble/session/servo_thread.h"
#include "thimble_error.h"

namespace thimble::python {
namespace {

constexpr int kTicksBetweenQuestions = 1024;  // 1 ms of work in virtual time; chosen
constexpr double kSecondsMax = 86400;         // as in `thimble run --duration`

/// Sets a flag until the end of the scope: two Python threads, or a force law that steps its own
/// run, may not use one session at once.
class Claim {
 public:
  explicit Claim(bool& busy) : busy_(busy) {
    if (busy_) throw ThimbleError("This run is already being stepped.");
    busy_ = true;
  }
  ~Claim() { busy_ = false; }
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

 private:
  bool& busy_;
};

/// Prints warnings to stderr, e.g. the limits of a real arm.
void log_warnings(const std::vector<std::string>& sentences) {
  for (const std::string& sentence : sentences) {
    scene::logger().warn("{}", sentence);
  }
}

}  // namespace

session::SessionOptions session_options(const RunOptions& options) {
  session::SessionOptions asked;
  if (options.seconds && !(*options.seconds >= 1e-3 && *options.seconds <= kSecondsMax)) {
    throw ArgumentError(
        fmt::format("seconds: expected 0.001 to 86400, found {:g}.", *options.seconds));
  }
  const auto quality = scene::quality_named(options.quality);
  if (!quality) {
    throw ArgumentError("quality: expected draft, normal, reference or auto, found \"" +
                        options.quality + "\".");
  }
  const auto plugged_in =
      options.device == "sim"
          ? driver::Result<std::vector<driver::FoundArm>>(std::vector<driver::FoundArm>())
          : scene::find_arms();
  asked.real_arm = named_by(scene::choose_arm(
      plugged_in ? *plugged_in : std::vector<driver::FoundArm>(), options.device));
  if (options.device == "auto" && !asked.real_arm) {
    throw ThimbleError(
        "No arm is plugged in that Thimble supports. Run `thimble doctor` to find the reason, or "
        "use "
        "the simulated arm: device=\"sim\".");
  }
  if (asked.real_arm && !options.agreed) {
    throw ThimbleError(
        asked.real_arm->arm + " " + asked.real_arm->name() +
        " will move by itself. Keep clear of it, hold its grip, keep its switch within reach, and "
        "pass agree=True.");
  }
  if (!options.arm_file.empty()) asked.arm_file = named_by(scene::find_arm_file(options.arm_file));
  asked.knobs = true;
  if (asked.real_arm) {
    asked.terms =
        value_of(scene::find_arm_policy(*asked.real_arm, {.arm_file = asked.arm_file,
                                                          .firmware = options.firmware,
                                                          .unchecked = options.unchecked}));
    log_warnings(asked.terms->warnings);
  }
  if (asked.real_arm) {  // requested on a temporary thread, before the arm is opened
    const auto allowed =
        session::check_real_time(session::ServoThread(true).grant(), options.no_real_time);
    if (!allowed) throw ThimbleError(allowed.error().message + " In Python: no_real_time=True.");
  }
  asked.homed = options.homed;
  const auto hold = session::hold_named(options.hold_to_run);
  if (!hold) throw ArgumentError("hold_to_run: " + hold.error().message);
  if (hold->by_caller) {
    throw ArgumentError(
        "hold_to_run: a key cannot be used in Python. Name a button of the arm, e.g. \"button\".");
  }
  asked.hold = *hold;
  asked.several_arms = true;
  const bool real_time = options.real_time || asked.real_arm;
  asked.clock = real_time ? session::ClockKind::kWall : session::ClockKind::kVirtual;
  asked.duration = options.seconds;
  asked.seed = options.seed;
  asked.buttons_by_program = true;
  asked.firmware = options.firmware;
  asked.record = options.record;
  asked.overwrite = options.overwrite;
  asked.meshes = options.meshes;
  asked.quality = options.quality;
  return asked;
}

SceneRun::SceneRun(const RunOptions& options) {
  const std::filesystem::path scene = named_by(scene::find_scene(options.scene));
  const session::SessionOptions asked = session_options(options);
  session_ = read_from(scene, session::Session::open(scene, asked));
  log_warnings(session_->warnings());
  if (!options.topics) return;
  if (!options.real_time) {
    throw ThimbleError("ros2: topics require a run in real time. Use thimble.open.");
  }
  asked_topics_ = value_of(ros2::ros_options(*options.topics));
}

SceneRun::~SceneRun() {
  try {
    stop();
    finish();
  } catch (const std::exception& trouble) {
    scene::logger().error("{}", trouble.what());
  }
}

std::string SceneRun::topics_report() const {
  std::string all;
  for (const auto& arm : topics_) all += arm->report();
  return all;
}

bool SceneRun::running() const noexcept {
  return servo_ && !servo_->ended();
}

std::optional<driver::ServoEnd> SceneRun::end() noexcept {
  if (running()) return {};
  if (servo_) end_ = servo_->join();
  return end_;
}

bool SceneRun::step() {
  if (session_->real_time()) throw ThimbleError("A run in real time cannot be stepped.");
  const Claim claim(busy_);
  return take_step();
}

bool SceneRun::take_step() {
  if (end_) return false;
  end_ = session_->step(stop_);
  if (!end_) return true;
  finish();
  return false;
}

void SceneRun::run(const std::function<bool()>& stop_asked) {
  if (session_->real_time()) throw ThimbleError("A run in real time must be started by start().");
  const Claim claim(busy_);
  for (int ticks = 1; take_step(); ++ticks) {
    if (ticks % kTicksBetweenQuestions == 0 && stop_asked()) ask_to_stop();
  }
}

void SceneRun::start() {
  if (!session_->real_time())
    throw ThimbleError("A run in virtual time cannot be started; use run() or step().");
  if (servo_ || end_) throw ThimbleError("This run was already started.");
  for (std::size_t arm = 0; asked_topics_ && arm < session_->arms(); ++arm) {
    topics_.push_back(value_of(ros2::RosRun::open(*session_, *asked_topics_, arm)));
  }
  servo_ = std::make_unique<session::ServoThread>(true);
  grant_ = servo_->grant();
  servo_->begin(*session_, stop_);
}

void SceneRun::stop() {
  ask_to_stop();
  if (servo_) end_ = servo_->join();
  if (!session_->real_time() && !end_) {
    const Claim claim(busy_);
    take_step();
  } else if (end_) {
    finish();
  }
}

void SceneRun::finish() {
  if (finished_) return;
  finished_ = true;
  servo_.reset();  // no longer keeps the processor awake
  if (const auto kept = session_->keep_black_boxes(true); kept) {
    for (const auto& file : *kept) {
      scene::logger().warn("the last seconds before the fault are saved in {}", file.string());
    }
  }
  if (const auto ended = session_->end_recording(); !ended)
    throw ThimbleError(ended.error().message);
}

std::span<const driver::TickRecord> SceneRun::ticks(std::size_t arm) const {
  if (running())
    throw ThimbleError("The run has not ended. Call stop() before you read its ticks.");
  return session_->ticks(arm);
}

session::RunFigures SceneRun::figures(std::size_t arm) {
  if (!end()) throw ThimbleError("The run has not ended, so it has no figures yet.");
  return session_->figures(grant_, arm);
}

}  // namespace thimble::python
