#include "report/html/touch_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "report/html/page.h"
#include "report/html/page_scene.h"
#include "run_records.h"
#include "setup.h"
#include "share/describe_scene.h"
#include "share/shared_run.h"
#include "thimble/scene/build_info.h"

namespace thimble::report {
namespace {

std::vector<PageShape> final_shapes(const scene::Scene& scene, const scene::SceneObjects& objects) {
  std::vector<PageShape> left;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (!scene.objects[i].body.shape.named()) continue;
    left.push_back({.object = i, .mesh = objects.mesh_bent(i)});
  }
  return left;
}

// Makes the trace of permanently deformed objects; null if there are none.
std::unique_ptr<ShapeTrace> trace_shapes(const scene::Scene& scene,
                                         const scene::SceneObjects& objects) {
  std::vector<ShapeTrace::Shaped> shaped;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (!scene.objects[i].body.shape.named()) continue;
    shaped.push_back({.object = i,
                      .shape = objects.touch().object(i).shape(),
                      .vertices = objects.mesh_W(i).vertices.size()});
  }
  if (shaped.empty()) return nullptr;
  return std::make_unique<ShapeTrace>(std::move(shaped));
}

std::vector<ShapeStep> steps_of(ShapeTrace* trace, const session::SharedScene& scene,
                                std::span<const driver::TickRecord> ticks) {
  if (trace == nullptr || ticks.empty()) return {};
  std::vector<render::TriangleMesh> first;
  for (const ShapeTrace::Shaped& one : trace->shaped()) {
    first.push_back(mesh_of(scene, scene.objects[one.object]));
  }
  return trace->steps(std::move(first), ticks.front().time_ns);
}

// Returns the summary of a recording's ticks.
std::vector<Figure> figures_of_ticks(std::span<const driver::TickRecord> ticks,
                                     const session::ReplayComparison& compared) {
  session::RunStatistics sums;
  for (const driver::TickRecord& tick : ticks) sums.take(tick);
  return {{"ticks", static_cast<double>(sums.ticks()), "", ""},
          {"rate", sums.rate(), "Hz", ""},
          {"touch_downs", static_cast<double>(sums.contacts()), "", ""},
          {"force_max", sums.force_max(), "N", ""},
          {"force_rms", sums.force_rms(), "N", ""},
          {"depth_max", 1e3 * sums.depth_max(), "mm", ""},
          {"energy_to_hand", 1e3 * sums.energy_to_hand(), "mJ", ""},
          {"reports_missing", static_cast<double>(sums.missing_reports()), "", ""},
          {"fault_ticks", static_cast<double>(sums.fault_ticks()), "", "== 0"},
          {"forces_differing", static_cast<double>(compared.differing), "", ""}};
}

}  // namespace

RunPage::RunPage(session::Session& session) : session_(session) {
  const session::Setup& setup = session.setup();
  if (const auto moving = setup.objects().moving(); !moving.empty()) {
    const auto duration_ns = static_cast<std::int64_t>(setup.ticks()) * setup.period_ns();
    bodies_ = std::make_unique<session::BodyTrace>(setup.objects().touch(), moving, duration_ns);
    (void)session.add_observer(*bodies_);
  }
  if (const session::DentRecord* now = session.records().dents.get()) {
    dents_ = std::make_unique<session::DentTrace>(now->drawn());
    (void)session.add_observer(*dents_);
  }
  shapes_ = trace_shapes(setup.scene(), setup.objects());
  if (shapes_) (void)session.add_observer(*shapes_);
  for (std::size_t arm = 0; arm < session.arms(); ++arm) {
    events_.push_back(std::make_unique<EventKeeper>(session.device(arm), setup.period_ns()));
    (void)session.add_observer(*events_.back(), arm);
  }
  for (std::size_t arm = 0; session.stride() > 1 && arm < session.arms(); ++arm) {
    outlines_.push_back(std::make_unique<OutlineTrace>(setup.ticks()));
    (void)session.add_observer(*outlines_.back(), arm);
  }
}

void RunPage::finish() {
  for (const auto& outline : outlines_) outline->finish();
}

std::span<const driver::TickRecord> RunPage::ticks(std::size_t arm) const noexcept {
  return outlines_.empty() ? session_.ticks(arm) : outlines_[arm]->ticks();
}

driver::Result<void> RunPage::write(const driver::RealTimeGrant& grant,
                                    const std::filesystem::path& file) {
  finish();
  const session::Setup& setup = session_.setup();
  // The meshes of too many shapes would fill the memory.
  if (auto fits = session::check_object_count(setup.scene().objects.size()); !fits) return fits;
  PageTouch touch{.title = setup.scene().name,
                  .subtitle = setup.scene().description,
                  .program = scene::program_name(),
                  .rate = setup.scene().rate,
                  .virtual_time = !setup.real_time(),
                  .bodies = bodies_.get(),
                  .dents = dents_.get(),
                  .left = final_shapes(setup.scene(), setup.objects())};
  std::vector<std::string> devices;
  for (std::size_t arm = 0; arm < session_.arms(); ++arm) {
    devices.push_back(setup.device_name(arm));
    touch.arms.push_back({.ticks = ticks(arm),
                          .periods_ns = outlines_.empty() ? std::span<const std::int64_t>()
                                                          : outlines_[arm]->periods_ns(),
                          .force_limit = setup.arm_file(arm).limits.force_max,
                          .marks = events_[arm]->finish(),
                          .figures = session::figures_of(session_.figures(grant, arm))});
  }
  touch.scene = session::describe_scene(setup.scene(), setup.objects(), devices);
  touch.shapes = steps_of(shapes_.get(), touch.scene, touch.arms.front().ticks);
  return write_page(touch, file);
}

void ReplayPage::begin(const scene::Scene& scene,
                       std::shared_ptr<const scene::SceneObjects> objects) {
  session::ReplayAnimation::begin(scene, std::move(objects));
  shapes_ = trace_shapes(this->scene(), this->objects());
}

void ReplayPage::take(const driver::TickRecord& tick) {
  session::ReplayAnimation::take(tick);
  if (shapes_) shapes_->take(tick);
}

driver::Result<void> ReplayPage::write(std::span<const session::Replay> replays,
                                       const std::filesystem::path& file) {
  const session::RecordingInfo& info = replays.front().felt.info;
  PageTouch touch{.title = info.scene,
                  .subtitle = scene().description,
                  .program = info.program,
                  .rate = info.rate,
                  .replayed = true,
                  .bodies = bodies(),
                  .dents = dents(),
                  .left = final_shapes(scene(), objects())};
  const auto period_ns = static_cast<std::int64_t>(std::llround(1e9 / info.rate));
  // Recordings come in any order; the page uses the scene's order of arms.
  std::vector<const session::Replay*> order(scene().arms.size(), nullptr);
  for (const session::Replay& replay : replays) order[arm_of(replay.felt.info)] = &replay;
  std::vector<std::string> devices;
  for (std::size_t arm = 0; arm < order.size(); ++arm) {
    const session::Recording& felt = order[arm]->felt;
    devices.push_back(felt.info.device);
    const auto& limits = scene().arms[arm].arm.limits;
    touch.arms.push_back({.ticks = felt.ticks,
                          .force_limit = limits.force_max,
                          .marks = marks_of_ticks(felt.ticks, period_ns),
                          .figures = figures_of_ticks(felt.ticks, order[arm]->compared)});
  }
  touch.scene = session::describe_scene(scene(), objects(), devices);
  touch.shapes = steps_of(shapes_.get(), touch.scene, touch.arms.front().ticks);
  return write_page(touch, file);
}

}  // namespace thimble::report
