#include "compat/server/arm_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "compat/core/shared_wait.h"
#include "compat/server/facts_of.h"
#include "compat/server/read_hand_path.h"
#include "log/logger.h"
#include "open_arm.h"
#include "run_arm.h"
#include "setup.h"
#include "terminal.h"
#include "text/counted.h"
#include "thimble/driver/fault.h"

namespace thimble::compat {
namespace {

std::filesystem::path recording_of(const std::filesystem::path& path, std::size_t index,
                                   int number) {
  if (path.empty() || (index == 0 && number == 0)) return path;
  std::string name = path.stem().string();
  if (index > 0) name += fmt::format("-arm{}", index + 1);
  if (number > 0) name += fmt::format("-{}", number + 1);
  return path.parent_path() / (name + path.extension().string());
}

}  // namespace

driver::Result<std::unique_ptr<ArmRun>> ArmRun::open(const ExecOptions& options, std::size_t index,
                                                     int number, ArmChannel& channel,
                                                     const std::atomic<bool>& stop) {
  std::unique_ptr<ArmRun> run(new ArmRun(options, index, channel));
  if (auto prepared = run->prepare(number); !prepared) return prepared.error();
  if (auto started = run->start(stop); !started) return started.error();
  return run;
}

driver::Result<void> ArmRun::prepare(int number) {
  const ExecArm& wanted = options_.arms[index_];
  auto arm = session::choose_run_arm(wanted.device, {.arm_file = wanted.arm_file,
                                                     .firmware = options_.firmware,
                                                     .unchecked = options_.unchecked});
  if (!arm) return arm.error();
  for (const std::string& warning : arm->warnings) scene::terminal().info("{}", warning);
  std::string scene = options_.scene;
  if (scene.empty()) {
    auto made = FreeScene::make(wanted.arm_file);
    if (!made) return made.error();
    free_scene_ = std::move(made).value();
    scene = free_scene_->file().string();
  }
  session::SessionOptions asked;
  asked.clock = options_.paced ? session::ClockKind::kVirtual : session::ClockKind::kWall;
  if (options_.paced) asked.own_clock = paced_ = std::make_shared<LockstepClock>(channel_);
  asked.endless = true;
  asked.arm_file = wanted.arm_file;
  asked.real_arm = arm->real;
  asked.terms = arm->terms;
  asked.firmware = options_.firmware;
  asked.record = recording_of(options_.record, index_, number);
  asked.overwrite = options_.overwrite;
  // Later runs use the next free number: the program is running, and the user cannot be asked.
  std::error_code unknown;
  const bool first = index_ == 0 && number == 0;
  for (int next = number; !first && !asked.overwrite && !asked.record.empty() &&
                          std::filesystem::exists(asked.record, unknown);) {
    asked.record = recording_of(options_.record, index_, ++next);
  }
  asked.log = true;
  asked.homed = options_.homed;
  asked.hold = options_.hold;
  asked.hand_by_mouse = options_.hand == "mouse" && !arm->real;
  asked.share_out = true;
  asked.share_if_possible = !options_.view && !asked.hand_by_mouse;
  std::vector<scene::HandWaypoint> path;
  std::vector<scene::ButtonStep> held;
  const bool is_file =
      options_.hand != "mouse" && options_.hand != "path" && options_.hand != "free";
  if (is_file) {
    auto read = read_hand_path(options_.hand);
    if (!read) return read.error();
    path = std::move(read->path);
    held = std::move(read->buttons);
  }
  asked.buttons = scene::steps_of(options_.presses, held);
  const bool alone = options_.scene.empty();
  asked.adjust = [path, alone, this](scene::Scene& adjusted) {
    if (alone) adjusted.name = options_.program;
    if (!path.empty()) adjusted.arms.front().hand = path;
  };
  auto prepared = session::Session::prepare(scene, asked);
  if (!prepared) return prepared.error();
  session_ = std::move(prepared).value();
  for (const std::string& warning : session_->warnings()) scene::terminal().info("{}", warning);
  std::vector<std::string> window;
  if (!options_.theme.empty()) window = {"--theme", options_.theme};
  desk_ = session::open_viewer_requests(*session_,
                                        options_.view || asked.hand_by_mouse
                                            ? session::ViewerChoice::kAsked
                                            : session::ViewerChoice::kNever,
                                        asked.hand_by_mouse, window);
  servo_ = std::make_unique<session::ServoThread>(!options_.paced);
  if (arm->real) return session::check_real_time(servo_->grant(), options_.no_real_time);
  return {};
}

driver::Result<void> ArmRun::start(const std::atomic<bool>& stop) {
  const session::Terminal terminal = session::user_terminal();
  if (!session::agree_to_forces(*session_, options_.yes, terminal, stop)) {
    return driver::Error{
        "The forces of the arm were not confirmed. Confirm them at the prompt, or pass --yes."};
  }
  const auto open = session::open_arm(*session_, terminal, stop);
  if (!open) return open.error();
  if (!*open) return driver::Error{"Stopped before the arm was at its start pose."};
  const scene::ArmFile& arm = session_->scene().arms.front().arm;
  client_ = std::make_unique<ClientForce>(channel_, session_->own_law(), session_->device(),
                                          !session_->setup().real_arm());
  publisher_ = std::make_unique<ReadingPublisher>(channel_, *client_, session_->device(), arm);
  if (session_->simulation() != nullptr && options_.hand != "mouse") {
    publisher_->let_hand_yield(*session_->simulation(), options_.hand == "free");
  }
  if (auto set = session_->set_servo_law(driver::ForceLaw(*client_)); !set) return set;
  if (options_.opened) options_.opened(index_, *session_);
  if (auto added = session_->add_observer(*publisher_); !added) return added;
  if (auto opened = open_topics(); !opened) return opened;
  ArmFacts facts = facts_of(arm, session_->device().traits());
  facts.rate = session_->scene().rate;
  number_simulated(facts, index_);
  if (const auto& real = session_->setup().real_arm()) name_real(facts, real->name());
  channel_.facts.store(facts);
  if (session_->setup().real_arm()) watch_.emplace(*session_);
  // No progress line, because the program writes to the same terminal.
  attendance_.emplace(*session_, watch_ ? &*watch_ : nullptr, desk_.get(), false);
  const std::uint32_t ticks = channel_.ticks.load();
  begun_ = true;
  servo_->begin(*session_, stop_);
  // A program reads an arm right after it is opened, so wait for the first tick.
  constexpr std::int64_t kSoon_ns = 100'000'000;
  for (int look = 0; look < 20 && channel_.ticks.load() == ticks && !servo_->ended(); ++look) {
    channel_.waiting.fetch_add(1);
    wait_while(channel_.ticks, ticks, kSoon_ns);
    channel_.waiting.fetch_sub(1);
  }
  if (channel_.ticks.load() == ticks) return driver::Error{"The servo loop did not start."};
  return {};
}

driver::Result<void> ArmRun::open_topics() {
  if (!options_.topics) return {};
  ros2::RosOptions topics = *options_.topics;
  if (options_.arms.size() > 1) topics.name_space += fmt::format("/arm{}", index_ + 1);
  auto opened = ros2::RosRun::open(*session_, topics);
  if (!opened) return opened.error();
  topics_ = std::move(opened).value();
  return {};
}

void ArmRun::attend(const std::string& program) {
  if (over_) return;
  attendance_->step();
  const std::string who = fmt::format("{} ({})", program, channel_.api.data());
  if (client_->stalls() != reported_stalls_) {
    if (reported_stalls_ == 0) {
      const ArmFacts facts = read_facts(channel_);
      scene::logger().warn(
          "{} has not renewed its force on {} for {:.0f} ms. The force is zero until it does. The "
          "program hangs, or its loop is too slow.",
          who, facts.name.data(), 1e-6 * static_cast<double>(facts.stall_ns));
    }
    reported_stalls_ = client_->stalls();
  }
  driver::TickRecord newest;
  if (!session_->newest().load(newest)) return;
  const bool faulty = newest.fault != driver::Fault::kNone;
  if (faulty && !fault_reported_) {
    scene::logger().error("{}: the force of {} was switched off: {}", who,
                          read_facts(channel_).name.data(), driver::describe(newest.fault));
  }
  fault_reported_ = faulty;
}

void ArmRun::answer_joints() noexcept {
  JointQuestion& question = channel_.joints;
  const std::uint32_t asked = question.asked.load();
  if (asked == question.answered.load()) return;
  const Eigen::Vector3d q = Eigen::Map<const Eigen::Vector3d>(question.q.data());
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(question.J_WT.data()) =
      jacobian_of(session_->scene().arms.front().arm, q);
  question.answered.store(asked, std::memory_order_release);
  wake_all(question.answered);
}

std::string ArmRun::end() {
  if (over_) return {};
  over_ = true;
  if (!begun_) return {};
  stop_.store(true);
  if (paced_) paced_->release();
  servo_->join();
  channel_.ticks.fetch_add(1);
  wake_all(channel_.ticks);
  session::keep_black_boxes(*session_, true);
  std::string report = session::summary(session_->figures(servo_->grant())) + own_report();
  const auto recorded = session_->end_recording();
  if (!recorded) {
    scene::logger().error("{}", recorded.error().message);
  } else if (*recorded) {
    report += fmt::format("Recording {}\n", (*recorded)->string());
  }
  return report;
}

std::string ArmRun::own_report() const {
  const session::RunStatistics& run = session_->statistics();
  const std::uint64_t ticks = run.ticks();
  const auto due = std::llround(run.duration() * session_->scene().rate) + 1;
  const auto missed = std::max<long long>(due - static_cast<long long>(ticks), 0);
  std::string s = fmt::format("Program   {} ({}): requested a force in {} of {}; {} missed.\n",
                              options_.program, channel_.api.data(), client_->renewals(),
                              scene::counted(ticks, "tick"), scene::counted(missed, "tick"));
  if (client_->stalls() > 0) {
    s += fmt::format(
        "Stalls    {} did not renew its force in time, {} time{}; the force was zero meanwhile.\n",
        options_.program, client_->stalls(), client_->stalls() == 1 ? "" : "s");
  }
  if (topics_) s += topics_->report();
  return s;
}

ArmRun::~ArmRun() {
  end();
}

}  // namespace thimble::compat
