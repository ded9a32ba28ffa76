#include "thimble/session/session_batch.h"

#include <utility>

#include "thimble/scene/scene_file.h"

namespace thimble::session {
namespace {

driver::Result<void> check(std::size_t count, const SessionOptions& options) {
  if (count == 0) return driver::Error{"A batch requires at least one run."};
  if (options.clock != ClockKind::kVirtual || options.own_clock || options.real_arm ||
      !options.real_arms.empty()) {
    return driver::Error{"A batch requires virtual time, the built-in clock and simulated arms."};
  }
  if (options.share || options.share_out || !options.record.empty()) {
    return driver::Error{
        "A batch cannot have viewers or recordings; open a session with the seed of the run "
        "instead."};
  }
  return {};
}

}  // namespace

driver::Result<std::unique_ptr<SessionBatch>> SessionBatch::open(const std::filesystem::path& scene,
                                                                 std::size_t count,
                                                                 const SessionOptions& options) {
  if (auto fits = check(count, options); !fits) return fits.error();
  auto first = Session::open(scene, options);
  if (!first) return first.error();
  std::unique_ptr<SessionBatch> batch(new SessionBatch);
  batch->like_ = std::move(first).value();
  const std::uint64_t seed = options.seed.value_or(batch->like_->scene().seed);
  for (std::size_t i = 0; i < count; ++i) {
    auto run = Session::open_like(*batch->like_, seed + i);
    if (!run) return run.error();
    batch->runs_.push_back(std::move(run).value());
  }
  batch->newest_.resize(count);
  for (std::size_t i = 0; i < count; ++i) batch->list_memory(i);
  return batch;
}

void SessionBatch::step(std::uint32_t ticks) noexcept {
  for (std::size_t i = 0; i < runs_.size(); ++i) step_one(i, ticks);
}

void SessionBatch::step(std::span<const std::uint32_t> ticks, std::span<const Eigen::Vector3d> p_WH,
                        std::span<std::uint8_t> reached) noexcept {
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const bool led = ticks[i] == 0 || p_WH.empty() || runs_[i]->lead_hand(p_WH[i]);
    if (!reached.empty()) reached[i] = led ? 1 : 0;
    step_one(i, ticks[i]);
  }
}

// Inlined by force, as prefetch_to_write: GCC 12 drops calls of a function that only prefetches.
[[gnu::always_inline]] inline void SessionBatch::prefetch_next(std::size_t i,
                                                               Half half) const noexcept {
  constexpr std::size_t kLine = 64;
  if (runs_.size() == 1) return;
  const std::size_t next = i + 1 < runs_.size() ? i + 1 : 0;
  const Lines* const parts = lines_.data() + next * parts_of_run_;
  const std::size_t middle = parts_of_run_ / 2;
  const std::size_t begin = half == Half::kFirst ? 0 : middle;
  const std::size_t end = half == Half::kFirst ? middle : parts_of_run_;
  for (std::size_t k = begin; k < end; ++k) {
    const std::byte* line = parts[k].first;
    for (std::size_t n = parts[k].count; n > 0; --n, line += kLine) __builtin_prefetch(line);
  }
}

// The state of many runs exceeds the cache. That of the next run is loaded while this one computes
// its last tick: some 110 lines, which are more than a processor loads at once. So one half is
// requested before the tick and the other one after it.
void SessionBatch::step_one(std::size_t i, std::uint32_t ticks) noexcept {
  if (ticks == 0) return;
  Session& run = *runs_[i];
  for (std::uint32_t k = 0; k < ticks; ++k) {
    if (k + 1 == ticks) prefetch_next(i, Half::kFirst);
    if (run.step()) break;
  }
  prefetch_next(i, Half::kSecond);
  run.newest().load(newest_[i]);
}

void SessionBatch::list_memory(std::size_t i) {
  constexpr std::uintptr_t kLine = 64;  // Cache line, bytes.
  std::vector<std::span<const std::byte>> memory;
  runs_[i]->list_memory(memory);
  if (lines_.empty()) {
    parts_of_run_ = memory.size();
    lines_.resize(runs_.size() * parts_of_run_);
  }
  // All runs of a scene have the same parts.
  memory.resize(parts_of_run_);
  for (std::size_t k = 0; k < parts_of_run_; ++k) {
    const std::byte* begin = memory[k].data();
    const auto before = reinterpret_cast<std::uintptr_t>(begin) % kLine;
    lines_[i * parts_of_run_ + k] = {
        .first = begin - before,
        .count = memory[k].empty() ? 0 : (memory[k].size() + before + kLine - 1) / kLine};
  }
}

driver::Result<void> SessionBatch::restart(std::size_t i, std::uint64_t seed) {
  auto run = Session::open_like(*like_, seed);
  if (!run) return run.error();
  runs_[i] = std::move(run).value();
  newest_[i] = {};
  list_memory(i);
  return {};
}

}  // namespace thimble::session
