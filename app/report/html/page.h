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

/// One arm of a touch on a page.
struct PageArm {
  std::span<const driver::TickRecord> ticks;  ///< Oldest first; must outlive the writing.
  /// The time since the previous tick of each, ns, if ticks between them were omitted; otherwise
  /// empty.
  std::span<const std::int64_t> periods_ns{};
  double force_limit = 0;       ///< N; 0: unknown.
  std::vector<PageMark> marks;  ///< Events.
  std::vector<Figure> figures;  ///< Summary.
};

/// The final mesh of an object with a permanent deformation; in the object's first pose (B, m).
struct PageShape {
  std::size_t object = 0;     ///< Index in the scene, from 0.
  render::TriangleMesh mesh;  ///< In the frame of the object's own mesh, m.
};

/// A touch that a page plays.
struct PageTouch {
  std::string title;         ///< Title at the top of the page.
  std::string subtitle;      ///< Subtitle; may be empty.
  std::string program;       ///< Version of Thimble that computed it.
  double rate = 0;           ///< Rate of the loop, Hz.
  bool virtual_time = true;  ///< Virtual time: periods are exact, and computing times are zero.
  /// A replay: forces sent are recorded ones, forces requested are the current result of the scene.
  bool replayed = false;
  session::SharedScene scene{};  ///< Objects, their meshes (W, m), and the arms for drawing.
  std::vector<PageArm> arms{};   ///< One for each arm of the scene, in its order.
  const session::BodyTrace* bodies = nullptr;  ///< Poses of moving objects; null if none moves.
  const session::DentTrace* dents = nullptr;   ///< Dents of objects; null if none can be dented.
  std::vector<ShapeStep> shapes{};  ///< Steps of the permanent deformation, s from the first tick.
  std::vector<PageShape> left{};    ///< Final meshes of the deformed objects.
};

/// Maximum number of ticks of all arms on a page: 60 s at 1 kHz. [chosen: below 10 MB with
/// everything else]
inline constexpr std::size_t kPageRowsMax = 60'001;
/// Maximum number of triangles of all objects on a page. [chosen: 2.5 MB]
inline constexpr std::size_t kPageTrianglesMax = 120'000;

/// The server of a live page, for its updates and its requests to the run.
struct PageSource {
  std::uint16_t port = 0;       ///< On this computer (127.0.0.1), for WebSocket and HTTP.
  std::size_t rows = 0;         ///< Maximum number of ticks of all arms that the page keeps.
  std::string run = {};         ///< Identifies the run among others of the same name.
  std::string no_restart = {};  ///< Why the run cannot restart; empty: it can.
  std::string no_step = {};     ///< Why the run cannot single-step; empty: it can.
};

/// Returns a page that plays a touch in a browser as text: one file without external resources.
/// With `source` it begins with the content of `touch`, gets updates from that source, and contacts
/// no other server. The error says what is missing on this system. Real-time: never from the servo
/// thread.
driver::Result<std::string> page_text(const PageTouch& touch, const PageSource* source = nullptr);

/// Writes a page that plays a touch in a browser: one file without external resources. The error
/// says what is missing on this system, or which file cannot be written. Real-time: never from the
/// servo thread.
driver::Result<void> write_page(const PageTouch& touch, const std::filesystem::path& file);

}  // namespace thimble::report
