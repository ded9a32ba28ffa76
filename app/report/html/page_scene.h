#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "report/html/page.h"
#include "report/html/page_block.h"

namespace thimble::report {

// The content of a page, part by part: each function returns its JSON and adds its numbers to
// `block` under the names in the JSON. Real-time: never from the servo thread.

/// Returns the objects and their drawn meshes.
nlohmann::ordered_json page_objects(const PageTouch& touch, PageBlock& block);

/// Returns the poses of moving objects for each picture; null if none moves.
nlohmann::ordered_json page_bodies(const PageTouch& touch, PageBlock& block);

/// Returns the dents of objects for each picture; null if there were none. Objects that are drawn
/// with fewer triangles are omitted.
nlohmann::ordered_json page_dents(const PageTouch& touch, PageBlock& block);

/// Returns the mesh of an object in the description of the scene (m).
render::TriangleMesh mesh_of(const session::SharedScene& scene,
                             const session::SharedScene::Object& object);

/// Returns whether all objects are drawn with all their triangles.
bool draws_all(const session::SharedScene& scene);

/// Adds the bars of an arm, about 60 times a second, under PREFIX + bar_t (s from `begin_ns`) and
/// bars; `lines` in `json` contains the number of points of each line. An arm of unknown geometry
/// has none.
void add_bars(const session::SharedScene::Arm& arm, std::span<const driver::TickRecord> ticks,
              std::int64_t begin_ns, const std::string& prefix, nlohmann::ordered_json& json,
              PageBlock& block);

/// Returns an event, in s from `begin_ns` on the loop's clock.
nlohmann::ordered_json page_mark(const PageMark& mark, std::int64_t begin_ns);

/// Returns figures in the page's format.
nlohmann::ordered_json page_figures(std::span<const Figure> figures);

/// Returns an arm: its ticks, its bars, its events and its figures.
nlohmann::ordered_json page_arm(const PageTouch& touch, std::size_t arm, PageBlock& block);

}  // namespace thimble::report
