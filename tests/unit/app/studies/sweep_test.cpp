#include "studies/sweep/sweep.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "studies/sweep/sweep_journal.h"
#include "support/hard_case.h"
#include "support/scratch.h"
#include "text_file.h"

namespace thimble::studies {
namespace {

/// A subfolder in the folder of this process.
class Folder {
 public:
  Folder() {
    static int count = 0;
    path_ = support::scratch_folder() / ("sweep_" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

const std::atomic<bool> kNoStop{false};

/// A sweep whose results depend on the cell only; some are NaN or infinite.
Sweep plain_sweep(std::size_t cells = 50) {
  return {.name = "plain", .key = "plain 1", .cells = cells, .measure = [](std::size_t cell) {
            const double x = static_cast<double>(cell);
            return std::vector<double>{std::sqrt(x), -0.0, std::log(x), std::nan("")};
          }};
}

std::string journal_after(const std::filesystem::path& folder, int jobs, bool resume) {
  const auto done =
      run_sweep(plain_sweep(), {.folder = folder, .jobs = jobs, .resume = resume}, kNoStop);
  if (!done) {
    ADD_FAILURE() << done.error().message;
    return {};
  }
  EXPECT_EQ(done->end, SweepEnd::kDone);
  EXPECT_EQ(done->numbers[49][0], 7);
  EXPECT_TRUE(std::signbit(done->numbers[3][1]));
  return scene::text_of(folder / "plain.journal");
}

TEST(HardCaseDeterminism, SweepIsIndependentOfThreads) {
  const Folder one, four;
  const std::string first = journal_after(one.path(), 1, false);
  const std::string second = journal_after(four.path(), 4, false);
  EXPECT_EQ(second, first);
  support::record_hard_case(41, "journal of a study's sweep with 1 and 4 threads",
                            "== journals that differ", second != first, 0, "1");
  EXPECT_EQ(std::count(first.begin(), first.end(), '\n'), 51);
}

TEST(Sweep, ResumesAfterATornJournal) {
  const Folder scratch;
  const std::string whole = journal_after(scratch.path(), 2, false);
  const auto file = scratch.path() / "plain.journal";
  for (std::size_t size = 0; size < whole.size(); size += 97) {
    std::ofstream(file, std::ios::binary) << whole.substr(0, size);
    EXPECT_EQ(journal_after(scratch.path(), 2, true), whole) << size;
  }
  std::string damaged = whole;
  damaged[whole.size() / 2] ^= 1;
  std::ofstream(file, std::ios::binary) << damaged;
  EXPECT_EQ(journal_after(scratch.path(), 2, true), whole);
}

TEST(Sweep, DoesNotRepeatCellsOfItsJournal) {
  const Folder scratch;
  journal_after(scratch.path(), 2, false);
  Sweep sweep = plain_sweep();
  sweep.measure = [](std::size_t) -> driver::Result<std::vector<double>> {
    return driver::Error{"again"};
  };
  const auto done =
      run_sweep(sweep, {.folder = scratch.path(), .jobs = 2, .resume = true}, kNoStop);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->numbers[49][0], 7);
}

TEST(Sweep, KeepsAnOlderJournalBesideANewOne) {
  const Folder scratch;
  const std::string first = journal_after(scratch.path(), 2, false);
  journal_after(scratch.path(), 2, false);
  EXPECT_EQ(scene::text_of(scratch.path() / "plain.journal.old"), first);
}

TEST(Sweep, RefusesFolderInUseAndNamesTheProcess) {
  const Folder scratch;
  CellNumbers numbers;
  auto first = SweepJournal::open(scratch.path() / "a.journal", "key", 3, false, numbers);
  ASSERT_TRUE(first);
  // Outputs of one process share its lock of a folder; those of another process are rejected.
  const std::string holder = "is being written by process " + std::to_string(getpid());
  const pid_t child = fork();
  if (child == 0) {
    const auto second = SweepJournal::open(scratch.path() / "b.journal", "key", 3, true, numbers);
    const bool named = !second && second.error().message.find(holder) != std::string::npos;
    _exit(named ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0) << "another process got the folder, or the error did not name the holder";
  first.value().reset();  // ends it in any way
  EXPECT_TRUE(SweepJournal::open(scratch.path() / "b.journal", "key", 3, true, numbers));
}

TEST(Sweep, RefusesTheJournalOfAnotherSweep) {
  const Folder scratch;
  journal_after(scratch.path(), 2, false);
  Sweep other = plain_sweep();
  other.key = "plain 2";
  const auto done =
      run_sweep(other, {.folder = scratch.path(), .jobs = 2, .resume = true}, kNoStop);
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("--resume"), std::string::npos);
}

TEST(Sweep, NamesTheCellThatFailed) {
  const Folder scratch;
  Sweep sweep = plain_sweep();
  sweep.measure = [](std::size_t cell) -> driver::Result<std::vector<double>> {
    if (cell == 17) return driver::Error{"no such wall"};
    return std::vector<double>{1};
  };
  const auto done = run_sweep(sweep, {.folder = scratch.path(), .jobs = 2}, kNoStop);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message, "plain, cell 17: no such wall");
}

TEST(Sweep, EmptyResultsAndExceptionsAreErrors) {
  const Folder scratch;
  Sweep sweep = plain_sweep();
  sweep.measure = [](std::size_t) { return std::vector<double>{}; };
  const auto empty = run_sweep(sweep, {.folder = scratch.path(), .jobs = 1}, kNoStop);
  ASSERT_FALSE(empty);
  EXPECT_NE(empty.error().message.find("plain, cell 0: no result"), std::string::npos)
      << empty.error().message;
  sweep.measure = [](std::size_t) -> std::vector<double> { throw std::bad_alloc(); };
  const auto thrown = run_sweep(sweep, {.folder = scratch.path(), .jobs = 1}, kNoStop);
  ASSERT_FALSE(thrown);
  EXPECT_NE(thrown.error().message.find("bad_alloc"), std::string::npos) << thrown.error().message;
}

TEST(Sweep, StopsOnRequestAndResumes) {
  const Folder scratch, other;
  std::atomic<bool> stop{false};
  Sweep sweep = plain_sweep();
  sweep.measure = [&stop](std::size_t cell) {
    if (cell == 20) stop = true;
    return plain_sweep().measure(cell);
  };
  const auto stopped = run_sweep(sweep, {.folder = scratch.path(), .jobs = 2}, stop);
  ASSERT_TRUE(stopped);
  EXPECT_EQ(stopped->end, SweepEnd::kStopped);
  EXPECT_EQ(journal_after(scratch.path(), 2, true), journal_after(other.path(), 1, false));
}

TEST(Sweep, ErrorNamesMissingFolder) {
  const auto done = run_sweep(plain_sweep(), {.folder = "/nowhere/at/all", .jobs = 1}, kNoStop);
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("Cannot write /nowhere/at/all"), std::string::npos);
}

}  // namespace
}  // namespace thimble::studies
