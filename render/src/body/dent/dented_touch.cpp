#include "body/dent/dented_touch.h"

#include "mesh/triangle_place.h"

namespace thimble::render {

driver::ForceCommand DentedTouch::update(const driver::DeviceState& state) noexcept {
  driver::ForceCommand command = inner_->update(state);
  if (!follow(state, command)) rest();
  return command;
}

void DentedTouch::rest() noexcept {
  if (dent_.triangle() >= 0) pull_.leave();
  dent_.rest();
}

bool DentedTouch::follow(const driver::DeviceState& state, driver::ForceCommand& command) noexcept {
  const std::int32_t triangle = command.touch.feature;
  if (!command.touch.in_contact || triangle < 0) return false;
  // Weights vanish on the planes between triangles, so that the place does not jump there. A
  // tracker with other cells may be slightly beyond one.
  const TrianglePlace closest = edge_plane_place(dent_.mesh(), triangle, state.p_WT);
  dent_.touch(triangle, closest.weights, state.p_WT);
  if (dent_.motion().settings().pull > 0) {
    command.f_T_W += pull_.force(dent_.pull_at_tip(closest.change), state.p_WT, state.v_WT,
                                 command.touch.n_W, command.touch.depth);
  }
  return true;
}

}  // namespace thimble::render
