#pragma once

#include <string>

#include "studies/accuracy/accuracy_axis.h"

namespace thimble::studies {

/// Returns the diagram of all contact methods from which `--quality auto` chooses. The knob is the
/// mesh's typical angle at an edge (quality_table.h of the scene). The error is the worst of force,
/// direction and jump, each relative to its threshold of perception. Real-time: never from the
/// servo thread.
AccuracyAxis contact_points_axis();

/// Measures every point of `--quality auto` and returns the text of the stored table, with the
/// version of the built-in one plus one. Takes about a minute. Real-time: never from the servo
/// thread.
std::string quality_table_text();

}  // namespace thimble::studies
