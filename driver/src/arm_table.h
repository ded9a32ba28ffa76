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

struct WireTable;

// The table of arms: all protocols and geometries. Arm files look up names here, discovery the
// protocol of a board, scenes the arm behind a wire.

/// A protocol: one row.
struct ArmRow {
  ArmKind kind = ArmKind::kUnsupported;  ///< Kind of arm.
  std::string_view protocol{};           ///< Name of the protocol in arm files.
  std::array<BoardKind, 3> boards{};     ///< Boards that use the protocol, the usual one first.
  std::size_t board_count = 0;           ///< Number of entries in `boards`.
  bool carries_gimbal = false;           ///< Reports have room for the encoders of a gimbal.
  /// The installed arm file that the protocol implies; empty if several arms use the protocol.
  std::string_view own_file{};
  /// Makes the arm of a model that uses the protocol. Null if the arm is behind a vendor's service
  /// or library and has its own link.
  std::unique_ptr<const Arm> (*make)(const ArmModel& model) = nullptr;

  /// Returns whether the arms report their tip pose and take forces. They then need neither a wire
  /// nor a geometry.
  constexpr bool has_own_link() const noexcept { return make == nullptr; }
};

/// An arm geometry: one row.
struct ShapeRow {
  std::string_view name;  ///< Name in arm files.
  /// Returns the model if it is code; null if the arm file holds it.
  ArmModel (*built_in)() noexcept = nullptr;
};

/// Lists all protocols. Real-time: never from the servo thread.
THIMBLE_EXPORT std::span<const ArmRow> arm_table() noexcept;

/// Returns the row of a kind, or null for kUnsupported. Real-time: never from the servo thread.
THIMBLE_EXPORT const ArmRow* row_of(ArmKind kind) noexcept;

/// Lists all geometries, in the order of ArmGeometry. Real-time: never from the servo thread.
THIMBLE_EXPORT std::span<const ShapeRow, std::variant_size_v<ArmGeometry>> arm_shapes() noexcept;

/// Returns the protocol of a board. Real-time: never from the servo thread.
ArmKind kind_of(BoardKind board) noexcept;

/// Makes the arm of a model with the given protocol; null if the arm has its own link
/// (ArmRow::has_own_link). Precondition: not kUnsupported. `wire`: the tables of an arm of the kind
/// kDescribed, of which the arm keeps a copy. Real-time: never from the servo thread.
THIMBLE_EXPORT std::unique_ptr<const Arm> make_arm(ArmKind kind, const ArmModel& model,
                                                   const WireTable* wire = nullptr);

/// Makes the arm of a model with ideal encoders, as on a simulated board (hfab::FineReportWire).
/// Real-time: never from the servo thread.
THIMBLE_EXPORT std::unique_ptr<const Arm> make_ideal_arm(const ArmModel& model);

}  // namespace thimble::driver
