#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <variant>

#include "thimble/driver/arm.h"
#include "thimble/driver/arm_model.h"
#include "thimble/driver/board.h"
#include "thimble/driver/export.h"

namespace thimble::driver {

// The table of arms: which languages and which builds there are. Everything else asks it: arm files
// for their names, discovery for the language of a board, scenes for the arm behind a wire.

/// A language of arms: one row.
struct ArmRow {
  ArmKind kind = ArmKind::kUnsupported;  ///< Which one.
  std::string_view protocol;             ///< Its name in arm files.
  std::array<BoardKind, 3> boards{};     ///< Boards that speak it, the usual one first.
  std::size_t board_count = 0;           ///< Of them.
  bool carries_gimbal = false;           ///< Its reports have room for the encoders of a gimbal.
  /// The installed arm file that it means by itself; empty if several arms speak it.
  std::string_view own_file;
  /// Makes the arm of a model that speaks it; null where the arm is behind a service or a library
  /// of its vendor, which is a link of its own.
  std::unique_ptr<const Arm> (*make)(const ArmModel& model) = nullptr;

  /// Returns whether its arms tell where their tip is and take forces, so that there is neither a
  /// wire nor a geometry of ours.
  constexpr bool has_own_link() const noexcept { return make == nullptr; }
};

/// A build of arms: one row.
struct ShapeRow {
  std::string_view name;  ///< In arm files.
  /// Returns the model, where that is code; null where the arm file has it.
  ArmModel (*built_in)() noexcept = nullptr;
};

/// Lists all languages. Real-time: never from the servo thread.
THIMBLE_EXPORT std::span<const ArmRow> arm_table() noexcept;

/// Returns the row of a kind, or null for kUnsupported. Real-time: never from the servo thread.
THIMBLE_EXPORT const ArmRow* row_of(ArmKind kind) noexcept;

/// Lists all builds, in the order of ArmGeometry. Real-time: never from the servo thread.
THIMBLE_EXPORT std::span<const ShapeRow, std::variant_size_v<ArmGeometry>> arm_shapes() noexcept;

/// Returns what a board speaks. Real-time: never from the servo thread.
ArmKind kind_of(BoardKind board) noexcept;

/// Makes the arm of a model that speaks a language; null if its link is its own
/// (ArmRow::has_own_link). Precondition: not kUnsupported. Real-time: never from the servo thread.
THIMBLE_EXPORT std::unique_ptr<const Arm> make_arm(ArmKind kind, const ArmModel& model);

/// Makes the arm of a model with ideal encoders, as a simulated board has them
/// (hfab::FineReportWire). Real-time: never from the servo thread.
THIMBLE_EXPORT std::unique_ptr<const Arm> make_ideal_arm(const ArmModel& model);

}  // namespace thimble::driver
