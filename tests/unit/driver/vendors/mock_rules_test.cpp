// The mock libraries of the link tests are strict: each rule is broken here once, and the mock
// reports it. A rule that cannot be broken would prove nothing about the links.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <thread>

#include "support/mock/mock_dhd.h"
#include "support/mock/mock_hd.h"
#include "vendors/dhd/dhd_library.h"
#include "vendors/hd/hd_library.h"

namespace thimble::driver {
namespace {

template <class Mock>
Mock& mock_of(const char* file, const char* name) {
  void* const handle = dlopen(file, RTLD_LAZY);
  return *reinterpret_cast<Mock* (*)()>(dlsym(handle, name))();
}

/// Expects that a mock reports only the last of some calls, with the given words.
template <class Mock>
void expect_complaint(Mock& mock, const std::string& words, const std::function<void()>& before,
                      const std::function<void()>& wrong) {
  mock.reset();
  before();
  EXPECT_TRUE(mock.wrong.empty()) << words << ": too early: " << mock.wrong.front();
  mock.wrong.clear();
  wrong();
  ASSERT_FALSE(mock.wrong.empty()) << "not reported: " << words;
  EXPECT_EQ(mock.wrong.front(), words);
}

TEST(MockDhd, ReportsEachCallThatIsOutOfOrder) {
  const auto library = dhd::load(THIMBLE_MOCK_DHD);
  ASSERT_TRUE(library) << library.error().message;
  const dhd::Functions& call = library->call;
  auto& mock = mock_of<support::MockDhd>(THIMBLE_MOCK_DHD, "mock_dhd");
  constexpr char kId = 0;
  const auto nothing = [] {};
  const auto open = [&] { call.drdOpenID(kId); };
  const auto watch = [&] {
    open();
    call.dhdEnableExpertMode();
    call.dhdSetWatchdog(160, kId);
    call.dhdDisableExpertMode();
  };
  const auto ready = [&] {  // for force
    watch();
    call.drdIsInitialized(kId);
    call.dhdSetGravityCompensation(1, kId);
    call.dhdSetBrakes(0, kId);
  };
  const auto pushing = [&] {
    ready();
    call.dhdEnableForce(1, kId);
    call.dhdSetForce(0.1, 0, 0, kId);
  };
  const auto enable = [&] { call.dhdEnableForce(1, kId); };
  double x = 0, y = 0, z = 0, frame[3][3];
  struct Row {
    const char* words;
    std::function<void()> before, wrong;
  };
  const Row rows[] = {
      {"dhdGetPosition before open or after close", nothing,
       [&] { call.dhdGetPosition(&x, &y, &z, kId); }},
      {"dhdSetForce before open or after close",
       [&] {
         open();
         call.drdClose(kId);
       },
       [&] { call.dhdSetForce(0, 0, 0, kId); }},
      {"dhdGetPosition with another arm's number", open,
       [&] { call.dhdGetPosition(&x, &y, &z, 1); }},
      {"drdOpenID twice", open, open},
      {"dhdSetWatchdog without expert functions", open, [&] { call.dhdSetWatchdog(160, kId); }},
      {"dhdSetWatchdog switches it off",
       [&] {
         open();
         call.dhdEnableExpertMode();
       },
       [&] { call.dhdSetWatchdog(0, kId); }},
      {"dhdSetWatchdog shorter than 10 ms",
       [&] {
         open();
         call.dhdEnableExpertMode();
       },
       [&] { call.dhdSetWatchdog(10, kId); }},
      {"dhdEnableForce for an uninitialised arm",
       [&] {
         watch();
         call.dhdSetGravityCompensation(1, kId);
         call.dhdSetBrakes(0, kId);
       },
       enable},
      {"dhdEnableForce before the watchdog",
       [&] {
         open();
         call.drdIsInitialized(kId);
         call.dhdSetGravityCompensation(1, kId);
         call.dhdSetBrakes(0, kId);
       },
       enable},
      {"dhdEnableForce before gravity compensation",
       [&] {
         watch();
         call.drdIsInitialized(kId);
         call.dhdSetBrakes(0, kId);
       },
       enable},
      {"dhdEnableForce with the brakes on",
       [&] {
         ready();
         call.dhdSetBrakes(1, kId);
       },
       enable},
      {"dhdEnableForce by an expert",
       [&] {
         ready();
         call.dhdEnableExpertMode();
       },
       enable},
      {"dhdSetForce before the forces are on", ready, [&] { call.dhdSetForce(0.1, 0, 0, kId); }},
      {"dhdSetForce with NaN or infinity", pushing,
       [&] { call.dhdSetForce(std::numeric_limits<double>::quiet_NaN(), 0, 0, kId); }},
      {"dhdEnableForce off during a force", pushing, [&] { call.dhdEnableForce(0, kId); }},
      {"drdClose with the forces on",
       [&] {
         pushing();
         call.dhdSetForce(0, 0, 0, kId);
       },
       [&] { call.drdClose(kId); }},
      {"dhdGetOrientationFrame of an arm without a wrist", open,
       [&] { call.dhdGetOrientationFrame(frame, kId); }},
      {"dhdGetGripperGap of an arm without a gripper", open,
       [&] { call.dhdGetGripperGap(&x, kId); }}};
  for (const Row& row : rows) expect_complaint(mock, row.words, row.before, row.wrong);
  mock.reset();
}

/// The action of a scheduled task in its only call.
struct Turn {
  std::function<void()> act;
  std::atomic<bool> done{false};

  static unsigned run(void* self) {
    auto* const turn = static_cast<Turn*>(self);
    turn->act();
    turn->done = true;
    return hd::kCallbackDone;
  }
};

TEST(MockHd, ReportsEachCallThatIsOutOfOrder) {
  const auto library = hd::load(THIMBLE_MOCK_HD);
  ASSERT_TRUE(library) << library.error().message;
  const hd::Functions& call = library->call;
  auto& mock = mock_of<support::MockHd>(THIMBLE_MOCK_HD, "mock_hd");
  const auto nothing = [] {};
  unsigned device = 0;
  const auto open = [&] { device = call.hdInitDevice(nullptr); };
  const auto frame = [&] {
    open();
    call.hdBeginFrame(device);
  };
  const auto calibrated = [&] {
    open();
    call.hdCheckCalibration();
  };
  const auto pushing = [&] {
    calibrated();
    call.hdEnable(hd::kForceOutput);
    call.hdBeginFrame(device);
    const double f[3] = {0.1, 0, 0};
    call.hdSetDoublev(hd::kForce, f);
    call.hdEndFrame(device);
  };
  double values[16] = {};
  int buttons = 0;
  const auto set = [&](double x) {
    const double f[3] = {x, 0, 0};
    call.hdSetDoublev(hd::kForce, f);
  };
  unsigned long task = 0;
  Turn idle{[] {}};
  const auto schedule = [&] { task = call.hdScheduleAsynchronous(&Turn::run, &idle, 1); };
  struct Row {
    const char* words;
    std::function<void()> before, wrong, after = [] {};
  };
  const Row rows[] = {
      {"hdInitDevice twice", open, open},
      {"hdBeginFrame before hdInitDevice", nothing, [&] { call.hdBeginFrame(0); }},
      {"hdCheckCalibration before hdInitDevice", nothing, [&] { call.hdCheckCalibration(); }},
      {"hdScheduleAsynchronous before hdInitDevice", nothing, schedule,
       [&] { call.hdUnschedule(task); }},
      {"hdScheduleAsynchronous without a callback", open,
       [&] { call.hdScheduleAsynchronous(nullptr, nullptr, 1); }},
      {"hdStartScheduler before hdInitDevice", nothing, [&] { call.hdStartScheduler(); },
       [&] { call.hdStopScheduler(); }},
      {"hdStopScheduler without hdStartScheduler", open, [&] { call.hdStopScheduler(); }},
      {"hdUpdateCalibration without a scheduler", open, [&] { call.hdUpdateCalibration(4); }},
      {"an unsupported style",
       [&] {
         open();
         call.hdStartScheduler();
       },
       [&] { call.hdUpdateCalibration(2); }, [&] { call.hdStopScheduler(); }},
      {"forces on before the arm is calibrated", open, [&] { call.hdEnable(hd::kForceOutput); }},
      {"forces on before the arm is calibrated",
       [&] {
         mock.calibrated = false;
         calibrated();
       },
       [&] { call.hdEnable(hd::kForceOutput); }},
      {"hdEnable of an unknown capability", calibrated, [&] { call.hdEnable(0x4001); }},
      {"hdBeginFrame in a frame", frame, [&] { call.hdBeginFrame(device); }},
      {"hdEndFrame without hdBeginFrame", open, [&] { call.hdEndFrame(device); }},
      {"hdGetDoublev outside of a frame", open, [&] { call.hdGetDoublev(hd::kPosition, values); }},
      {"hdGetDoublev of an unknown parameter", frame, [&] { call.hdGetDoublev(0x2100, values); }},
      {"hdGetIntegerv outside of a frame", open,
       [&] { call.hdGetIntegerv(hd::kButtons, &buttons); }},
      {"hdSetDoublev outside of a frame", open, [&] { set(0); }},
      {"a force before forces are on", frame, [&] { set(0.1); }},
      {"a force that is NaN or infinite",
       [&] {
         pushing();
         call.hdBeginFrame(device);
       },
       [&] { set(std::numeric_limits<double>::quiet_NaN()); }},
      {"more than the nominal force",
       [&] {
         pushing();
         call.hdBeginFrame(device);
       },
       [&] { set(3.5); }},
      {"a callback left its frame open", open,
       [&] {
         Turn forgetful{[&] { call.hdBeginFrame(device); }};
         call.hdScheduleAsynchronous(&Turn::run, &forgetful, 1);
         call.hdStartScheduler();
         while (!forgetful.done) std::this_thread::sleep_for(std::chrono::milliseconds(1));
         call.hdStopScheduler();
       }},
      {"hdUnschedule of an unknown task", open, [&] { call.hdUnschedule(4711); }},
      {"hdDisableDevice of a closed device", nothing, [&] { call.hdDisableDevice(0); }},
      {"hdDisableDevice during a force", pushing, [&] { call.hdDisableDevice(device); }},
      {"hdDisableDevice while the scheduler runs",
       [&] {
         open();
         call.hdStartScheduler();
       },
       [&] { call.hdDisableDevice(device); }, [&] { call.hdStopScheduler(); }},
      {"hdDisableDevice with a callback scheduled",
       [&] {
         open();
         schedule();
       },
       [&] { call.hdDisableDevice(device); }, [&] { call.hdUnschedule(task); }}};
  for (const Row& row : rows) {
    expect_complaint(mock, row.words, row.before, row.wrong);
    row.after();
  }
  mock.reset();
}

}  // namespace
}  // namespace thimble::driver
