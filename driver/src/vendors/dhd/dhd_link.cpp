#include "vendors/dhd/dhd_link.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "vendors/slot_link.h"

namespace thimble::driver::dhd {
namespace {

constexpr char kId = 0;  // id of the only arm
constexpr int kOn = 1, kOff = 0;

/// Time after which the arm's watchdog switches the motors off, in steps of 125 us [S
/// forcedimension_core]: 20 ms, equal to kForceKept [chosen; the max. is 32 ms].
constexpr unsigned char kWatchdog = 160;

/// Interval of checks whether the forces are still on; the library does not report that unasked.
/// [chosen: every 8 ms at 4 kHz, less than half of the time that is a fault]
constexpr unsigned kStatusEvery = 32;
constexpr std::size_t kStatusSize = 17, kStatusForce = 5;  // [S forcedimension_core]

/// Time for which a force is repeated without a new one from the loop. [chosen: 20 missed ticks]
constexpr auto kForceKept = std::chrono::milliseconds(20);

/// Number of failed reads in a row after which the arm is lost. [chosen: 50 ms at 4 kHz]
constexpr int kFailuresMax = 200;

/// Far beyond any position of an arm, m: a position in a wrong unit is rejected.
constexpr double kFarthest = 2;

Error failure(const Library& library, const std::string& what) {
  const char* why = library.call.dhdErrorGetLastStr();
  return Error{what + ": the library says \"" + (why == nullptr ? "nothing" : why) + "\"."};
}

class DhdLink;

/// The owner of the library. The library's functions have one arm and no handles, so anything that
/// a link does at its end affects the arm of all links. Therefore one link owns it at a time, and a
/// lost one is shut down before its successor opens the arm.
struct Owner {
  std::recursive_mutex mutex;  // recursive: a refused link is destroyed while it is held
  DhdLink* link = nullptr;
};

Owner& owner() {
  static Owner only;
  return only;
}

/// An open arm, closed in the destructor.
class OpenArm {
 public:
  static Result<OpenArm> open(const Library& library) {
    const int count = library.call.dhdGetDeviceCount();
    if (count < 1) {
      return Error{
          "Force Dimension's library found no arm. Check the arm's power and cable, and the udev "
          "rule (thimble doctor)."};
    }
    if (count > 1) {
      return Error{"Force Dimension's library found " + std::to_string(count) +
                   " arms, and only one is supported. Unplug the others."};
    }
    if (library.call.drdOpenID(kId) < 0) {
      return failure(library, "Cannot open the arm. Close other programs that use it");
    }
    return OpenArm(library);
  }
  OpenArm(OpenArm&& other) noexcept
      : library_(other.library_), open_(std::exchange(other.open_, false)) {}
  OpenArm& operator=(OpenArm&&) = delete;
  OpenArm(const OpenArm&) = delete;
  OpenArm& operator=(const OpenArm&) = delete;
  ~OpenArm() {
    if (open_) library_.call.drdClose(kId);
  }
  const Library& library() const { return library_; }
  const Functions& call() const { return library_.call; }

 private:
  explicit OpenArm(const Library& library) : library_(library) {}

  Library library_;
  bool open_ = true;
};

class DhdLink final : public SlotLink {
 public:
  /// Precondition: the caller holds the owner's mutex.
  DhdLink(OpenArm arm, const ArmTraits& traits, Clock& clock)
      : SlotLink(traits, clock), arm_(std::move(arm)) {
    owner().link = this;
    thread_ = std::thread([this] { run(); });
  }

  ~DhdLink() override {
    const std::lock_guard lock(owner().mutex);
    shut_down();
  }

  bool gone() const noexcept { return is_lost(); }

  /// Ends all use of the library, permanently. Precondition: as for the constructor.
  void shut_down() noexcept {
    if (!arm_) return;
    ends_.store(true, std::memory_order_release);
    thread_.join();
    const Functions& call = arm_->call();
    call.dhdSetForce(0, 0, 0, kId);
    call.dhdEnableForce(kOff, kId);
    call.dhdStop(kId);
    arm_.reset();
    lose();
    owner().link = nullptr;
  }

 private:
  void run() noexcept {
    const Functions& call = arm_->call();
    while (!ends_.load(std::memory_order_acquire) && !is_lost()) {
      ArmSample sample;
      if (ask(call, sample)) {
        failures_ = 0;
        publish(sample);
      } else {
        reject();
        if (++failures_ > kFailuresMax) lose();
      }
      send(call);
      if (++exchanges_ % kStatusEvery == 0) check_force_enabled(call);
    }
  }

  /// Notifies the loop of forces that the library has switched off: by its watchdog, after too fast
  /// a motion, or by the arm's button. They stay off until the arm is reopened.
  void check_force_enabled(const Functions& call) noexcept {
    std::array<int, kStatusSize> status{};
    if (call.dhdGetStatus(status.data(), kId) >= 0) refuse(status[kStatusForce] == 0);
  }

  bool ask(const Functions& call, ArmSample& sample) const noexcept {
    Eigen::Vector3d& p = sample.pose.p_BT;
    Eigen::Vector3d& v = sample.v_BT;
    if (call.dhdGetPosition(&p.x(), &p.y(), &p.z(), kId) < 0) return false;
    if (call.dhdGetLinearVelocity(&v.x(), &v.y(), &v.z(), kId) < 0) return false;
    // Written so that NaN is refused.
    if (!(p.cwiseAbs().maxCoeff() < kFarthest) || !p.allFinite() || !v.allFinite()) return false;
    if (traits().has_orientation) {
      double frame[3][3];
      if (call.dhdGetOrientationFrame(frame, kId) < 0) return false;
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) sample.R_BT(row, column) = frame[row][column];
      }
      if (!sample.R_BT.allFinite()) return false;
    }
    if (traits().has_gripper) {
      if (call.dhdGetGripperGap(&sample.gripper, kId) < 0) return false;
      if (!std::isfinite(sample.gripper)) return false;
    }
    sample.buttons = static_cast<std::uint16_t>(call.dhdGetButtonMask(kId));
    return true;
  }

  void send(const Functions& call) noexcept {
    const auto now = std::chrono::steady_clock::now();
    Eigen::Vector3d fresh;
    if (take_force(fresh)) {
      f_T_B_ = fresh;
      asked_at_ = now;
    } else if (now - asked_at_ > kForceKept) {
      f_T_B_.setZero();
    }
    // An arm with an unknown pose gets no force.
    const Eigen::Vector3d f = failures_ == 0 ? f_T_B_ : Eigen::Vector3d(0, 0, 0);
    if (call.dhdSetForce(f.x(), f.y(), f.z(), kId) < 0) lose();
  }

  std::optional<OpenArm> arm_;  // empty after shut_down
  std::atomic<bool> ends_{false};
  // Used only by the thread.
  Eigen::Vector3d f_T_B_{0, 0, 0};
  std::chrono::steady_clock::time_point asked_at_;
  int failures_ = 0;
  unsigned exchanges_ = 0;
  std::thread thread_;
};

/// Switches the forces on, in the order of the open clients [S ICube fd_effort_hi.cpp]: no force
/// before the watchdog is set.
Result<void> enable(const OpenArm& arm) {
  const Functions& call = arm.call();
  const auto step = [&](int answer, const char* what) -> Result<void> {
    if (answer < 0) return failure(arm.library(), std::string("The arm did not ") + what);
    return {};
  };
  // Only expert mode can set the watchdog, and the arm must not stay in expert mode.
  call.dhdEnableExpertMode();
  const int watched = call.dhdSetWatchdog(kWatchdog, kId);
  auto done_watch = step(watched, "accept the watchdog timeout");
  call.dhdDisableExpertMode();
  if (!done_watch) return done_watch;
  if (auto done = step(call.dhdSetGravityCompensation(kOn, kId), "switch on gravity compensation");
      !done) {
    return done;
  }
  if (auto done = step(call.dhdSetBrakes(kOff, kId), "release its brakes"); !done) return done;
  return step(call.dhdEnableForce(kOn, kId), "switch on its forces");
}

/// Opens the arm if no other link of this program has it. Precondition: the caller holds the
/// owner's mutex.
Result<OpenArm> take_arm(const Library& library) {
  if (DhdLink* const link = owner().link; link != nullptr) {
    if (!link->gone()) {
      return Error{
          "This program has already opened the arm through Force Dimension's library. End that run "
          "first."};
    }
    link->shut_down();
  }
  return OpenArm::open(library);
}

}  // namespace

Result<std::unique_ptr<ArmLink>> open_link(const Library& library, Clock& clock) {
  const std::lock_guard lock(owner().mutex);
  auto arm = take_arm(library);
  if (!arm) return arm.error();
  const Functions& call = arm->call();
  if (!call.drdIsInitialized(kId)) {
    return Error{
        "The arm is not initialised. Let go of the arm and run `thimble calibrate --device NAME`; "
        "the arm then moves by itself to find its zero."};
  }
  const ArmTraits traits{.has_velocity = true,
                         .has_orientation = call.dhdHasWrist(kId),
                         .has_gripper = call.dhdHasGripper(kId)};
  if (auto enabled = enable(*arm); !enabled) {
    call.dhdStop(kId);
    return enabled.error();
  }
  return std::unique_ptr<ArmLink>(std::make_unique<DhdLink>(std::move(arm).value(), traits, clock));
}

Result<void> find_zero(const Library& library) {
  const std::lock_guard lock(owner().mutex);
  auto arm = take_arm(library);
  if (!arm) return arm.error();
  const Functions& call = arm->call();
  if (call.drdIsInitialized(kId)) return {};
  if (call.drdAutoInit(kId) < 0 || !call.drdIsInitialized(kId)) {
    const Error error = failure(library, "The arm did not find its zero position");
    call.drdStop(false, kId);
    return error;
  }
  call.drdStop(false, kId);
  return {};
}

}  // namespace thimble::driver::dhd
