#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "log/console.h"
#include "log/log_file.h"
#include "log/logger.h"
#include "log/printed_text.h"
#include "support/scratch.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Returns the output on standard error of `work`.
template <class Work>
std::string said_by(Work&& work) {
  testing::internal::CaptureStderr();
  work();
  return testing::internal::GetCapturedStderr();
}

class LogTest : public ::testing::Test {
 protected:
  LogTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    setenv("XDG_STATE_HOME", folder_.c_str(), 1);
  }

  /// Logs one message of each level.
  static void say_everything(spdlog::logger& logger) {
    logger.trace("a trace");
    logger.debug("a detail");
    logger.info("an event");
    logger.warn("a warning");
    logger.error("an error");
  }

  fs::path folder_ = support::scratch_folder() / "log";
};

TEST_F(LogTest, LineHasTimeLevelProcessAndSource) {
  const fs::path file = folder_ / "named.log";
  ASSERT_TRUE(begin_log({.file = file, .heading = "thimble 1.2: run box"}));
  run_logger("box")->info("tick 7, 0.007 s: Forces are enabled.");
  const auto lines = lines_of(file);
  ASSERT_EQ(lines.size(), 2u);
  const std::string time = R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}[+-]\d\d:\d\d )";
  const std::string process = std::to_string(getpid());
  EXPECT_TRUE(std::regex_match(
      lines[0], std::regex(time + "info     " + process + " thimble: thimble 1\\.2: run box")))
      << lines[0];
  EXPECT_TRUE(std::regex_match(lines[1], std::regex(time + "info     " + process +
                                                    " box: tick 7, 0\\.007 s: Forces are "
                                                    "enabled\\.")))
      << lines[1];
}

TEST_F(LogTest, TerminalShowsWarningsAndErrorsByDefault) {
  ASSERT_TRUE(begin_log({}));
  EXPECT_EQ(said_by([] { say_everything(logger()); }), "thimble: a warning\nthimble: an error\n");
  ASSERT_TRUE(begin_log({.verbosity = Verbosity::kQuiet}));
  EXPECT_EQ(said_by([] { say_everything(logger()); }), "thimble: an error\n");
  ASSERT_TRUE(begin_log({.verbosity = Verbosity::kDebug}));
  EXPECT_EQ(said_by([] { say_everything(logger()); }),
            "thimble: a detail\nthimble: an event\nthimble: a warning\nthimble: an error\n");
  ASSERT_TRUE(begin_log({.verbosity = Verbosity::kTrace}));
  EXPECT_EQ(said_by([] { say_everything(logger()); }),
            "thimble: a trace\nthimble: a detail\nthimble: an event\nthimble: a warning\n"
            "thimble: an error\n");
}

TEST_F(LogTest, RunEventsAreOnTheTerminalOnlyOnRequest) {
  ASSERT_TRUE(begin_log({}));
  EXPECT_EQ(said_by([] { say_everything(*run_logger("box")); }), "");
  ASSERT_TRUE(begin_log({.verbosity = Verbosity::kDebug}));
  EXPECT_NE(said_by([] { say_everything(*run_logger("box")); }).find("thimble: an event\n"),
            std::string::npos);
}

TEST_F(LogTest, QuestionsAreShownUnchanged) {
  for (const Verbosity verbosity : {Verbosity::kQuiet, Verbosity::kNormal, Verbosity::kTrace}) {
    ASSERT_TRUE(begin_log({.verbosity = verbosity}));
    EXPECT_EQ(said_by([] { terminal().info("Press Enter to begin."); }), "Press Enter to begin.\n");
  }
}

TEST_F(LogTest, FileHasTracesOnlyOnRequest) {
  ASSERT_TRUE(begin_log({}));
  said_by([] { say_everything(logger()); });
  ASSERT_EQ(default_log_file(), folder_ / "thimble" / "log" / "thimble.log");
  EXPECT_EQ(lines_of(default_log_file()).size(), 1 + 4u);
  ASSERT_TRUE(begin_log({.verbosity = Verbosity::kTrace}));
  said_by([] { say_everything(logger()); });
  EXPECT_EQ(lines_of(default_log_file()).size(), 1 + 4u + 1 + 5u);
}

TEST_F(LogTest, FileIsCreatedByTheFirstMessage) {
  ASSERT_TRUE(begin_log({}));
  EXPECT_FALSE(fs::exists(default_log_file()));
}

TEST_F(LogTest, ProgressStaysTheLastLine) {
  ASSERT_TRUE(begin_log({}));
  EXPECT_EQ(said_by([] {
              console().show("50 %");
              logger().warn("a warning");
              console().show("51 %");
              console().show("");
            }),
            "\r\033[K50 %"
            "\r\033[Kthimble: a warning\n50 %"
            "\r\033[K51 %"
            "\r\033[K");
}

TEST_F(LogTest, FilesAreBoundedInSizeAndNumber) {
  ASSERT_TRUE(begin_log({}));
  const std::string words(1000, 'x');
  constexpr std::size_t kLines = (LogFile::kFilesMax + 3) * LogFile::kBytesMax / 1000;
  for (std::size_t i = 0; i < kLines; ++i) logger().info("{} {}", i, words);
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(default_log_file().parent_path())) {
    ++files;
    EXPECT_LE(entry.file_size(), LogFile::kBytesMax) << entry.path();
  }
  EXPECT_EQ(files, LogFile::kFilesMax);
  EXPECT_NE(lines_of(default_log_file()).back().find(std::to_string(kLines - 1) + " x"),
            std::string::npos);
}

TEST_F(LogTest, UnwritableFileIsReportedOnce) {
  std::ofstream(folder_ / "thimble") << "a file where the folder should be";
  ASSERT_TRUE(begin_log({}));
  const std::string said = said_by([] {
    logger().warn("one");
    logger().warn("two");
  });
  const std::size_t reported =
      said.find("thimble: Logging has stopped, because " + default_log_file().string());
  ASSERT_NE(reported, std::string::npos) << said;
  EXPECT_EQ(said.find("Logging has stopped", reported + 20), std::string::npos) << said;
  EXPECT_NE(said.find("thimble: one\n"), std::string::npos);
  EXPECT_NE(said.find("thimble: two\n"), std::string::npos);
}

TEST_F(LogTest, FullDiskEndsOnlyTheLog) {
  const fs::path file = folder_ / "full.log";
  ASSERT_TRUE(begin_log({.file = file, .heading = "begin"}));
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto signal_before = signal(SIGXFSZ, SIG_IGN);
  const rlimit tight{.rlim_cur = 2000, .rlim_max = before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &tight);
  const std::string said = said_by([] {
    for (int i = 0; i < 100; ++i)
      logger().info("a line of some forty letters and the number {}", i);
    logger().warn("the last");
  });
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, signal_before);
  EXPECT_TRUE(
      std::regex_match(said, std::regex("thimble: Logging has stopped, because " + file.string() +
                                        " cannot be written \\(.*\\)\\. .*\n"
                                        "thimble: the last\n")))
      << said;
  EXPECT_GT(lines_of(file).size(), 10u);
}

TEST_F(LogTest, FileNamedByTheUserMustBeWritable) {
  const auto begun = begin_log({.file = "/dev/full"});
  ASSERT_FALSE(begun);
  EXPECT_EQ(begun.error().message.rfind("/dev/full: cannot write the log there (", 0), 0u)
      << begun.error().message;
  EXPECT_FALSE(begin_log({.file = folder_}));
}

// Names from files must not control a terminal, directly or through a log shown on it.
constexpr const char* kHostile = "a\x1b]0;title\a\x1b[31m\r\xC2\x9Bm\xE2\x80\xAE\xFFz";
constexpr const char* kShown = "a?]0;title??[31m??m??z";

TEST_F(LogTest, ConsoleShowsNamesPrintable) {
  const std::string said = said_by([] { logger().error("{}", kHostile); });
  EXPECT_EQ(said, std::string("thimble: ") + kShown + "\n");
}

TEST_F(LogTest, LogFileHoldsNamesPrintable) {
  const fs::path file = folder_ / "hostile.log";
  ASSERT_TRUE(begin_log({.file = file, .heading = kHostile}));
  said_by([] { logger().error("{}", kHostile); });
  ASSERT_TRUE(begin_log({.file = folder_ / "next.log"}));
  const auto lines = lines_of(file);
  ASSERT_EQ(lines.size(), 2U);
  for (const std::string& line : lines) {
    EXPECT_TRUE(line.ends_with(std::string(": ") + kShown)) << line;
  }
}

TEST_F(LogTest, LogFileHoldsRunNamesPrintable) {
  const fs::path file = folder_ / "hostile_run.log";
  ASSERT_TRUE(begin_log({.file = file}));
  said_by([] { run_logger(kHostile)->info("open"); });
  ASSERT_TRUE(begin_log({.file = folder_ / "next.log"}));
  const auto lines = lines_of(file);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_TRUE(lines.back().ends_with(std::string(" ") + kShown + ": open")) << lines.back();
}

TEST_F(LogTest, PrintedTextIsPrintable) {
  testing::internal::CaptureStdout();
  print_format("%s %d\n", kHostile, 7);
  write_text(stdout, kHostile);
  std::fflush(stdout);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), std::string(kShown) + " 7\n" + kShown);
}

TEST_F(LogTest, PrintedTextHasAnyLength) {
  const std::string text(100'000, 'x');
  testing::internal::CaptureStdout();
  print_format("%s", text.c_str());
  std::fflush(stdout);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), text);
}

}  // namespace
}  // namespace thimble::scene
