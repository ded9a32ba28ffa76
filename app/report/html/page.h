#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "observers/body_trace.h"
#include "observers/dent_trace.h"
#include "report/figure_output.h"
#include "report/html/page_marks.h"
#include "report/html/shape_steps.h"
#include "share/shared_scene.h"
#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::report {

/// One arm of a touch that a page plays.
struct PageArm {
  std::span<const driver::TickRecord> ticks;  ///< Oldest first; must outlive the writing.
  /// The time since the tick before of each, ns, if ticks are missing between them; else empty.
  std::span<const std::int64_t> periods_ns{};
  double force_limit = 0;       ///< N; 0: not known.
  std::vector<PageMark> marks;  ///< What happened.
  std::vector<Figure> figures;  ///< What it sums up to.
};

/// The mesh of an object that was shaped for good, as it was left; where the object was at first
/// (B, m).
struct PageShape {
  std::size_t object = 0;     ///< Of the scene, counted from 0.
  render::TriangleMesh mesh;  ///< In the frame of the object's own mesh, m.
};

/// A touch that a page plays.
struct PageTouch {
  std::string title;         ///< In the page's head.
  std::string subtitle;      ///< Under it; may be empty.
  std::string program;       ///< Which build felt it.
  double rate = 0;           ///< Of the loop, Hz.
  bool virtual_time = true;  ///< Its ticks came as asked, and took no time.
  /// The forces sent were felt before, those asked for are what the scene answers now.
  bool replayed = false;
  session::SharedScene scene{};  ///< Objects, their meshes (W, m), and the arms as they are drawn.
  std::vector<PageArm> arms{};   ///< As many as the scene has, in its order.
  const session::BodyTrace* bodies = nullptr;  ///< Where objects were that move; null if none does.
  const session::DentTrace* dents = nullptr;   ///< How objects were dented; null if none can be.
  std::vector<ShapeStep> shapes{};  ///< How objects came to that, in s from the first tick.
  std::vector<PageShape> left{};    ///< What objects were shaped to.
};

/// Ticks of all arms that a page shows: 60 s at 1 kHz. [chosen: below 10 MB with all else]
inline constexpr std::size_t kPageRowsMost = 60'001;
/// Triangles of all objects that a page draws. [chosen: 2.5 MB]
inline constexpr std::size_t kPageTrianglesMost = 120'000;

/// Where a page that is live gets its ticks from, and asks what of the run.
struct PageSource {
  std::uint16_t port = 0;       ///< Of this computer (127.0.0.1), WebSocket and HTTP.
  std::size_t rows = 0;         ///< Ticks of all arms that it keeps.
  std::string run = {};         ///< Which run it is; another run of the same name has another.
  std::string no_restart = {};  ///< Why the run cannot be begun anew; empty: it can.
  std::string no_step = {};     ///< Why it cannot go on by single ticks; empty: it can.
};

/// Returns a page that plays a touch in a browser as text: one file, which loads nothing. With
/// `source` it begins with what `touch` has, is led on from there, and asks nobody else. The error
/// says what is missing on this system. Real-time: never from the servo thread.
driver::Result<std::string> page_text(const PageTouch& touch, const PageSource* source = nullptr);

/// Writes a page that plays a touch in a browser: one file, which loads nothing. The error says
/// what is missing on this system, or which file cannot be written. Real-time: never from the servo
/// thread.
driver::Result<void> write_page(const PageTouch& touch, const std::filesystem::path& file);

}  // namespace thimble::report
