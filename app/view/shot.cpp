#include "view/shot.h"

#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "setup.h"
#include "share/shared_run.h"
#include "view/overlays/legend.h"
#include "view/overlays/tip_trail.h"

namespace thimble::view {
namespace {

/// An observer that sees a run tick by tick, on its virtual clock.
class Watcher final : public session::TickObserver {
 public:
  explicit Watcher(std::function<void(const driver::TickRecord&)> look) : look_(std::move(look)) {}
  void take(const driver::TickRecord& record) noexcept override { look_(record); }

 private:
  std::function<void(const driver::TickRecord&)> look_;
};

/// Runs a session that has not begun; `look` is its last observer.
void watch(session::Session& session, std::function<void(const driver::TickRecord&)> look) {
  Watcher watcher(std::move(look));
  if (session.add_observer(watcher)) session.run();
}

/// Returns the scale of text, whose sizes are chosen for a picture of this height.
float scale_of(int height) {
  return std::clamp(static_cast<float>(height) / 640, 0.7F, 4.0F);
}

int strip_of(const ShotChoice& choice) {
  return choice.plots ? static_cast<int>(0.24 * choice.height) : 0;
}

}  // namespace

driver::Result<std::unique_ptr<PlayedScene>> PlayedScene::open(
    const std::filesystem::path& scene, const session::SessionOptions& options) {
  session::SessionOptions shared = options;
  shared.clock = session::ClockKind::kVirtual;
  shared.share = true;
  auto session = session::Session::open(scene, shared);
  if (!session) return session.error();
  std::unique_ptr<PlayedScene> played(new PlayedScene);
  played->session_ = std::move(session).value();
  auto memory = played->session_->shared()->memory().again();
  if (!memory) return memory.error();
  auto reader = session::SharedReader::over(std::move(memory).value());
  if (!reader) return reader.error();
  played->reader_ = std::move(reader).value();
  played->live_ = std::make_unique<LiveScene>(*played->reader_);
  return played;
}

void PlayedScene::play(const std::vector<double>& times, const Look& look) {
  const std::int64_t period_ns = session_->setup().period_ns();
  const std::uint64_t last = session_->setup().ticks() - 1;
  std::vector<std::uint64_t> ticks;
  for (const double time : times) {
    const std::int64_t time_ns = std::max<std::int64_t>(0, std::llround(1e9 * time));
    ticks.push_back(std::min(static_cast<std::uint64_t>(time_ns / period_ns), last));
  }
  const auto moment = std::make_unique<DrawnMoment>();
  Plots plots;
  TipTrail trail;
  std::size_t next = 0;
  watch(*session_, [&](const driver::TickRecord& record) {
    plots.add(record);
    trail.add(record);
    while (next < ticks.size() && record.tick >= ticks[next]) {
      if (live_->update(*moment)) {
        trail.copy_to(moment->trail);
        look(*moment, plots);
      }
      ++next;
    }
  });
  (void)session_->end_recording();  // a reader of the file detects what it lacks
}

driver::Result<double> strongest_moment(const std::filesystem::path& scene,
                                        const session::SessionOptions& options) {
  auto session = session::Session::open(scene, options);
  if (!session) return session.error();
  const auto period_ns = static_cast<double>((*session)->setup().period_ns());
  const double duration = static_cast<double>((*session)->setup().ticks()) * period_ns * 1e-9;
  double most = 0.05;  // N: weaker forces are hardly felt
  double time = duration / 2;
  watch(**session, [&](const driver::TickRecord& record) {
    const auto& f = record.f_sent_W;
    const double force = std::hypot(f[0], f[1], f[2]);
    if (!(force > most)) return;
    most = force;
    time = static_cast<double>(record.tick) * period_ns * 1e-9;
  });
  return time;
}

ShotPainter::ShotPainter(const DrawnScene& scene, const ShotChoice& choice, ScenePrograms programs)
    : choice_(choice),
      painter_(scene, std::move(programs)),
      canvas_(choice.width, choice.height, strip_of(choice)),
      text_(std::make_unique<PictureText>(scale_of(choice.height), choice.paint.theme)),
      scale_(scale_of(choice.height)) {}

ShotPainter::~ShotPainter() = default;

void ShotPainter::frame_at(const DrawnMoment& moment) {
  if (!choice_.camera) choice_.camera = frame(painter_.scene(), moment, canvas_.aspect());
}

Picture ShotPainter::paint(const DrawnMoment& moment, const Plots& plots) {
  frame_at(moment);
  const auto labels = painter_.paint(moment, *choice_.camera, choice_.paint, canvas_);
  glViewport(0, 0, canvas_.width(), canvas_.height());
  text_->begin(canvas_.width(), canvas_.height());
  const auto width = static_cast<float>(canvas_.width());
  const auto strip = static_cast<float>(canvas_.strip());
  const ScreenPart scene{0, 0, width, static_cast<float>(canvas_.height()) - strip};
  const Theme theme = choice_.paint.theme;
  write_labels(labels, *choice_.camera, theme, scene);
  if (choice_.caption) {
    write_legend(legend_of(painter_.scene(), moment, choice_.paint), theme, scene);
  }
  if (choice_.caption) {
    const std::string text = fmt::format("{}, {:.2f} s{}", painter_.scene().name,
                                         static_cast<double>(moment.tick.time_ns) * 1e-9,
                                         choice_.paint.grid ? "; grid 10 mm" : "");
    write_caption(text, theme, scene);
  }
  if (canvas_.strip() > 0) {
    const float pad = 14 * scale_;
    const float half = (width - 3 * pad) / 2;
    fill_part({0, scene.height, width, strip}, colours_of(theme).ground);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ScreenPart left{pad, scene.height + pad / 2, half, strip - pad};
    const ScreenPart right{2 * pad + half, left.y, half, left.height};
    const TimeRange shown = plots.whole_run(painter_.scene().duration).value_or(plots.newest());
    plots.draw(list, left, Channel::kForce, shown, {});
    plots.draw(list, right, Channel::kDepth, shown, {});
  }
  text_->end();
  return canvas_.read();
}

}  // namespace thimble::view
