// Many runs of one scene in a batch: each is bit-identical to a single run.
#include "thimble/session/session_batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "setup.h"
#include "support/heap_guard.h"
#include "support/run_hash.h"
#include "thimble/session/run_statistics.h"

namespace thimble {
namespace {

using Eigen::Vector3d;
using session::Session;
using session::SessionBatch;

class SessionBatchTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::current_path(THIMBLE_SOURCE_DIR); }

  static std::unique_ptr<SessionBatch> open(const std::string& scene, std::size_t count,
                                            const session::SessionOptions& options = {
                                                .keep = session::Keep::kNewest}) {
    auto opened = SessionBatch::open(scene, count, options);
    if (!opened) {
      ADD_FAILURE() << opened.error().message;
      return nullptr;
    }
    return std::move(opened).value();
  }
  static std::unique_ptr<Session> alone(const std::string& scene, std::uint64_t seed,
                                        std::optional<double> duration = {}) {
    return Session::open(scene, {.duration = duration, .seed = seed}).value();
  }
  static std::uint64_t hash_of(const driver::TickRecord& row) {
    support::RunHash hash;
    hash.add(row);
    return hash.value();
  }
};

TEST_F(SessionBatchTest, EachRunIsBitIdenticalToASingleRun) {
  // A shape, a mesh with friction, a body that moves.
  for (const char* scene : {"rubber", "clay", "floating_block"}) {
    constexpr std::size_t kRuns = 3;
    const auto batch = open(scene, kRuns, {.seed = 7, .keep = session::Keep::kNewest});
    std::vector<std::unique_ptr<Session>> singles;
    for (std::size_t i = 0; i < kRuns; ++i) singles.push_back(alone(scene, 7 + i));
    bool touched = false;
    for (const std::uint32_t ticks : {1U, 700U, 13U, 1U, 400U, 500U, 400U}) {
      batch->step(ticks);
      touched = touched || batch->newest()[0].in_contact;
      for (std::size_t i = 0; i < kRuns; ++i) {
        for (std::uint32_t k = 0; k < ticks; ++k) singles[i]->step();
        EXPECT_EQ(hash_of(batch->newest()[i]), hash_of(singles[i]->ticks().back())) << scene << i;
      }
    }
    EXPECT_TRUE(touched) << scene;
    EXPECT_NE(hash_of(batch->newest()[0]), hash_of(batch->newest()[1])) << "seeds of their own";
    EXPECT_EQ(batch->run(0).setup().objects().shared_mesh_W(0),
              batch->run(2).setup().objects().shared_mesh_W(0));
  }
}

TEST_F(SessionBatchTest, MovesEachHandToItsPoint) {
  constexpr std::size_t kRuns = 3;
  const auto batch = open("rubber", kRuns, {.seed = 1, .keep = session::Keep::kNewest});
  const std::array<Vector3d, kRuns> there{Vector3d(0, 0, 0.0), Vector3d(0.1, 0.1, 0.1),
                                          Vector3d(0.01, 0, 0.02)};
  std::array<std::uint8_t, kRuns> reached{9, 9, 9};
  const std::array<std::uint32_t, kRuns> ticks{400, 400, 0};
  batch->step(ticks, there, reached);
  EXPECT_EQ(reached, (std::array<std::uint8_t, kRuns>{1, 0, 1}));
  for (std::size_t i = 0; i < kRuns; ++i) {
    const auto single = alone("rubber", 1 + i);
    if (ticks[i] > 0) {
      EXPECT_EQ(single->lead_hand(there[i]), reached[i] == 1);
    }
    for (std::uint32_t k = 0; k < ticks[i]; ++k) single->step();
    const driver::TickRecord expected =
        ticks[i] > 0 ? single->ticks().back() : driver::TickRecord();
    EXPECT_EQ(hash_of(batch->newest()[i]), hash_of(expected)) << i;
  }
}

TEST_F(SessionBatchTest, RestartedRunFollowsItsSeed) {
  const auto batch = open("rubber", 2, {.seed = 3, .keep = session::Keep::kNewest});
  batch->step(300);
  ASSERT_TRUE(batch->restart(0, 4));
  EXPECT_EQ(batch->newest()[0].tick, driver::TickRecord().tick);
  batch->step(300);
  const auto first = alone("rubber", 4), second = alone("rubber", 4);
  for (int k = 0; k < 300; ++k) first->step();
  for (int k = 0; k < 600; ++k) second->step();
  EXPECT_EQ(hash_of(batch->newest()[0]), hash_of(first->ticks().back()));
  EXPECT_EQ(hash_of(batch->newest()[1]), hash_of(second->ticks().back()));
}

TEST_F(SessionBatchTest, FinishedRunIsUnchanged) {
  const auto batch = open("rubber", 2, {.duration = 0.1, .keep = session::Keep::kNewest});
  batch->step(1000);
  EXPECT_EQ(batch->newest()[0].tick, 99U);
  EXPECT_EQ(batch->run(1).step(), driver::ServoEnd::kDone);
}

TEST_F(SessionBatchTest, StepDoesNotAllocate) {
  const auto batch = open("clay", 3);
  const std::vector<std::uint32_t> ticks(3, 10);
  const std::vector<Vector3d> there(3, Vector3d(0, 0, -0.005));
  std::vector<std::uint8_t> reached(3);
  EXPECT_EQ(support::heap_calls_of([&] {
              batch->step(1500);
              for (int k = 0; k < 20; ++k) batch->step(ticks, there, reached);
            }),
            0);
  EXPECT_TRUE(batch->newest()[0].in_contact);
}

// Less than 11 KB; a whole run takes some 60 KB.
TEST_F(SessionBatchTest, ARunListsTheMemoryOfItsTicks) {
  for (const char* scene : {"rubber", "blocks"}) {
    const auto batch = open(scene, 2);
    const Session& run = batch->run(1);
    std::vector<std::span<const std::byte>> memory;
    run.list_memory(memory);
    const auto holds = [&](const void* place) {
      const auto* byte = static_cast<const std::byte*>(place);
      return std::any_of(memory.begin(), memory.end(), [&](const auto& part) {
        return byte >= part.data() && byte < part.data() + part.size();
      });
    };
    EXPECT_TRUE(holds(&run.newest())) << scene;
    EXPECT_TRUE(holds(&run.device())) << scene;
    EXPECT_TRUE(holds(&run.device().state())) << scene;
    EXPECT_TRUE(holds(&run.device().f_sent_W())) << scene;
    EXPECT_TRUE(holds(&run.device().gate())) << scene;
    EXPECT_TRUE(holds(run.simulation()->board_arm())) << scene;
    EXPECT_TRUE(holds(&run.touch())) << scene;
    std::size_t bytes = 0;
    for (const auto& part : memory) bytes += part.size();
    EXPECT_LT(bytes, 11'000U) << scene;
  }
}

TEST_F(SessionBatchTest, KeepsTheRequestedTicks) {
  const auto newest = open("rubber", 1), whole = open("rubber", 1, {});
  newest->step(500);
  whole->step(500);
  EXPECT_EQ(hash_of(newest->newest()[0]), hash_of(whole->newest()[0]));
  EXPECT_TRUE(newest->run(0).ticks().empty());
  EXPECT_EQ(newest->run(0).statistics().ticks(), 0U);
  EXPECT_EQ(newest->run(0).figures().statistics.ticks(), 0U);
  EXPECT_EQ(whole->run(0).ticks().size(), 500U);
  EXPECT_EQ(whole->run(0).statistics().ticks(), 500U);
}

TEST_F(SessionBatchTest, RejectsOptionsOfSingleRuns) {
  EXPECT_FALSE(SessionBatch::open("rubber", 0));
  EXPECT_FALSE(SessionBatch::open("no_such_scene", 2));
  EXPECT_FALSE(SessionBatch::open("rubber", 2, {.clock = session::ClockKind::kWall}));
  EXPECT_FALSE(SessionBatch::open("rubber", 2, {.record = "all.h5"}));
  EXPECT_FALSE(SessionBatch::open("rubber", 2, {.share = true}));
  EXPECT_FALSE(Session::open("rubber", {.share = true, .keep = session::Keep::kNewest}))
      << "what is not kept cannot be watched";
}

}  // namespace
}  // namespace thimble
