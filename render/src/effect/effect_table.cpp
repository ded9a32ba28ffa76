#include "thimble/render/effect/effect_table.h"

#include <array>

#include "thimble/render/surface/friction/bristle.h"
#include "thimble/render/surface/friction/dahl.h"
#include "thimble/render/surface/friction/implicit_coulomb.h"
#include "thimble/render/surface/friction/karnopp.h"
#include "thimble/render/surface/friction/lugre.h"
#include "thimble/render/surface/friction/naive.h"
#include "thimble/render/surface/friction/paper.h"
#include "thimble/render/surface/friction/stiction_point.h"

namespace thimble::render {
namespace {

constexpr std::array kEffects{
    effect_kind<BristleFriction>(),         effect_kind<DahlFriction>(),
    effect_kind<ImplicitCoulombFriction>(), effect_kind<KarnoppFriction>(),
    effect_kind<LugreFriction>(),           effect_kind<NaiveFriction>(),
    effect_kind<PaperFriction>(),           effect_kind<StictionPointFriction>(),
};

}  // namespace

std::span<const EffectKind> effect_table() {
  return kEffects;
}

}  // namespace thimble::render
