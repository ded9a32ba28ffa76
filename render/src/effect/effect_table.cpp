#include "thimble/render/effect/effect_table.h"

#include <array>
#include <cstddef>

#include "surface/contact_transient.h"
#include "surface/friction/baseline/naive.h"
#include "surface/friction/bristle.h"
#include "surface/friction/dahl.h"
#include "surface/friction/implicit_coulomb.h"
#include "surface/friction/karnopp.h"
#include "surface/friction/lugre.h"
#include "surface/friction/paper.h"
#include "surface/friction/stiction_point.h"
#include "surface/law/formula_law.h"
#include "surface/texture/height_map.h"
#include "surface/texture/sandpaper.h"
#include "surface/texture/sines.h"

namespace thimble::render {
namespace {

// A program may be built with only one effect ("": with none), to verify that unused effects cost a
// scene nothing (tests/arch).
constexpr bool kept([[maybe_unused]] std::string_view name) {
#ifdef THIMBLE_ONLY_EFFECT
  constexpr std::string_view only = THIMBLE_ONLY_EFFECT;
  return name == only;
#else
  return true;
#endif
}

template <SurfaceStage... Stages>
constexpr auto kinds_of() {
  std::array<EffectKind, (std::size_t{kept(Stages::kName)} + ...)> kinds{};
  [[maybe_unused]] std::size_t i = 0;
  (
      [&] {
        if constexpr (kept(Stages::kName)) kinds[i++] = effect_kind<Stages>();
      }(),
      ...);
  return kinds;
}

constexpr auto kEffects = kinds_of<  //
    BristleFriction,                 //
    DahlFriction,                    //
    ImplicitCoulombFriction,         //
    KarnoppFriction,                 //
    LugreFriction,                   //
    NaiveFriction,                   //
    PaperFriction,                   //
    StictionPointFriction,           //
    Sines,                           //
    Sandpaper,                       //
    HeightMap,                       //
    ContactTransient,                //
    FormulaLaw                       //
    >();

}  // namespace

std::span<const EffectKind> effect_table() {
  return kEffects;
}

}  // namespace thimble::render
