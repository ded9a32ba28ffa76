#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace thimble::render {

/// Returns the metres per unit of a word of 3MF or AMF; empty for one that they do not know.
/// Real-time: never from the servo thread.
std::optional<double> unit_of_word(std::string_view unit);

/// Returns the metres per unit that the text of a 3MF or AMF model names in its root element
/// (`<model unit="inch">`), mm if it names none, as both formats say; empty for a word that they do
/// not know. `element` is "model" or "amf". Real-time: never from the servo thread.
std::optional<double> unit_of_model(std::string_view text, std::string_view element);

/// Returns the axis that a DAE file's text says is up: x, y or z; y if it says nothing.
/// Real-time: never from the servo thread.
char up_axis_of_dae(std::string_view text);

}  // namespace thimble::render
