#include "thimble/render/effect/effect_table.h"

#include <array>

namespace thimble::render {
namespace {

constexpr std::array<EffectKind, 0> kEffects{};

}  // namespace

std::span<const EffectKind> effect_table() { return kEffects; }

}  // namespace thimble::render
