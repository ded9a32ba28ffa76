#pragma once

#include <string>

#include "studies/accuracy/accuracy_axis.h"

namespace thimble::studies {

/// Returns the diagram of all ways to touch a mesh that `--quality auto` chooses among: the knob is
/// the mesh's typical turn over an edge (scene's quality_table.h), the error the worst of force,
/// direction and jump, each over what can be felt of it. Real-time: never from the servo thread.
AccuracyAxis contact_points_axis();

/// Measures every point of `--quality auto` and returns the text of the stored table, one version
/// after the one that is built in. Takes about a minute. Real-time: never from the servo thread.
std::string quality_table_text();

}  // namespace thimble::studies
