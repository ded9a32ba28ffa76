#include "studies/fuzz_scenes/random_scene.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "energy_guard_settings.h"
#include "stability/draw.h"
#include "stability/stability_laws.h"
#include "studies/fuzz_scenes/small_meshes.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/effect/effect_table.h"

namespace thimble::studies {
namespace {

using Eigen::Vector3d;

constexpr double kTouch = 1.6;  // s of touch [issue of the search, including the start of the rest]
/// s at the end, in which the hand rests. The softest hand (100 N/m) creeps through the most
/// viscous fields and walls (9 + 2 * 8 N s/m) with a time constant of 0.25 s; from 0.2 m/s it slows
/// down to 1 mm/s, a count in 30 ms, after 1.3 s.
constexpr double kRest = 1.6;
constexpr double kDuration = kTouch + kRest;
constexpr double kGravity = 9.81;  // m/s^2
constexpr double kFall = 0.2;      // m: no weight falls farther within the workspace

std::string number(double value) {
  return fmt::format("{:.6g}", value);
}

std::string vector(const Vector3d& v) {
  std::string text = "[";
  text.append(number(v.x())).append(", ").append(number(v.y())).append(", ");
  return text.append(number(v.z())).append("]");
}

std::string joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text.append(part);
  return text;
}

/// Writes YAML line by line.
class Lines {
 public:
  void add(int indent, std::string_view key, std::string_view value) {
    text_.append(static_cast<std::size_t>(indent), ' ').append(key).append(":");
    if (!value.empty()) text_.append(" ").append(value);
    text_.append("\n");
  }
  void add(int indent, std::string_view key, double value) { add(indent, key, number(value)); }
  std::string& text() { return text_; }

 private:
  std::string text_;
};

struct Hand {
  double mass, stiffness, damping, tremor;
};

/// The properties of an object that the hand uses.
struct Placed {
  std::string name;
  bool has_surface = false;
  Vector3d p_WO{0, 0, 0};
  double size = 0;
};

class Drawing {
 public:
  Drawing(std::uint64_t seed, const RandomSceneLimits& limits)
      : draw_(seed), limits_(limits), seed_(seed) {}

  RandomScene scene() {
    constexpr std::array kRates{1000.0, 1000.0, 1000.0, 500.0, 2000.0};
    rate_ = kRates[draw_.one_of(kRates.size())];
    // Pinch grips from low to high impedance [PHYSICS 0 and 9: constants varied by 1/3 to 3].
    hand_ = {.mass = draw_.octave(0.01, 0.075),
             .stiffness = draw_.octave(100, 900),
             .damping = draw_.octave(1, 9),
             .tremor = draw_.chance(0.3) ? draw_.uniform(0, 1e-4) : 0};
    const std::string name = fmt::format("trouble_{:016x}", seed_);
    lines_.add(0, "name", name);
    lines_.add(0, "arm", limits_.arm_path);
    lines_.add(0, "duration", kDuration);
    lines_.add(0, "rate", rate_);
    lines_.add(0, "seed", static_cast<double>(seed_ % 1000));
    lines_.add(0, "objects", "");
    const std::size_t count = 1 + draw_.one_of(3);
    share_ = 1 / static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) object(i);
    hand();
    return {std::move(lines_.text()), own_energy_, oscillates_};
  }

 private:
  /// Returns the maximum stiffness of a surface.
  double stiffness_max() const {
    const scene::ArmFile& arm = limits_.arm;
    const device_sim::SimulatedArmSettings& sim = arm.simulated;
    const double law = scene::stiffness_limit(sim.plant.viscous + hand_.damping,
                                              scene::latency_of(scene::loop_pace(arm, rate_)));
    return std::min(limits_.stiffness_share * law, arm.declared.stiffness);
  }

  void object(std::size_t i) {
    Placed placed{.name = joined({"o", std::to_string(i)}), .p_WO = 0.03 * draw_.in_box(1)};
    placed.p_WO.z() -= 0.02;
    lines_.text().append("  - name: ").append(placed.name).append("\n");
    if (i > 0 && draw_.chance(0.25)) {
      field(placed);
    } else {
      surface(placed);
    }
    objects_.push_back(placed);
  }

  void field(const Placed& placed) {
    lines_.add(4, "position", vector(placed.p_WO));
    switch (draw_.one_of(4)) {
      case 0: {
        const double mass = draw_.uniform(0, 0.1);
        own_energy_ += mass * kGravity * kFall;
        lines_.add(4, "field", "gravity");
        lines_.add(4, "mass", mass);
        break;
      }
      case 1:
        lines_.add(4, "field", "viscous");
        lines_.add(4, "damping", draw_.uniform(0, 8));
        break;
      case 2: {
        const double force = draw_.uniform(-2, 2), radius = draw_.uniform(0.01, 0.03);
        // Depth of the potential: 1.5 sqrt(3) F R.
        own_energy_ += 2.6 * std::abs(force) * radius;
        lines_.add(4, "field", "charges");
        lines_.add(4, "charges",
                   joined({"[{position: [0, 0, 0], force: ", number(force),
                           ", radius: ", number(radius), "}]"}));
        break;
      }
      default: {
        const double force = draw_.uniform(0, 1.5), radius = draw_.uniform(0.008, 0.02);
        own_energy_ += 0.65 * force * radius;
        lines_.add(4, "field", "magnetic_snap");
        lines_.add(4, "targets",
                   joined({"[{from: [0, 0, 0], to: ", vector(0.03 * draw_.direction()), ", force: ",
                           number(force), ", capture_radius: ", number(radius), "}]"}));
      }
    }
  }

  void surface(Placed& placed) {
    placed.has_surface = true;
    placed.size = draw_.uniform(0.02, 0.05);
    const std::size_t form = draw_.one_of(7);
    const bool mesh = form >= 4;
    lines_.add(4, "position", vector(placed.p_WO));
    if (form == 0) {
      const Vector3d tilt = Vector3d(0, 0, 1) + draw_.in_box(0.4);
      lines_.add(4, "plane", joined({"{normal: ", vector(tilt), "}"}));
      placed.size = 0;
    } else if (form == 1) {
      lines_.add(4, "sphere", joined({"{radius: ", number(placed.size / 2), "}"}));
    } else if (form <= 3) {
      const Vector3d sides = placed.size * (Vector3d(0.6, 0.6, 0.6) + draw_.in_box(0.4));
      lines_.add(4, "box",
                 joined({"{sides: ", vector(sides), ", form: ", form == 2 ? "entry_face" : "wedges",
                         "}"}));
    } else {
      lines_.add(4, "mesh",
                 joined({limits_.mesh_path, "/", kSmallMeshes[draw_.one_of(kSmallMeshes.size())],
                         ".off"}));
      lines_.add(4, "size", placed.size);
    }
    if (form != 0 && draw_.chance(0.5)) {
      lines_.add(4, "rotate_degrees",
                 joined({"[[x, ", number(draw_.uniform(-180, 180)), "], [y, ",
                         number(draw_.uniform(-90, 90)), "]]"}));
    }
    const bool texture = draw_.chance(0.3);
    // Springs of overlapping objects add up; a slope of up to 1 doubles the stiffness of a surface.
    const double stiffest = share_ * stiffness_max() / (texture ? 2 : 1);
    lines_.add(4, "stiffness", draw_.octave(std::min(50.0, stiffest / 2), stiffest));
    lines_.add(4, "damping", draw_.chance(0.3) ? 0 : draw_.uniform(0, 3));
    bool compact = false;
    if (mesh && draw_.chance(0.7)) compact = contact();
    effects(texture);
    if (form != 0 && draw_.chance(0.45)) body(placed, mesh && !compact);
  }

  bool contact() {
    const std::size_t tracker = draw_.one_of(render::kTrackerNames.size());
    const auto is = [&](render::TrackerChoice choice) {
      return tracker == static_cast<std::size_t>(choice);
    };
    lines_.add(4, "contact", "");
    lines_.add(6, "tracker", render::kTrackerNames[tracker]);
    if (is(render::TrackerChoice::kPacked)) return true;
    if (draw_.chance(0.5)) {
      lines_.add(6, "search", render::kSearchNames[draw_.one_of(render::kSearchNames.size())]);
    }
    const bool flat = is(render::TrackerChoice::kGodObject);
    if (!flat && draw_.chance(0.5)) {
      lines_.add(6, "blending",
                 render::kBlendingNames[draw_.one_of(render::kBlendingNames.size())]);
    }
    if (draw_.chance(0.3)) lines_.add(6, "crease_degrees", draw_.uniform(10, 90));
    return false;
  }

  void effects(bool texture) {
    const bool friction = draw_.chance(0.6);
    if (!texture && !friction) return;
    lines_.add(4, "effects", "");
    if (texture && draw_.chance(0.5)) {
      lines_.text().append("      - texture: sines\n");
      const double wavelength = draw_.octave(0.002, 0.02);
      const double amplitude = draw_.uniform(0, 0.1) * wavelength;
      lines_.add(8, "waves",
                 joined({"[{amplitude: ", number(amplitude), ", wavelength: ", number(wavelength),
                         ", direction: ", vector(draw_.direction()), "}]"}));
    } else if (texture) {
      lines_.text().append("      - texture: sandpaper\n");
      const double wavelength = draw_.octave(0.002, 0.01);
      lines_.add(8, "wavelength", wavelength);
      lines_.add(8, "roughness", draw_.uniform(0, 0.02) * wavelength);
    }
    if (!friction) return;
    std::vector<const render::EffectKind*> frictions;
    for (const render::EffectKind& kind : render::effect_table()) {
      if (kind.group == "friction") frictions.push_back(&kind);
    }
    const render::EffectKind& chosen = *frictions[draw_.one_of(frictions.size())];
    oscillates_ = oscillates_ || !chosen.rests;
    lines_.text().append("      - friction: ").append(chosen.name).append("\n");
    lines_.add(8, "coefficient", draw_.uniform(0.05, 1));
  }

  void body(const Placed& placed, bool bends) {
    const bool moves = !bends || draw_.chance(0.3);
    const bool dents = bends && draw_.chance(0.8);
    const std::size_t base = bends ? draw_.one_of(4) : 3;  // clay, snap, or none
    if (!moves && !dents && base > 1) return;
    lines_.add(4, "body", "");
    if (dents) {
      lines_.add(6, "dent", "");
      lines_.add(8, "stiffness", draw_.octave(20, 500));
      lines_.add(8, "damping", draw_.octave(0.01, 1));
      if (draw_.chance(0.5)) lines_.add(8, "neighbour_stiffness", draw_.octave(5, 300));
      if (draw_.chance(0.3)) lines_.add(8, "pull", draw_.uniform(0, 0.5));
      if (draw_.chance(0.3)) lines_.add(8, "region", "whole");
    }
    if (base == 0) {
      lines_.add(6, "plastic", "");
      lines_.add(8, "yield_force", draw_.uniform(0.2, 2));
      lines_.add(8, "radius", draw_.uniform(0.1, 0.4) * placed.size);
      lines_.add(8, "movement_limit", 0.2 * placed.size);
    } else if (base == 1) {
      const double depth = draw_.uniform(0.05, 0.2) * placed.size;
      lines_.add(6, "snap", "");
      lines_.add(8, "force", draw_.uniform(0.5, 3));
      lines_.add(8, "depth", depth);
      lines_.add(8, "radius", draw_.uniform(1.5, 4) * depth);
    }
    if (moves) motion(placed);
  }

  void motion(const Placed& placed) {
    const bool rigid = draw_.chance(0.7);
    const double mass = draw_.octave(0.03, 1);
    lines_.add(6, "motion", "");
    lines_.add(8, "kind", rigid ? "rigid" : "translate");
    lines_.add(8, "mass", mass);
    lines_.add(8, "damping", draw_.octave(0.05, 2));
    if (rigid) lines_.add(8, "angular_damping", draw_.octave(1e-5, 1e-3));
    if (draw_.chance(0.4)) {
      own_energy_ += mass * kGravity * kFall;
      lines_.add(8, "gravity", "[0, 0, -9.81]");
      lines_.add(8, "floor", placed.p_WO.z() - 0.6 * placed.size);
      lines_.add(8, "floor_friction", draw_.uniform(0, 0.6));
    } else if (draw_.chance(0.3)) {
      lines_.add(8, "reach", draw_.uniform(0.005, 0.05));
    }
  }

  void hand() {
    lines_.add(0, "hand", "");
    lines_.add(
        2, "grip",
        joined({"{mass: ", number(hand_.mass), ", stiffness: ", number(hand_.stiffness),
                ", damping: ", number(hand_.damping), ", tremor: ", number(hand_.tremor), "}"}));
    lines_.add(2, "path", "");
    // Above everything, so that nothing is touched during the soft start.
    station(0, Vector3d{draw_.uniform(-0.05, 0.05), draw_.uniform(-0.05, 0.05), 0.075});
    double time = draw_.uniform(0.3, 0.5);
    const Placed* last = nullptr;
    std::string rest;
    while (time < kTouch) {
      rest = next_station(last);
      lines_.text().append("    - {t: ").append(number(time)).append(rest).append("}\n");
      time += draw_.uniform(0.12, 0.5);
    }
    // Rests at the last station.
    lines_.text().append("    - {t: ").append(number(kTouch)).append(rest);
    lines_.text().append(", stop: true}\n");
    lines_.text().append("    - {t: ").append(number(kDuration)).append(rest);
    lines_.text().append(", stop: true}\n");
  }

  void station(double time, const Vector3d& p_W) {
    lines_.text().append("    - {t: ").append(number(time)).append(", at: ");
    lines_.text().append(vector(p_W)).append("}\n");
  }

  /// Returns a random station, without its time: near the last one on the same object, on another
  /// object, or a free point, which may be inside of something.
  std::string next_station(const Placed*& last) {
    if (last == nullptr || draw_.chance(0.25)) {
      const Placed& object = objects_[draw_.one_of(objects_.size())];
      last = object.has_surface && draw_.chance(0.85) ? &object : nullptr;
      way_ = draw_.direction();
      way_.z() = std::abs(way_.z());
    }
    if (last == nullptr) return joined({", at: ", vector(draw_.in_box(0.045))});
    way_ = (way_ + 0.4 * draw_.in_box(1)).normalized();
    const Vector3d near = last->size > 0 ? Vector3d(last->p_WO + 0.6 * last->size * way_)
                                         : Vector3d(last->p_WO + 0.02 * way_);
    return joined({", on: ", last->name, ", near: ", vector(near),
                   ", press: ", number(draw_.uniform(0, 0.01))});
  }

  stability::Draw draw_;
  const RandomSceneLimits& limits_;
  std::uint64_t seed_;
  double rate_ = 1000;
  Hand hand_{};
  Lines lines_;
  double own_energy_ = 0;
  bool oscillates_ = false;
  double share_ = 1;  // of the stiffness, per object
  std::vector<Placed> objects_;
  Vector3d way_{0, 0, 1};
};

}  // namespace

RandomScene random_scene(std::uint64_t seed, const RandomSceneLimits& limits) {
  return Drawing(seed, limits).scene();
}

}  // namespace thimble::studies
