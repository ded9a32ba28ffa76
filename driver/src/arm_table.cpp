#include "arm_table.h"

#include <algorithm>
#include <numbers>
#include <type_traits>

#include "arms/falcon/falcon_arm.h"
#include "arms/hfab/hfab_models.h"
#include "arms/hfab/hfab_wire.h"
#include "arms/woody/woody_wire.h"
#include "thimble/driver/wire_arm.h"
#include "wires/described_arm.h"

namespace thimble::driver {
namespace {

template <class Wire>
std::unique_ptr<const Arm> make(const ArmModel& model) {
  return std::visit(
      [&]<class Geometry>(const Geometry& geometry) -> std::unique_ptr<const Arm> {
        if constexpr (std::is_same_v<Geometry, VendorPoseArm>) {
          return nullptr;  // no wire has it
        } else {
          return std::make_unique<WireArm<Wire, Geometry>>(
              JointModel<Geometry>{geometry, model.drives, model.encoders, model.gimbal});
        }
      },
      model.geometry);
}

/// Makes the arm of a model that uses a described wire.
std::unique_ptr<const Arm> make_described(const ArmModel& model, const WireTable& wire) {
  return std::visit(
      [&]<class Geometry>(const Geometry& geometry) -> std::unique_ptr<const Arm> {
        if constexpr (std::is_same_v<Geometry, VendorPoseArm>) {
          return nullptr;  // no wire has it
        } else {
          return std::make_unique<DescribedArm<Geometry>>(
              wire, JointModel<Geometry>{geometry, model.drives, model.encoders, model.gimbal});
        }
      },
      model.geometry);
}

/// Returns the model of an arm that reports its tip position: a motor of 1 N/A and an encoder along
/// each axis of the base. The encoder step represents the resolution of such an arm, which the
/// vendors do not state: 0.02 mm, as for arms with known steps [DEVICES 2].
ArmModel vendor_pose_model() noexcept {
  ArmModel model;
  model.geometry = VendorPoseArm{};
  model.drives.fill({.sign = 1, .ratio = 1, .torque_constant = 1, .current_max = 1});
  model.encoders.fill(
      {.sign = 1, .counts_per_motor_turn = 2 * std::numbers::pi / 2e-5, .home_counts = 0});
  return model;
}

// One line per protocol. The text lines carry all data of the 14-byte reports.
constexpr std::array kArms{
    ArmRow{ArmKind::kPolhem,
           "hfab_14_byte",
           {BoardKind::kMbedHid14, BoardKind::kTeensyRawHid64, BoardKind::kTextLines},
           3,
           true,
           "",
           &make<hfab::ReportWire>},
    ArmRow{ArmKind::kWoody,
           "woody_8_byte",
           {BoardKind::kMbedHid8},
           1,
           false,
           "woodenhaptics",
           &make<woody::ReportWire>},
    ArmRow{ArmKind::kFalcon,
           "falcon_packet",
           {BoardKind::kFalconFtdi},
           1,
           false,
           "falcon",
           &make<falcon::PacketWire>},
    ArmRow{ArmKind::kHfabLine,
           "text_lines",
           {BoardKind::kTextLines},
           1,
           true,
           "",
           &make<hfab::LineWire>},
    ArmRow{ArmKind::kHaply, "haply_service", {BoardKind::kHaplyService}, 1, false, "inverse3"},
    ArmRow{ArmKind::kDhd, "dhd_library", {BoardKind::kDhdLibrary}, 1, false, ""},
    ArmRow{ArmKind::kHd, "hd_library", {BoardKind::kHdLibrary}, 1, false, ""},
};

// One line per geometry.
constexpr std::array<ShapeRow, std::variant_size_v<ArmGeometry>> kShapes{{
    {"serial", nullptr},
    {"polhem", []() noexcept { return arm_model(hfab::polhem_model()); }},
    {"falcon", []() noexcept { return arm_model(falcon::falcon_model()); }},
    {"told", vendor_pose_model},
    {"paddle", nullptr},
    {"five_bar", nullptr},
    {"cartesian", nullptr},
}};

}  // namespace

std::span<const ArmRow> arm_table() noexcept {
  return kArms;
}

const ArmRow* row_of(ArmKind kind) noexcept {
  const auto row =
      std::find_if(kArms.begin(), kArms.end(), [&](const ArmRow& r) { return r.kind == kind; });
  return row == kArms.end() ? nullptr : &*row;
}

std::span<const ShapeRow, std::variant_size_v<ArmGeometry>> arm_shapes() noexcept {
  return kShapes;
}

ArmKind kind_of(BoardKind board) noexcept {
  // Select the row whose usual board it is, else the first that has it. A board with text lines
  // reports its model when asked, so the row of that protocol is preferred to that of an arm that
  // may also have such a board.
  const ArmRow* any = nullptr;
  for (const ArmRow& row : kArms) {
    const std::span<const BoardKind> boards(row.boards.data(), row.board_count);
    if (boards.front() == board) return row.kind;
    if (any == nullptr && std::find(boards.begin(), boards.end(), board) != boards.end()) {
      any = &row;
    }
  }
  return any == nullptr ? ArmKind::kUnsupported : any->kind;
}

std::unique_ptr<const Arm> make_arm(ArmKind kind, const ArmModel& model, const WireTable* wire) {
  if (kind == ArmKind::kDescribed) {
    return wire == nullptr ? nullptr : make_described(model, *wire);
  }
  const ArmRow* row = row_of(kind);
  return row == nullptr || row->has_own_link() ? nullptr : row->make(model);
}

std::unique_ptr<const Arm> make_ideal_arm(const ArmModel& model) {
  ArmModel fine = with_fine_counts(model);
  fine.gimbal.reset();
  return make<hfab::FineReportWire>(fine);
}

}  // namespace thimble::driver
