#include "controller.h"

namespace thimble {
namespace firmware {
namespace {

constexpr float kTwoPi = 6.2831853f;
// A current up to 1 % beyond the limit is a rounding error of the host [chosen].
constexpr float kRounding = 1.01f;

int32_t sum(int32_t a, int32_t b) noexcept {
  return static_cast<int32_t>(static_cast<uint32_t>(a) + static_cast<uint32_t>(b));
}

int32_t difference(int32_t a, int32_t b) noexcept {
  return static_cast<int32_t>(static_cast<uint32_t>(a) - static_cast<uint32_t>(b));
}

uint32_t magnitude(int32_t value) noexcept {
  return value < 0 ? 0u - static_cast<uint32_t>(value) : static_cast<uint32_t>(value);
}

int16_t rounded_mA(float amperes) noexcept {
  const float mA = amperes * 1000.0f;
  if (!(mA > -32767.0f)) return -32767;
  if (!(mA < 32767.0f)) return 32767;
  return static_cast<int16_t>(mA < 0 ? mA - 0.5f : mA + 0.5f);
}

}  // namespace

Controller::Controller(const ArmConfig& config, bool restarted) noexcept : config_(config) {
  if (restarted) notes_ = kRestarted;
  // Here, because divisions are slow on small processors.
  late_us_ = UINT32_C(1000000) * kLatePeriods / config_.loop_hz;
  watchdog_us_ = config_.watchdog_ms * UINT32_C(1000);
  current_max_ = 1e-3f * static_cast<float>(config_.current_max_mA);
  const float window = static_cast<float>(kWindow) / static_cast<float>(config_.loop_hz);
  for (size_t i = 0; i < kMotorsMax; ++i) {
    const float turns = 0.1f * static_cast<float>(config_.speed_max) / kTwoPi * window;
    // One count more, because a count shows only that an edge was passed.
    steps_max_[i] =
        1 + static_cast<uint32_t>(turns * static_cast<float>(config_.counts_per_turn[i]));
  }
}

bool Controller::receive(const uint8_t* bytes, size_t size, uint32_t now_us) noexcept {
  Command command;
  if (!decode_command(bytes, size, command)) {
    refuse();
    return false;
  }
  switch (command.type) {
    case kDrive:
      drive(command, now_us);
      return false;
    case kSetCounters:
      set_counters(command);
      return false;
    case kStop:
      // A fault remains latched.
      if (state_.stage == Stage::kDriving) switch_off(Stage::kOff);
      break;
    case kClear:
      clear();
      break;
    case kBlink:
      blink_from_us_ = now_us;
      blink_us_ = command.duration_ms * UINT32_C(1000);
      break;
    default:
      break;
  }
  state_.echo = command.number;
  return command.type == kDescribe;
}

void Controller::drive(const Command& command, uint32_t now_us) noexcept {
  float amperes[kMotorsMax];
  bool zero = true;
  for (size_t i = 0; i < kMotorsMax; ++i) {
    const float wanted = command.amperes[i];
    amperes[i] = 0;
    if (wanted == 0) continue;  // saves arithmetic, which is slow without a floating-point unit
    const float most = i < config_.motors ? current_max_ : 0;
    // Written so that NaN is refused.
    if (!(wanted <= most * kRounding && wanted >= -most * kRounding)) {
      refuse();
      if (state_.stage == Stage::kDriving) fail(kBadCommand);
      return;
    }
    amperes[i] = wanted > most ? most : (wanted < -most ? -most : wanted);
    zero = false;
  }
  if (state_.stage == Stage::kFault) return;
  if (state_.stage == Stage::kOff) {
    if (!zero || causes_ != 0 || !ticked_) return;
    state_.stage = Stage::kDriving;
    outputs_.motors_on = true;
  }
  for (size_t i = 0; i < kMotorsMax; ++i) outputs_.amperes[i] = amperes[i];
  outputs_.fed_us = now_us;
  state_.echo = command.number;
}

void Controller::set_counters(const Command& command) noexcept {
  if (state_.stage == Stage::kDriving) {
    refuse();
    return;
  }
  for (size_t i = 0; i < kMotorsMax; ++i) {
    offset_[i] = difference(command.counters[i], inputs_.counts[i]);
    state_.counts[i] = command.counters[i];
  }
  state_.echo = command.number;
}

void Controller::clear() noexcept {
  switch_off(Stage::kOff);
  latched_ = static_cast<uint16_t>(latched_ & causes_);
  if (latched_ != 0) state_.stage = Stage::kFault;
}

void Controller::switch_off(Stage stage) noexcept {
  outputs_ = Outputs();
  state_.stage = stage;
}

void Controller::fail(uint16_t flags) noexcept {
  latched_ = static_cast<uint16_t>(latched_ | flags);
  switch_off(Stage::kFault);
}

bool Controller::over_speed(const Inputs& inputs) noexcept {
  bool over = false;
  int32_t* oldest = past_[newest_];
  for (size_t i = 0; i < config_.motors; ++i) {
    const uint32_t steps = magnitude(difference(inputs.counts[i], oldest[i]));
    if (filled_ == kWindow && config_.speed_max != 0 && steps > steps_max_[i]) over = true;
    oldest[i] = inputs.counts[i];
  }
  newest_ = static_cast<uint8_t>((newest_ + 1) % kWindow);
  if (filled_ < kWindow) ++filled_;
  return over;
}

void Controller::tick(const Inputs& inputs, uint32_t now_us) noexcept {
  const bool late = ticked_ && now_us - ticked_us_ > late_us_;
  ticked_ = true;
  ticked_us_ = now_us;
  inputs_ = inputs;
  state_.time_us = now_us;
  state_.buttons = inputs.buttons;
  state_.supply_mV = inputs.supply_mV;
  state_.temperature_dC = inputs.temperature_dC;
  for (size_t i = 0; i < kMotorsMax; ++i) {
    state_.counts[i] = sum(inputs.counts[i], offset_[i]);
    state_.gimbal[i] = inputs.gimbal[i];
  }

  causes_ = 0;
  if (over_speed(inputs)) causes_ |= kOverSpeed;
  if (inputs.temperature_dC > config_.temperature_max_dC) causes_ |= kOverTemperature;
  if (inputs.supply_mV != 0 && inputs.supply_mV < config_.supply_min_mV) causes_ |= kBrownOut;
  if (inputs.encoder_error) causes_ |= kEncoder;
  if (state_.stage == Stage::kDriving) {
    if (causes_ != 0) fail(causes_);
    // Another fault at the same time does not hide this one.
    if (late) fail(kLateLoop);
  }
  watch(now_us);
}

void Controller::watch(uint32_t now_us) noexcept {
  if (state_.stage != Stage::kDriving) return;
  // Signed: the caller may have taken the time before the last message arrived.
  const int32_t silent_us =
      difference(static_cast<int32_t>(now_us), static_cast<int32_t>(outputs_.fed_us));
  if (silent_us >= static_cast<int32_t>(watchdog_us_)) fail(kWatchdog);
}

void Controller::lose_link() noexcept {
  if (state_.stage == Stage::kDriving) fail(kLinkLost);
}

void Controller::loop_took(uint32_t duration_us) noexcept {
  const uint16_t us = duration_us < 65535 ? static_cast<uint16_t>(duration_us) : UINT16_C(65535);
  if (us > state_.loop_us) state_.loop_us = us;
}

void Controller::report(uint8_t* bytes) noexcept {
  state_.flags = flags();
  for (size_t i = 0; i < config_.motors; ++i) {
    const float amperes = outputs_.amperes[i];
    state_.current_mA[i] = amperes == 0 ? int16_t(0) : rounded_mA(amperes);
  }
  encode_state(state_, bytes);
  ++state_.number;
  state_.loop_us = 0;
}

void Controller::describe(uint8_t* bytes) const noexcept {
  encode_description(config_, notes_, bytes);
}

bool Controller::lamp(uint32_t now_us) noexcept {
  const uint32_t since_us = now_us - blink_from_us_;
  if (blink_us_ != 0 && since_us < blink_us_) {
    return since_us / UINT32_C(62500) % 2 == 0;  // 8 Hz [chosen: seen at once]
  }
  blink_us_ = 0;
  return state_.stage == Stage::kDriving;
}

}  // namespace firmware
}  // namespace thimble
