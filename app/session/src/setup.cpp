#include "setup.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "log/logger.h"
#include "scene_poses.h"
#include "text_file.h"
#include "thimble/scene/build_info.h"
#include "thimble/scene/device_settings.h"
#include "thimble/scene/hand_route.h"
#include "thimble/scene/real_arm.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::session {
namespace {

std::string full_path(const std::filesystem::path& file) {
  return std::filesystem::absolute(file).lexically_normal().string();
}

}  // namespace

driver::Result<std::unique_ptr<Setup>> Setup::prepare(const std::filesystem::path& scene,
                                                      const SessionOptions& options) {
  if (options.real_arm && !options.terms) {
    return driver::Error{"A real arm is used on terms only (terms_for)."};
  }
  auto found = scene::find_scene(scene.string());
  if (!found) return found.error();
  std::unique_ptr<Setup> setup(new Setup);
  setup->scene_file_ = std::move(found).value();
  setup->real_arm_ = options.real_arm;
  setup->firmware_ = options.firmware;
  setup->open_link_ = options.open_link;
  setup->device_name_ = options.real_arm ? options.real_arm->name() : "sim";
  setup->hand_by_mouse_ = options.hand_by_mouse;
  setup->homed_ = options.homed;
  setup->endless_ = options.endless;
  setup->real_time_ = options.clock == ClockKind::kWall || options.real_arm.has_value();
  if (!setup->real_time_) setup->clock_ = options.own_clock;
  if (auto read = setup->read(options); !read) return read.error();

  auto objects = scene::SceneObjects::build(setup->scene_);
  if (!objects) return objects.error();
  setup->objects_ = std::move(objects).value();
  const std::vector<std::string>& notes = setup->objects_->notes();
  setup->told_.insert(setup->told_.end(), notes.begin(), notes.end());
  if (setup->objects_->moving().size() > ScenePoses::kMost) {
    return driver::Error{fmt::format("{}: at most {} objects may move.",
                                     setup->scene_file_.string(), ScenePoses::kMost)};
  }
  if (!options.real_arm) {
    if (auto simulated = setup->simulate_arm(); !simulated) return simulated.error();
  }
  if (setup->real_time_) setup->objects_->start_loaders();
  return setup;
}

driver::Result<void> Setup::read(const SessionOptions& options) {
  auto scene = scene::load_scene(
      scene_file_, {.arm = options.real_arm ? options.terms->arm.path : options.arm_file,
                    .mesh_folder = options.mesh_folder,
                    .rate_factor = options.real_arm ? 1 : options.rate_factor});
  if (!scene) return scene.error();
  scene_ = std::move(scene).value();
  if (options.adjust) options.adjust(scene_);
  if (options.real_arm) {
    start_pose_ = StartPose::of(scene_.arm, options.real_arm->kind);
    auto told = scene::put_on_terms(scene_, scene_file_, *options.terms);
    if (!told) return told.error();
    told_ = std::move(told).value();
    feel_check_ = options.terms->feel_check;
  }
  seed_ = options.seed.value_or(scene_.seed);
  period_ns_ = std::llround(1e9 / scene_.rate);
  const double duration = options.duration.value_or(scene_.duration);
  // Led by a person, or by another program, it goes on until he has enough, unless he says how
  // long.
  if ((!options.hand_by_mouse && !options.endless) || options.duration) {
    ticks_ =
        static_cast<std::uint64_t>(std::ceil(duration * 1e9 / static_cast<double>(period_ns_)));
  }
  return {};
}

driver::Result<void> Setup::simulate_arm() {
  std::vector<render::TriangleMesh> meshes_W;
  for (std::size_t i = 0; i < scene_.objects.size(); ++i) meshes_W.push_back(objects_->mesh_W(i));
  std::vector<scene::NamedMesh> named;
  for (std::size_t i = 0; i < meshes_W.size(); ++i) {
    const scene::SceneObject& object = scene_.objects[i];
    if (!object.build_field && !object.paged) named.push_back({object.name, &meshes_W[i]});
  }
  const auto in_file = [](const std::filesystem::path& file, const driver::Error& error) {
    return driver::Error{file.string() + ": " + error.message};
  };
  auto route = scene::plan_hand(scene_.hand, named);
  if (!route) return in_file(scene_file_, route.error());
  if (auto reach = scene::check_reach(scene_.arm, *route); !reach) {
    return in_file(scene_file_, reach.error());
  }
  if (hand_by_mouse_) route->resize(1);  // waits where the planned path begins
  auto simulation = scene::ArmSimulation::make(scene_.arm, *route, firmware_, seed_);
  if (!simulation) return in_file(scene_.arm_file, simulation.error());
  simulation_ = std::move(simulation).value();
  return {};
}

driver::Result<void> Setup::open_arm() {
  const scene::ArmFile& arm = scene_.arm;
  // The clock starts last, so that the arm's time begins with the session's. A real arm knows only
  // the time of the world.
  if (real_time_) {
    clock_ = std::make_unique<driver::WallClock>();
  } else if (!clock_) {
    clock_ = std::make_unique<driver::VirtualClock>();
  }
  std::unique_ptr<driver::ArmLink> link;
  if (real_arm_) {
    auto opened = open_link_ ? open_link_(arm, *clock_)
                             : scene::open_link(*real_arm_, arm, firmware_, *clock_);
    if (!opened) return opened.error();
    link = std::move(opened).value();
  } else {
    link = simulation_->link(*clock_);
  }
  driver::DeviceSettings settings = scene::device_settings(arm, scene_.rate, scene_.energy);
  // A simulated hand that a mouse holds has no tremor, and its arm sends no old positions.
  constexpr double kAnyTime = 1e9;  // s
  if (hand_by_mouse_) settings.motion.hold_most = kAnyTime;
  driver::HeatSettings& heat = settings.heat;
  if (real_arm_ && heat.named()) {
    const scene::KnownHeat known = scene::load_heat(real_arm_->name(), heat, scene::world_time());
    if (!known.note.empty()) scene::logger().warn("{}", known.note);
    heat.at_start = known.heat;
  }
  auto device = driver::Device::open(std::move(link), settings, clock_->now_ns());
  if (!device) return device.error();
  device_ = std::move(device).value();
  if (!real_arm_) return device_->activate();
  if (heat.named()) {
    heat_keeper_ = std::make_unique<scene::HeatKeeper>(real_arm_->name(), *device_);
  }
  return {};
}

driver::Result<void> Setup::check_start_pose() const {
  if (!real_arm_) return {};
  const std::string trouble = start_pose_->trouble(device_->state().p_WT, !homed_);
  if (!trouble.empty()) return driver::Error{trouble};
  return {};
}

std::string Setup::scene_path() const {
  return full_path(scene_file_);
}

RecordingInfo Setup::recording_info() const {
  return {.scene = scene_.name,
          .scene_file = full_path(scene_file_),
          .scene_text = scene::text_of(scene_file_),
          .arm = scene_.arm.name,
          .arm_file = full_path(scene_.arm_file),
          .arm_text = scene::text_of(scene_.arm_file),
          .device = device_name_,
          .clock = real_time_ ? "wall" : "virtual",
          .program = scene::program_name(),
          .rate = scene_.rate,
          .seed = seed_};
}

}  // namespace thimble::session
