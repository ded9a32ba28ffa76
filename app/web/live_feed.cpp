#include "web/live_feed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include "report/html/page.h"
#include "report/html/page_rows.h"
#include "report/html/page_scene.h"
#include "report/json_text.h"
#include "thimble/scene/build_info.h"

namespace thimble::web {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kStepsPerFigures = 10;  // three times a second [chosen: readable]

void fill_up(std::string& bytes, char with) {
  bytes.resize((bytes.size() + 7) / 8 * 8, with);
}

std::string update_of(Json json, const report::PageBlock& block) {
  json["arrays"] = block.arrays();
  std::string text = report::json_text(json);
  fill_up(text, ' ');
  const auto sizes = std::array{static_cast<std::uint32_t>(text.size()),
                                static_cast<std::uint32_t>((block.bytes().size() + 7) / 8 * 8)};
  std::string bytes(sizeof sizes, '\0');
  std::memcpy(bytes.data(), sizes.data(), sizeof sizes);
  bytes += text;
  bytes.append(reinterpret_cast<const char*>(block.bytes().data()), block.bytes().size());
  fill_up(bytes, '\0');
  return bytes;
}

// Adds one dent, in the form of the dents of a stored page (page_dents).
void add_dent(const render::BodyPatch& patch, double t, report::PageBlock& block) {
  const auto points_of =
      static_cast<std::uint16_t>(patch.triangle_count > 0 ? patch.point_count : 0);
  std::vector<float> points;
  std::vector<std::int16_t> normals;
  for (const auto& point : std::span(patch.points).first(points_of)) {
    for (const double one : point.p) points.push_back(static_cast<float>(one));
    for (const float one : point.n) {
      normals.push_back(static_cast<std::int16_t>(32767 * std::clamp(one, -1.0F, 1.0F)));
    }
  }
  std::vector<std::uint16_t> corners;
  std::vector<std::uint32_t> sources;
  for (std::size_t i = 0; i < patch.triangle_count; ++i) {
    corners.insert(corners.end(), patch.triangles[i].begin(), patch.triangles[i].end());
    sources.push_back(static_cast<std::uint32_t>(patch.source[i]));
  }
  block.add("dents.t", std::vector<double>{t});
  block.add("dents.object", std::vector<std::int16_t>{patch.object});
  block.add("dents.first_point", std::vector<std::uint32_t>{0});
  block.add("dents.first_triangle", std::vector<std::uint32_t>{0});
  block.add("dents.points_of", std::vector<std::uint16_t>{points_of});
  block.add("dents.triangles_of", std::vector<std::uint16_t>{patch.triangle_count});
  block.add("dents.points", points);
  block.add("dents.normals", normals);
  block.add("dents.corners", corners);
  block.add("dents.sources", sources);
}

}  // namespace

LiveFeed::LiveFeed(session::SharedReader& reader)
    : reader_(reader),
      draws_all_(report::draws_all(reader.scene())),
      other_ticks_(reader.scene().arms.size() - 1, UINT64_MAX),
      marks_(reader.scene().period_ns),
      statistics_(std::make_unique<session::RunStatistics>()),
      patch_(std::make_unique<render::BodyPatch>()) {
  for (const session::SharedScene::Object& object : reader.scene().objects) {
    const bool shown = object.shaped && draws_all_;
    first_.push_back(shown ? report::mesh_of(reader.scene(), object) : render::TriangleMesh{});
  }
  base_ = meshes_ = first_;
}

std::string LiveFeed::run() const {
  return std::to_string(reader_.scene().began_ns);
}

driver::Result<std::string> LiveFeed::page(std::uint16_t port) const {
  const session::SharedScene& scene = reader_.scene();
  report::PageTouch touch{.title = scene.name,
                          .subtitle = {},
                          .program = scene::program_name(),
                          .rate = 1e9 / static_cast<double>(scene.period_ns),
                          .virtual_time = !scene.wall_clock,
                          .scene = scene};
  for (std::size_t i = 0; i < scene.arms.size(); ++i) {
    touch.arms.emplace_back();
    touch.arms.back().force_limit = scene.force_max;
  }
  const report::PageSource source{.port = port,
                                  .rows = kTicksMax,
                                  .run = run(),
                                  .no_restart = reader_.why_no_restart(),
                                  .no_step = reader_.why_no_step()};
  return report::page_text(touch, &source);
}

void LiveFeed::step() {
  Update update;
  report::PageBlock block;
  const session::SharedReader::Counters counters = reader_.counters();
  Json json{{"state", session::name_of(reader_.state())},
            {"paused", reader_.pause_asked()},
            {"died", reader_.died()},
            {"recording", counters.recording ? reader_.recording_path() : ""},
            {"notice", reader_.notice()},
            {"knobs", Json::array()}};
  for (std::size_t i = 0; i < reader_.scene().knobs.size(); ++i) {
    json["knobs"].push_back(reader_.knob_wanted(i));
  }
  const std::string facts = report::json_text(json);
  take_ticks(json, block, update);
  if (update.ticks == 0 && facts == sent_facts_) return;
  sent_facts_ = facts;
  json["ticks"] = counters.ticks;
  json["missed"] = counters.missed;
  json["lost"] = lost_;
  take_other_arms(json, block);
  take_bodies(json, block);
  take_shapes(json, block, update);
  const bool stands = reader_.state() != session::RunState::kRunning;
  if (stands || until_figures_-- <= 0) add_figures(json);
  update.bytes = update_of(std::move(json), block);
  take_dent(update);
  kept_ticks_ += update.ticks;
  kept_bytes_ += update.bytes.size();
  updates_.push_back(std::move(update));
  while (updates_.size() > 1 && (kept_ticks_ > kTicksMax || kept_bytes_ > kBytesMax)) forget();
}

void LiveFeed::take_ticks(Json& json, report::PageBlock& block, Update& update) {
  if (has_last_) {
    ticks_.front() = ticks_.back();
    ticks_.resize(1);
  }
  lost_ += reader_.ticks_since(serial_, ticks_);
  const std::size_t old = has_last_ ? 1 : 0;
  Json arm{{"rows", ticks_.size() - old}, {"marks", Json::array()}};
  if (ticks_.size() > old) {
    if (!has_begin_) {
      const driver::TickRecord& first = ticks_.front();
      begin_ns_ = first.due_ns - static_cast<std::int64_t>(first.tick) * reader_.scene().period_ns;
      has_begin_ = true;
    }
    const auto fresh = std::span(ticks_).subspan(old);
    for (const driver::TickRecord& tick : fresh) statistics_->take(tick);
    for (const std::uint64_t number : marks_.take(fresh)) {
      if (const report::PageMark* mark = marks_.mark(number)) {
        arm["marks"].push_back({number, report::page_mark(*mark, begin_ns_)});
      }
    }
    std::vector<std::size_t> kept;
    for (std::size_t i = std::max(old, ticks_.size() - std::min(ticks_.size(), kTicksMax));
         i < ticks_.size(); ++i) {
      kept.push_back(i);
    }
    arm["rows"] = kept.size();
    report::add_rows(block, "arm0.", ticks_, kept, begin_ns_);
    report::add_bars(reader_.scene().arms.front(), std::span(ticks_).last(1), begin_ns_, "arm0.",
                     arm, block);
    update.ticks = ticks_.size() - old;
    now_ = 1e-9 * static_cast<double>(ticks_.back().time_ns - begin_ns_);
    has_last_ = true;
  }
  json["arms"] = Json::array({arm});
}

void LiveFeed::take_other_arms(Json& json, report::PageBlock& block) {
  for (std::size_t i = 0; i < other_ticks_.size(); ++i) {
    driver::TickRecord tick;
    Json arm{{"rows", 0}, {"marks", Json::array()}};
    if (has_begin_ && reader_.newest_of(i + 1, tick) && tick.tick != other_ticks_[i]) {
      other_ticks_[i] = tick.tick;
      const std::string prefix = "arm" + std::to_string(i + 1) + ".";
      const std::size_t only = 0;
      report::add_rows(block, prefix, std::span<const driver::TickRecord>(&tick, 1), {&only, 1},
                       begin_ns_);
      report::add_bars(reader_.scene().arms[i + 1], {&tick, 1}, begin_ns_, prefix, arm, block);
      arm["rows"] = 1;
    }
    json["arms"].push_back(std::move(arm));
  }
}

void LiveFeed::take_bodies(Json& json, report::PageBlock& block) {
  session::ScenePoses poses;
  if (!has_begin_ || !reader_.poses(poses) || poses.count == 0) return;
  std::vector<float> numbers;
  std::vector<std::int32_t> objects;
  for (std::size_t i = 0; i < poses.count; ++i) {
    objects.push_back(poses.object[i]);
    for (const double one : poses.pose[i].p_WB) numbers.push_back(static_cast<float>(one));
    for (const double one : poses.pose[i].q_WB) numbers.push_back(static_cast<float>(one));
  }
  block.add("bodies.t", std::vector<double>{now_});
  block.add("bodies.poses", numbers);
  json["bodies"]["objects"] = objects;
}

void LiveFeed::take_shapes(Json& json, report::PageBlock& block, Update& update) {
  const std::uint64_t moves = reader_.shape_moves();
  if (!draws_all_ || moves == shape_moves_) return;
  shape_moves_ = moves;
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    if (!reader_.scene().objects[i].shaped) continue;
    render::TriangleMesh now = meshes_[i];
    reader_.shape(i, now);
    report::ShapeStep step = report::shape_step(meshes_[i], now);
    step.t = now_;
    step.object = i;
    meshes_[i] = std::move(now);
    if (!step.empty()) update.shapes.push_back(std::move(step));
  }
  json["shapes"] = report::page_shapes(update.shapes, block);
}

void LiveFeed::take_dent(Update& update) {
  const std::uint64_t patches = reader_.patch_count();
  if (!draws_all_ || !has_begin_ || patches == patches_) return;
  patches_ = patches;
  if (!reader_.patch(*patch_)) return;
  report::PageBlock block;
  add_dent(*patch_, now_, block);
  const std::string dent = update_of({{"dents", {{"frames", 1}}}}, block);
  update.bytes += dent;
  update.dent = dent.size();
}

void LiveFeed::add_figures(Json& json) {
  until_figures_ = kStepsPerFigures;
  const session::RunStatistics& sums = *statistics_;
  const session::SharedReader::Counters counters = reader_.counters();
  json["figures"] = report::page_figures(std::vector<session::Figure>{
      {"ticks", static_cast<double>(counters.ticks), "", ""},
      {"rate", sums.rate(), "Hz", ""},
      {"ticks_missed", static_cast<double>(counters.missed), "", ""},
      {"touch_downs", static_cast<double>(sums.contacts()), "", ""},
      {"force_max", sums.force_max(), "N", ""},
      {"force_rms", sums.force_rms(), "N", ""},
      {"depth_max", 1e3 * sums.depth_max(), "mm", ""},
      {"energy_to_hand", 1e3 * sums.energy_to_hand(), "mJ", ""},
      {"reports_missing", static_cast<double>(sums.missing_reports()), "", ""},
      {"fault_ticks", static_cast<double>(sums.fault_ticks()), "", "== 0"}});
}

void LiveFeed::forget() {
  Update& update = updates_.front();
  for (const report::ShapeStep& step : update.shapes) {
    render::TriangleMesh& mesh = base_[step.object];
    for (std::size_t i = 0; i < step.vertices.size(); ++i) {
      const std::size_t v = step.vertices[i];
      if (v >= mesh.vertices.size()) mesh.vertices.resize(v + 1);
      mesh.vertices[v] = {step.places[3 * i], step.places[3 * i + 1], step.places[3 * i + 2]};
    }
    for (std::size_t i = 0; i < step.triangles.size(); ++i) {
      const std::size_t t = step.triangles[i];
      if (t >= mesh.triangles.size()) mesh.triangles.resize(t + 1);
      for (std::size_t k = 0; k < 3; ++k) {
        mesh.triangles[t][k] = static_cast<std::int32_t>(step.corners[3 * i + k]);
      }
    }
  }
  if (update.dent > 0) base_dent_ = update.bytes.substr(update.bytes.size() - update.dent);
  kept_ticks_ -= update.ticks;
  kept_bytes_ -= update.bytes.size();
  forgotten_ticks_ += update.ticks;
  updates_.pop_front();
  ++oldest_;
}

std::string LiveFeed::base(std::uint64_t lost) const {
  report::PageBlock block;
  Json json{{"base", true}, {"run", run()}, {"lost_here", lost}};
  std::vector<report::ShapeStep> shapes;
  for (std::size_t i = 0; i < base_.size(); ++i) {
    report::ShapeStep step = report::shape_step(first_[i], base_[i]);
    step.object = i;
    if (!step.empty()) shapes.push_back(std::move(step));
  }
  json["shapes"] = report::page_shapes(shapes, block);
  Json marks = Json::array();
  for (std::uint64_t number = marks_.oldest(); number < marks_.end(); ++number) {
    marks.push_back({number, report::page_mark(*marks_.mark(number), begin_ns_)});
  }
  json["arms"] = Json::array({{{"rows", 0}, {"marks", marks}}});
  return update_of(std::move(json), block) + base_dent_;
}

std::string LiveFeed::message(Place& place) const {
  std::string bytes;
  if (!place.begun || place.next < oldest_) {
    // A page that has received ticks before has lost those before the oldest update.
    bytes = base(place.begun ? forgotten_ticks_ - place.ticks : 0);
    place = {.next = oldest_, .ticks = forgotten_ticks_, .begun = true};
  }
  for (; place.next < end() && bytes.size() < kMessageBytes; ++place.next) {
    const Update& update = updates_[place.next - oldest_];
    bytes += update.bytes;
    place.ticks += update.ticks;
  }
  return bytes;
}

}  // namespace thimble::web
