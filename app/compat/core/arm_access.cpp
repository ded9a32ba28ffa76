#include "compat/core/arm_access.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <mutex>

#include "byte_lock.h"
#include "compat/core/arm_channel.h"
#include "compat/core/arm_listing.h"
#include "compat/core/open_channel.h"
#include "compat/core/shared_wait.h"

namespace thimble::compat::arms {
namespace {

constexpr std::int64_t kLook_ns = 100'000'000;  // time after which a waiter checks that the other
                                                // side is alive
constexpr std::int64_t kPeriod_ns = 1'000'000;  // paces a loop whose arm has ended
constexpr std::int64_t kOpening_ns = 120'000'000'000;  // a person may have to agree to forces

/// This process's state of an arm that it has open.
struct OwnArm {
  std::mutex mutex;                          // for writers: a snapshot allows one
  std::atomic<int> opened{0};                // number of openings
  std::uint64_t number = 0;                  // number of the last force
  std::atomic<const char*> leader{nullptr};  // the only thread whose waits advance time
  std::mutex questions;                      // one question at a time
};

// Never destroyed: threads of the program may use it while it exits.
std::array<OwnArm, kArmsMax>& own_arms() {
  static auto& all = *new std::array<OwnArm, kArmsMax>;
  return all;
}

OwnArm& own(int arm) noexcept {
  return own_arms()[static_cast<std::size_t>(arm)];
}

std::mutex& opening() {
  static std::mutex& only = *new std::mutex;
  return only;
}

/// Returns an address that is unique to this thread.
const char* this_thread() noexcept {
  static thread_local const char own_byte = 0;
  return &own_byte;
}

bool is_number(int arm) noexcept {
  return arm >= 0 && arm < kArmsMax;
}

/// Returns the channel of an arm opened here; null if it is not open.
ArmChannel* channel_of(int arm) noexcept {
  if (!is_number(arm) || own(arm).opened.load(std::memory_order_acquire) == 0) return nullptr;
  Channel* channel = open_channel();
  return channel == nullptr ? nullptr : &channel->arms[static_cast<std::size_t>(arm)];
}

bool is_server_alive() noexcept {
  return driver::is_byte_locked(channel_file(), kServerByte);
}

/// Sleeps in wall-clock time.
void wait_ns(std::int64_t duration_ns) noexcept {
  timespec left{duration_ns / 1'000'000'000, duration_ns % 1'000'000'000};
  while (nanosleep(&left, &left) != 0 && errno == EINTR) {
  }
}

std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

template <std::size_t N>
void copy_text(std::array<char, N>& to, const char* from) noexcept {
  to.fill(0);
  if (from != nullptr) std::strncpy(to.data(), from, N - 1);
}

template <std::size_t N>
std::string text_of(const std::array<char, N>& text) {
  return {text.data(), strnlen(text.data(), N)};
}

/// Permits ticks of an arm that wait for the program, up to number `ticks`.
void permit(ArmChannel& arm, std::uint32_t ticks) noexcept {
  std::uint32_t permitted = arm.permitted.load();
  // Comparison with wrap-around: the later number is less than half the range ahead.
  while (static_cast<std::int32_t>(ticks - permitted) > 0) {
    if (!arm.permitted.compare_exchange_weak(permitted, ticks)) continue;
    wake_all(arm.permitted);
    return;
  }
}

/// Returns the first arm from `first` that is opened here and whose ticks wait for the program; -1:
/// none.
int paced_arm(int first = 0) noexcept {
  for (int arm = first; arm < kArmsMax; ++arm) {
    if (is_paced(arm)) return arm;
  }
  return -1;
}

/// Waits until `done` returns true for a loop. If the loop or its process has ended, returns false
/// after a sleep of one period.
template <class Done>
bool wait_until(int number, Done done) noexcept {
  Channel* channel = open_channel();
  ArmChannel& arm = channel->arms[static_cast<std::size_t>(number)];
  const std::atomic<const char*>& leader = own(number).leader;
  arm.waiting.fetch_add(1);
  bool reached = false;
  for (;;) {
    const std::uint32_t ticks = arm.ticks.load();
    reached = done();
    if (reached || arm.state.load() != ChannelState::kOpen) break;
    if (arm.paced.load() != 0 && (leader.load() == nullptr || leader.load() == this_thread())) {
      permit(arm, ticks + 1);
    }
    wait_while(arm.ticks, ticks, kLook_ns);
    if (arm.ticks.load() == ticks && !is_server_alive()) break;
  }
  arm.waiting.fetch_sub(1);
  if (!reached) wait_ns(kPeriod_ns);
  return reached;
}

/// Claims an arm for this program before it writes anything of the arm. Of two programs that do so
/// at once, one gets it and the other changes nothing.
bool claim_arm(int number, const ArmChannel& arm) noexcept {
  constexpr std::int64_t kPause_ns = 10'000'000;
  constexpr int kLooks = 200;  // 2 s: the server closes a dead program's arm meanwhile
  for (int look = 0; look < kLooks; ++look) {
    if (!driver::lock_byte(channel_file(), kFirstOwnerByte + number)) return false;
    if (arm.state.load() == ChannelState::kClosed) return true;
    driver::unlock_byte(channel_file(), kFirstOwnerByte + number);
    if (!is_server_alive()) return false;
    wait_ns(kPause_ns);
  }
  return false;
}

void release_arm(int number) noexcept {
  driver::unlock_byte(channel_file(), kFirstOwnerByte + number);
}

/// Requests an arm claimed by this program from the server, and waits for its answer: empty, or the
/// problem.
std::string request_arm(Channel& channel, ArmChannel& arm, const char* api) {
  copy_text(arm.api, api);
  // Settings of an earlier program are reset.
  arm.enabled.store(0);
  arm.watchdog_ns.store(0);
  arm.speed_limit.store(0);
  arm.force_limit.store(0);
  arm.regulated.store(0);
  arm.state.store(ChannelState::kWanted);
  channel.requests.fetch_add(1);
  wake_all(channel.requests);
  const std::int64_t end_ns = monotonic_ns() + kOpening_ns;
  for (;;) {
    const ChannelState state = arm.state.load(std::memory_order_acquire);
    if (state == ChannelState::kOpen) return {};
    if (state == ChannelState::kFailed) {
      std::string trouble = text_of(arm.trouble);
      arm.state.store(ChannelState::kClosed);
      return trouble.empty() ? "The arm cannot be opened." : trouble;
    }
    if (!is_server_alive()) return "The `thimble exec` that started this program has ended.";
    if (monotonic_ns() > end_ns) {
      arm.state.store(ChannelState::kLeaving);
      return "`thimble exec` did not open the arm within two minutes.";
    }
    wait_while(arm.state, state, kLook_ns);
  }
}

template <class T>
bool set(int arm, std::atomic<T> ArmChannel::*member, T value) noexcept {
  ArmChannel* channel = channel_of(arm);
  if (channel == nullptr) return false;
  (channel->*member).store(value);
  return true;
}

}  // namespace

int count() noexcept {
  const Channel* channel = open_channel();
  return channel == nullptr ? 0 : channel->arm_count;
}

int listed(const char* api) noexcept {
  Channel* channel = open_channel();
  return channel != nullptr && may_list_arms(*channel, api) ? channel->arm_count : 0;
}

bool is_taken(int arm) noexcept {
  const Channel* channel = open_channel();
  if (channel == nullptr || !is_number(arm) || arm >= channel->arm_count) return false;
  return own(arm).opened.load() == 0 &&
         driver::is_byte_locked(channel_file(), kFirstOwnerByte + arm);
}

std::string open(int arm, const char* api) {
  std::string trouble;
  Channel* channel = open_channel(&trouble);
  if (channel == nullptr) return trouble;
  if (!is_number(arm) || arm >= channel->arm_count) {
    return "`thimble exec` has fewer arms. Add another --arm option.";
  }
  const std::lock_guard lock(opening());
  OwnArm& own_arm = own(arm);
  if (own_arm.opened.load() > 0) {
    own_arm.opened.fetch_add(1);
    return {};
  }
  ArmChannel& shared = channel->arms[static_cast<std::size_t>(arm)];
  if (!claim_arm(arm, shared)) {
    return is_server_alive() ? "Another program of this `thimble exec` already uses this arm."
                             : "The `thimble exec` that started this program has ended.";
  }
  trouble = request_arm(*channel, shared, api);
  if (trouble.empty()) {
    may_list_arms(*channel, api);
    own_arm.number = shared.taken.load();
    own_arm.opened.store(1, std::memory_order_release);
  } else {
    release_arm(arm);
  }
  return trouble;
}

bool close(int arm) noexcept {
  const std::lock_guard lock(opening());
  ArmChannel* shared = channel_of(arm);
  if (shared == nullptr) return false;
  if (own(arm).opened.fetch_sub(1) > 1) return true;
  shared->enabled.store(0);
  shared->regulated.store(0);
  if (shared->state.exchange(ChannelState::kLeaving) == ChannelState::kEnded) {
    shared->state.store(ChannelState::kClosed);  // its run has ended by itself
    release_arm(arm);
    return true;
  }
  Channel* channel = open_channel();
  channel->requests.fetch_add(1);
  wake_all(channel->requests);
  // Waits until the arm is free, because the same arm may be opened again at once.
  while (shared->state.load() == ChannelState::kLeaving && is_server_alive()) {
    wait_while(shared->state, ChannelState::kLeaving, kLook_ns);
  }
  release_arm(arm);
  return true;
}

bool is_open(int arm) noexcept {
  return channel_of(arm) != nullptr;
}

bool is_running(int arm) noexcept {
  const ArmChannel* channel = channel_of(arm);
  return channel != nullptr && channel->state.load() == ChannelState::kOpen && is_server_alive();
}

bool is_paced(int arm) noexcept {
  const ArmChannel* channel = channel_of(arm);
  return channel != nullptr && channel->paced.load() != 0 &&
         channel->state.load() == ChannelState::kOpen;
}

ArmFacts facts(int arm) noexcept {
  const Channel* channel = open_channel();
  if (channel == nullptr || !is_number(arm) || arm >= channel->arm_count) return {};
  return read_facts(channel->arms[static_cast<std::size_t>(arm)]);
}

std::string name(int arm) {
  const Channel* channel = open_channel();
  if (channel == nullptr || !is_number(arm) || arm >= channel->arm_count) return {};
  return text_of(channel->arms[static_cast<std::size_t>(arm)].name);
}

bool read(int arm, ArmReading& reading) noexcept {
  const ArmChannel* channel = channel_of(arm);
  return channel != nullptr && channel->reading.load(reading);
}

bool jacobian_at(int arm, const std::array<double, 3>& q, std::array<double, 9>& J_WT) noexcept {
  ArmChannel* shared = channel_of(arm);
  if (shared == nullptr || !read_facts(*shared).has_joints) return false;
  JointQuestion& question = shared->joints;
  const std::lock_guard lock(own(arm).questions);
  question.q = q;
  const std::uint32_t number = question.asked.fetch_add(1) + 1;
  Channel* channel = open_channel();
  channel->requests.fetch_add(1);
  wake_all(channel->requests);
  for (;;) {
    const std::uint32_t answered = question.answered.load(std::memory_order_acquire);
    if (answered == number) break;
    if (shared->state.load() != ChannelState::kOpen) return false;
    wait_while(question.answered, answered, kLook_ns);
    if (question.answered.load() == answered && !is_server_alive()) return false;
  }
  // A pose that the arm cannot have is answered by NaN.
  for (const double number_of_J : question.J_WT) {
    if (!std::isfinite(number_of_J)) return false;
  }
  J_WT = question.J_WT;
  return true;
}

bool wait_for_tick(int arm, std::uint64_t tick) noexcept {
  ArmChannel* channel = channel_of(arm);
  if (channel == nullptr) {
    wait_ns(kPeriod_ns);
    return false;
  }
  return wait_until(arm, [&] {
    ArmReading reading;
    return channel->reading.load(reading) && reading.tick > tick;
  });
}

bool ask_force(int arm, const ForceRequest& asked) noexcept {
  ArmChannel* channel = channel_of(arm);
  if (channel == nullptr) return false;
  OwnArm& own_arm = own(arm);
  {
    const std::lock_guard lock(own_arm.mutex);
    channel->force.store({.asked = asked, .number = ++own_arm.number});
  }
  // NaN counts as nonzero.
  const auto acts = [](double value) { return !(value == 0); };
  if (std::any_of(asked.torque_W.begin(), asked.torque_W.end(), acts)) {
    open_channel()->torque_requests.fetch_add(1, std::memory_order_relaxed);
  }
  if (acts(asked.gripper)) {
    open_channel()->gripper_requests.fetch_add(1, std::memory_order_relaxed);
  }
  return true;
}

bool wait_until_taken(int arm) noexcept {
  ArmChannel* channel = channel_of(arm);
  if (channel == nullptr) {
    wait_ns(kPeriod_ns);
    return false;
  }
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(own(arm).mutex);
    number = own(arm).number;
  }
  return wait_until(arm, [&] { return channel->taken.load() >= number; });
}

void lead(int arm, bool leads) noexcept {
  if (!is_number(arm)) return;
  const char* leader = this_thread();
  if (leads) {
    own(arm).leader.store(leader);
  } else {
    own(arm).leader.compare_exchange_strong(leader, nullptr);
  }
}

std::int64_t now_ns() noexcept {
  ArmReading reading;
  const int arm = paced_arm();
  return arm >= 0 && read(arm, reading) ? reading.time_ns : monotonic_ns();
}

void sleep_ns(std::int64_t duration_ns) noexcept {
  int arm = paced_arm();
  if (arm < 0) wait_ns(duration_ns);
  for (; arm >= 0; arm = paced_arm(arm + 1)) {
    ArmReading reading;
    if (!read(arm, reading)) continue;
    const std::int64_t end_ns = reading.time_ns + duration_ns;
    while (reading.time_ns < end_ns && wait_for_tick(arm, reading.tick) && read(arm, reading)) {
    }
  }
}

bool enable_force(int arm, bool enabled) noexcept {
  ArmChannel* channel = channel_of(arm);
  if (channel == nullptr) return false;
  if (enabled) channel->enablings.fetch_add(1);
  channel->enabled.store(enabled ? 1 : 0);
  return true;
}

bool force_enabled(int arm) noexcept {
  const ArmChannel* channel = channel_of(arm);
  return channel != nullptr && channel->enabled.load() != 0;
}

bool set_watchdog(int arm, std::int64_t watchdog_ns) noexcept {
  return set(arm, &ArmChannel::watchdog_ns, std::max<std::int64_t>(watchdog_ns, 0));
}

bool set_speed_limit(int arm, double speed) noexcept {
  return set(arm, &ArmChannel::speed_limit, speed > 0 ? speed : 0.0);
}

bool set_force_limit(int arm, double force) noexcept {
  return set(arm, &ArmChannel::force_limit, force > 0 ? force : 0.0);
}

bool set_regulated(int arm, bool regulated) noexcept {
  return set(arm, &ArmChannel::regulated, std::uint32_t{regulated});
}

bool mark_calibrated(int arm) noexcept {
  return set(arm, &ArmChannel::calibrated, std::uint32_t{1});
}

bool is_calibrated(int arm) noexcept {
  const ArmChannel* channel = channel_of(arm);
  return channel != nullptr && channel->calibrated.load() != 0;
}

void wrong_call(const char* function, const char* what) noexcept {
  Channel* channel = open_channel();
  if (channel == nullptr) return;
  // Several programs and libraries write this table, so an entry is read only if it is ready. If
  // two of them add one function at once, it has two entries.
  const std::uint32_t used = channel->wrong_calls_used.load();
  for (std::uint32_t i = 0; i < used && i < Channel::kWrongCallsMax; ++i) {
    WrongCall& call = channel->wrong_calls[i];
    if (call.count.load(std::memory_order_acquire) == 0 ||
        std::strncmp(call.function.data(), function, call.function.size() - 1) != 0) {
      continue;
    }
    call.count.fetch_add(1);
    return;
  }
  std::uint32_t entry = used;
  do {
    if (entry >= Channel::kWrongCallsMax) return;
  } while (!channel->wrong_calls_used.compare_exchange_weak(entry, entry + 1));
  WrongCall& call = channel->wrong_calls[entry];
  copy_text(call.function, function);
  copy_text(call.what, what);
  call.count.store(1, std::memory_order_release);
}

}  // namespace thimble::compat::arms
