#include "web/steer_run.h"

#include <charconv>
#include <cstdint>
#include <string>

#include "share/turn_knob.h"

namespace thimble::web {
namespace {

driver::Result<void> ask(session::SharedReader& reader, std::string_view request) {
  const std::size_t space = request.find(' ');
  const std::string_view what = request.substr(0, space);
  const std::string_view rest =
      space == std::string_view::npos ? std::string_view{} : request.substr(space + 1);
  if (request == "pause" || request == "resume") {
    reader.ask_pause(request == "pause");
    return {};
  }
  if (request == "restart") return reader.ask_restart();
  if (what == "turn") return session::turn_knob(reader, std::string(rest));
  std::uint64_t ticks = 0;
  const auto number = std::from_chars(rest.data(), rest.data() + rest.size(), ticks);
  if (what == "step" && !rest.empty() && number.ec == std::errc{} &&
      number.ptr == rest.data() + rest.size()) {
    return reader.ask_steps(ticks);
  }
  return driver::Error{
      "Unknown command; expected pause, resume, restart, step N or turn KNOB=VALUE."};
}

}  // namespace

driver::Result<void> steer_run(session::SharedReader& reader, std::string_view request) {
  if (auto now = reader.check_accepted(); !now) return now;
  if (reader.state() == session::RunState::kEnded) return driver::Error{"The run has ended."};
  if (auto asked = ask(reader, request); !asked) return asked;
  return reader.check_accepted();
}

}  // namespace thimble::web
