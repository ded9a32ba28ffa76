#include "view/start/child_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>

namespace thimble::view {
namespace {

std::unique_ptr<ChildProcess> shell(const std::string& words, const ChildChoice& choice) {
  auto started = ChildProcess::start("/bin/sh", {"-c", words}, choice);
  EXPECT_TRUE(started);
  return started ? std::move(started).value() : nullptr;
}

int wait_for(ChildProcess& child) {
  for (int i = 0; i < 3000; ++i) {
    if (const auto code = child.ended()) return *code;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return -1;
}

/// Waits up to 10 s for a process to end; returns whether it has ended.
bool gone(pid_t pid) {
  for (int i = 0; i < 1000; ++i) {
    if (kill(pid, 0) != 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

TEST(ChildProcess, ReturnsExitCodeAndOutput) {
  const auto child = shell("echo chosen; exit 3", {.keep_output = true, .quiet = true});
  EXPECT_EQ(wait_for(*child), 3);
  EXPECT_EQ(child->text(), "chosen\n");
}

TEST(ChildProcess, HasNoInput) {
  const auto child = shell("read line || exit 7", {.quiet = true});
  EXPECT_EQ(wait_for(*child), 7);
}

TEST(ChildProcess, IsEndedBySigtermWhenItIsDropped) {
  auto child = shell("trap 'exit 0' TERM; echo $$; while :; do sleep 0.05; done",
                     {.keep_output = true, .quiet = true});
  for (int i = 0; i < 1000 && child->text().empty(); ++i) {
    EXPECT_FALSE(child->ended());
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const pid_t pid = std::stoi(child->text());
  child.reset();
  EXPECT_TRUE(gone(pid));
}

TEST(ChildProcess, EndsWithAParentThatIsKilled) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t parent = fork();
  if (parent == 0) {
    const auto child = shell("echo $$; exec sleep 60", {.keep_output = true, .quiet = true});
    while (child->text().empty()) {
      child->ended();
      usleep(1000);
    }
    const pid_t pid = std::stoi(child->text());
    if (write(ends[1], &pid, sizeof pid) != sizeof pid) _exit(1);
    pause();
    _exit(0);
  }
  pid_t pid = 0;
  ASSERT_EQ(read(ends[0], &pid, sizeof pid), static_cast<ssize_t>(sizeof pid));
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  EXPECT_TRUE(gone(pid));
  close(ends[0]);
  close(ends[1]);
}

TEST(ChildProcess, ErrorNamesAMissingProgram) {
  const auto started = ChildProcess::start("/no/such/program", {}, {});
  ASSERT_FALSE(started);
  EXPECT_NE(started.error().message.find("/no/such/program"), std::string::npos);
}

}  // namespace
}  // namespace thimble::view
