#include "run_law.h"

#include "thimble/driver/tick_record.h"

namespace thimble::session {

driver::ForceLaw RunLaw::law() noexcept {
  objects_only_ = !caller_ && scene_.bare();
  if (device_ != nullptr || carries_) return driver::ForceLaw(*this);
  return caller_ ? *caller_ : scene_.law();
}

// Flattened, because nearly every tick only calls the objects, which are inlined here.
[[gnu::flatten]] driver::ForceCommand RunLaw::operator()(
    const driver::DeviceState& state) noexcept {
  driver::ForceCommand command = in_fault()      ? no_force(state)
                                 : objects_only_ ? scene_.objects()(state)
                                                 : changed_force(state);
  if (carries_) carried_.add_to(command, state);
  return command;
}

/// Returns the force of the caller, or of the scene with its knobs and its pause.
driver::ForceCommand RunLaw::changed_force(const driver::DeviceState& state) noexcept {
  return caller_ ? (*caller_)(state) : scene_(state);
}

/// Returns no force, for an arm in fault. Requests are still processed, because its pause applies
/// to the other arms too.
driver::ForceCommand RunLaw::no_force(const driver::DeviceState& state) noexcept {
  scene_.take_requests(state);
  return {};
}

void RunLaw::prepare(const driver::DeviceState& expected) const noexcept {
  if (caller_) {
    caller_->prepare(expected);
  } else {
    scene_.prepare(expected);
  }
}

const LawChange* RunLaw::change() const noexcept {
  static constexpr LawChange kOtherLaw{
      .setting = driver::TickRecord::kOtherLaw, .value = 0, .gain = 1};
  return caller_ ? &kOtherLaw : scene_.change();
}

}  // namespace thimble::session
