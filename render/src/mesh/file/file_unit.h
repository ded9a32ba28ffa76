#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace thimble::render {

/// Returns the metres per unit of a unit word of 3MF or AMF; empty for an unknown word. Real-time:
/// never from the servo thread.
std::optional<double> unit_of_word(std::string_view unit);

/// Returns the metres per unit named in the root element of the text of a 3MF or AMF model (`<model
/// unit="inch">`); mm if it names none, as both formats specify; empty for an unknown word.
/// `element` is "model" or "amf". Real-time: never from the servo thread.
std::optional<double> unit_of_model(std::string_view text, std::string_view element);

/// Returns the up axis of a DAE file's text: x, y or z; y if none is given. Real-time: never from
/// the servo thread.
char up_axis_of_dae(std::string_view text);

}  // namespace thimble::render
