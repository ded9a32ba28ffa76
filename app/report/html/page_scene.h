#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "report/html/page.h"
#include "report/html/page_block.h"

namespace thimble::report {

// What a page tells of a touch, part by part: each gives its JSON and adds its numbers to `block`
// under the names that this tells. Real-time: never from the servo thread.

/// Returns the objects, with what is drawn of them.
nlohmann::ordered_json page_objects(const PageTouch& touch, PageBlock& block);

/// Returns where objects were that move, picture by picture; null if none does.
nlohmann::ordered_json page_bodies(const PageTouch& touch, PageBlock& block);

/// Returns how objects were dented, picture by picture; null if none was. Those that are drawn with
/// fewer triangles than they have are left out.
nlohmann::ordered_json page_dents(const PageTouch& touch, PageBlock& block);

/// Returns the mesh of an object as it is described (m).
render::TriangleMesh mesh_of(const session::SharedScene& scene,
                             const session::SharedScene::Object& object);

/// Returns whether all objects are drawn with all triangles that they have.
bool draws_all(const session::SharedScene& scene);

/// Adds the bars of an arm, about 60 times a second, under PREFIX + bar_t (s from `begin_ns`) and
/// bars; `lines` in `json` says how many points each line has. An arm of unknown build has none.
void add_bars(const session::SharedScene::Arm& arm, std::span<const driver::TickRecord> ticks,
              std::int64_t begin_ns, const std::string& prefix, nlohmann::ordered_json& json,
              PageBlock& block);

/// Returns something that happened, in s from `begin_ns` on the loop's clock.
nlohmann::ordered_json page_mark(const PageMark& mark, std::int64_t begin_ns);

/// Returns figures as the page shows them.
nlohmann::ordered_json page_figures(std::span<const Figure> figures);

/// Returns an arm: its ticks, its bars, what happened to it and its figures.
nlohmann::ordered_json page_arm(const PageTouch& touch, std::size_t arm, PageBlock& block);

}  // namespace thimble::report
