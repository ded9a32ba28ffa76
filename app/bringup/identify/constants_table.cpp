#include "bringup/identify/constants_table.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "math/elementary.h"

#include "bringup/identify/link_inertia/masses_per_pose.h"
#include "bringup/identify/unidentified_parameters.h"

namespace thimble::bringup {
namespace {

class Rows {
 public:
  /// Adds an SI constant; `scale` converts it to `unit`.
  void add(std::string name, const Estimate& found, double scale, std::string unit,
           std::optional<double> named = {}) {
    if (named) named = scale * *named;
    rows_.push_back(
        {std::move(name), {scale * found.value, scale * found.plus_minus}, std::move(unit), named});
  }
  std::vector<ConstantRow> take() { return std::move(rows_); }

 private:
  std::vector<ConstantRow> rows_;
};

void add_friction(const FrictionDirections& friction, Rows& rows) {
  for (std::size_t i = 0; i < 3; ++i) {
    const char axis = "xyz"[i];
    const Estimate &mean = friction.mean[i], &uneven = friction.uneven[i];
    if (friction.directions_differ && friction.is_observable(static_cast<int>(i))) {
      const double error = math::hypot(mean.plus_minus, uneven.plus_minus);
      rows.add(fmt::format("Coulomb friction, +{}", axis), {mean.value - uneven.value, error}, 1e3,
               "mN, base");
      rows.add(fmt::format("Coulomb friction, -{}", axis), {mean.value + uneven.value, error}, 1e3,
               "mN, base");
    } else if (friction.axes_differ || friction.directions_differ) {
      rows.add(fmt::format("Coulomb friction, {}", axis), mean, 1e3, "mN, base");
    }
  }
}

/// Adds the friction of a rigid arm's joints, and of their two directions if these differ. An
/// excess in one direction along an axis of the base also applies to the joints that turn with it.
void add_joints(const Identified& identified, const scene::ArmFile& file, Rows& rows) {
  if (!identified.rubbing.seen) return;
  const auto& train = file.simulated.drive_train;
  const auto named = [&](double value) {
    return file.can_simulate ? std::optional(value) : std::nullopt;
  };
  const FrictionDirections& friction = identified.friction;
  const Eigen::Matrix3d J = identified.moved.samples.empty()
                                ? Eigen::Matrix3d::Zero()
                                : identified.moved.samples.back().G.inverse().eval();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const Estimate dry = identified.joint_coulomb(i);
    rows.add(fmt::format("Coulomb friction, joint {}", i + 1), dry, 1e3, "mN m",
             named(train.coulomb[k]));
    if (!friction.directions_differ) continue;
    double uneven = 0, square = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double lever = J(static_cast<Eigen::Index>(axis), k);
      uneven += lever * friction.uneven[axis].value;
      square += lever * lever * friction.uneven[axis].plus_minus * friction.uneven[axis].plus_minus;
    }
    const double error = math::hypot(dry.plus_minus, std::sqrt(square));
    rows.add(fmt::format("  turning forwards, joint {}", i + 1), {dry.value - uneven, error}, 1e3,
             "mN m, without what is vertical");
    rows.add(fmt::format("  turning backwards, joint {}", i + 1), {dry.value + uneven, error}, 1e3,
             "mN m, without what is vertical");
  }
  for (std::size_t i = 0; i < 3; ++i) {
    rows.add(fmt::format("viscous friction, joint {}", i + 1), identified.joint_viscous(i), 1e3,
             "mN m s/rad", named(train.viscous[static_cast<Eigen::Index>(i)]));
  }
}

void add_encoders(const Encoders& found, const scene::ArmFile& file, Rows& rows) {
  constexpr double kMicro = 1e6;
  const auto motors = static_cast<std::size_t>(file.motors());
  for (std::size_t i = 0; i < motors; ++i) {
    if (found.step[i].counts == 0) continue;
    const double step = file.model.step(i);
    rows.add(fmt::format("step of encoder {}", i + 1), {found.step[i].counts * step, 0}, kMicro,
             "urad at the joint", step);
  }
  for (std::size_t i = 0; found.rest && i < motors; ++i) {
    if (!found.rest->at_rest[i]) continue;
    const Estimate& noise = found.rest->noise[i];
    rows.add(fmt::format("noise of encoder {}, RMS", i + 1), noise, kMicro * file.model.step(i),
             "urad at the joint, at rest");
  }
}

void add_cables(const ArmConstants& found, const scene::ArmFile& file, Rows& rows) {
  const auto& train = file.simulated.drive_train;
  const bool named = train.compliant();
  for (std::size_t i = 0; i < 3; ++i) {
    const CableConstants& cable = (*found.cables)[i];
    const auto name = [i](const char* what) { return fmt::format("{} {}", what, i + 1); };
    const auto of = [&](const Eigen::Vector3d& values) {
      return named ? std::optional(values[static_cast<Eigen::Index>(i)]) : std::nullopt;
    };
    rows.add(name("inertia of motor"), cable.inertia, 1e3, "g m^2", of(train.inertia));
    rows.add(name("stiffness of cable"), cable.stiffness, 1, "N m/rad", of(train.stiffness));
    rows.add(name("damping of cable"), cable.damping, 1, "N m s/rad", of(train.damping));
    if (cable.play.value > 0) {
      rows.add(name("play of joint"), cable.play, 1e3, "mrad, whole width", of(train.play));
    }
    if (cable.viscous.value > 0) {
      rows.add(name("viscous friction, motor"), cable.viscous, 1e3, "mN m s/rad at the joint",
               of(train.viscous));
    }
    if (cable.coulomb.value > 0) {
      rows.add(name("Coulomb friction, motor"), cable.coulomb, 1e3, "mN m at the joint",
               of(train.coulomb));
    }
    if (CableConstants::sees(cable.antiresonance)) {
      rows.add(name("antiresonance"), cable.antiresonance, 1, "Hz, link on its cable");
    }
    if (CableConstants::sees(cable.resonance)) {
      rows.add(name("resonance"), cable.resonance, 1, "Hz, motor against link");
    }
  }
}

void add_cogging(const Identified& identified, const scene::ArmFile& file, Rows& rows) {
  const MotorCogging& waves = identified.waves;
  if (!waves.is_reported()) return;
  const auto& train = file.simulated.drive_train;
  const bool names = train.periods_per_turn > 0;
  const auto named = [&](double value) { return names ? std::optional(value) : std::nullopt; };
  rows.add("periods of cogging, ripple", {waves.periods, 0}, 1, "in a turn of a motor",
           named(train.periods_per_turn));
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const auto name = [i](const char* what) { return fmt::format("{} {}", what, i + 1); };
    if (waves.cogging[i].seen) {
      rows.add(name("cogging of motor"), cogging_at_motor(waves, i, identified.constants.gain[i]),
               1e3, "mN m at the motor", named(train.cogging[k]));
      rows.add(name("phase of cogging"), waves.cogging[i].phase, 1,
               "rad where the joint's angle is zero", named(train.cogging_phase[k]));
    }
    if (waves.ripple[i].seen) {
      rows.add(name("ripple of motor"), waves.ripple[i].amplitude, 100, "% of the torque constant",
               named(train.ripple[k]));
      rows.add(name("phase of ripple"), waves.ripple[i].phase, 1,
               "rad where the joint's angle is zero", named(train.ripple_phase[k]));
    }
  }
}

void add_links(const LinkConstants& found, const scene::ArmFile& file, Rows& rows) {
  const device_sim::LinkSettings& links = file.simulated.links;
  const auto add = [&](const char* name, const Estimate& is, const char* unit, double named) {
    rows.add(name, is, 1e3, unit, links.named() ? std::optional(named) : std::nullopt);
  };
  add("inertia of links, A", found.inertia[0], "g m^2", links.inertia[0]);
  add("inertia of links, B", found.inertia[1], "g m^2", links.inertia[1]);
  add("inertia of links, C", found.inertia[2], "g m^2", links.inertia[2]);
  add("about the yaw, sin^2 B", found.yaw_b, "g m^2", links.yaw_b);
  add("about the yaw, sin^2 C", found.yaw_c, "g m^2", links.yaw_c);
  // A value that was assumed to be zero is not a result.
  if (found.coupling.value != 0)
    add("coupling of B and C", found.coupling, "g m^2", links.coupling);
  add("first moment along B", found.moment_b, "g m", links.moment_b);
  if (found.moment_c.value != 0) {
    add("first moment along C", found.moment_c, "g m", links.moment_c);
  }
}

/// Names a joint whose friction stands out; empty if there is none.
std::string high_friction_text(const Identified& identified) {
  constexpr double kFarAbove = 3;  // [chosen: shipped arms' joints differ by less]
  if (!identified.constants.cables) return "";
  std::array<std::pair<double, int>, 3> by{};
  for (std::size_t i = 0; i < 3; ++i) {
    by[i] = {(*identified.constants.cables)[i].coulomb.value, static_cast<int>(i)};
  }
  std::sort(by.begin(), by.end());
  const auto& [highest, joint] = by[2];
  const double at_tip = highest / std::sqrt(identified.lines.JTJ(joint, joint));
  if (!(highest > kFarAbove * by[1].first && at_tip > identified.constants.coulomb.value))
    return "";
  return fmt::format(
      " Joint {} has far more friction than the others and than the tip. Check its cable, bearing "
      "and motor.",
      joint + 1);
}

}  // namespace

std::vector<ConstantRow> constant_rows(const Identified& identified, const scene::ArmFile& file) {
  const ArmConstants& found = identified.constants;
  const auto& simulated = file.simulated;
  const auto named = [&](double value) {
    return file.can_simulate ? std::optional(value) : std::nullopt;
  };
  Rows rows;
  rows.add("mass at the tip", found.mass, 1e3, "g", named(simulated.plant.mass));
  rows.add("viscous friction", found.viscous, 1, "N s/m", named(simulated.plant.viscous));
  rows.add("Coulomb friction", found.coulomb, 1e3, "mN per axis", named(simulated.plant.coulomb));
  if (!identified.rubbing.seen) add_friction(identified.friction, rows);
  add_joints(identified, file, rows);
  rows.add("weight", found.weight, 1e3, "mN", named(simulated.weight_B.norm()));
  const auto motors = static_cast<std::size_t>(file.motors());
  for (std::size_t i = 0; i < motors; ++i) {
    rows.add(fmt::format("gain of motor {}", i + 1), found.gain[i], 1,
             "of the arm file's torque constant", 1.0);
  }
  const double delay =
      1e-9 * static_cast<double>(simulated.wire.delay_in_ns + simulated.wire.delay_out_ns);
  // For an arm whose converter and bus are code, the file names no delay.
  const bool names_delay = !file.is<driver::DeltaArm>();
  rows.add("delay, force to motion", found.delay, 1e3, "ms",
           names_delay ? named(delay) : std::nullopt);
  if (found.cables) add_cables(found, file, rows);
  add_cogging(identified, file, rows);
  if (found.links) add_links(*found.links, file, rows);
  for (std::size_t i = 0; i < 3; ++i) {
    const Saturation& one = identified.saturation[i];
    if (one.seen) {
      rows.add(fmt::format("most torque of motor {}", i + 1), one.max_torque, 1,
               "N m at the joint, by the arm file's constants");
    }
  }
  add_encoders(identified.encoders, file, rows);
  if (identified.reports && identified.reports->period.value > 0) {
    const double period = 1e-9 * static_cast<double>(simulated.firmware.report_period_ns);
    rows.add("report period", identified.reports->period, 1e3, "ms", named(period));
    rows.add("jitter of reports, RMS", identified.reports->jitter, 1e3, "ms");
  }
  if (identified.watchdog && identified.watchdog->known()) {
    rows.add("watchdog of the firmware", identified.watchdog->time, 1e3, "ms after a message",
             1e-9 * static_cast<double>(file.limits.watchdog_ns));
  }
  return rows.take();
}

std::string fit_text(const Identified& identified) {
  const MassNormalisedFit& fit = identified.bare;
  if (identified.play.fits_to_steps()) {
    const BacklashResult& play = identified.play;
    const char* what = play.seen && play.friction.seen ? " with backlash and friction of the motors"
                       : play.seen                     ? " with backlash"
                       : play.friction.seen            ? " with friction of the motors"
                                                       : "";
    std::string text = fmt::format(
        "Fitted{} to {} segments of motion; the residual of the angles is {:.2f} times the noise "
        "of the encoder steps",
        what, fit.windows, std::sqrt(play.best().misfit));
    if (play.is_reported())
      text += fmt::format(" ({:.1f} times without)", std::sqrt(play.plain.misfit));
    return text + "." + high_friction_text(identified);
  }
  return fmt::format(
      "Fitted to {} segments of motion ({} omitted because an axis was at rest). The fit explains "
      "{:.3f} % of the acceleration; the residual is {:.1f} times the noise of the encoder steps.",
      fit.windows, fit.left_out, 100 * fit.explained, fit.residual / fit.noise);
}

std::string constants_table(const Identified& identified, const scene::ArmFile& file) {
  std::string text = "Constants, each with its 95 % interval:\n";
  for (const ConstantRow& row : constant_rows(identified, file)) {
    text += fmt::format("  {:<24} {:>10.5g} +- {:<9.2g} {}\n", row.name, row.found.value,
                        row.found.plus_minus, row.unit);
  }
  text += fit_text(identified) + "\n";
  if (identified.constants.absolute) text += "Mass and forces were measured with the known mass.\n";
  if (identified.constants.links) text += pose_table(*identified.over.fit, file);
  text += "Not identified:\n";
  for (const std::string& sentence : unidentified_parameters(identified))
    text += "  " + sentence + "\n";
  return text;
}

}  // namespace thimble::bringup
