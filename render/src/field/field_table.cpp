#include "thimble/render/field/field_table.h"

#include <array>

#include "field/gravity.h"
#include "field/magnetic_snap.h"
#include "field/point_charges.h"
#include "field/viscous.h"

namespace thimble::render {
namespace {

constexpr std::array kFields{
    field_kind<PointCharges>(),
    field_kind<Gravity>(),
    field_kind<Viscous>(),
    field_kind<MagneticSnap>(),
};

}  // namespace

std::span<const FieldKind> field_table() {
  return kFields;
}

}  // namespace thimble::render
