#pragma once

#include <string>

#include "wires/wire_table.h"

namespace thimble::bringup {

/// Draws the layout of the messages of one direction: rows of eight bytes with the names of the
/// fields, or the pattern of a text. Real-time: never from the servo thread.
std::string picture_of(const driver::WireLayout& layout, const std::string& title);

/// Lists the fields of a message with their values; `frame` must be valid or have error flags.
/// Real-time: never from the servo thread.
std::string values_of(const driver::WireLayout& layout, const driver::WireLayoutText& text,
                      std::span<const std::byte> frame);

}  // namespace thimble::bringup
