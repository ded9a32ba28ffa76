#include "arms/hfab/hfab_models.h"

#include <array>

#include "arms/hfab/hfab_wire.h"

namespace thimble::driver::hfab {
namespace {

template <class Geometry>
JointModel<Geometry> model_of(const Geometry& geometry, const std::array<double, 3>& signs,
                              const std::array<double, 3>& ratios,
                              const std::array<double, 3>& torque_constants, double current_max,
                              double counts_per_motor_turn,
                              const std::array<std::int32_t, 3>& home_counts) {
  JointModel<Geometry> model;
  model.geometry = geometry;
  for (std::size_t i = 0; i < 3; ++i) {
    model.drives[i] = {.sign = signs[i],
                       .ratio = ratios[i],
                       .torque_constant = torque_constants[i],
                       .current_max = current_max};
    model.encoders[i] = {.sign = signs[i],
                         .counts_per_motor_turn = counts_per_motor_turn,
                         .home_counts = home_counts[i]};
  }
  return model;
}

}  // namespace

JointModel<LinkageArm> polhem_model() noexcept {
  return model_of(LinkageArm{.length_0 = 0.034,
                             .length_1 = 0.165,
                             .length_2 = 0.025,
                             .length_3 = 0.190,
                             .length_4 = 0.034,
                             .length_5 = 0.1308},
                  {1, -1, 1}, {0.175 / 0.0288534, 0.100 / 0.0136981, 0.100 / 0.0137281},
                  {0.0603, 0.0538, 0.0538}, 3, 4096, {8312, -10366, 19764});
}

JointModel<SerialArm> vintage_model() noexcept {
  return model_of(SerialArm{.height = 0, .length_b = 0.138, .length_c = 0.112}, {-1, 1, -1},
                  {0.117 / 0.013, 7.7, 7.7}, {0.0234, 0.0234, 0.0234}, 3, 4000, {0, 7700, 0});
}

JointModel<SerialArm> woody_model(WoodyBoard board) noexcept {
  const double current_max = board == WoodyBoard::kMbed ? 3 : 6;
  auto model =
      model_of(SerialArm{.height = 0.080, .length_b = 0.205, .length_c = 0.245}, {1, -1, -1},
               {16, 12, 12}, {0.0259, 0.0259, 0.0259}, current_max, 2000, {0, 0, -6000});
  if (board == WoodyBoard::kMbed) model.encoders[0].sign = -1;
  return model;
}

std::unique_ptr<const Arm> make_line_arm(std::int32_t model_number) {
  switch (static_cast<LineModel>(model_number)) {
    case LineModel::kPolhem:
      return std::make_unique<WireArm<LineWire, LinkageArm>>(polhem_model());
    case LineModel::kVintage:
      return std::make_unique<WireArm<LineWire, SerialArm>>(vintage_model());
    case LineModel::kWoody:
      return std::make_unique<WireArm<LineWire, SerialArm>>(woody_model(WoodyBoard::kTextLines));
  }
  return nullptr;
}

}  // namespace thimble::driver::hfab
