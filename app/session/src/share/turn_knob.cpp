#include "share/turn_knob.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace thimble::session {

driver::Result<std::size_t> find_knob(const std::vector<SharedScene::Knob>& knobs,
                                      const std::string& name, double value) {
  std::string known;
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    const SharedScene::Knob& knob = knobs[i];
    if (knob.name == name) {
      // Written so that NaN is rejected.
      if (value >= knob.min && value <= knob.max) return i;
      return driver::Error{
          fmt::format("{} must be {:g} to {:g} {}, found {:g}; the knob is unchanged.", name,
                      knob.min, knob.max, knob.unit, value)};
    }
    known += "\n    " + knob.name;
  }
  return driver::Error{"the run has no knob \"" + name + "\"" +
                       (known.empty() ? "." : "; its knobs are" + known)};
}

driver::Result<void> turn_knob(SharedReader& reader, const std::string& order) {
  const std::size_t equals = order.rfind('=');
  const std::string name = order.substr(0, equals);
  char* end = nullptr;
  const char* text = equals == std::string::npos ? "" : order.c_str() + equals + 1;
  const double value = std::strtod(text, &end);
  if (end == text || *end != 0 || !std::isfinite(value)) {
    return driver::Error{"--turn: expected NAME=VALUE, found \"" + order + "\"."};
  }
  const auto knob = find_knob(reader.scene().knobs, name, value);
  if (!knob) return driver::Error{"--turn: " + knob.error().message};
  reader.turn_knob(*knob, value);
  return {};
}

}  // namespace thimble::session
