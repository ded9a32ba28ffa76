#include "vendors/hd/hd_link.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "vendors/slot_link.h"

namespace thimble::driver::hd {
namespace {

using std::chrono::steady_clock;

/// Time for which a force is repeated without a new one from the loop. [chosen: 20 missed ticks]
constexpr auto kForceKept = std::chrono::milliseconds(20);
/// Time for which forces are refused after an error about them. [chosen: five times the time that
/// is a fault]
constexpr auto kRefused = std::chrono::milliseconds(100);
/// Max. wait at the end for the frame with zero force.
constexpr auto kCloseTimeout = std::chrono::milliseconds(200);
/// Interval and number of checks whether the device is calibrated.
constexpr auto kLook = std::chrono::milliseconds(10);
constexpr int kLooksAtOpening = 50, kLooksAtCalibration = 500;
constexpr int kErrorsPerFrame = 8;  // read from the queue; further ones wait for the next frame

constexpr double kMetres = 1e-3;  // per mm
constexpr double kFarthest = 2;   // m, far beyond any position of an arm

Error failure(const Library& library, const std::string& what, unsigned code) {
  const char* why = library.call.hdGetErrorString(code);
  return Error{what + ": the library says \"" + (why == nullptr ? "nothing" : why) + "\"."};
}

/// Empties the queue of errors; returns the first code, 0 if there was none.
unsigned first_error(const Functions& call) {
  unsigned first = 0;
  for (int i = 0; i < kErrorsPerFrame; ++i) {
    const unsigned code = call.hdGetError().code;
    if (code == 0) break;
    if (first == 0) first = code;
  }
  return first;
}

class HdLink;

/// The owner of the library. Its scheduler is one for all devices and links. Therefore one link
/// owns it at a time, and a lost one is shut down before its successor opens the device.
struct Owner {
  std::recursive_mutex mutex;  // recursive: a refused link is destroyed while it is held
  HdLink* link = nullptr;
};

Owner& owner() {
  static Owner only;
  return only;
}

/// An open device, released in the destructor.
class OpenDevice {
 public:
  static Result<OpenDevice> open(const Library& library) {
    first_error(library.call);
    const unsigned device = library.call.hdInitDevice(nullptr);
    const unsigned code = first_error(library.call);
    if (device == kNoDevice || code != 0) {
      if (device != kNoDevice) library.call.hdDisableDevice(device);
      return failure(library,
                     "Cannot open the arm. Check its power and cable, select it as the default "
                     "device in the vendor's set-up, and close other programs that use it",
                     code);
    }
    return OpenDevice(library, device);
  }
  OpenDevice(OpenDevice&& other) noexcept
      : library_(other.library_), device_(std::exchange(other.device_, kNoDevice)) {}
  OpenDevice& operator=(OpenDevice&&) = delete;
  OpenDevice(const OpenDevice&) = delete;
  OpenDevice& operator=(const OpenDevice&) = delete;
  ~OpenDevice() {
    if (device_ != kNoDevice) library_.call.hdDisableDevice(device_);
  }
  const Library& library() const { return library_; }
  const Functions& call() const { return library_.call; }
  unsigned handle() const { return device_; }

 private:
  OpenDevice(const Library& library, unsigned device) : library_(library), device_(device) {}

  Library library_;
  unsigned device_;
};

class HdLink final : public SlotLink {
 public:
  /// Precondition: the caller holds the owner's mutex.
  HdLink(OpenDevice device, const ArmTraits& traits, double max_force, Clock& clock)
      : SlotLink(traits, clock, max_force), device_(std::move(device)) {
    owner().link = this;
    task_ = call().hdScheduleAsynchronous(&HdLink::tick, this, kFirstPriority);
    call().hdStartScheduler();
  }

  ~HdLink() override {
    const std::lock_guard lock(owner().mutex);
    shut_down();
  }

  bool gone() const noexcept { return is_lost(); }

  /// Ends all use of the library, permanently. Precondition: as for the constructor.
  void shut_down() noexcept {
    if (!device_) return;
    ends_.store(true, std::memory_order_release);
    const auto until = steady_clock::now() + kCloseTimeout;
    while (!ended_.load(std::memory_order_acquire) && steady_clock::now() < until) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    call().hdStopScheduler();
    // A callback that has ended is no longer scheduled.
    if (!ended_.load(std::memory_order_acquire)) call().hdUnschedule(task_);
    device_.reset();
    lose();
    owner().link = nullptr;
  }

  /// Switches the forces on after the device reports that it is calibrated.
  Result<void> enable() {
    for (int look = 0; call().hdCheckCalibration() != kCalibrated; ++look) {
      if (look == kLooksAtOpening) {
        return Error{
            "The arm is not calibrated, so its positions are unreliable. Calibrate it: thimble "
            "calibrate --device NAME."};
      }
      std::this_thread::sleep_for(kLook);
    }
    call().hdEnable(kForceOutput);
    return {};
  }

 private:
  const Functions& call() const { return device_->call(); }

  static unsigned tick(void* self) { return static_cast<HdLink*>(self)->frame(); }

  unsigned frame() noexcept {
    const bool last = ends_.load(std::memory_order_acquire);
    const auto now = steady_clock::now();
    call().hdBeginFrame(device_->handle());
    ArmSample sample;
    const bool understood = ask(sample);
    // An arm that is lost or has an unknown pose gets no force.
    const bool trusted = understood && !rejected_ && !is_lost();
    const Eigen::Vector3d f = last || !trusted ? Eigen::Vector3d(0, 0, 0) : force_at(now);
    call().hdSetDoublev(kForce, f.data());
    call().hdEndFrame(device_->handle());
    judge(first_error(call()), understood, sample, now);
    if (last) ended_.store(true, std::memory_order_release);
    return last ? kCallbackDone : kCallbackContinue;
  }

  bool ask(ArmSample& sample) const noexcept {
    std::array<double, 16> transform{};
    int buttons = 0;
    call().hdGetDoublev(kPosition, sample.pose.p_BT.data());
    call().hdGetDoublev(kVelocity, sample.v_BT.data());
    call().hdGetDoublev(kTransform, transform.data());
    call().hdGetIntegerv(kButtons, &buttons);
    sample.pose.p_BT *= kMetres;
    sample.v_BT *= kMetres;
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) {
        sample.R_BT(row, column) = transform[static_cast<std::size_t>(4 * column + row)];
      }
    }
    sample.buttons = static_cast<std::uint16_t>(buttons);
    // Written so that NaN is refused.
    return sample.pose.p_BT.allFinite() && sample.pose.p_BT.cwiseAbs().maxCoeff() < kFarthest &&
           sample.v_BT.allFinite() && sample.R_BT.allFinite();
  }

  Eigen::Vector3d force_at(steady_clock::time_point now) noexcept {
    Eigen::Vector3d fresh;
    if (take_force(fresh)) {
      f_T_B_ = fresh;
      asked_at_ = now;
    } else if (now - asked_at_ > kForceKept) {
      f_T_B_.setZero();
    }
    return now < refused_until_ ? Eigen::Vector3d(0, 0, 0) : f_T_B_;
  }

  void judge(unsigned code, bool understood, const ArmSample& sample,
             steady_clock::time_point now) noexcept {
    if (code >= kWarmMotors && code <= kForceError) {
      refused_until_ = now + kRefused;
    } else if (code >= kDeviceFault && code <= kTimerError) {
      return lose();
    } else if (code != 0 || !understood) {
      rejected_ = true;
      return reject();
    }
    rejected_ = false;
    refuse(now < refused_until_);
    if (understood) publish(sample);
  }

  std::optional<OpenDevice> device_;  // empty after shut_down
  unsigned long task_ = 0;
  std::atomic<bool> ends_{false}, ended_{false};
  // Used only by the scheduler's thread.
  Eigen::Vector3d f_T_B_{0, 0, 0};
  steady_clock::time_point asked_at_, refused_until_;
  bool rejected_ = false;  // the previous frame was rejected
};

/// Opens the device if no other link of this program has it. Precondition: the caller holds the
/// owner's mutex.
Result<OpenDevice> take_device(const Library& library) {
  if (HdLink* const link = owner().link; link != nullptr) {
    if (!link->gone()) {
      return Error{
          "This program has already opened the arm through OpenHaptics. End that run first."};
    }
    link->shut_down();
  }
  return OpenDevice::open(library);
}

}  // namespace

Result<std::unique_ptr<ArmLink>> open_link(const Library& library, Clock& clock) {
  const std::lock_guard lock(owner().mutex);
  auto device = take_device(library);
  if (!device) return device.error();
  double nominal = 0;
  device->call().hdGetDoublev(kNominalMaxForce, &nominal);
  if (first_error(device->call()) != 0 || !(nominal > 0)) {
    return Error{
        "The library reports no nominal force of the arm, so no force is sent. Check that the "
        "driver is the one for this arm."};
  }
  const ArmTraits traits{.has_velocity = true, .has_orientation = true};
  auto link = std::make_unique<HdLink>(std::move(device).value(), traits, nominal, clock);
  if (auto enabled = link->enable(); !enabled) return enabled.error();
  return std::unique_ptr<ArmLink>(std::move(link));
}

Result<std::string> how_to_calibrate(const Library& library) {
  const std::lock_guard lock(owner().mutex);
  auto device = take_device(library);
  if (!device) return device.error();
  int styles = 0;
  device->call().hdGetIntegerv(kCalibrationStyle, &styles);
  const auto asks = static_cast<unsigned>(styles);
  if ((asks & kStyleInkwell) != 0) return std::string("Put the stylus into its inkwell.");
  if ((asks & kStyleAuto) != 0) {
    return std::string(
        "After you press Enter, move the stylus slowly through its whole workspace.");
  }
  return std::string(
      "Hold the arm in its reset pose, with all links at right angles, as its manual shows.");
}

Result<void> calibrate(const Library& library) {
  const std::lock_guard lock(owner().mutex);
  auto device = take_device(library);
  if (!device) return device.error();
  const Functions& call = device->call();
  int styles = 0;
  call.hdGetIntegerv(kCalibrationStyle, &styles);
  const auto asks = static_cast<unsigned>(styles);
  const unsigned style = (asks & kStyleInkwell) != 0 ? kStyleInkwell
                         : (asks & kStyleAuto) != 0  ? kStyleAuto
                                                     : kStyleEncoderReset;
  call.hdStartScheduler();
  bool done = false;
  for (int look = 0; look < kLooksAtCalibration && !done; ++look) {
    if (look % 10 == 0) call.hdUpdateCalibration(style);
    std::this_thread::sleep_for(kLook);
    done = call.hdCheckCalibration() == kCalibrated;
  }
  call.hdStopScheduler();
  const unsigned code = first_error(call);
  if (done) return {};
  return failure(library, "The arm was not calibrated", code);
}

}  // namespace thimble::driver::hd
