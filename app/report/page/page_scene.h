#pragma once

#include <nlohmann/json.hpp>

#include "report/page/page.h"
#include "report/page/page_block.h"

namespace thimble::app {

// What a page tells of a touch, part by part: each gives its JSON and adds its numbers to `block`
// under the names that this tells. Real-time: never from the servo thread.

/// Returns the objects, with what is drawn of them.
nlohmann::ordered_json page_objects(const PageTouch& touch, PageBlock& block);

/// Returns where objects were that move, picture by picture; null if none does.
nlohmann::ordered_json page_bodies(const PageTouch& touch, PageBlock& block);

/// Returns how objects were dented, picture by picture; null if none was. Those that are drawn with
/// fewer triangles than they have are left out.
nlohmann::ordered_json page_dents(const PageTouch& touch, PageBlock& block);

/// Returns an arm: its ticks, its bars, what happened to it and its figures.
nlohmann::ordered_json page_arm(const PageTouch& touch, std::size_t arm, PageBlock& block);

}  // namespace thimble::app
