#include "studies/sweep/sweep.h"

#include <sched.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "log/progress.h"
#include "studies/sweep/sweep_journal.h"

namespace thimble::studies {
namespace {

using Message = SweepTeam::Message;

// Protocol: a helper requests work with the results of its last portion: 0, then CELL COUNT
// NUMBERS... of each. Or it reports an error: 1, then one character per number. The answer is its
// next cells; an empty one ends the helper.
constexpr std::uint64_t kResults = 0;
constexpr std::uint64_t kTrouble = 1;

/// The remaining work and the first error, shared by all threads of a process.
class Work {
 public:
  Work(std::vector<std::size_t> cells, const std::atomic<bool>& stop)
      : cells_(std::move(cells)), stop_(stop) {}

  /// Returns up to `most` of the next cells; none if all are assigned, or the sweep is to end.
  std::vector<std::size_t> take(std::size_t max) {
    const std::scoped_lock lock(mutex_);
    if (trouble_ || stop_.load(std::memory_order_relaxed)) return {};
    const std::size_t count = std::min(max, cells_.size() - next_);
    const auto begin = cells_.begin() + static_cast<std::ptrdiff_t>(next_);
    next_ += count;
    return {begin, begin + static_cast<std::ptrdiff_t>(count)};
  }
  std::size_t left() {
    const std::scoped_lock lock(mutex_);
    return cells_.size() - next_;
  }
  /// Ends the sweep; the first error is reported.
  void fail(std::string message) {
    const std::scoped_lock lock(mutex_);
    if (!trouble_) trouble_ = std::move(message);
  }
  std::optional<std::string> trouble() {
    const std::scoped_lock lock(mutex_);
    return trouble_;
  }

 private:
  std::mutex mutex_;
  std::vector<std::size_t> cells_;
  std::size_t next_ = 0;
  const std::atomic<bool>& stop_;
  std::optional<std::string> trouble_;
};

/// Measures cells until no work remains, on the calling thread.
template <class Keep>
void measure_all(const Sweep& sweep, Work& work, const Keep& keep) {
  while (true) {
    const std::vector<std::size_t> cell = work.take(1);
    if (cell.empty()) return;
    const auto fail = [&](const std::string& why) {
      work.fail(sweep.name + ", cell " + std::to_string(cell[0]) + ": " + why);
    };
    try {
      auto numbers = sweep.measure(cell[0]);
      if (!numbers) {
        fail(numbers.error().message);
      } else if (numbers->empty()) {
        fail("no result. This is an internal error; please report it.");
      } else {
        keep(cell[0], std::move(numbers).value());
      }
    } catch (const std::exception& thrown) {  // out of memory, say: must not end the program
      fail(thrown.what());
    }
  }
}

/// Measures a portion on all threads of a helper and packs the results for the leading process.
Message measure_portion(const Sweep& sweep, const Message& portion, int jobs,
                        const std::atomic<bool>& stop) {
  Work work({portion.begin(), portion.end()}, stop);
  std::mutex mutex;
  Message results{kResults};
  {
    std::vector<std::jthread> threads;
    threads.reserve(static_cast<std::size_t>(jobs));
    for (int i = 0; i < jobs; ++i) {
      threads.emplace_back([&] {
        measure_all(sweep, work, [&](std::size_t cell, const std::vector<double>& numbers) {
          const std::scoped_lock lock(mutex);
          results.push_back(cell);
          results.push_back(numbers.size());
          for (const double number : numbers) {
            results.push_back(std::bit_cast<std::uint64_t>(number));
          }
        });
      });
    }
  }
  if (const auto trouble = work.trouble()) {
    results.assign(1, kTrouble);
    for (const char c : *trouble) results.push_back(static_cast<unsigned char>(c));
  }
  return results;
}

/// Helps the leading process until it has no more work.
SweepResult help(const Sweep& sweep, SweepTeam& team, int jobs, const std::atomic<bool>& stop) {
  Message answer{kResults};
  while (true) {
    team.send(0, answer);
    const Message portion = team.receive(0);
    if (portion.empty()) return {SweepEnd::kHelped, {}};
    answer = measure_portion(sweep, portion, jobs, stop);
  }
}

/// Leads a sweep: threads of this process and helpers share the work, and all results arrive here.
class Lead {
 public:
  Lead(const Sweep& sweep, SweepJournal* journal, CellNumbers& numbers,
       const std::atomic<bool>& stop)
      : sweep_(sweep), journal_(journal), numbers_(numbers), work_(missing(), stop) {}

  void run(int jobs, SweepTeam* team) {
    scene::Progress progress("study " + sweep_.name, share_done());
    int busy = jobs;
    std::vector<std::jthread> threads;
    threads.reserve(static_cast<std::size_t>(jobs));
    for (int i = 0; i < jobs; ++i) {
      threads.emplace_back([&] {
        measure_all(sweep_, work_, [this](std::size_t cell, std::vector<double> found) {
          keep(cell, std::move(found));
        });
        const std::scoped_lock lock(mutex_);
        --busy;
        changed_.notify_one();
      });
    }
    int helpers = team != nullptr ? team->size() - 1 : 0;
    std::unique_lock lock(mutex_);
    while (busy > 0 || helpers > 0) {
      progress.set_share(share_done());
      // A message of a helper does not wake this thread, so it polls often enough to keep helpers
      // busy.
      changed_.wait_for(lock, std::chrono::milliseconds(helpers > 0 ? 1 : 100),
                        [&] { return busy == 0 && helpers == 0; });
      lock.unlock();
      while (helpers > 0 && answer(*team, helpers)) {
      }
      lock.lock();
    }
    progress.set_share(share_done());
  }

  Work& work() { return work_; }
  bool complete() const { return done_ == numbers_.size(); }

 private:
  double share_done() const {
    return numbers_.empty() ? 1 : static_cast<double>(done_) / static_cast<double>(numbers_.size());
  }

  std::vector<std::size_t> missing() {
    std::vector<std::size_t> cells;
    for (std::size_t cell = 0; cell < numbers_.size(); ++cell) {
      if (numbers_[cell].empty()) cells.push_back(cell);
    }
    done_ = numbers_.size() - cells.size();
    return cells;
  }

  void keep(std::size_t cell, std::vector<double> found) {
    const std::scoped_lock lock(mutex_);
    if (!journal_->add(cell, found))
      work_.fail("Cannot write the journal of the sweep. Check that the disk has room.");
    numbers_[cell] = std::move(found);
    ++done_;
  }

  void keep(const Message& results) {
    for (std::size_t i = 1; i + 1 < results.size();) {
      const auto cell = static_cast<std::size_t>(results[i]);
      const auto count = static_cast<std::size_t>(results[i + 1]);
      std::vector<double> found;
      for (std::size_t k = 0; k < count; ++k) {
        found.push_back(std::bit_cast<double>(results[i + 2 + k]));
      }
      keep(cell, std::move(found));
      i += 2 + count;
    }
  }

  /// Answers one helper, if it has sent a request; decrements `helpers` if it is dismissed.
  bool answer(SweepTeam& team, int& helpers) {
    int from = 0;
    Message asked;
    if (!team.poll(from, asked)) return false;
    if (asked.front() == kTrouble) {
      std::string text;
      for (std::size_t i = 1; i < asked.size(); ++i) text += static_cast<char>(asked[i]);
      work_.fail(text);
    } else {
      keep(asked);
    }
    // Large portions need fewer messages; small ones at the end keep all processes busy.
    constexpr std::size_t kPortionMax = 32;
    const auto shares = std::size_t{4} * static_cast<std::size_t>(team.size());
    const auto cells = work_.take(std::clamp(work_.left() / shares, std::size_t{1}, kPortionMax));
    team.send(from, {cells.begin(), cells.end()});
    if (cells.empty()) --helpers;
    return true;
  }

  const Sweep& sweep_;
  SweepJournal* journal_;
  CellNumbers& numbers_;
  std::size_t done_ = 0;  // before work_, whose initialiser uses it
  Work work_;
  std::mutex mutex_;  // for the results
  std::condition_variable changed_;
};

}  // namespace

driver::Result<SweepResult> run_sweep(const Sweep& sweep, const SweepOptions& options,
                                      const std::atomic<bool>& stop) {
  const int jobs = options.jobs > 0 ? options.jobs : jobs_here();
  if (options.team != nullptr && options.team->rank() > 0) {
    return help(sweep, *options.team, jobs, stop);
  }
  SweepResult result;
  auto journal = SweepJournal::open(options.folder / (sweep.name + ".journal"), sweep.key,
                                    sweep.cells, options.resume, result.numbers);
  Lead lead(sweep, journal ? journal->get() : nullptr, result.numbers, stop);
  // Helpers wait for an answer even if there is no work for them.
  if (!journal) lead.work().fail(journal.error().message);
  lead.run(jobs, options.team);
  if (const auto trouble = lead.work().trouble()) return driver::Error{*trouble};
  if (!lead.complete()) {
    result.end = SweepEnd::kStopped;
    result.numbers.clear();
    return result;
  }
  if (auto done = (*journal)->finish(result.numbers); !done) return done.error();
  return result;
}

std::uint64_t cell_seed(std::uint64_t seed, std::size_t cell) {
  // SplitMix64 [S Steele, Lea, Flood 2014; the constants of its public-domain form].
  std::uint64_t z = seed + 0x9e3779b97f4a7c15 * (static_cast<std::uint64_t>(cell) + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

int jobs_here() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  int cores = 1;
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) cores = CPU_COUNT(&allowed);
  int local_processes = 1;
  if (const char* text = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE"))
    local_processes = std::atoi(text);
  // mpirun may have assigned cores to this process, or all cores to every process.
  const auto all = static_cast<int>(std::thread::hardware_concurrency());
  if (local_processes > 1 && cores >= all) cores /= local_processes;
  return std::max(cores, 1);
}

}  // namespace thimble::studies
