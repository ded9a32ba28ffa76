#include "hand/button_plan.h"

#include <algorithm>
#include <sstream>

namespace thimble::scene {

driver::Result<ButtonPress> read_button_press(const std::string& text) {
  constexpr double kLatest = 86400;  // s, as in the file of a hand
  constexpr int kButtonMax = 16;
  constexpr double kClick = 0.2;  // s [chosen: a deliberate click; the shortest take 0.1 s]
  ButtonPress press{.begin = -1, .duration = kClick, .buttons = 1};
  std::istringstream fields(text);
  int button = 1;
  char colon = ':';
  fields >> press.begin;
  bool good = !fields.fail();
  if (good && fields >> colon) good = colon == ':' && !(fields >> button).fail();
  if (good && fields >> colon) good = colon == ':' && !(fields >> press.duration).fail();
  char rest = 0;
  good = good && !(fields >> rest) && press.begin >= 0 && press.begin <= kLatest && button >= 1 &&
         button <= kButtonMax && press.duration > 0 && press.duration <= kLatest;
  if (!good) {
    return driver::Error{
        "expected SECONDS, SECONDS:BUTTON or SECONDS:BUTTON:DURATION (0 to 86400 "
        "s, buttons 1 to 16), found \"" +
        text + "\"."};
  }
  press.buttons = static_cast<std::uint16_t>(1U << (button - 1));
  return press;
}

driver::Result<std::vector<ButtonPress>> read_button_presses(
    const std::string& option, const std::vector<std::string>& texts) {
  std::vector<ButtonPress> presses;
  for (const std::string& text : texts) {
    const auto press = read_button_press(text);
    if (!press) return driver::Error{option + ": " + press.error().message};
    presses.push_back(*press);
  }
  return presses;
}

std::vector<ButtonStep> steps_of(const std::vector<ButtonPress>& presses,
                                 const std::vector<ButtonStep>& held) {
  std::vector<double> times;
  for (const ButtonStep& step : held) times.push_back(step.time);
  for (const ButtonPress& press : presses) {
    times.push_back(press.begin);
    times.push_back(press.begin + press.duration);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::vector<ButtonStep> steps;
  ButtonPlan plan(held);
  for (const double time : times) {
    unsigned buttons = plan.at(time);
    for (const ButtonPress& press : presses) {
      if (time >= press.begin && time < press.begin + press.duration) buttons |= press.buttons;
    }
    steps.push_back({time, static_cast<std::uint16_t>(buttons)});
  }
  return steps;
}

}  // namespace thimble::scene
