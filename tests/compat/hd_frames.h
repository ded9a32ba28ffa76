#pragma once

#include <HD/hd.h>
#include <gtest/gtest.h>

#include <array>

#include "compat/exec_rig.h"

namespace thimble::compat {

/// Removes all errors; returns the oldest.
inline HDErrorInfo drain_hd_errors() {
  HDErrorInfo oldest{HD_SUCCESS, 0, 0};
  for (HDErrorInfo error = hdGetError(); error.errorCode != HD_SUCCESS; error = hdGetError()) {
    oldest = error;
  }
  return oldest;
}

/// Runs `work` in a frame of each of `ticks` ticks.
template <class Work>
void hd_frames(HHD device, int ticks, Work work) {
  for (int i = 0; i < ticks; ++i) {
    hdBeginFrame(device);
    work();
    hdEndFrame(device);
    arms::wait_until_taken(static_cast<int>(device));
    ExecRig::wait(static_cast<int>(device), 1);
  }
}

/// Closes all arms after each test, and keeps no errors.
struct HdTest : ::testing::Test {
  HdTest() { drain_hd_errors(); }
  ~HdTest() override {
    hdStopScheduler();
    for (HHD device = 0; device < kArmsMax; ++device) hdDisableDevice(device);
    drain_hd_errors();
  }
};

/// Returns a vector parameter.
inline std::array<double, 3> hd_vector(HDenum parameter) {
  std::array<double, 3> v{7, 7, 7};
  hdGetDoublev(parameter, v.data());
  return v;
}

}  // namespace thimble::compat
