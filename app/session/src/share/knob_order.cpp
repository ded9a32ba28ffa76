#include "share/knob_order.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace thimble::session {

driver::Result<void> turn_knob(SharedReader& reader, const std::string& order) {
  const std::size_t equals = order.rfind('=');
  const std::string name = order.substr(0, equals);
  char* end = nullptr;
  const char* text = equals == std::string::npos ? "" : order.c_str() + equals + 1;
  const double value = std::strtod(text, &end);
  if (end == text || *end != 0 || !std::isfinite(value)) {
    return driver::Error{"--turn: expected NAME=VALUE, found \"" + order + "\"."};
  }
  std::string known;
  for (std::size_t i = 0; i < reader.scene().knobs.size(); ++i) {
    const SharedScene::Knob& knob = reader.scene().knobs[i];
    if (knob.name == name) {
      if (value < knob.least || value > knob.most) {
        return driver::Error{
            fmt::format("--turn: {} may be {:g} to {:g} {}, found {:g}; nothing was "
                        "turned.",
                        name, knob.least, knob.most, knob.unit, value)};
      }
      reader.turn_knob(i, value);
      return {};
    }
    known += "\n    " + knob.name;
  }
  return driver::Error{"--turn: the run has no knob \"" + name + "\"" +
                       (known.empty() ? "." : "; it has" + known)};
}

}  // namespace thimble::session
