#include "log/progress.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <regex>
#include <string>
#include <vector>

#include "log/console.h"
#include "log/printed_text.h"

namespace thimble::scene {
namespace {

constexpr std::size_t kWidth = 80;

ProgressMeter line(double first = 0, std::size_t width = kWidth) {
  return {"work", ProgressMeter::Form::kReplacedLine, width, first};
}

ProgressMeter lines() {
  return {"work", ProgressMeter::Form::kLines, kWidth};
}

/// Returns the percentage in a text; -1 if it has none.
int percent_in(const std::string& text) {
  std::smatch found;
  return std::regex_search(text, found, std::regex("([0-9]+) %")) ? std::stoi(found[1]) : -1;
}

TEST(ProgressMeter, LineAppearsAfterTwoSeconds) {
  ProgressMeter meter = line();
  EXPECT_FALSE(meter.update(0.5, "", 1.9));
  EXPECT_TRUE(meter.update(0.5, "", 2.0));
}

TEST(ProgressMeter, LineIsRedrawnFiveTimesASecond) {
  ProgressMeter meter = line();
  int drawn = 0;
  for (int ms = 2000; ms < 12000; ms += 10) drawn += meter.update(0.5, "", 1e-3 * ms) ? 1 : 0;
  EXPECT_GE(drawn, 45);
  EXPECT_LE(drawn, 50);
}

TEST(ProgressMeter, LineHasBarShareTimeLeftAndState) {
  ProgressMeter meter = line();
  EXPECT_EQ(meter.update(0.25, "the step", 10),
            "work  [######..................] 25 %, 30 s left  the step");
}

TEST(ProgressMeter, ShownShareNeverDecreases) {
  ProgressMeter meter = line();
  int last = -1;
  for (const double share : {0.1, 0.3, 0.2, std::nan(""), -1.0, 0.29, 0.7, 5.0, 0.0}) {
    static double now = 2;
    const auto text = meter.update(share, "", now += 1);
    ASSERT_TRUE(text);
    EXPECT_GE(percent_in(*text), last) << *text;
    last = percent_in(*text);
  }
  EXPECT_EQ(last, 100);
}

TEST(ProgressMeter, TimeLeftOfConstantSpeedIsExact) {
  ProgressMeter meter = line();
  for (int second = 3; second <= 100; ++second) {
    meter.update(0.01 * second, "", second);
    ASSERT_TRUE(meter.left(second));
    EXPECT_NEAR(*meter.left(second), 100 - second, 1e-9);
  }
}

TEST(ProgressMeter, NoTimeLeftBeforeThreePercent) {
  ProgressMeter meter = line();
  meter.update(0.029, "", 100);
  EXPECT_FALSE(meter.left(100));
  meter.update(0.031, "", 101);
  EXPECT_TRUE(meter.left(101));
}

TEST(ProgressMeter, NoTimeLeftBeforeTwoSeconds) {
  ProgressMeter meter = line();
  meter.update(0.5, "", 1.9);
  EXPECT_FALSE(meter.left(1.9));
}

TEST(ProgressMeter, TimeLeftDecreasesDuringAStep) {
  ProgressMeter meter = line();
  meter.update(0.5, "", 10);
  EXPECT_DOUBLE_EQ(*meter.left(14), 6);
  EXPECT_DOUBLE_EQ(*meter.left(40), 0) << "a step that takes longer than expected";
}

TEST(ProgressMeter, ResumedWorkCountsOnlyItsOwnShare) {
  ProgressMeter meter = line(0.9);
  meter.update(0.95, "", 20);
  ASSERT_TRUE(meter.left(20));
  EXPECT_NEAR(*meter.left(20), 20, 1e-9);
}

TEST(ProgressMeter, ShareThatWasDoneBeforeGivesNoEstimate) {
  ProgressMeter meter = line(1);
  const auto text = meter.update(1, "", 5);
  EXPECT_FALSE(meter.left(5));
  EXPECT_EQ(percent_in(text.value_or("")), 100);
}

TEST(ProgressMeter, WorkOfUnknownLengthShowsItsState) {
  ProgressMeter meter = line(std::nan(""));
  EXPECT_EQ(meter.update(std::nan(""), "12.0 s", 12), "work  12.0 s");
}

TEST(ProgressMeter, LineIsNarrowerThanTheTerminal) {
  for (std::size_t width = 0; width < 100; ++width) {
    ProgressMeter meter = line(0, width);
    const auto text = meter.update(0.25, "touching \u00e4\u00f6\u00fc the elephant", 10);
    ASSERT_TRUE(text);
    EXPECT_LT(text->size(), std::max<std::size_t>(width, 1));
    const bool cut = !text->empty() && (static_cast<unsigned char>(text->back()) & 0xc0) == 0xc0;
    EXPECT_FALSE(cut) << "ends in half a character: " << *text;
  }
}

TEST(ProgressMeter, NarrowTerminalHasNoBarButShare) {
  ProgressMeter meter = line(0, 30);
  EXPECT_EQ(meter.update(0.25, "", 10), "work  25 %, 30 s left");
}

TEST(ProgressMeter, SeparateLinesAreOnePerSecondAndTenPercent) {
  ProgressMeter meter = lines();
  std::vector<std::string> shown;
  for (int ms = 0; ms <= 20'000; ms += 100) {
    if (auto text = meter.update(ms / 20'000.0, "", 1e-3 * ms)) shown.push_back(*text);
  }
  ASSERT_EQ(shown.size(), 9U);
  EXPECT_EQ(shown[0], "work: 10 %, 18 s left");
  EXPECT_EQ(meter.end(1, 20), "work: 100 %, took 20 s");
}

TEST(ProgressMeter, FastWorkHasAtMostOneLinePerSecond) {
  ProgressMeter meter = lines();
  int shown = 0;
  for (int ms = 0; ms < 3000; ++ms) shown += meter.update(ms / 3000.0, "", 1e-3 * ms) ? 1 : 0;
  EXPECT_EQ(shown, 2);
}

TEST(ProgressMeter, SlowWorkHasALineEveryHalfMinute) {
  ProgressMeter meter = lines();
  int shown = 0;
  for (int second = 0; second <= 300; ++second) shown += meter.update(0.01, "", second) ? 1 : 0;
  EXPECT_EQ(shown, 10);
}

TEST(ProgressMeter, RoundedSumOfTimesIsAllDone) {
  ProgressMeter meter = lines();
  EXPECT_TRUE(meter.end(std::nextafter(1.0, 0.0), 20));
}

TEST(ProgressMeter, UnfinishedWorkHasNoLastLine) {
  ProgressMeter meter = lines();
  EXPECT_FALSE(meter.end(0.99, 20));
}

TEST(DurationText, HasSecondsMinutesAndHours) {
  EXPECT_EQ(duration_text(0.4), "0 s");
  EXPECT_EQ(duration_text(59.4), "59 s");
  EXPECT_EQ(duration_text(200), "3 min 20 s");
  EXPECT_EQ(duration_text(1830), "31 min");
  EXPECT_EQ(duration_text(2 * 3600 + 300), "2 h 5 min");
  EXPECT_EQ(duration_text(std::nan("")), "0 s");
  EXPECT_EQ(duration_text(-5), "0 s");
}

/// Returns what `work` prints on a standard error that is no terminal.
template <class Work>
std::string printed_by(Work&& work) {
  testing::internal::CaptureStderr();
  work();
  return testing::internal::GetCapturedStderr();
}

class ProgressTest : public ::testing::Test {
 protected:
  ~ProgressTest() override { choose_progress(ProgressChoice::kNever); }
};

TEST_F(ProgressTest, IsSilentWithoutATerminal) {
  choose_progress(ProgressChoice::kIfTerminal);
  EXPECT_EQ(printed_by([] { Progress("work").set_share(1.0); }), "");
}

TEST_F(ProgressTest, FinishedWorkHasALineIfAsked) {
  choose_progress(ProgressChoice::kAlways);
  EXPECT_EQ(printed_by([] { Progress("work").set_share(1.0); }), "work: 100 %, took 0 s\n");
}

TEST_F(ProgressTest, InnerWorkIsNotShown) {
  choose_progress(ProgressChoice::kAlways);
  const std::string printed = printed_by([] {
    Progress outer("outer");
    Progress("inner").set_share(1.0);
    outer.set_share(1.0);
  });
  EXPECT_EQ(printed, "outer: 100 %, took 0 s\n");
}

TEST_F(ProgressTest, LibrariesPrintNothingByDefault) {
  EXPECT_EQ(printed_by([] { Progress("work").set_share(1.0); }), "");
}

/// A pseudo-terminal as standard output and standard error.
class TerminalTest : public ProgressTest {
 protected:
  void SetUp() override {
    setenv("TERM", "xterm", 1);
    master_ = posix_openpt(O_RDWR | O_NOCTTY);
    ASSERT_GE(master_, 0);
    ASSERT_EQ(grantpt(master_), 0);
    ASSERT_EQ(unlockpt(master_), 0);
    const int slave = open(ptsname(master_), O_RDWR | O_NOCTTY);
    ASSERT_GE(slave, 0);
    std::fflush(stdout);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
      before_.push_back(dup(stream));
      dup2(slave, stream);
    }
    close(slave);
  }
  /// Ends the terminal and returns all that it got.
  std::string shown() {
    std::fflush(stdout);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
      dup2(before_[static_cast<std::size_t>(stream - 1)], stream);
      close(before_[static_cast<std::size_t>(stream - 1)]);
    }
    std::string text;
    char bytes[4096];
    for (ssize_t got; (got = read(master_, bytes, sizeof bytes)) > 0;) {
      text.append(bytes, static_cast<std::size_t>(got));
    }
    close(master_);
    return text;
  }

  int master_ = -1;
  std::vector<int> before_;
};

TEST_F(TerminalTest, TextAppearsAboveTheProgress) {
  console().show("50 %");
  print_format("a result\n");
  console().show("");
  EXPECT_EQ(shown(), "\r\x1b[K50 %\r\x1b[Ka result\r\n50 %\r\x1b[K");
}

TEST_F(TerminalTest, IncompleteTextIsNotErased) {
  console().show("50 %");
  print_format("Write? ");
  console().show("60 %");
  print_format("yes\n");
  console().show("");
  EXPECT_EQ(shown(), "\r\x1b[K50 %\r\x1b[KWrite? yes\r\n60 %\r\x1b[K");
}

TEST_F(TerminalTest, ShortWorkShowsNothing) {
  choose_progress(ProgressChoice::kIfTerminal);
  Progress("work").set_share(1.0);
  EXPECT_EQ(shown(), "");
}

}  // namespace
}  // namespace thimble::scene
