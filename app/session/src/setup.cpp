#include "setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "arm/report_timeout.h"
#include "log/logger.h"
#include "meshes/cache/cache_folder.h"
#include "scene_poses.h"
#include "text_file.h"
#include "thimble/driver/device.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/build_info.h"
#include "thimble/scene/hand_route.h"
#include "thimble/scene/quality.h"
#include "thimble/scene/real_arm.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::session {
namespace {

std::string full_path(const std::filesystem::path& file) {
  return std::filesystem::absolute(file).lexically_normal().string();
}

bool any_real_in(const SessionOptions& options) {
  return options.real_arm || std::any_of(options.real_arms.begin(), options.real_arms.end(),
                                         [](const auto& use) { return use.second.has_value(); });
}

/// Returns a store of meshes for one session. `cache`: SessionOptions::mesh_cache.
std::shared_ptr<scene::SharedMeshes> own_meshes(std::filesystem::path cache) {
  if (cache.empty()) cache = scene::mesh_cache_of_environment().value_or(cache);
  if (cache.empty()) return std::make_shared<scene::SharedMeshes>();
  return std::make_shared<scene::SharedMeshes>(
      scene::MeshCacheChoice{.folder = std::filesystem::absolute(cache)});
}

}  // namespace

driver::Result<std::unique_ptr<Setup>> Setup::prepare(const std::filesystem::path& scene,
                                                      const SessionOptions& options) {
  auto found = scene::find_scene(scene.string());
  if (!found) return found.error();
  std::unique_ptr<Setup> setup(new Setup);
  setup->plan_.scene_file = std::move(found).value();
  return prepare(std::move(setup), options);
}

driver::Result<std::unique_ptr<Setup>> Setup::prepare(const scene::SceneBuilder& scene,
                                                      const SessionOptions& options) {
  std::unique_ptr<Setup> setup(new Setup);
  setup->plan_.scene_file = scene.file();
  setup->plan_.built = std::make_shared<const scene::SceneBuilder>(scene);
  return prepare(std::move(setup), options);
}

driver::Result<std::unique_ptr<Setup>> Setup::prepare(std::unique_ptr<Setup> setup,
                                                      const SessionOptions& options) {
  if (options.real_arm && !options.terms) {
    return driver::Error{"A real arm requires `terms` (scene::find_arm_policy)."};
  }
  setup->plan_.firmware = options.firmware;
  setup->plan_.hand_by_mouse = options.hand_by_mouse;
  setup->plan_.hand_by_program = options.hand_by_program;
  setup->plan_.buttons_allowed = options.buttons_by_program || options.share || options.share_out;
  setup->plan_.homed = options.homed;
  setup->plan_.hold = options.hold;
  setup->plan_.endless = options.endless;
  setup->plan_.keep = options.keep;
  setup->plan_.meshes = options.meshes ? options.meshes : own_meshes(options.mesh_cache);
  setup->plan_.real_time = options.clock == ClockKind::kWall || any_real_in(options);
  setup->plan_.paced =
      options.clock == ClockKind::kPaced && !setup->plan_.real_time && !options.own_clock;
  const auto has_test_link = [](const auto& use) { return use.second && use.second->open_link; };
  if (!setup->plan_.real_time || options.open_link ||
      std::any_of(options.real_arms.begin(), options.real_arms.end(), has_test_link)) {
    setup->clock_ = options.own_clock;
    setup->plan_.own_clock = options.own_clock != nullptr;
  }
  if (auto read = setup->read(options); !read) return read.error();

  if (auto built = setup->build_objects(); !built) return built.error();
  const std::vector<std::string>& notes = setup->objects_->notes();
  setup->plan_.warnings.insert(setup->plan_.warnings.end(), notes.begin(), notes.end());
  if (setup->objects_->moving().size() > ScenePoses::kMax) {
    return driver::Error{fmt::format(
        "{}: at most {} objects may move in the loop. Simulate more of them beside it, at a lower "
        "rate (guide, slow_simulation).",
        setup->plan_.scene_file.string(), ScenePoses::kMax)};
  }
  if (auto simulated = setup->simulate_arms(); !simulated) return simulated.error();
  if (!options.meshes)
    setup->plan_.meshes->drop_unused();  // the hand's path, of which the arm has a copy
  if (setup->plan_.real_time) setup->objects_->start_loaders();
  return setup;
}

driver::Result<std::unique_ptr<Setup>> Setup::prepare_like(const Setup& other, std::uint64_t seed) {
  if (other.any_real() || other.plan_.own_clock) {
    return driver::Error{"A run like another one requires simulated arms and the built-in clock."};
  }
  std::unique_ptr<Setup> setup(new Setup);
  setup->plan_ = other.plan_;
  setup->plan_.seed = seed;
  if (auto built = setup->build_objects(); !built) return built.error();
  setup->arms_.resize(other.arms_.size());
  for (std::size_t i = 0; i < setup->arms_.size(); ++i) {
    setup->arms_[i].energy = other.arms_[i].energy;
    setup->arms_[i].inside_at_start = other.arms_[i].inside_at_start;
    auto simulation = other.arms_[i].simulation->another(seed + i);
    if (!simulation) return simulation.error();
    setup->arms_[i].simulation = std::move(simulation).value();
  }
  if (setup->plan_.real_time) setup->objects_->start_loaders();
  return setup;
}

driver::Result<void> Setup::build_objects() {
  auto objects = scene::SceneObjects::build(*plan_.scene, plan_.meshes);
  if (!objects) return objects.error();
  objects_ = std::move(objects).value();
  return {};
}

driver::Result<void> Setup::read(const SessionOptions& options) {
  const bool real = any_real_in(options);
  const auto quality = scene::quality_named(options.quality);
  if (!quality) {
    return driver::Error{fmt::format("Unknown quality \"{}\"; choose one of {}.", options.quality,
                                     fmt::join(scene::kQualityNames, ", "))};
  }
  const scene::SceneReading reading{
      .arm = options.real_arm ? options.terms->arm.path : options.arm_file,
      .mesh_folder = options.mesh_folder,
      .rate_factor = real ? 1 : options.rate_factor * scene::rate_factor_of(*quality),
      .several_arms = options.several_arms};
  auto scene =
      plan_.built ? plan_.built->build(reading) : scene::load_scene(plan_.scene_file, reading);
  if (!scene) return scene.error();
  plan_.scene = std::make_shared<scene::Scene>(std::move(scene).value());
  plan_.inputs = std::make_shared<scene::FileHashes>(plan_.scene->inputs);
  if (auto fits = check_several(options); !fits) return fits;
  plan_.quality_choices = scene::apply_quality(*quality, *plan_.scene, options.budget);
  plan_.choices = {.quality = options.quality,
                   .budget = options.budget,
                   .rate_factor = plan_.scene->rate_factor,
                   .adjusted = options.adjust || (plan_.built && plan_.built->has_own_effects())};
  plan_.scene->arms.front().buttons = options.buttons;
  if (options.adjust) options.adjust(*plan_.scene);
  if (auto used = use_real_arms(options); !used) return used;
  plan_.seed = options.seed.value_or(plan_.scene->seed);
  plan_.period_ns = std::llround(1e9 / plan_.scene->rate);
  const double duration = options.duration.value_or(plan_.scene->duration);
  // A run whose hand is moved by a viewer or a program has no end unless a duration is given.
  if ((!hand_led() && !options.endless) || options.duration) {
    plan_.ticks = static_cast<std::uint64_t>(
        std::ceil(duration * 1e9 / static_cast<double>(plan_.period_ns)));
  }
  return {};
}

driver::Result<void> Setup::check_several(const SessionOptions& options) const {
  if (arms() == 1 && options.real_arms.empty()) return {};
  if (arms() == 1) {
    return driver::Error{fmt::format("{}: the scene has one arm; remove {}= from --device.",
                                     plan_.scene_file.string(), options.real_arms.begin()->first)};
  }
  const auto refuse = [this](const char* what) {
    return driver::Error{
        fmt::format("{}: the scene has {} arms; {}", plan_.scene_file.string(), arms(), what)};
  };
  if (options.real_arm) {
    return refuse(fmt::format("name the arm: --device {}=WHICH.", arm_name(0)).c_str());
  }
  std::string names = arm_name(0);
  for (std::size_t i = 1; i < arms(); ++i) names += ", " + arm_name(i);
  for (const auto& real : options.real_arms) {
    const std::string& name = real.first;
    const auto same = [&name](const scene::SceneArm& arm) { return arm.name == name; };
    if (std::none_of(plan_.scene->arms.begin(), plan_.scene->arms.end(), same)) {
      return refuse(fmt::format("none is named \"{}\". Choose one of: {}.", name, names).c_str());
    }
  }
  if (options.hand_by_mouse) {
    return refuse("--hand mouse supports one arm only; remove it.");
  }
  if (options.hand_by_program) {
    return refuse("--hand topic supports one arm only; remove it.");
  }
  return {};
}

driver::Result<void> Setup::use_real_arms(const SessionOptions& options) {
  arms_.resize(arms());
  for (ArmOfRun& arm : arms_) arm.energy = plan_.scene->energy;
  if (options.real_arm) {
    ArmOfRun& arm = arms_.front();
    arm.real = options.real_arm;
    arm.open_link = options.open_link;
    arm.start_pose = StartPose::of(plan_.scene->arms.front().arm, arm.real->kind);
    auto warnings = scene::apply_arm_policy(*plan_.scene, plan_.scene_file, *options.terms);
    if (!warnings) return warnings.error();
    plan_.warnings = std::move(warnings).value();
    arm.energy = plan_.scene->energy;
    arm.feel_check = options.terms->feel_check;
    return {};
  }
  if (!any_real_in(options)) return {};
  for (std::size_t i = 0; i < arms(); ++i) {
    const auto use = options.real_arms.find(arm_name(i));
    if (use == options.real_arms.end() || !use->second) {
      arms_[i].start_pose.emplace(arm_file(i).workspace, std::nullopt);
    } else if (auto used = use_real_arm(i, *use->second); !used) {
      return used;
    }
  }
  return {};
}

driver::Result<void> Setup::use_real_arm(std::size_t i, const RealArmUse& use) {
  scene::SceneArm& in_scene = plan_.scene->arms[i];
  const auto of_arm = [&](const std::string& what) {
    return "The arm \"" + arm_name(i) + "\": " + what;
  };
  ArmOfRun& arm = arms_[i];
  arm.real = use.arm;
  arm.open_link = use.open_link;
  arm.feel_check = use.terms.feel_check;
  // The arm's place comes from the scene. Its counts at the home pose come only from its file.
  const auto uncalibrated = scene::load_arm(use.terms.arm.path);
  if (!uncalibrated) return driver::Error{of_arm(uncalibrated.error().message)};
  arm.start_pose = StartPose::of(in_scene.place.put(*uncalibrated), use.arm.kind);
  // Applies the limits named in the scene to this arm, as for a scene with one arm.
  scene::Scene alone;
  alone.arms.front().own_arm_file = in_scene.arm_file;
  alone.energy = plan_.scene->energy;
  alone.energy_line = plan_.scene->energy_line;
  auto warnings = scene::apply_arm_policy(alone, plan_.scene_file, use.terms);
  if (!warnings) return driver::Error{of_arm(warnings.error().message)};
  for (const std::string& sentence : *warnings) plan_.warnings.push_back(of_arm(sentence));
  in_scene.arm = in_scene.place.put(alone.arms.front().arm);
  in_scene.arm_file = alone.arms.front().arm_file;
  arm.energy.reset();  // now in the arm's own settings
  return {};
}

driver::Result<void> Setup::simulate_arms() {
  std::unordered_set<std::string_view>
      touched;  // objects that a hand follows; only these need meshes
  for (const scene::SceneArm& arm : plan_.scene->arms) {
    for (const scene::HandWaypoint& waypoint : arm.hand) {
      if (waypoint.on) touched.insert(*waypoint.on);
    }
  }
  std::vector<std::pair<std::string, std::shared_ptr<const render::TriangleMesh>>> named;
  for (std::size_t i = 0; i < plan_.scene->objects.size(); ++i) {
    const scene::SceneObject& object = plan_.scene->objects[i];
    if (object.build_field || object.paged || !touched.contains(object.name)) continue;
    named.emplace_back(object.name, objects_->shared_mesh_W(i));
  }
  using Simulated = driver::Result<std::unique_ptr<scene::ArmSimulation>>;
  const auto simulate = [&](const scene::ArmFile& arm, const std::filesystem::path& arm_file,
                            const std::vector<scene::HandWaypoint>& hand, const std::string& name,
                            std::uint64_t seed, Eigen::Vector3d& start) -> Simulated {
    const std::string whose = name.empty() ? "" : "the arm \"" + name + "\": ";
    const auto in_file = [&whose](const std::filesystem::path& file, const driver::Error& error) {
      return driver::Error{file.string() + ": " + whose + error.message};
    };
    const auto planned = plan_.meshes->hand_route(hand, named);
    if (!planned) return in_file(plan_.scene_file, planned.error());
    const scene::HandRoute& route = **planned;
    if (auto reach = scene::check_reach(arm, route); !reach) {
      return in_file(plan_.scene_file, reach.error());
    }
    start = route.front().second;
    // A hand moved by a viewer or a program waits at the start of the planned path.
    auto simulation = scene::ArmSimulation::make(
        arm, hand_led() ? scene::HandRoute{route.front()} : route, plan_.firmware, seed);
    if (!simulation) return in_file(arm_file, simulation.error());
    return simulation;
  };
  for (std::size_t i = 0; i < arms(); ++i) {
    if (arms_[i].real) continue;
    // Each arm has a different seed, so that the tremors of two hands differ.
    Eigen::Vector3d start;
    const scene::SceneArm& one = plan_.scene->arms[i];
    auto simulation = simulate(one.arm, one.arm_file, one.hand, one.name, plan_.seed + i, start);
    if (!simulation) return simulation.error();
    arms_[i].simulation = std::move(simulation).value();
    arms_[i].simulation->plan_buttons(one.buttons);
    if (plan_.buttons_allowed) arms_[i].simulation->allow_buttons();
    if (auto inside = find_start_inside(i, start); !inside.empty()) {
      plan_.warnings.push_back(std::move(inside));
    }
  }
  return {};
}

std::string Setup::find_start_inside(std::size_t i, const Eigen::Vector3d& p_WT) {
  std::vector<std::string>& inside = arms_[i].inside_at_start;
  inside.clear();
  const render::SceneTouch& touch = objects_->touch(i);
  for (std::size_t object = 0; object < touch.size(); ++object) {
    // An object held by the hand contains the tip from the first tick on.
    const auto& motion = plan_.scene->objects[object].body.motion;
    if (motion && motion->grip) continue;
    if (touch.object(object).inside(p_WT)) inside.push_back(plan_.scene->objects[object].name);
  }
  if (inside.empty()) return {};
  return fmt::format(
      "{}{} starts inside {}: its surface is felt only once the tip has been outside.",
      arms() == 1 ? "The tip" : "The tip of the arm ", arms() == 1 ? "" : "\"" + arm_name(i) + "\"",
      fmt::join(inside, ", "));
}

bool Setup::any_real() const noexcept {
  return std::any_of(arms_.begin(), arms_.end(),
                     [](const ArmOfRun& arm) { return arm.real.has_value(); });
}

driver::Result<void> Setup::open(std::size_t i) {
  ArmOfRun& arm = arms_[i];
  std::unique_ptr<driver::ArmLink> link;
  if (arm.real && !arm.open_link) {
    arm.awake = std::make_unique<scene::SleepLock>();
    if (!arm.awake->held()) scene::logger().warn("{}", arm.awake->note());
  }
  if (arm.real) {
    auto opened = arm.open_link ? arm.open_link(arm_file(i), *clock_)
                                : scene::open_link(*arm.real, arm_file(i), plan_.firmware, *clock_);
    if (!opened) return opened.error();
    link = std::move(opened).value();
  } else {
    link = arm.simulation->link(*clock_);
  }
  driver::DeviceSettings settings =
      scene::device_settings(arm_file(i), plan_.scene->rate, arm.energy);
  // A hand moved by a viewer or a program has no tremor, so unchanged counts are no sign of old
  // reports.
  constexpr double kAnyTime = 1e9;  // s
  if (hand_led()) settings.motion.max_hold = kAnyTime;
  settings.hold = plan_.hold;
  driver::HeatSettings& heat = settings.heat;
  if (arm.real && heat.named()) {
    const scene::KnownHeat known = scene::load_heat(arm.real->name(), heat, scene::world_time());
    if (!known.note.empty()) scene::logger().warn("{}", known.note);
    heat.at_start = known.heat;
  }
  auto device = driver::Device::open(
      std::move(link), settings, clock_->now_ns(),
      arm.real ? scene::kReportTimeout_ns : scene::report_timeout_ns(arm_file(i)));
  if (!device) return device.error();
  arm.device = std::move(device).value();
  if (arm.real && heat.named()) {
    arm.heat_keeper = std::make_unique<scene::HeatKeeper>(arm.real->name(), *arm.device);
  }
  return {};
}

driver::Result<void> Setup::open_arm() {
  // The clock starts last, so that the time of the arms starts with that of the session. A real arm
  // requires real time.
  if (!clock_ && plan_.real_time) clock_ = std::make_unique<driver::WallClock>();
  if (!clock_ && plan_.paced) {
    auto clock = std::make_shared<SpeedClock>();
    pace_ = clock.get();
    clock_ = std::move(clock);
  }
  if (!clock_) clock_ = std::make_unique<driver::VirtualClock>();
  for (std::size_t i = 0; i < arms(); ++i) {
    if (auto opened = open(i); !opened) {
      if (arms() == 1) return opened;
      return driver::Error{"The arm \"" + arm_name(i) + "\": " + opened.error().message};
    }
  }
  if (!any_real()) return activate();
  // If another arm is real, a simulated hand starts its path when forces are enabled.
  for (const ArmOfRun& arm : arms_) {
    if (arm.simulation) arm.simulation->hold(true);
  }
  return {};
}

driver::Result<void> Setup::activate() {
  for (std::size_t i = 0; i < arms(); ++i) {
    if (arms_[i].real) {
      const std::string inside = find_start_inside(i, device(i).state().p_WT);
      if (!inside.empty()) scene::logger().warn("{}", inside);
    }
  }
  for (std::size_t i = 0; i < arms(); ++i) {
    if (auto active = device(i).activate(); !active) {
      for (const ArmOfRun& arm : arms_) arm.device->deactivate();
      if (arms() == 1) return active;
      return driver::Error{"The arm \"" + arm_name(i) + "\": " + active.error().message};
    }
    if (any_real() && arms_[i].simulation) arms_[i].simulation->hold(false);
  }
  return {};
}

driver::Result<void> Setup::check_start_pose() const {
  for (std::size_t i = 0; i < arms(); ++i) {
    if (!arms_[i].real) continue;
    const std::string problem =
        start_pose(i).problem(device(i).state().p_WT, !plan_.homed || device(i).home_needed());
    if (problem.empty()) {
      device(i).confirm_home();
      continue;
    }
    return driver::Error{arms() == 1 ? problem : "The arm \"" + arm_name(i) + "\": " + problem};
  }
  return {};
}

Terminal terminal_of(const Setup& setup, std::size_t arm, Terminal terminal) {
  if (setup.arms() == 1) return terminal;
  const std::string name = setup.arm_name(arm) + ": ";
  for (auto* output : {&terminal.print_line, &terminal.ask}) {
    if (!*output) continue;
    *output = [name, whole = *output](const std::string& line) {
      const bool starts_new_line = !line.empty() && line.front() == '\n';
      whole(starts_new_line ? "\n" + name + line.substr(1) : name + line);
    };
  }
  return terminal;
}

std::string Setup::scene_path() const {
  return full_path(plan_.scene_file);
}

RecordingInfo Setup::recording_info(std::size_t arm) const {
  const auto& file = plan_.scene->arms[arm].arm_file;
  return {.scene = plan_.scene->name,
          .scene_file = full_path(plan_.scene_file),
          .scene_text = plan_.built ? plan_.built->text() : scene::text_of(plan_.scene_file),
          .arm = arm_file(arm).name,
          .arm_file = full_path(file),
          .arm_text = scene::text_of(file),
          .device = device_name(arm),
          .clock = plan_.real_time ? "wall" : "virtual",
          .program = scene::program_name(),
          .rate = plan_.scene->rate,
          .seed = plan_.seed + arm,
          .arm_in_scene = arm_name(arm),
          .inside_at_start = fmt::format("{}", fmt::join(inside_at_start(arm), ", ")),
          .options = text_of(plan_.choices),
          .file_hashes = plan_.inputs->text()};
}

}  // namespace thimble::session
