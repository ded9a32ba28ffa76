// The page that plays a touch: it contains the required data of a run, as recorded.
#include <gtest/gtest.h>
#include <zlib.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "observers/body_trace.h"
#include "observers/dent_trace.h"
#include "report/html/light_mesh.h"
#include "report/html/outline_trace.h"
#include "report/html/page.h"
#include "report/html/page_block.h"
#include "report/html/page_marks.h"
#include "report/html/page_rows.h"
#include "report/html/page_scene.h"
#include "support/heap_guard.h"
#include "support/random.h"
#include "support/scratch.h"
#include "text_file.h"
#include "thimble/render/object_touch.h"

namespace thimble::report {
namespace {

using driver::TickRecord;

constexpr std::int64_t kMillisecond = 1'000'000;

// A run in which every plotted value rises and falls, with one extreme tick per value.
std::vector<TickRecord> lively_run(std::size_t count) {
  std::vector<TickRecord> ticks(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double phase = 0.01 * static_cast<double>(i);
    TickRecord& tick = ticks[i];
    tick.tick = i;
    tick.time_ns = tick.due_ns = 5'000'000'000 + static_cast<std::int64_t>(i) * kMillisecond;
    tick.p_WT = {0.03 * std::sin(phase), 0.03 * std::cos(phase), 0.01 * std::sin(3 * phase)};
    tick.p_WP = {tick.p_WT[0], tick.p_WT[1], tick.p_WT[2] + 1e-3};
    tick.v_WT = {0.1 * std::cos(phase), 0, 0};
    tick.in_contact = std::sin(phase) > 0;
    tick.object = tick.in_contact ? 0 : -1;
    tick.depth = tick.in_contact ? 1e-3 * std::sin(phase) : 0;
    tick.f_sent_W = {0, 0.3 * tick.depth / 1e-3, 0.8 * tick.depth / 1e-3};
    tick.f_wanted_W = tick.f_sent_W;
    tick.work_ns = 8000 + static_cast<std::int64_t>(i % 97);
    tick.stage = driver::DeviceStage::kActive;
  }
  return ticks;
}

double size_of(const std::array<double, 3>& v) {
  return std::hypot(v[0], v[1], v[2]);
}

template <class Number>
std::vector<Number> numbers_of(const PageBlock& block, const std::string& name) {
  const auto& array = block.arrays()[name];
  std::vector<Number> numbers(array["count"].get<std::size_t>());
  const auto offset = array["offset"].get<std::size_t>();
  EXPECT_LE(offset + numbers.size() * sizeof(Number), block.bytes().size());
  if (!numbers.empty())
    std::memcpy(numbers.data(), block.bytes().data() + offset, numbers.size() * sizeof(Number));
  return numbers;
}

TEST(PageBlock, WritesBase64AsTheStandardDoes) {
  const auto of = [](const std::string& text) {
    return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  // The test vectors of RFC 4648, section 10.
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foo"), "Zm9v");
  EXPECT_EQ(of("foob"), "Zm9vYg==");
  EXPECT_EQ(of("fooba"), "Zm9vYmE=");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
}

TEST(PageBlock, DeflatedBytesInflateToTheSame) {
  support::Random random(1);
  for (const std::size_t size : {0, 1, 1000, 300'000}) {
    std::vector<std::uint8_t> bytes(size);
    for (std::size_t i = 0; i < size; ++i) {
      bytes[i] = static_cast<std::uint8_t>(i % 3 == 0 ? random.uniform(0, 255)
                                                      : static_cast<double>(i / 100));
    }
    const auto packed = deflated(bytes);
    std::vector<std::uint8_t> again(size + 1);
    uLongf count = again.size();
    ASSERT_EQ(uncompress(again.data(), &count, packed.data(), packed.size()), Z_OK) << size;
    again.resize(count);
    EXPECT_EQ(again, bytes) << size;
    EXPECT_LT(packed.size(), bytes.size() * 9 / 10 + 20) << size;
  }
}

TEST(PageBlock, AlignsEveryArrayForABrowser) {
  PageBlock block;
  block.add("odd", std::vector<std::uint8_t>{1, 2, 3});
  block.add("wide", std::vector<double>{0.1, -1e300});
  block.add("none", std::vector<float>{});
  block.add("short", std::vector<std::int16_t>{-1, 7});
  for (const char* name : {"odd", "wide", "none", "short"}) {
    EXPECT_EQ(block.arrays()[name]["offset"].get<std::size_t>() % 8, 0U) << name;
  }
  EXPECT_EQ(numbers_of<std::uint8_t>(block, "odd"), (std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_EQ(numbers_of<double>(block, "wide"), (std::vector<double>{0.1, -1e300}));
  EXPECT_EQ(numbers_of<float>(block, "none"), std::vector<float>{});
  EXPECT_EQ(numbers_of<std::int16_t>(block, "short"), (std::vector<std::int16_t>{-1, 7}));
}

TEST(PageRows, KeepEveryTickThatFits) {
  const auto ticks = lively_run(1000);
  const auto kept = rows_kept(ticks, 1000);
  ASSERT_EQ(kept.size(), 1000U);
  for (std::size_t i = 0; i < kept.size(); ++i) ASSERT_EQ(kept[i], i);
  EXPECT_TRUE(rows_kept({}, 1000).empty());
}

TEST(PageRows, KeepMinimumAndMaximumOfALongRun) {
  constexpr std::size_t kMax = 2000;
  auto ticks = lively_run(100'000);
  // Single ticks that regular sampling would miss.
  ticks[12'345].f_sent_W = {0, 0, 4.5};
  ticks[23'457].f_wanted_W = {0, 0, 9.5};
  ticks[34'567].depth = 0.02;
  ticks[45'679].time_ns += kMillisecond * 9 / 10;
  ticks[56'789].work_ns = 700'000;
  ticks[67'891].f_sent_W = {0, 0, 0};
  const auto kept = rows_kept(ticks, kMax);
  EXPECT_LE(kept.size(), kMax);
  EXPECT_GE(kept.size(), kMax / 4);
  EXPECT_EQ(kept.front(), 0U);
  EXPECT_EQ(kept.back(), ticks.size() - 1);
  for (std::size_t i = 1; i < kept.size(); ++i) ASSERT_LT(kept[i - 1], kept[i]);
  for (const std::size_t one : {12'345U, 23'457U, 34'567U, 45'679U, 45'680U, 56'789U}) {
    EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), one)) << "tick " << one;
  }
}

TEST(PageRows, KeepMinimumAndMaximumInEveryStretch) {
  // A plot of a few hundred points must show the whole outline of noise.
  constexpr std::size_t kCount = 50'000, kMax = 5500;
  auto ticks = lively_run(kCount);
  support::Random random(7);
  for (TickRecord& tick : ticks) tick.f_sent_W = {0, 0, random.uniform(0.0, 5.0)};
  const auto kept = rows_kept(ticks, kMax);
  constexpr std::size_t kStretch = 1000;  // each contains many rows of the page
  for (std::size_t begin = 0; begin < kCount; begin += kStretch) {
    const auto first = std::lower_bound(kept.begin(), kept.end(), begin);
    const auto last = std::lower_bound(kept.begin(), kept.end(), begin + kStretch);
    double max_force = 0, max_kept = 0;
    for (std::size_t i = begin; i < begin + kStretch; ++i) {
      max_force = std::max(max_force, size_of(ticks[i].f_sent_W));
    }
    for (auto i = first; i != last; ++i) max_kept = std::max(max_kept, size_of(ticks[*i].f_sent_W));
    ASSERT_EQ(max_kept, max_force) << "from tick " << begin;
  }
}

// Ten minutes at rest, with one stroke of ten seconds in contact.
std::vector<TickRecord> one_touch() {
  constexpr std::size_t kTouch = 300'000;
  auto ticks = lively_run(600'000);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    TickRecord& tick = ticks[i];
    const double moved = std::clamp((static_cast<double>(i) - kTouch) * 1e-3, -0.5, 10.5);
    tick.p_WT = tick.p_WP = {0.05 * moved, 0, 0};
    tick.in_contact = i >= kTouch && i < kTouch + 10'000;
    tick.object = tick.in_contact ? 0 : -1;
    tick.depth = tick.in_contact ? 1e-3 : 0;
    tick.f_sent_W = tick.f_wanted_W = {0, 0, tick.in_contact ? 1.0 : 0.0};
  }
  return ticks;
}

TEST(PageRows, KeepEachTickOfATouchInALongRun) {
  const auto ticks = one_touch();
  const auto kept = rows_kept(ticks, kPageRowsMax);
  EXPECT_LE(kept.size(), kPageRowsMax);
  std::size_t touching = 0;
  for (const std::size_t i : kept) touching += ticks[i].in_contact ? 1 : 0;
  EXPECT_EQ(touching, 10'000U);
  for (const std::size_t end : {299'999U, 300'000U, 309'999U, 310'000U}) {
    EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), end)) << end;
  }
}

TEST(PageRows, KeepThePathOfALongRun) {
  const auto ticks = one_touch();
  const auto kept = rows_kept(ticks, kPageRowsMax);
  // The page shows the last row until the next one.
  double off = 0;
  for (std::size_t i = 0, row = 0; i < ticks.size(); ++i) {
    if (row + 1 < kept.size() && kept[row + 1] == i) ++row;
    off = std::max(off, std::abs(ticks[i].p_WT[0] - ticks[kept[row]].p_WT[0]));
  }
  EXPECT_LE(off, 1e-4);
}

TEST(PageRows, AreNearlyAllOfARunJustTooLong) {
  const auto kept = rows_kept(lively_run(61'000), kPageRowsMax);
  EXPECT_LE(kept.size(), kPageRowsMax);
  EXPECT_GE(kept.size(), 59'000U);
}

TEST(PageRows, KnowThePeriodWhereTicksAreMissing) {
  auto ticks = lively_run(1000);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    ticks[i].tick = 2 * i;
    ticks[i].time_ns = static_cast<std::int64_t>(2 * i) * kMillisecond;
  }
  PageBlock block;
  add_rows(block, "arm0.", ticks, rows_kept(ticks, 1000), 0);
  for (const float period : numbers_of<float>(block, "arm0.period")) ASSERT_EQ(period, 1e-3F);
}

TEST(OutlineTrace, KeepsPeaksAndPeriodsOfMillionsOfTicks) {
  constexpr std::size_t kCount = 2'500'000, kPeak = 1'234'567, kLate = 2'000'001;
  OutlineTrace trace(kCount);
  TickRecord tick;
  for (std::size_t i = 0; i < kCount; ++i) {
    tick.tick = i;
    tick.time_ns = static_cast<std::int64_t>(i) * kMillisecond + (i >= kLate ? 300'000 : 0);
    tick.p_WT = {0.03 * std::sin(0.01 * static_cast<double>(i)), 0, 0};
    tick.in_contact = i >= 700'000 && i < 720'000;
    tick.f_sent_W = {0, 0, i == kPeak ? 7.5 : 0.0};
    trace.take(tick);
  }
  trace.finish();
  const auto ticks = trace.ticks();
  EXPECT_LE(ticks.size(), OutlineTrace::kRowsMax);
  double peak = 0;
  std::size_t touching = 0;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    if (i > 0) {
      ASSERT_LT(ticks[i - 1].tick, ticks[i].tick);
      ASSERT_EQ(trace.periods_ns()[i], ticks[i].tick == kLate ? 1'300'000 : kMillisecond);
    }
    peak = std::max(peak, ticks[i].f_sent_W[2]);
    touching += ticks[i].in_contact ? 1 : 0;
  }
  EXPECT_EQ(peak, 7.5);
  EXPECT_EQ(touching, 20'000U);
  EXPECT_EQ(ticks.back().tick, kCount - 1);
  EXPECT_EQ(*std::max_element(trace.periods_ns().begin(), trace.periods_ns().end()), 1'300'000);
}

TEST(PageRows, AreTheRecordedTicks) {
  const auto ticks = lively_run(40'000);
  const auto kept = rows_kept(ticks, 3000);
  PageBlock block;
  add_rows(block, "arm0.", ticks, kept, ticks.front().time_ns);
  const auto time = numbers_of<double>(block, "arm0.t");
  const auto number = numbers_of<std::uint32_t>(block, "arm0.tick");
  const auto tip = numbers_of<float>(block, "arm0.tip");
  const auto sent = numbers_of<float>(block, "arm0.sent");
  const auto depth = numbers_of<float>(block, "arm0.depth");
  const auto period = numbers_of<float>(block, "arm0.period");
  const auto touching = numbers_of<std::uint8_t>(block, "arm0.touching");
  ASSERT_EQ(time.size(), kept.size());
  ASSERT_EQ(tip.size(), 3 * kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const TickRecord& tick = ticks[kept[i]];
    ASSERT_EQ(number[i], tick.tick);
    ASSERT_EQ(time[i], 1e-9 * static_cast<double>(tick.time_ns - ticks[0].time_ns));
    ASSERT_EQ(depth[i], static_cast<float>(tick.depth));
    ASSERT_EQ(touching[i], tick.in_contact ? 1 : 0);
    // The time since the previous tick, which may not be on the page.
    ASSERT_EQ(period[i], 1e-3F);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(tip[3 * i + k], static_cast<float>(tick.p_WT[k]));
      ASSERT_EQ(sent[3 * i + k], static_cast<float>(tick.f_sent_W[k]));
    }
  }
}

render::TriangleMesh wavy_plate(int cells) {
  render::TriangleMesh mesh;
  for (int i = 0; i <= cells; ++i) {
    for (int k = 0; k <= cells; ++k) {
      const double x = 0.1 * i / cells, y = 0.1 * k / cells;
      mesh.vertices.push_back({x, y, 0.01 * std::sin(60 * x) * std::cos(50 * y)});
    }
  }
  for (int i = 0; i < cells; ++i) {
    for (int k = 0; k < cells; ++k) {
      const int a = i * (cells + 1) + k, b = a + cells + 1;
      mesh.triangles.push_back({a, b, a + 1});
      mesh.triangles.push_back({b, b + 1, a + 1});
    }
  }
  return mesh;
}

TEST(LightMesh, HasFewTrianglesAndStaysOnTheSurface) {
  const auto mesh = wavy_plate(400);
  const auto light = light_mesh(mesh, 10'000);
  EXPECT_LE(light.triangles.size(), 10'000U);
  EXPECT_GE(light.triangles.size(), 1000U);
  for (const Eigen::Vector3d& v : light.vertices) {
    ASSERT_NEAR(v.z(), 0.01 * std::sin(60 * v.x()) * std::cos(50 * v.y()), 1e-3);
  }
  EXPECT_EQ(light_mesh(mesh, mesh.triangles.size()).triangles, mesh.triangles);
}

TEST(Page, MinuteAtOneKilohertzIsBelowTenMegabytes) {
  const auto ticks = lively_run(60'001);
  const auto mesh = wavy_plate(400);  // 320,000 triangles
  PageTouch touch;
  touch.rate = 1000;
  touch.scene.vertices = mesh.vertices;
  for (const auto& [a, b, c] : mesh.triangles) {
    touch.scene.triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                                     static_cast<std::uint32_t>(c)});
  }
  touch.scene.objects.push_back({.name = "plate",
                                 .vertex_count = mesh.vertices.size(),
                                 .triangle_count = mesh.triangles.size()});
  touch.arms.emplace_back().ticks = ticks;
  PageBlock block;
  const auto objects = page_objects(touch, block);
  const auto arm = page_arm(touch, 0, block);
  EXPECT_EQ(arm["rows"], 60'001);  // all ticks of the touch
  EXPECT_EQ(objects[0]["triangles"], 320'000);
  EXPECT_LE(objects[0]["drawn"].get<std::size_t>(), kPageTrianglesMax);
  constexpr std::size_t kLibraries = 1'100'000;  // three.js and dygraphs of Debian 12
  EXPECT_LT(base64(block.bytes()).size() + kLibraries, 10'000'000U);
}

/// A triangle with a map of two parts along each side.
session::SharedScene mapped_triangle() {
  session::SharedScene scene;
  scene.vertices = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}};
  scene.triangles = {{0, 1, 2}};
  scene.objects.push_back({.name = "pad", .vertex_count = 3, .triangle_count = 1});
  scene.objects[0].map = {
      .quantity = "stiffness", .unit = "N/m", .min = 250, .max = 800, .parts = 2, .first_value = 1};
  scene.map_values = {0.9F, 0, 0.2F, 0.4F, 0.6F, 0.8F, 1};
  return scene;
}

TEST(Page, HasTheMapOfAnObjectWithItsRange) {
  PageTouch touch;
  touch.scene = mapped_triangle();
  PageBlock block;
  const auto objects = page_objects(touch, block);
  EXPECT_EQ(objects[0]["map"].dump(),
            R"({"quantity":"stiffness","unit":"N/m","min":250.0,"max":800.0,"parts":2})");
  EXPECT_EQ(numbers_of<std::uint8_t>(block, "object0.map"),
            (std::vector<std::uint8_t>{0, 51, 102, 153, 204, 255}));
}

TEST(Page, AnObjectWithoutAMapAddsNothingForIt) {
  PageTouch touch;
  touch.scene = mapped_triangle();
  touch.scene.objects[0].map = {};
  PageBlock block;
  EXPECT_FALSE(page_objects(touch, block)[0].contains("map"));
  EXPECT_FALSE(block.arrays().contains("object0.map"));
}

TEST(PageMarks, ShowFaultsAndTheGateInARecording) {
  auto ticks = lively_run(3000);
  for (std::size_t i = 500; i < 520; ++i) ticks[i].f_sent_W = {0, 0, 0.1};
  for (std::size_t i = 2500; i < 3000; ++i) {
    ticks[i].stage = driver::DeviceStage::kFault;
    ticks[i].fault = driver::Fault::kNoReports;
    ticks[i].f_sent_W = {0, 0, 0};
  }
  const auto marks = marks_of_ticks(ticks, kMillisecond);
  ASSERT_EQ(marks.size(), 3U);
  EXPECT_EQ(marks[0].kind, PageMark::Kind::kNote);  // forces are enabled
  EXPECT_EQ(marks[1].kind, PageMark::Kind::kGate);
  EXPECT_EQ(marks[1].begin_ns, ticks[500].time_ns);
  EXPECT_EQ(marks[1].end_ns, ticks[519].time_ns);
  EXPECT_NE(marks[1].words.find("20 ticks"), std::string::npos) << marks[1].words;
  EXPECT_EQ(marks[2].kind, PageMark::Kind::kFault);
  EXPECT_EQ(marks[2].begin_ns, ticks[2500].time_ns);
}

// Object whose position the test sets.
class Wanderer final : public render::ObjectTouch {
 public:
  driver::ForceCommand update(const driver::DeviceState&) noexcept override { return {}; }
  bool inside(const Eigen::Vector3d&) const noexcept override { return false; }
  render::BodyPose pose() const noexcept override { return {.p_WB = {at, 0, 0}}; }
  double at = 0;
};

TEST(BodyTrace, LongRunFitsWithoutAllocation) {
  std::vector<std::unique_ptr<render::ObjectTouch>> objects;
  auto one = std::make_unique<Wanderer>();
  Wanderer& wanderer = *one;
  objects.push_back(std::move(one));
  const render::SceneTouch touch(std::move(objects));
  const std::size_t moving[] = {0};
  session::BodyTrace trace(touch, moving,
                           1000 * kMillisecond);  // planned for one second, run for a minute
  EXPECT_EQ(support::heap_calls_of([&] {
              TickRecord tick;
              for (std::int64_t i = 0; i < 60'000; ++i) {
                tick.time_ns = i * kMillisecond;
                wanderer.at = 1e-3 * static_cast<double>(i);
                trace.take(tick);
              }
            }),
            0);
  ASSERT_EQ(trace.times_ns().size(), trace.poses().size());
  EXPECT_GT(trace.times_ns().size(), 25U);
  EXPECT_EQ(trace.times_ns().front(), 0);
  EXPECT_GT(trace.times_ns().back(), 57'000 * kMillisecond);
  for (std::size_t i = 0; i < trace.times_ns().size(); ++i) {
    ASSERT_NEAR(trace.poses()[i].p_WB[0], 1e-9 * static_cast<double>(trace.times_ns()[i]), 1e-9);
  }
}

TEST(PageBodies, HaveThePoseOfEachBodyInEachPicture) {
  constexpr std::size_t kBodies = 3;
  std::vector<std::unique_ptr<render::ObjectTouch>> objects;
  std::vector<Wanderer*> wanderers;
  for (std::size_t i = 0; i <= kBodies; ++i) {  // the second one stays
    auto one = std::make_unique<Wanderer>();
    wanderers.push_back(one.get());
    objects.push_back(std::move(one));
  }
  const render::SceneTouch touch(std::move(objects));
  const std::vector<std::size_t> moving = {0, 2, 3};
  session::BodyTrace trace(touch, moving, 1000 * kMillisecond);
  auto ticks = lively_run(100);
  for (TickRecord& tick : ticks) {
    for (std::size_t i = 0; i < wanderers.size(); ++i) {
      wanderers[i]->at = static_cast<double>(i + 1) * (1 + 1e-3 * static_cast<double>(tick.tick));
    }
    trace.take(tick);
  }
  PageTouch page{};
  page.bodies = &trace;
  page.arms.emplace_back();
  page.arms.back().ticks = ticks;
  PageBlock block;
  const auto json = page_bodies(page, block);
  EXPECT_EQ(json["objects"], nlohmann::ordered_json(moving));
  const auto times = numbers_of<double>(block, "bodies.t");
  const auto poses = numbers_of<float>(block, "bodies.poses");
  ASSERT_GT(times.size(), 4U);
  ASSERT_EQ(poses.size(), 7 * kBodies * times.size());
  for (std::size_t picture = 0; picture < times.size(); ++picture) {
    for (std::size_t k = 0; k < kBodies; ++k) {
      const double expected = static_cast<double>(moving[k] + 1) * (1 + times[picture]);
      ASSERT_NEAR(poses[7 * (picture * kBodies + k)], expected, 1e-5) << picture << ", body " << k;
    }
  }
}

TEST(DentTrace, KeepsTheEndOfEveryDentWhenFull) {
  auto drawn = std::make_unique<session::DrawnDent>();
  session::DentTrace trace(*drawn);
  drawn->patch.object = 0;
  drawn->patch.point_count = 30;
  EXPECT_EQ(support::heap_calls_of([&] {
              TickRecord tick;
              for (int i = 0; i < 20'000; ++i) {
                tick.time_ns = i * 16 * kMillisecond;
                // Nine pictures of a growing dent, then one without it.
                drawn->patch.triangle_count = i % 10 == 9 ? 0 : 40;
                drawn->patch.points[29].p = {0, 0, 1e-3 * i};
                ++drawn->drawings;
                trace.take(tick);
                trace.take(tick);  // a tick in which nothing was drawn
              }
            }),
            0);
  const auto frames = trace.frames();
  ASSERT_GT(frames.size(), 1000U);
  EXPECT_LE(trace.points().size(), session::DentTrace::kPointsMax);
  EXPECT_LE(trace.triangles().size(), session::DentTrace::kTrianglesMax);
  std::size_t gone = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const session::DentTrace::Frame& frame = frames[i];
    if (frame.triangles == 0) {
      ++gone;
      ASSERT_EQ(frame.time_ns / kMillisecond / 16 % 10, 9);
      continue;
    }
    // Its points were moved with it when memory was freed.
    const auto number = static_cast<double>(frame.time_ns / kMillisecond / 16);
    ASSERT_NEAR(trace.points()[frame.point + 29][2], 1e-3 * number, 1e-5);
  }
  EXPECT_GE(gone, 500U);
}

// Replaces the contents of Debian's packages.
void write_libraries(const std::filesystem::path& share) {
  const auto write = [&](const std::string& file, const std::string& text) {
    std::filesystem::create_directories((share / file).parent_path());
    std::ofstream(share / file) << text;
  };
  write("javascript/three/three.min.js", "var THREE = '</script>@NUMBERS@';");
  write("doc/libjs-three/copyright", "three's licence <three@example.org>");
  write("javascript/dygraphs/dygraph.min.js", "var Dygraph;");
  write("javascript/dygraphs/dygraph.min.css", ".dygraph-legend {}");
  write("doc/libjs-dygraphs/copyright", "dygraphs' licence");
}

TEST(Page, IsSelfContainedAndEscapesSceneNames) {
  const std::filesystem::path share = support::scratch_folder() / "share";
  const char* before = std::getenv("XDG_DATA_DIRS");
  const std::string kept = before != nullptr ? before : "";
  setenv("XDG_DATA_DIRS", share.c_str(), 1);
  const auto ticks = lively_run(100);
  PageTouch touch;
  touch.title = "</title><script>bad()</script>";
  touch.scene.objects.push_back({.name = "</script><b>\xff"});
  touch.arms.emplace_back().ticks = ticks;
  const std::filesystem::path file = support::scratch_folder() / "page.html";
  const auto missing = write_page(touch, file);
  write_libraries(share);
  const auto written = write_page(touch, file);
  if (kept.empty()) {
    unsetenv("XDG_DATA_DIRS");
  } else {
    setenv("XDG_DATA_DIRS", kept.c_str(), 1);
  }
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().message.find("libjs-three libjs-dygraphs"), std::string::npos);
  ASSERT_TRUE(written.ok()) << written.error().message;
  const std::string page = scene::text_of(file);
  const auto count = [&page](const std::string& text) {
    std::size_t found = 0;
    for (auto at = page.find(text); at != page.npos; at = page.find(text, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("<script>bad()"), 0U);
  EXPECT_EQ(count("</script><b>"), 0U);
  EXPECT_EQ(count("<script"), count("</script>"));
  EXPECT_EQ(count("@NUMBERS@"), 1U);  // from the library, unchanged
  EXPECT_EQ(count("default-src 'none'"), 1U);
  EXPECT_EQ(count("three&#39;s licence &lt;three@example.org&gt;"), 1U);
  EXPECT_EQ(count("http://") + count("https://"), 0U);
}

}  // namespace
}  // namespace thimble::report
