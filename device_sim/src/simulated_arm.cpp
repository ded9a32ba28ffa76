#include "simulated_arm.h"

#include <algorithm>
#include <utility>

namespace thimble::device_sim {

namespace {

/// Returns the point where the hand wants the tip at the beginning.
Eigen::Vector3d wanted_first(const HandPath& path, const Tremor& tremor) {
  HandPath way = path;
  Tremor first = tremor;
  return way.at(0) + first.at(0);
}

bool needs_drive_train(const SimulatedArmSettings& settings) {
  return settings.drive_train.named() || !settings.weight_B.isZero(0);
}

template <class AnyPlant, class Made>
driver::Result<AnyPlant> as_any(driver::Result<Made> made) {
  if (!made) return made.error();
  return AnyPlant(std::move(made).value());
}

}  // namespace

template <class MakePlant>
driver::Result<SimulatedArm> SimulatedArm::make_of(const driver::ArmModel& board,
                                                   SimulatedArmSettings settings, HandPath path,
                                                   std::uint64_t seed,
                                                   const MakePlant& make_plant) {
  const int motors = driver::motor_count(board.geometry);
  const Eigen::Vector3d free_B = driver::free_axes(motors);
  if (motors < 3) settings.weight_B = settings.weight_B.cwiseProduct(free_B);
  if (settings.wire.delay_in_ns < 0 || settings.wire.delay_out_ns < 0) {
    return driver::Error{"The simulated wire's delays must not be negative (ns)."};
  }
  if (settings.wire.jitter_ns < 0 || !(settings.wire.loss >= 0 && settings.wire.loss < 1)) {
    return driver::Error{
        "The simulated wire's jitter must not be negative (ns), and its loss must be at least 0 "
        "and below 1."};
  }
  if (!(settings.gimbal.period > 0) || !settings.gimbal.middle.allFinite() ||
      !settings.gimbal.amplitude.allFinite()) {
    return driver::Error{
        "The simulated gimbal requires finite angles and a period above zero (s)."};
  }
  const auto tremor = Tremor::make(settings.hand, seed);
  if (!tremor) return tremor.error();
  auto plant = make_plant(settings, path.points().front().p_BH.cwiseProduct(free_B),
                          wanted_first(path, *tremor).cwiseProduct(free_B));
  if (!plant) return plant.error();
  const auto firmware = Firmware::make(board, settings.firmware);
  if (!firmware) return firmware.error();
  // The plant was made from the same constants.
  const auto tip = LoadedTip::make(settings.plant, settings.hand, settings.weight_B);
  if (!tip) return tip.error();
  return SimulatedArm(settings, Hand(std::move(path), *tremor), std::move(plant).value(), *tip,
                      *firmware, motors, seed);
}

SimulatedArm::SimulatedArm(const SimulatedArmSettings& settings, Hand hand, AnyPlant plant,
                           const LoadedTip& tip, const Firmware& firmware, int motors,
                           std::uint64_t seed)
    : report_period_ns_(settings.firmware.report_period_ns),
      wire_(settings.wire),
      reports_at_once_(wire_.delay_in_ns == 0 && wire_.regular()),
      messages_at_once_(wire_.delay_out_ns == 0 && wire_.regular()),
      wire_chance_(seed ^ 0x77697265),
      edge_chance_(seed ^ 0x65646765),
      hand_(std::move(hand)),
      gimbal_(settings.gimbal),
      plant_(std::move(plant)),
      tip_(tip),
      free_B_(driver::free_axes(motors)),
      firmware_(firmware),
      reports_(!reports_at_once_),
      messages_(!messages_at_once_) {
  sample();
  deliver();
}

driver::Result<SimulatedArm> SimulatedArm::make(const driver::JointModel<driver::SerialArm>& model,
                                                const SimulatedArmSettings& settings, HandPath path,
                                                std::uint64_t seed) {
  return make_of(
      arm_model(model), settings, std::move(path), seed,
      [&](const SimulatedArmSettings&, const Eigen::Vector3d& p_BT,
          const Eigen::Vector3d& p_BH) -> driver::Result<AnyPlant> {
        if (settings.links.named() || settings.drive_train.has_joint_friction()) {
          return as_any<AnyPlant>(LinkedSerialPlant::make(model, settings, p_BT, p_BH));
        }
        if (needs_drive_train(settings)) {
          return as_any<AnyPlant>(SerialDriveTrainPlant::make(model, settings, p_BT, p_BH));
        }
        return as_any<AnyPlant>(ArmPlant::make(model.geometry, model.drives, settings.plant,
                                               settings.hand, settings.motors, p_BT, p_BH));
      });
}

driver::Result<SimulatedArm> SimulatedArm::make(const driver::JointModel<driver::LinkageArm>& model,
                                                const SimulatedArmSettings& settings, HandPath path,
                                                std::uint64_t seed) {
  return make_of(
      arm_model(model), settings, std::move(path), seed,
      [&](const SimulatedArmSettings&, const Eigen::Vector3d& p_BT,
          const Eigen::Vector3d& p_BH) -> driver::Result<AnyPlant> {
        if (settings.links.named()) {
          return driver::Error{
              "Link inertia is simulated for serial arms only. Remove the links from the arm "
              "file."};
        }
        if (settings.drive_train.has_joint_friction()) {
          return as_any<AnyPlant>(RubbingLinkagePlant::make(model, settings, p_BT, p_BH));
        }
        if (needs_drive_train(settings)) {
          return as_any<AnyPlant>(LinkageDriveTrainPlant::make(model, settings, p_BT, p_BH));
        }
        return as_any<AnyPlant>(
            LinkagePlant::make(model, settings.plant, settings.hand, settings.motors, p_BT, p_BH));
      });
}

driver::Result<SimulatedArm> SimulatedArm::make_by_inverse(const driver::ArmModel& model,
                                                           const SimulatedArmSettings& settings,
                                                           HandPath path, std::uint64_t seed) {
  if (settings.links.named()) {
    return driver::Error{
        "Link inertia is simulated for serial arms only. Remove the links from the arm file."};
  }
  const driver::JointModel<BoardGeometry> by_inverse = board_model(model);
  return make_of(
      model, settings, std::move(path), seed,
      [&](const SimulatedArmSettings& used, const Eigen::Vector3d& p_BT,
          const Eigen::Vector3d& p_BH) -> driver::Result<AnyPlant> {
        if (used.drive_train.has_joint_friction()) {
          return as_any<AnyPlant>(RubbingBoardPlant::make(by_inverse, used, p_BT, p_BH));
        }
        if (needs_drive_train(used)) {
          return as_any<AnyPlant>(BoardDriveTrainPlant::make(by_inverse, used, p_BT, p_BH));
        }
        return as_any<AnyPlant>(
            BoardPlant::make(by_inverse, used.plant, used.hand, used.motors, p_BT, p_BH));
      });
}

driver::Result<SimulatedArm> SimulatedArm::make(const driver::ArmModel& model,
                                                const SimulatedArmSettings& settings, HandPath path,
                                                std::uint64_t seed) {
  if (std::holds_alternative<driver::SerialArm>(model.geometry)) {
    return make(driver::model_as<driver::SerialArm>(model), settings, std::move(path), seed);
  }
  if (std::holds_alternative<driver::LinkageArm>(model.geometry)) {
    return make(driver::model_as<driver::LinkageArm>(model), settings, std::move(path), seed);
  }
  return make_by_inverse(model, settings, std::move(path), seed);
}

driver::Result<void> SimulatedArm::fix_mass(double mass, const Eigen::Vector3d& gravity_B) {
  if (auto fixed = tip_.fix_mass(mass, gravity_B); !fixed) return fixed;
  mechanics().take_tip(tip_.dynamics(held_));
  mechanics().set_pull(tip_.pull_B().cwiseProduct(free_B_));
  return {};
}

// Without the unused part of the variant and without `tip_`, which only `fix_mass` and `hold_tip`
// read.
void SimulatedArm::list_memory(std::vector<std::span<const std::byte>>& memory) const {
  const auto add = [&](const void* begin, const void* end) {
    memory.emplace_back(static_cast<const std::byte*>(begin), static_cast<const std::byte*>(end));
  };
  std::visit([&](const auto& plant) { add(this, &plant + 1); }, plant_);
  add(&free_B_, this + 1);
  memory.push_back(messages_.memory());
  memory.push_back(reports_.memory());
}

void SimulatedArm::advance_to(std::int64_t time_ns) noexcept {
  while (time_ns_ < time_ns) {
    std::int64_t next_ns = std::min(time_ns, time_ns_ + ArmPlant::kStepMax_ns);
    next_ns = std::min({next_ns, next_sample_ns_, firmware_.watchdog_due_ns()});
    if (!messages_.empty()) next_ns = std::min(next_ns, messages_.front().due_ns);

    mechanics().step(hand_.at(next_ns).cwiseProduct(free_B_), next_ns - time_ns_);
    time_ns_ = next_ns;

    if (next_sample_ns_ == time_ns_) sample();
    while (!messages_.empty() && messages_.front().due_ns <= time_ns_) {
      receive(messages_.front().content());
      messages_.pop();
    }
    if (firmware_.watchdog_due_ns() <= time_ns_) {
      firmware_.watch(time_ns_);
      mechanics().set_currents(firmware_.currents());
    }
    deliver();
  }
}

void SimulatedArm::sample() noexcept {
  if (reports_at_once_) {
    sample_into(newest_);
    ++readable_;
  } else {
    const BoardBytes report = sample_now();
    send(reports_, report, wire_.delay_in_ns);
  }
  next_sample_ns_ += report_period_ns_;
}

BoardBytes SimulatedArm::sample_now() noexcept {
  BoardBytes report;
  sample_into(report);
  return report;
}

// The exact angles are computed only if a count depends on their last digits.
void SimulatedArm::sample_into(BoardBytes& report) noexcept {
  const std::uint16_t number = number_++;
  const Eigen::Vector3d turned = gimbal();
  const Eigen::Vector3d q = mechanics().q_about();
  if (!firmware_.sample_about(q, Plant::kAboutError, turned, number, report)) {
    if (firmware_.misses_edges()) firmware_.miss_edges(plant().q(), edge_chance_);
    report = firmware_.sample(plant().q(), turned, number);
  }
  if (!firmware_.has_program()) return;
  firmware_.tick(time_ns_, report);
  mechanics().set_currents(firmware_.currents());
}

void SimulatedArm::restart_board() noexcept {
  firmware_.restart(plant().q(), gimbal());
  mechanics().set_currents(firmware_.currents());
  // Frames in flight are lost, because the board is not running.
  while (!messages_.empty()) messages_.pop();
  while (!reports_.empty()) reports_.pop();
  readable_ = 0;
}

void SimulatedArm::receive(std::span<const std::byte> bytes) noexcept {
  const auto counters = firmware_.receive(bytes, time_ns_);
  if (counters) firmware_.preset(*counters, plant().q(), gimbal());
  mechanics().set_currents(firmware_.currents());
}

void SimulatedArm::deliver() noexcept {
  while (!reports_.empty() && reports_.front().due_ns <= time_ns_) {
    const std::span<const std::byte> report = reports_.front().content();
    newest_.size = std::min(report.size(), newest_.bytes.size());
    std::copy_n(report.begin(), newest_.size, newest_.bytes.begin());
    ++readable_;
    reports_.pop();
  }
}

std::size_t SimulatedArm::take_report(std::span<std::byte> buffer,
                                      std::uint32_t& skipped) noexcept {
  skipped = readable_ > 0 ? readable_ - 1 : 0;
  if (readable_ == 0) return 0;
  readable_ = 0;
  const std::size_t size = std::min(newest_.size, buffer.size());
  std::copy_n(newest_.bytes.begin(), size, buffer.begin());
  return size;
}

std::int64_t SimulatedArm::next_report_ns() const noexcept {
  if (readable_ > 0) return time_ns_;
  if (!reports_.empty()) return reports_.front().due_ns;
  return next_sample_ns_ + wire_.delay_in_ns;
}

void SimulatedArm::put_message(std::span<const std::byte> bytes) noexcept {
  if (messages_at_once_) {
    receive(bytes);
  } else {
    send(messages_, bytes, wire_.delay_out_ns);
  }
}

void SimulatedArm::send(WireQueue& queue, std::span<const std::byte> bytes,
                        std::int64_t delay_ns) noexcept {
  std::int64_t due_ns = time_ns_ + delay_ns;
  if (!wire_.regular()) {
    if (wire_chance_.uniform() < wire_.loss) {
      ++losses_;
      return;
    }
    due_ns +=
        static_cast<std::int64_t>(wire_chance_.uniform() * static_cast<double>(wire_.jitter_ns));
  }
  // Frames keep their order: one that is due before the previous frame arrives with it.
  queue.push(bytes, due_ns);
}

}  // namespace thimble::device_sim
