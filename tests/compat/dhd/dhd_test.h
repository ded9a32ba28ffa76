#pragma once

#include <gtest/gtest.h>

#include "compat/dhd/fake_arms.h"
#include "drdc.h"

namespace thimble::compat {

/// Two fake arms, both closed. After `begin_and_open`, -1 means the first.
class CompatDhd : public ::testing::Test {
 protected:
  void SetUp() override { begin({}); }
  void TearDown() override { close_all(); }

  static void begin(const fake::Setup& setup) {
    close_all();
    fake::reset(setup);
    dhdDisableExpertMode();
  }
  static void begin_and_open(const fake::Setup& setup) {
    begin(setup);
    ASSERT_EQ(dhdOpenID(0), 0);
  }
  /// Sends a force until the soft start is over.
  static void send_for_long(double x, double y, double z, char id = -1) {
    for (int i = 0; i < 100; ++i) dhdSetForce(x, y, z, id);
  }

 private:
  static void close_all() {
    for (char id = 0; id < kArmsMax; ++id) dhdClose(id);
  }
};

}  // namespace thimble::compat
