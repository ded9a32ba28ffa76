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

void SessionBatch::step_one(std::size_t i, std::uint32_t ticks) noexcept {
  if (ticks == 0) return;
  Session& run = *runs_[i];
  for (std::uint32_t k = 0; k < ticks; ++k) {
    if (run.step()) break;
  }
  run.newest().load(newest_[i]);
}

driver::Result<void> SessionBatch::restart(std::size_t i, std::uint64_t seed) {
  auto run = Session::open_like(*like_, seed);
  if (!run) return run.error();
  runs_[i] = std::move(run).value();
  newest_[i] = {};
  return {};
}

}  // namespace thimble::session
