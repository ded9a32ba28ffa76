#include "system/run_apart.h"

#include <gtest/gtest.h>

#include <unistd.h>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>

namespace thimble::driver {
namespace {

TEST(RunApart, GivesWhatTheWorkGives) {
  const std::string much(20'000'000, 'x');
  const auto done = run_apart([&] { return much; }, {});
  ASSERT_TRUE(done.ok()) << done.error().message;
  EXPECT_TRUE(*done == much);
  EXPECT_EQ(*run_apart([] { return std::string(); }, {}), "");
}

TEST(RunApart, SurvivesWorkThatCrashesHangsOrAsksForTooMuch) {
  const auto crashed = run_apart(
      []() -> std::string {
        std::raise(SIGSEGV);
        return "";
      },
      {});
  ASSERT_FALSE(crashed.ok());
  EXPECT_EQ(crashed.error().message, "breaks its reader");
  const auto left = run_apart([]() -> std::string { std::_Exit(0); }, {});
  EXPECT_FALSE(left.ok());
  const auto hung = run_apart(
      []() -> std::string {
        for (std::atomic<int> i = 0;; ++i) {
        }
      },
      {.seconds = 1, .bytes = 1 << 20});
  ASSERT_FALSE(hung.ok());
  EXPECT_EQ(hung.error().message, "takes more than 1 s");
  const auto greedy = run_apart([]() -> std::string { throw std::bad_alloc(); }, {});
  ASSERT_FALSE(greedy.ok());
  EXPECT_EQ(greedy.error().message, "needs more memory than its size allows");
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_FALSE(
      run_apart([] { return std::string(100'000'000, 'x'); }, {.seconds = 10, .bytes = 10'000'000})
          .ok());
#endif
}

TEST(RunApart, ReturnsBytesThatTheWorkWrites) {
  const auto done = run_apart(
      [](ApartWriter& out) {
        out.write("wrong", 5);
        out.restart();
        for (const char* text : {"two ", "pieces"}) out.write(text, std::strlen(text));
      },
      {});
  ASSERT_TRUE(done.ok()) << done.error().message;
  const auto bytes = done->bytes();
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), "two pieces");
}

TEST(RunApart, RefusesMoreBytesThanItsLimit) {
  const auto done = run_apart(
      [](ApartWriter& out) {
        const std::string much(10'000'000, 'x');
        out.write(much.data(), much.size());
      },
      {.seconds = 10, .bytes = 9'000'000});
  ASSERT_FALSE(done.ok());
  EXPECT_EQ(done.error().message, "needs more memory than its size allows");
}

TEST(RunApart, WorksWithoutStandardStreams) {
  EXPECT_EXIT(
      {
        for (int file = 0; file < 3; ++file) close(file);
        const auto done = run_apart([] { return std::string("kept"); }, {});
        std::_Exit(done.ok() && *done == "kept" ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace thimble::driver
