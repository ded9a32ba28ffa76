#include "system/run_in_sandbox.h"

#include <gtest/gtest.h>

#include <unistd.h>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <vector>

namespace thimble::driver {
namespace {

TEST(RunInSandbox, ReturnsTheResultOfTheWork) {
  const std::string much(20'000'000, 'x');
  const auto done = run_in_sandbox([&] { return much; }, {});
  ASSERT_TRUE(done.ok()) << done.error().message;
  EXPECT_TRUE(*done == much);
  EXPECT_EQ(*run_in_sandbox([] { return std::string(); }, {}), "");
}

TEST(SandboxReader, NeverReadsBeyondItsBytes) {
  const auto written = run_in_sandbox(
      [](SandboxWriter& out) {
        const double numbers[] = {1, 2, 3};
        out.write_array(numbers, 3);
        const std::uint64_t many = 1'000'000'000'000;  // claimed by faulty work
        out.write(&many, sizeof many);
        out.write("ab", 2);
      },
      {});
  ASSERT_TRUE(written) << written.error().message;
  SandboxReader in(written->bytes());
  std::vector<double> numbers;
  ASSERT_TRUE(in.take_array(numbers));
  EXPECT_EQ(numbers, (std::vector<double>{1, 2, 3}));
  std::string text;
  EXPECT_FALSE(in.take_array(text));
  std::uint64_t number = 0;
  EXPECT_FALSE(in.take(&number, sizeof number));
  EXPECT_EQ(in.left().size(), 2U);
}

TEST(RunInSandbox, SurvivesWorkThatCrashesHangsOrAsksForTooMuch) {
  const auto crashed = run_in_sandbox(
      []() -> std::string {
        std::raise(SIGSEGV);
        return "";
      },
      {});
  ASSERT_FALSE(crashed.ok());
  EXPECT_EQ(crashed.error().message, "crashes its reader");
  const auto left = run_in_sandbox([]() -> std::string { std::_Exit(0); }, {});
  EXPECT_FALSE(left.ok());
  const auto hung = run_in_sandbox(
      []() -> std::string {
        for (std::atomic<int> i = 0;; ++i) {
        }
      },
      {.seconds = 1, .bytes = 1 << 20});
  ASSERT_FALSE(hung.ok());
  EXPECT_EQ(hung.error().message, "takes more than 1 s");
  const auto greedy = run_in_sandbox([]() -> std::string { throw std::bad_alloc(); }, {});
  ASSERT_FALSE(greedy.ok());
  EXPECT_EQ(greedy.error().message, "needs more memory than its size allows");
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_FALSE(run_in_sandbox([] { return std::string(100'000'000, 'x'); },
                              {.seconds = 10, .bytes = 10'000'000})
                   .ok());
#endif
}

TEST(RunInSandbox, ReturnsBytesThatTheWorkWrites) {
  const auto done = run_in_sandbox(
      [](SandboxWriter& out) {
        out.write("wrong", 5);
        out.restart();
        for (const char* text : {"two ", "pieces"}) out.write(text, std::strlen(text));
      },
      {});
  ASSERT_TRUE(done.ok()) << done.error().message;
  const auto bytes = done->bytes();
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), "two pieces");
}

TEST(RunInSandbox, RefusesMoreBytesThanItsLimit) {
  const auto done = run_in_sandbox(
      [](SandboxWriter& out) {
        const std::string much(10'000'000, 'x');
        out.write(much.data(), much.size());
      },
      {.seconds = 10, .bytes = 9'000'000});
  ASSERT_FALSE(done.ok());
  EXPECT_EQ(done.error().message, "needs more memory than its size allows");
}

TEST(RunInSandbox, WorksWithoutStandardStreams) {
  EXPECT_EXIT(
      {
        for (int file = 0; file < 3; ++file) close(file);
        const auto done = run_in_sandbox([] { return std::string("kept"); }, {});
        std::_Exit(done.ok() && *done == "kept" ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace thimble::driver
