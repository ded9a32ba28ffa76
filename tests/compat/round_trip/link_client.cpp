// Opens an arm with one of Thimble's drivers for a vendor's library. `thimble exec` replaces that
// library by the compatibility library. The program requests another force in each tick, and logs
// the state known at this end, until the arm has reported ARM_TICKS of its ticks.
//   link_client dhd|hd ARM_FILE LOG ARM_TICKS
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "support/patient_clock.h"
#include "thimble/driver/device.h"
#include "thimble/scene/arm_file.h"
#include "vendors/dhd/dhd_link.h"
#include "vendors/hd/hd_link.h"

namespace {

using namespace thimble;

driver::Result<std::unique_ptr<driver::ArmLink>> open_link(const std::string& kind,
                                                           driver::Clock& clock) {
  if (kind == "dhd") {
    const auto library = driver::dhd::library();
    if (!library) return library.error();
    return driver::dhd::open_link(*library, clock);
  }
  const auto library = driver::hd::library();
  if (!library) return library.error();
  if (auto calibrated = driver::hd::calibrate(*library); !calibrated) return calibrated.error();
  return driver::hd::open_link(*library, clock);
}

/// Returns the force of a tick, N. It depends only on the time, because the arm has another clock:
/// a spring with that delay would oscillate.
Eigen::Vector3d push_of(int tick) {
  const double t = 1e-3 * tick;
  return {0.4 * std::sin(5 * t), 0.5 * std::cos(3 * t), 0.3 * std::sin(7 * t + 1)};
}

int complain(const driver::Error& error) {
  std::fprintf(stderr, "link_client: %s\n", error.message.c_str());
  return 1;
}

int run(const std::string& kind, const char* arm_file, std::FILE* log, std::uint64_t arm_ticks) {
  const auto arm = scene::load_arm(arm_file);
  if (!arm) return complain(arm.error());
  driver::DeviceSettings settings = scene::device_settings(*arm, 1000, driver::EnergyStage::kNone);
  // The arm has another clock, so times of both are not compared.
  settings.silence_limit_ns = 60'000'000'000;
  settings.limits.speed_max = 20;
  settings.motion = {};
  // A twentieth of real time.
  support::PatientClock clock(0.05);
  auto link = open_link(kind, clock);
  if (!link) return complain(link.error());
  auto device = driver::Device::open(std::move(link).value(), settings, clock.now_ns());
  if (!device) return complain(device.error());
  if (auto active = (*device)->activate(); !active) return complain(active.error());
  // Depending on the load, many ticks here may be few ticks of the arm.
  const auto arm_reported = [&] {
    return (*device)->wire_counters().reports + (*device)->wire_counters().skipped;
  };
  for (int tick = 0; arm_reported() < arm_ticks && (*device)->fault() == driver::Fault::kNone;
       ++tick) {
    const std::int64_t next_ns = clock.now_ns() + 1'000'000;
    clock.sleep_until_ns(next_ns);
    (*device)->read(next_ns, next_ns + 20'000'000);
    const driver::DeviceState& state = (*device)->state();
    (*device)->write({.f_T_W = push_of(tick), .touch = {}});
    const Eigen::Vector3d& f = (*device)->f_sent_W();
    if (!state.fresh) {
      std::fprintf(log, "- - - - - - %.17g %.17g %.17g\n", f.x(), f.y(), f.z());
      continue;
    }
    std::fprintf(log, "%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", state.p_WT.x(),
                 state.p_WT.y(), state.p_WT.z(), state.v_WT.x(), state.v_WT.y(), state.v_WT.z(),
                 f.x(), f.y(), f.z());
  }
  if ((*device)->fault() == driver::Fault::kNone) return 0;
  std::fprintf(stderr, "link_client: fault: %s\n",
               std::string(driver::name((*device)->fault())).c_str());
  return 1;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) return 2;
  std::FILE* const log = std::fopen(arguments[3], "w");
  if (log == nullptr) return 2;
  const int code = run(arguments[1], arguments[2], log, std::strtoull(arguments[4], nullptr, 10));
  std::fclose(log);
  return code;
}
