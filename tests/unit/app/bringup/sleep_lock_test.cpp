// The lock against sleep, with a program that replaces systemd-inhibit.
#include "sleep_lock.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>

#include "support/scratch.h"

namespace thimble::scene {
namespace {

/// Puts a folder with a program of this text first in the search path.
class SleepLockTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const char* path = std::getenv("PATH")) path_ = path;
    folder_ = support::scratch_folder() / "sleep_lock";
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { setenv("PATH", path_.c_str(), 1); }

  void stand_in(const std::string& text) {
    const auto program = folder_ / "systemd-inhibit";
    std::ofstream(program) << "#!/bin/sh\n" << text;
    chmod(program.c_str(), 0755);
    setenv("PATH", (folder_.string() + ":" + path_).c_str(), 1);
  }

  std::string written(const char* name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::string path_;
  std::filesystem::path folder_;
};

TEST_F(SleepLockTest, IsHeldDuringItsLifetime) {
  // Like the real program: skips the options, runs the command, and ends with it.
  stand_in("echo \"$*\" >" + (folder_ / "asked").string() +
           "\nwhile [ \"${1#--}\" != \"$1\" ]; do shift; done\n\"$@\"\necho over >" +
           (folder_ / "over").string() + "\n");
  auto lock = std::make_unique<SleepLock>();
  EXPECT_TRUE(lock->held()) << lock->note();
  EXPECT_EQ(lock->note(), "");
  EXPECT_NE(written("asked").find("--what=sleep:idle:handle-lid-switch --mode=block"),
            std::string::npos);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(written("over"), "");
  lock.reset();
  EXPECT_EQ(written("over"), "over\n");
}

TEST_F(SleepLockTest, ReportsARefusal) {
  stand_in("echo 'Failed to inhibit: Access denied' >&2\nexit 1\n");
  const SleepLock lock;
  EXPECT_FALSE(lock.held());
  EXPECT_NE(lock.note().find("logind gave no lock"), std::string::npos);
}

TEST_F(SleepLockTest, ReportsAMissingProgram) {
  setenv("PATH", folder_.c_str(), 1);
  const SleepLock lock;
  EXPECT_FALSE(lock.held());
  EXPECT_NE(lock.note().find("not installed"), std::string::npos);
}

TEST_F(SleepLockTest, DoesNotWaitForAHangingProgram) {
  stand_in("exec sleep 60\n");
  const auto begin = std::chrono::steady_clock::now();
  { const SleepLock lock; }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST_F(SleepLockTest, EndsAProgramThatIgnoresItsSignal) {
  stand_in("trap '' TERM\nexec sleep 60\n");
  const auto begin = std::chrono::steady_clock::now();
  { const SleepLock lock; }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

}  // namespace
}  // namespace thimble::scene
