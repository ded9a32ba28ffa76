#include "compat/server/arm_server.h"

#include <fmt/format.h>

#include <new>
#include <utility>

#include "compat/core/channel_layout.h"
#include "compat/core/shared_wait.h"
#include "compat/server/facts_of.h"
#include "compat/server/put_text.h"
#include "compat/server/read_hand_path.h"
#include "log/logger.h"
#include "system/printable_text.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::compat {
namespace {

/// Returns the properties of an arm before it is opened.
ArmFacts known_facts(const ExecOptions& options, const ExecArm& arm) {
  if (arm.device != "sim") return {};
  std::filesystem::path file = arm.arm_file;
  if (file.empty() && !options.scene.empty()) {
    const auto scene = scene::load_scene(options.scene);
    if (scene) file = scene->arms.front().arm_file;
  }
  const auto read = scene::load_arm(file.empty() ? "vintage_phantom" : file);
  return read ? facts_of(*read) : ArmFacts{};
}

/// Reads all input files of the options, because the arms are opened later, if at all.
driver::Result<void> check_inputs(const ExecOptions& options) {
  for (const ExecArm& arm : options.arms) {
    if (arm.arm_file.empty()) continue;
    const auto found = scene::find_arm_file(arm.arm_file);
    if (!found) return driver::Error{"--arm: " + found.error().message};
    if (const auto read = scene::load_arm(*found); !read) return read.error();
  }
  if (!options.scene.empty()) {
    const auto found = scene::find_scene(options.scene);
    if (!found) return driver::Error{"--scene: " + found.error().message};
    const auto read = scene::load_scene(*found, {.arm = options.arms.front().arm_file});
    if (!read) return read.error();
  }
  if (options.hand == "path" || options.hand == "mouse" || options.hand == "free") return {};
  const auto hand = read_hand_path(options.hand);
  return hand ? driver::Result<void>() : driver::Error{"--hand: " + hand.error().message};
}

std::string name_of(const ExecArm& arm) {
  if (!arm.arm_file.empty()) return std::filesystem::path(arm.arm_file).stem().string();
  return arm.device == "sim" ? "vintage_phantom" : arm.device;
}

template <class Word>
void answer(std::atomic<Word>& word, Word value) {
  word.store(value);
  wake_all(word);
}

}  // namespace

driver::Result<std::unique_ptr<ArmServer>> ArmServer::make(const ExecOptions& options,
                                                           const std::atomic<bool>& stop) {
  if (options.arms.empty() || options.arms.size() > kArmsMax) {
    return driver::Error{fmt::format("--arm: expected 1 to {} arms.", kArmsMax)};
  }
  if (options.paced) {
    for (const ExecArm& arm : options.arms) {
      if (arm.device == "sim") continue;
      return driver::Error{fmt::format(
          "--clock virtual requires simulated arms. Remove it, because {} runs in real time.",
          arm.device)};
    }
    if (options.view || options.hand == "mouse") {
      return driver::Error{
          "--clock virtual cannot be used with --view or --hand mouse. Remove one of them."};
    }
  }
  if (auto readable = check_inputs(options); !readable) return readable.error();
  auto memory = session::SharedMemory::create_nameless(sizeof(Channel));
  if (!memory) return memory.error();
  return std::unique_ptr<ArmServer>(new ArmServer(options, stop, std::move(memory).value()));
}

ArmServer::ArmServer(const ExecOptions& options, const std::atomic<bool>& stop,
                     std::unique_ptr<session::SharedMemory> memory)
    : options_(options),
      stop_(stop),
      memory_(std::move(memory)),
      channel_(new (memory_->bytes().data()) Channel) {
  channel_->arm_count = static_cast<std::int32_t>(options_.arms.size());
  for (std::size_t i = 0; i < options_.arms.size(); ++i) {
    put_text(channel_->arms[i].name, name_of(options_.arms[i]));
    ArmFacts facts = known_facts(options_, options_.arms[i]);
    if (options_.arms[i].device == "sim") number_simulated(facts, i);
    channel_->arms[i].facts.store(facts);
  }
  channel_->layout.store(channel_layout_hash(), std::memory_order_release);
}

ArmServer::~ArmServer() {
  end();
}

std::string ArmServer::address() const {
  return memory_->path();
}

void ArmServer::step(std::int64_t wait_ns) {
  const std::uint32_t requests = channel_->requests.load();
  if (requests == served_) wait_while(channel_->requests, requests, wait_ns);
  served_ = channel_->requests.load();
  for (std::size_t i = 0; i < options_.arms.size(); ++i) serve(i);
}

void ArmServer::serve(std::size_t index) {
  ArmChannel& shared = channel_->arms[index];
  const ChannelState state = shared.state.load();
  if (state == ChannelState::kClosed) return;
  // Ignores the request of a program that has died.
  const bool owned = memory_->locked_elsewhere(kFirstOwnerByte + static_cast<std::int64_t>(index));
  if (state == ChannelState::kWanted && owned) {
    open(index);
    return;
  }
  ArmRun* run = arms_[index].run.get();
  if (state == ChannelState::kLeaving) {
    close(index, ChannelState::kClosed);
    return;
  }
  if (run == nullptr) {
    // The program died before it read the answer. Another one may have requested the arm since.
    ChannelState left = state;
    if (!owned && shared.state.compare_exchange_strong(left, ChannelState::kClosed)) {
      wake_all(shared.state);
    }
    return;
  }
  run->answer_joints();
  run->attend(options_.program);
  ended_by_viewer_ = ended_by_viewer_ || run->ended_by_viewer();
  if (!owned) {
    scene::logger().warn("{} ended without closing {}; its force is off.", options_.program,
                         read_facts(shared).name.data());
    close(index, ChannelState::kClosed);
  }
}

void ArmServer::open(std::size_t index) {
  ArmChannel& shared = channel_->arms[index];
  auto run = over_ ? driver::Result<std::unique_ptr<ArmRun>>(driver::Error{"The run is over."})
                   : ArmRun::open(options_, index, arms_[index].runs, shared, stop_);
  if (run) {
    arms_[index].run = std::move(run).value();
    ++runs_;
    answer(shared.state, ChannelState::kOpen);
    return;
  }
  scene::logger().error("{}", run.error().message);
  put_text(shared.trouble, driver::printable(run.error().message));
  answer(shared.state, ChannelState::kFailed);
}

void ArmServer::close(std::size_t index, ChannelState state) {
  Arm& arm = arms_[index];
  ArmChannel& shared = channel_->arms[index];
  if (arm.run) {
    reports_ += arm.run->end();
    any_fault_ = any_fault_ || arm.run->fault() != driver::Fault::kNone;
    arm.run.reset();
    ++arm.runs;
  }
  shared.enabled.store(0);
  answer(shared.state, state);
}

void ArmServer::end() {
  if (over_) return;
  over_ = true;
  for (std::size_t i = 0; i < options_.arms.size(); ++i) {
    if (arms_[i].run) close(i, ChannelState::kEnded);
  }
}

std::string ArmServer::report() const {
  std::string s = reports_;
  if (const std::uint64_t torques = channel_->torque_requests.load(); torques > 0) {
    s += fmt::format("Torque    requested {} times; ignored, because the arm has 3 motors.\n",
                     torques);
  }
  if (const std::uint64_t grips = channel_->gripper_requests.load(); grips > 0) {
    s += fmt::format(
        "Gripper   force requested {} times; ignored, because the gripper has no motor.\n", grips);
  }
  const std::uint32_t used = channel_->wrong_calls_used.load();
  for (std::size_t i = 0; i < used && i < Channel::kWrongCallsMax; ++i) {
    const WrongCall& call = channel_->wrong_calls[i];
    const std::uint64_t count = call.count.load(std::memory_order_acquire);
    if (count == 0) continue;  // a program adds it at this moment
    s += fmt::format("Wrong     {} {} time{}: {}\n", call.function.data(), count,
                     count == 1 ? "" : "s", call.what.data());
  }
  return s;
}

}  // namespace thimble::compat
