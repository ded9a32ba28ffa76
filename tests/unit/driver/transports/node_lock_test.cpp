#include "transports/node_lock.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "support/mock/fake_usb.h"

namespace thimble::driver {
namespace {

std::string some_node(const std::string& name) {
  const auto file = support::scratch_folder() / name;
  std::ofstream(file) << "";
  return std::filesystem::canonical(file).string();
}

/// Another program that has a node open, from `begin` until it is destroyed.
class OtherProgram {
 public:
  /// Opens the node in a child process; with `locks` through NodeLock, as another Thimble would.
  OtherProgram(const std::string& node, bool locks) {
    int ready[2];
    if (pipe(ready) != 0) return;
    pid_ = fork();
    if (pid_ == 0) {
      NodeLock lock;
      if (locks) {
        if (auto taken = NodeLock::take(node)) lock = std::move(taken).value();
      } else {
        (void)!open(node.c_str(), O_RDWR);
      }
      (void)!::write(ready[1], "x", 1);
      pause();
      _exit(0);
    }
    char sign = 0;
    (void)!::read(ready[0], &sign, 1);
    close(ready[0]);
    close(ready[1]);
  }
  ~OtherProgram() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  OtherProgram(const OtherProgram&) = delete;
  OtherProgram& operator=(const OtherProgram&) = delete;
  int pid() const { return pid_; }

 private:
  int pid_ = -1;
};

TEST(NodeLock, LetsOneUseANodeAndGivesItBack) {
  const std::string node = some_node("lock_own");
  {
    auto first = NodeLock::take(node);
    ASSERT_TRUE(first) << first.error().message;
    const auto second = NodeLock::take(node);  // by this program
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("in use"), std::string::npos);
    const NodeLock moved = std::move(first).value();
    EXPECT_FALSE(NodeLock::take(node));
  }
  EXPECT_TRUE(NodeLock::take(node));
}

TEST(NodeLock, NamesTheProgramThatHasTheNode) {
  const std::string node = some_node("lock_other");
  for (const bool locks : {true, false}) {
    {
      const OtherProgram other(node, locks);
      const auto refused = NodeLock::take(node);
      ASSERT_FALSE(refused) << locks;
      const std::string& said = refused.error().message;
      EXPECT_NE(said.find("(process " + std::to_string(other.pid()) + ")"), std::string::npos)
          << said;
      EXPECT_NE(said.find("test_driver"), std::string::npos) << said;
      const auto by_link = support::scratch_folder() / "lock_link";
      std::filesystem::remove(by_link);
      std::filesystem::create_symlink(node, by_link);
      EXPECT_FALSE(NodeLock::take(by_link.string()));  // as /dev/serial/by-id does
    }
    EXPECT_TRUE(NodeLock::take(node)) << locks;
  }
}

TEST(NodeLock, FindsTheHolderInAnyRoot) {
  const support::FakeUsb usb("lock_holder");
  usb.write("proc/77/comm", "steam");
  std::filesystem::create_directories(usb.root() / "proc/77/fd");
  std::filesystem::create_symlink("/dev/hidraw3", usb.root() / "proc/77/fd/12");
  const auto holder = find_holder("/dev/hidraw3", usb.root());
  ASSERT_TRUE(holder);
  EXPECT_EQ(holder->pid, 77);
  EXPECT_EQ(holder->program, "steam");
  EXPECT_FALSE(find_holder("/dev/hidraw4", usb.root()));
}

TEST(NodeLock, OpenErrorNamesTheReason) {
  const auto missing = NodeLock::take("/dev/no_such_arm");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("plugged in"), std::string::npos);
}

}  // namespace
}  // namespace thimble::driver
