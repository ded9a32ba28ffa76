#include "events/event_words.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>

#include "wall_side.h"

namespace thimble::session {
namespace {

using spdlog::level::level_enum;

struct ActivityWords {
  level_enum level;
  const char* began;
  const char* happened;  // Past tense; a count follows ("3 times").
};

// In the order of Activity.
constexpr std::array<ActivityWords, kActivities> kWords{{
    {spdlog::level::debug, "The soft start limits the force.", "The soft start limited the force"},
    {spdlog::level::info, "The force is limited to the arm's maximum.",
     "The force was limited to the arm's maximum"},
    {spdlog::level::debug, "The rise of the force is limited.",
     "The rise of the force was limited"},
    {spdlog::level::info, "The gate's energy stage adds damping.",
     "The gate's energy stage added damping"},
    {spdlog::level::info, "The gate's energy bound limits the force.",
     "The gate's energy bound limited the force"},
    {spdlog::level::warn, "The force is reduced because a motor is hot: press less hard or rest.",
     "The force was reduced because of a hot motor"},
    {spdlog::level::warn,
     "The loop was blocked, so the force restarts softly: close other programs, or run thimble "
     "doctor.",
     "The loop was blocked"},
    {spdlog::level::debug, "Ticks are missed.", "Ticks were missed"},
    {spdlog::level::warn, "Invalid reports arrive: check the arm's cable.",
     "Invalid reports arrived"},
    {spdlog::level::warn, "A report was dropped because of an impossible jump: check the encoders.",
     "Reports were dropped because of a jump"},
    {spdlog::level::warn, "The arm accepts no messages: check its cable and power.",
     "Messages were not accepted"},
    {spdlog::level::warn, "The force is reduced: its mean power is at the gate's limit.",
     "The force was reduced because of its mean power"},
    {spdlog::level::warn,
     "The program's force oscillates and grows, so it is reduced: its spring or damper is too "
     "stiff for this arm and loop.",
     "The program's force was reduced after an oscillation"},
    {spdlog::level::warn, "A wall of the workspace pushes the tip back.",
     "A wall of the workspace pushed"},
}};

/// Returns the name of a stage, with its key in the files or the remedy.
const char* stage_words(Activity activity) noexcept {
  switch (activity) {
    case Activity::kSoftStart:
      return "The soft start (soft_start in the arm file; after a stall: reopen)";
    case Activity::kForceCut:
      return "The force limit (force_max in the arm file)";
    case Activity::kRiseCut:
      return "The rise limit (rise_max in the arm file)";
    case Activity::kDamped:
      return "The energy stage (energy: passivity; the arm gave more energy than was stored)";
    case Activity::kBounded:
      return "The energy bound (energy: bounding in the arm file or scene)";
    case Activity::kHeat:
      return "The heat guard (a motor is hot: press less hard or rest)";
    case Activity::kPower:
      return "The power limit (power_max in the arm file)";
    case Activity::kCalmed:
      return "The oscillation guard (the program's spring or damper is too stiff)";
    case Activity::kWall:
      return "The workspace wall (workspace in the arm file)";
    default:
      break;
  }
  return "A stage of the gate";
}

const ActivityWords& words_for(Activity activity) noexcept {
  return kWords[static_cast<std::size_t>(activity)];
}

/// Returns the message for a workspace wall: that it pushes, or how often and how strongly it
/// pushed.
std::string wall_sentence(const TickEvent& event) {
  const Eigen::Vector3d f_W(event.f_wall_W.data());
  if (event.kind == EventKind::kActivityBegan) {
    return fmt::format("The {} wall of the workspace pushes the tip back.", wall_side(f_W));
  }
  return fmt::format(
      "The walls of the workspace pushed in {} tick{} within {:.3f} s, with {:.2f} N at most ({} "
      "wall).",
      event.count, event.count == 1 ? "" : "s", 1e-9 * static_cast<double>(event.lasted_ns),
      f_W.norm(), wall_side(f_W));
}

std::string sentence(const TickEvent& event, std::span<const std::string> objects) {
  switch (event.kind) {
    case EventKind::kActivated:
      return "Forces are enabled.";
    case EventKind::kDeactivated:
      return "Forces are off.";
    case EventKind::kWaiting:
      return "The enabling input is not held: no force.";
    case EventKind::kFault:
      return fmt::format("Force is off ({}). {}", name(event.fault), describe(event.fault));
    case EventKind::kLinkReplaced:
      return "A new link to the arm is used; its force stays off until the user enables it.";
    case EventKind::kActivityBegan:
      if (event.activity == Activity::kWall) return wall_sentence(event);
      return words_for(event.activity).began;
    case EventKind::kActivityEnded:
      if (event.activity == Activity::kWall) return wall_sentence(event);
      return fmt::format("{} {} time{} within {:.3f} s.", words_for(event.activity).happened,
                         event.count, event.count == 1 ? "" : "s",
                         1e-9 * static_cast<double>(event.lasted_ns));
    case EventKind::kTouchBegan: {
      const auto object = static_cast<std::size_t>(event.object);
      return event.object >= 0 && object < objects.size()
                 ? fmt::format("The tip touches {}.", objects[object])
                 : "The tip touches an object.";
    }
    case EventKind::kTouchEnded:
      return "The tip is free.";
    case EventKind::kForceChanged:
      return fmt::format("{} has changed the force for 0.2 s, now by {} %.",
                         stage_words(event.activity), event.count);
    case EventKind::kLinkChanged:
      switch (event.link) {
        case driver::LinkState::kConnected:
          return "The arm reports again.";
        case driver::LinkState::kSilent:
          return "The arm is silent: check its cable and power.";
        case driver::LinkState::kLost:
          return "The arm was disconnected: plug it in again.";
      }
      break;
  }
  return "Unknown event.";
}

}  // namespace

level_enum level_of(const TickEvent& event) noexcept {
  switch (event.kind) {
    case EventKind::kActivated:
    case EventKind::kDeactivated:
    case EventKind::kWaiting:
    case EventKind::kLinkReplaced:
      return spdlog::level::info;
    case EventKind::kLinkChanged:
      return event.link == driver::LinkState::kConnected ? spdlog::level::info
                                                         : spdlog::level::warn;
    case EventKind::kForceChanged:
      return spdlog::level::warn;
    case EventKind::kFault:
      return spdlog::level::err;
    case EventKind::kActivityBegan:
      return words_for(event.activity).level;
    case EventKind::kActivityEnded:
      // No action is needed once the activity has ended.
      return std::min(words_for(event.activity).level, spdlog::level::info);
    case EventKind::kTouchBegan:
    case EventKind::kTouchEnded:
      return spdlog::level::trace;
  }
  return spdlog::level::err;
}

bool is_notice(const TickEvent& event) noexcept {
  return event.kind == EventKind::kForceChanged ||
         (event.kind == EventKind::kActivityBegan &&
          (event.activity == Activity::kPower || event.activity == Activity::kCalmed ||
           event.activity == Activity::kWall));
}

std::string at_tick(std::uint64_t tick, std::int64_t time_ns) {
  return fmt::format("tick {}, {:.3f} s: ", tick, 1e-9 * static_cast<double>(time_ns));
}

std::string words_of(const TickEvent& event, std::span<const std::string> objects) {
  return at_tick(event.tick, event.time_ns) + sentence(event, objects);
}

}  // namespace thimble::session
