#include "view/compare/signal_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "support/scratch.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

fs::path file_of(const std::string& text) {
  const fs::path file = support::scratch_folder() / "own.csv";
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

driver::Result<OwnSignals> read(const std::string& text, const SignalLimits& limits = {}) {
  return read_signals(file_of(text), limits);
}

/// The error must name the line, and have each of the words.
void expect_error(const std::string& text, int line, const std::vector<std::string>& words,
                  const SignalLimits& limits = {}) {
  const auto signals = read(text, limits);
  ASSERT_FALSE(signals) << text;
  const std::string& message = signals.error().message;
  const std::string place =
      line > 0 ? "own.csv:" + std::to_string(line) + ": " : std::string("own.csv: ");
  EXPECT_NE(message.find(place), std::string::npos) << message;
  for (const std::string& word : words) {
    EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
  }
  // A problem and a remedy, a sentence each.
  EXPECT_NE(message.find(". "), std::string::npos) << message;
  EXPECT_EQ(message.back(), '.') << message;
}

TEST(SignalFile, HasTimesNamesUnitsAndValues) {
  const auto signals = read("time, muscle [mV], heart rate\n0, 1.5, 60\n0.001, -2e-3, 61\n");
  ASSERT_TRUE(signals) << signals.error().message;
  EXPECT_EQ(*signals->time, (std::vector<double>{0, 0.001}));
  ASSERT_EQ(signals->signals.size(), 2U);
  EXPECT_EQ(signals->signals[0].name, "muscle");
  EXPECT_EQ(signals->signals[0].unit, "mV");
  EXPECT_EQ(signals->signals[0].values, (std::vector<float>{1.5F, -2e-3F}));
  EXPECT_EQ(signals->signals[1].name, "heart rate");
  EXPECT_EQ(signals->signals[1].unit, "");
  EXPECT_EQ(signals->signals[1].values, (std::vector<float>{60, 61}));
}

TEST(SignalFile, ConvertsTheUnitOfTheTime) {
  for (const auto& [unit, factor] : std::vector<std::pair<std::string, double>>{
           {"", 1}, {" [s]", 1}, {" [ms]", 1e-3}, {" [us]", 1e-6}, {" [ns]", 1e-9}}) {
    const auto signals = read("time" + unit + ",a\n-1,0\n2,0\n2,0\n");
    ASSERT_TRUE(signals) << signals.error().message;
    EXPECT_EQ(*signals->time, (std::vector<double>{-factor, 2 * factor, 2 * factor})) << unit;
  }
}

TEST(SignalFile, AcceptsWhatOtherProgramsWrite) {
  const auto signals = read(
      "\xEF\xBB\xBF# of a logger\r\n\"time\",\"a [N]\"\r\n\r\n\"0\",+1\r\n# later\r\n 1.0 "
      ",\t2\r\n");
  ASSERT_TRUE(signals) << signals.error().message;
  EXPECT_EQ(signals->signals[0].name, "a");
  EXPECT_EQ(signals->signals[0].unit, "N");
  EXPECT_EQ(signals->signals[0].values, (std::vector<float>{1, 2}));
  EXPECT_TRUE(read("time,a\n0,1"));  // without a last end of line
}

TEST(SignalFile, ErrorNamesLineAndProblem) {
  expect_error("", 0, {"empty", "time, name [unit]"});
  expect_error("# nothing\n\n", 0, {"empty"});
  expect_error("time,a\n", 0, {"no line below the header"});
  expect_error("0,1\n1,2\n", 1, {"header is missing"});
  expect_error("\nseconds,a\n", 2, {"\"seconds\"", "time"});
  expect_error("time [h],a\n0,1\n", 1, {"\"h\"", "ms"});
  expect_error("time\n0\n", 1, {"no column"});
  expect_error("time;a\n0;1\n", 1, {"commas"});
  expect_error("time,a,\n", 1, {"column 3", "no name"});
  expect_error("time,[N]\n", 1, {"column 2", "no name"});
  expect_error("time,a,a [N]\n", 1, {"\"a\"", "own name"});
  expect_error("time,a\n0,1\n1\n", 3, {"1 value where the header has 2"});
  expect_error("time,a\n0,1,2\n", 2, {"3 values where the header has 2"});
  expect_error("time,a\n0,1\n0.5,1\n0.4,1\n", 4, {"\"0.4\"", "earlier", "Sort"});
  expect_error("time,a\n0,nan\n", 2, {"\"a\"", "\"nan\"", "finite"});
  expect_error("time,a\n0,-inf\n", 2, {"\"-inf\"", "finite"});
  expect_error("time,a\n0,1e39\n", 2, {"\"1e39\"", "larger"});
  expect_error("time,a\n86401,1\n", 2, {"\"86401\"", "86400 s"});
  expect_error("time,a\n-86401,1\n", 2, {"\"-86401\"", "86400 s"});
  expect_error("time [ms],a\n0,1\n1e300,1\n", 3, {"\"1e300\"", "86400 s"});
  expect_error("time,a\n0,1e999\n", 2, {"\"1e999\"", "finite"});
  expect_error("time,a\nnan,1\n", 2, {"\"time\"", "\"nan\""});
  expect_error("time,a\n0,\n", 2, {"\"\"", "finite"});
  expect_error("time,a\n0,1 N\n", 2, {"\"1 N\""});
  expect_error("time,a\n0,0x10\n", 2, {"\"0x10\""});
}

TEST(SignalFile, RefusesWhatIsNoText) {
  expect_error(std::string("\x89HDF\r\n\x1a\n", 8), 1, {"not text"});
  expect_error("time,a [\xB5V]\n0,1\n", 1, {"UTF-8"});
  expect_error(std::string("time,a\n0,\0\n", 11), 2, {"not text"});
  expect_error(std::string(100'000, 'x'), 1, {"65536 bytes"});
}

TEST(SignalFile, KeepsToItsLimits) {
  const SignalLimits limits{.columns = 2, .numbers = 6, .line = 20, .bytes = 100};
  EXPECT_TRUE(read("time,a,b\n0,1,1\n0,1,1\n", limits));
  expect_error("time,a,b,c\n", 1, {"more than 2 columns"}, limits);
  expect_error("time,a,b\n0,1,1\n0,1,1\n1,1,1\n", 4, {"more than 6 numbers"}, limits);
  EXPECT_TRUE(read("time,a\n0,1         \n", limits));
  expect_error("time,a\n0,1                     \n", 2, {"more than 20 bytes"}, limits);
  const auto large = read("time,a\n" + std::string(100, '\n'), limits);
  ASSERT_FALSE(large);
  EXPECT_NE(large.error().message.find("larger than"), std::string::npos) << large.error().message;
}

TEST(SignalFile, RefusesFoldersAndPipesWithoutWaiting) {
  const fs::path folder = support::scratch_folder();
  const fs::path pipe = folder / "pipe.csv";
  fs::remove(pipe);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const fs::path& file : {folder, pipe, folder / "missing.csv"}) {
    const auto signals = read_signals(file);
    ASSERT_FALSE(signals);
    EXPECT_EQ(signals.error().message.find(file.string() + ": "), 0U) << signals.error().message;
  }
  fs::remove(pipe);
}

TEST(SignalFile, EndsWithDamagedBytes) {
  std::string good = "time, a [mV], b\n";
  for (int i = 0; i < 200; ++i)
    good += std::to_string(0.5 * i) + ", 1.5e-3," + std::to_string(i) + "\n";
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 500; ++i) {
    std::string text = good;
    for (int k = 0; k < 3; ++k) text[random() % text.size()] = static_cast<char>(random() % 256);
    text.resize(random() % (text.size() + 1));
    const auto signals = read(text);
    if (!signals) {
      ++refused;
      EXPECT_NE(signals.error().message.find("own.csv"), std::string::npos);
      continue;
    }
    for (const OwnSignal& signal : signals->signals) {
      EXPECT_EQ(signal.values.size(), signals->time->size());
    }
  }
  EXPECT_GT(refused, 250);
  EXPECT_LT(refused, 500);
}

}  // namespace
}  // namespace thimble::view
