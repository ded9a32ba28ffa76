#include "session.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "build_info.h"
#include "calibration.h"
#include "hand_route.h"
#include "real_arm.h"
#include "thimble/render/body/move_object.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/mesh/load_mesh.h"
#include "thimble/render/mesh/orient_mesh.h"

namespace thimble::app {
namespace {

/// Finds the first point of the hand's way that the arm cannot reach.
driver::Result<void> check_reach(const HandRoute& route, const ArmFile& arm) {
  for (const auto& [time, p_WH] : route) {
    const bool in_box = (p_WH.array() >= arm.workspace.min_W.array()).all() &&
                        (p_WH.array() <= arm.workspace.max_W.array()).all();
    if (!in_box || !joint_angles_at(arm, p_WH)) {
      char text[200];
      std::snprintf(text, sizeof text,
                    "At %.3f s the hand would be at (%.3f, %.3f, %.3f) m, outside the arm's "
                    "workspace; move that waypoint or the object.",
                    time, p_WH.x(), p_WH.y(), p_WH.z());
      return driver::Error{text};
    }
  }
  return {};
}

/// Reads the mesh of every object and puts it into the world (m); a shape has one to be drawn, a
/// field and a mesh on the disk an empty one.
driver::Result<std::vector<render::TriangleMesh>> load_meshes(const Scene& scene) {
  std::vector<render::TriangleMesh> meshes;
  for (const SceneObject& object : scene.objects) {
    if (object.shape || object.build_field || object.paged) {
      meshes.push_back(object.shape ? object.shape->mesh_W : render::TriangleMesh());
      continue;
    }
    const auto mesh = render::load_mesh(object.mesh_file);
    if (!mesh) return mesh.error();
    meshes.push_back(place_mesh(*mesh, object));
    // What plans and draws must know the same outside as what touches.
    render::orient_mesh(meshes.back());
  }
  return meshes;
}

using Touched = driver::Result<std::unique_ptr<render::ObjectTouch>>;

/// Says which object a sentence is about.
std::string name_of(const SceneObject& object) {
  return object.mesh_file.empty() ? object.name : object.mesh_file.string();
}

/// Builds the force law that the scene calls for.
driver::Result<std::unique_ptr<render::SceneTouch>> build_touch(
    const Scene& scene, const std::vector<render::TriangleMesh>& meshes_W,
    std::vector<std::shared_ptr<render::PagedSurface>>& pages) {
  std::vector<std::unique_ptr<render::ObjectTouch>> objects;
  for (std::size_t i = 0; i < meshes_W.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const render::SurfaceChoice surface{
        .spring = {.stiffness = object.stiffness, .damping = object.damping},
        .effects = object.effects,
        .dent = object.body.dent,
        .shape = object.body.shape};
    if (object.build_field) {
      objects.push_back(object.build_field());
      continue;
    }
    if (object.paged) {
      auto opened = render::PagedSurface::open(object.mesh_file);
      if (!opened) return opened.error();
      pages.emplace_back(std::move(opened).value());
      const render::PagedPlace place = place_pages(pages.back()->file(), object);
      objects.push_back(render::build_paged_touch(pages.back(), place, surface));
      continue;
    }
    auto touch = object.shape
                     ? Touched(render::build_primitive_touch(object.shape->shape_W, surface))
                     : render::build_object_touch(meshes_W[i], object.contact, surface);
    if (touch && object.body.motion) {
      touch = render::move_object(std::move(touch).value(), meshes_W[i], *object.body.motion,
                                  object.coupling);
    }
    if (!touch) return driver::Error{name_of(object) + ": " + touch.error().message};
    objects.push_back(std::move(touch).value());
  }
  return std::make_unique<render::SceneTouch>(std::move(objects));
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Adds the triangles of one mesh to another.
void append(const render::TriangleMesh& mesh, render::TriangleMesh& whole) {
  const auto first = static_cast<std::int32_t>(whole.vertices.size());
  whole.vertices.insert(whole.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const auto& [a, b, c] : mesh.triangles) {
    whole.triangles.push_back({first + a, first + b, first + c});
  }
}

}  // namespace

driver::Result<std::unique_ptr<Session>> Session::open(const std::filesystem::path& scene_file,
                                                       const SessionOptions& options) {
  auto scene = read_scene(scene_file, options.mesh_folder, options.arm_file);
  if (!scene) return scene.error();

  std::unique_ptr<Session> session(new Session);
  session->scene_ = std::move(scene).value();
  if (options.real_arm) {
    const auto calibration = load_calibration(options.real_arm->name());
    if (!calibration) return calibration.error();
    if (*calibration) apply(**calibration, session->scene_.arm);
  }
  const ArmFile& arm = session->scene_.arm;

  auto meshes = load_meshes(session->scene_);
  if (!meshes) return meshes.error();
  auto touch = build_touch(session->scene_, *meshes, session->pages_);
  if (!touch) return touch.error();
  session->touch_ = std::move(touch).value();

  for (std::size_t i = 0; i < meshes->size(); ++i) {
    if (!session->scene_.objects[i].shape) session->triangles_ += (*meshes)[i].triangles.size();
    session->places_.push_back(
        {session->mesh_W_.vertices.size(), session->mesh_W_.triangles.size()});
    append((*meshes)[i], session->mesh_W_);
    if (session->scene_.objects[i].body.motion) session->moving_.push_back(i);
  }
  session->places_.push_back({session->mesh_W_.vertices.size(), session->mesh_W_.triangles.size()});
  if (session->moving_.size() > ScenePoses::kMost) {
    return driver::Error{scene_file.string() + ": at most " + std::to_string(ScenePoses::kMost) +
                         " objects may move."};
  }
  for (const auto& pages : session->pages_) {
    session->triangles_ += static_cast<std::size_t>(pages->triangle_count());
  }
  session->seed_ = options.seed.value_or(session->scene_.seed);
  session->period_ns_ = std::llround(1e9 / session->scene_.rate);
  const double duration = options.duration.value_or(session->scene_.duration);
  session->ticks_ = static_cast<std::uint64_t>(
      std::ceil(duration * 1e9 / static_cast<double>(session->period_ns_)));
  session->statistics_ = std::make_unique<RunStatistics>();
  session->trace_ = std::make_unique<Trace>(session->ticks_);
  const auto dents = [](const SceneObject& object) { return object.body.dent.has_value(); };
  if (std::any_of(session->scene_.objects.begin(), session->scene_.objects.end(), dents)) {
    session->dents_ = std::make_unique<DentRecord>(session->period_ns_);
  }

  if (!options.real_arm) {
    if (auto planned = session->plan_simulation(scene_file, *meshes, options.firmware); !planned) {
      return planned.error();
    }
  }
  // The clock starts last, so that the arm's time begins with the session's. A real arm knows only
  // the time of the world.
  if (options.clock == ClockKind::kWall || options.real_arm) {
    session->clock_ = std::make_unique<driver::WallClock>();
  } else {
    session->clock_ = std::make_unique<driver::VirtualClock>();
  }
  std::unique_ptr<driver::Transport> wire;
  std::unique_ptr<const driver::Arm> protocol;
  if (options.real_arm) {
    auto opened = open_wire(*options.real_arm, arm, options.firmware, *session->clock_);
    if (!opened) return opened.error();
    wire = std::move(opened).value();
    protocol = make_arm(arm, options.real_arm->kind);
  } else {
    wire = session->simulation_->wire(*session->clock_);
    protocol = session->simulation_->protocol();
  }
  auto device = driver::Device::open(std::move(wire), std::move(protocol),
                                     {.R_WB = arm.R_WB,
                                      .p_WB = arm.p_WB,
                                      .limits = arm.limits,
                                      .velocity_corner_frequency = arm.velocity_corner_frequency},
                                     session->clock_->now_ns());
  if (!device) return device.error();
  session->device_ = std::move(device).value();
  if (auto activated = session->device_->activate(); !activated) return activated.error();
  session->by_thread_ = options.clock == ClockKind::kWall || options.real_arm.has_value();
  if (session->by_thread_) {
    for (const auto& pages : session->pages_) pages->start_loader();
  }
  session->scene_file_ = scene_file;
  session->device_name_ = options.real_arm ? options.real_arm->name() : "sim";
  session->black_box_ = std::make_unique<BlackBox>(session->scene_.rate);
  if (!options.record.empty()) {
    auto recorder = Recorder::open(options.record, session->recording_info(), session->ticks_);
    if (!recorder) return recorder.error();
    session->recorder_ = std::move(recorder).value();
    if (session->by_thread_) session->recorder_->start_thread();
  }
  return session;
}

RecordingInfo Session::recording_info() const {
  const BuildInfo build = build_info();
  std::string program = "thimble";
  for (const std::string_view part : {build.version, build.revision, build.type, build.compiler}) {
    if (!part.empty()) program.append(" ").append(part);
  }
  return {.scene = scene_.name,
          .scene_file = std::filesystem::absolute(scene_file_).lexically_normal().string(),
          .scene_text = text_of(scene_file_),
          .arm = scene_.arm.name,
          .arm_file = std::filesystem::absolute(scene_.arm_file).lexically_normal().string(),
          .arm_text = text_of(scene_.arm_file),
          .device = device_name_,
          .clock = by_thread_ ? "wall" : "virtual",
          .program = program,
          .rate = scene_.rate,
          .seed = seed_};
}

driver::Result<void> Session::plan_simulation(const std::filesystem::path& scene_file,
                                              const std::vector<render::TriangleMesh>& meshes_W,
                                              const std::filesystem::path& firmware) {
  const ArmFile& arm = scene_.arm;
  std::vector<NamedMesh> named;
  for (std::size_t i = 0; i < meshes_W.size(); ++i) {
    const SceneObject& object = scene_.objects[i];
    if (!object.build_field && !object.paged) named.push_back({object.name, &meshes_W[i]});
  }
  const auto route = plan_hand(scene_.hand, named);
  if (!route) return driver::Error{scene_file.string() + ": " + route.error().message};
  if (auto reach = check_reach(*route, arm); !reach) {
    return driver::Error{scene_file.string() + ": " + reach.error().message};
  }
  auto simulation = ArmSimulation::make(arm, *route, firmware, seed_);
  if (!simulation)
    return driver::Error{scene_.arm_file.string() + ": " + simulation.error().message};
  simulation_ = std::move(simulation).value();
  return {};
}

driver::ServoEnd Session::run(const std::atomic<bool>& stop) noexcept {
  const driver::ServoEnd end = driver::run_servo(
      *device_, *clock_, driver::ForceLaw(*touch_), driver::TickSink(*this),
      {.period_ns = period_ns_, .ticks = ticks_, .outlive_faults = !simulation_}, stop);
  if (simulation_) simulation_->settle(clock_->now_ns());
  return end;
}

void Session::operator()(const driver::TickRecord& record) noexcept {
  snapshot_.store(record);
  (*statistics_)(record);
  (*trace_)(record);
  (*black_box_)(record);
  if (dents_) dents_->take(record, *touch_);
  if (!moving_.empty()) store_poses(record.tick);
  if (recorder_) (*recorder_)(record);
  if (by_thread_) return;
  // In virtual time a tick lasts as long as it computes: the disk is as fast as one could wish, and
  // every run is the same.
  for (const auto& pages : pages_) {
    while (pages->serve() > 0) {
    }
  }
  if (recorder_ && recorder_->waiting() >= Recorder::kRingTicks / 2) recorder_->serve();
}

render::TriangleMesh Session::bent_mesh_W() const {
  if (!dents_ || dents_->deepest().triangle_count == 0) return mesh_W_;
  const render::BodyPatch& patch = dents_->deepest();
  return bent(mesh_W_, places_[static_cast<std::size_t>(patch.object)], patch);
}

void Session::store_poses(std::uint64_t tick) noexcept {
  poses_now_.tick = tick;
  poses_now_.count = static_cast<std::uint32_t>(moving_.size());
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    poses_now_.object[i] = static_cast<std::int32_t>(moving_[i]);
    poses_now_.pose[i] = touch_->object(moving_[i]).pose();
  }
  poses_.store(poses_now_);
}

render::TriangleMesh Session::mesh_now(int object) const {
  render::TriangleMesh mesh = mesh_W_;
  for (std::size_t i = 0; i < touch_->size(); ++i) {
    const std::size_t begin = places_[i].vertex;
    touch_->object(i).place_now(
        std::span(mesh.vertices).subspan(begin, places_[i + 1].vertex - begin));
  }
  if (object < 0) return mesh;
  const auto& [v, t] = places_[static_cast<std::size_t>(object)];
  const auto& [v_end, t_end] = places_[static_cast<std::size_t>(object) + 1];
  const auto at = [](auto& list, std::size_t i) {
    return list.begin() + static_cast<std::ptrdiff_t>(i);
  };
  render::TriangleMesh one;
  one.vertices.assign(at(mesh.vertices, v), at(mesh.vertices, v_end));
  one.triangles.assign(at(mesh.triangles, t), at(mesh.triangles, t_end));
  for (auto& triangle : one.triangles) {
    for (std::int32_t& vertex : triangle) vertex -= static_cast<std::int32_t>(v);
  }
  return one;
}

std::optional<render::PagingCounters> Session::paging() const {
  if (pages_.empty()) return {};
  render::PagingCounters sum;
  for (const auto& pages : pages_) {
    const render::PagingCounters one = pages->counters();
    sum.loads += one.loads;
    sum.evictions += one.evictions;
    sum.failures += one.failures;
    sum.misses += one.misses;
    sum.short_of_frames += one.short_of_frames;
  }
  return sum;
}

}  // namespace thimble::app
