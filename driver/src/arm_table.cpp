#include "arm_table.h"

#include <algorithm>

#include "arms/falcon/falcon_arm.h"
#include "arms/hfab/hfab_models.h"
#include "arms/hfab/hfab_wire.h"
#include "arms/woody/woody_wire.h"
#include "thimble/driver/wire_arm.h"

namespace thimble::driver {
namespace {

template <class Wire>
std::unique_ptr<const Arm> make(const ArmModel& model) {
  return std::visit(
      [&]<class Geometry>(const Geometry& geometry) -> std::unique_ptr<const Arm> {
        return std::make_unique<WireArm<Wire, Geometry>>(
            JointModel<Geometry>{geometry, model.drives, model.encoders, model.gimbal});
      },
      model.geometry);
}

// One line per language. The text lines carry all that the 14-byte reports do.
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
};

// One line per build.
constexpr std::array<ShapeRow, std::variant_size_v<ArmGeometry>> kShapes{{
    {"serial", nullptr},
    {"polhem", []() noexcept { return arm_model(hfab::polhem_model()); }},
    {"falcon", []() noexcept { return arm_model(falcon::falcon_model()); }},
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
  // What speaks text lines is asked for its model, so its own row comes before that of an arm that
  // may also have such a board: the row whose usual board it is, else the first that has it.
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

std::unique_ptr<const Arm> make_arm(ArmKind kind, const ArmModel& model) {
  const ArmRow* row = row_of(kind);
  return row == nullptr ? nullptr : row->make(model);
}

std::unique_ptr<const Arm> make_ideal_arm(const ArmModel& model) {
  ArmModel fine = with_fine_counts(model);
  fine.gimbal.reset();
  return make<hfab::FineReportWire>(fine);
}

}  // namespace thimble::driver
