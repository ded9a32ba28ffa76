#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "support/contact_walk.h"
#include "support/long_form.h"
#include "support/meshes/shapes.h"
#include "support/random.h"
#include "support/run_hash.h"
#include "thimble/render/build_object_touch.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

/// Returns a ball of 10 cm with bumps and dents, built with arithmetic that is the same on every
/// processor.
TriangleMesh lumpy_ball(int subdivisions) {
  TriangleMesh mesh = support::icosphere(subdivisions, 0.05);
  for (Vector3d& p : mesh.vertices) {
    const Vector3d u = p / 0.05;
    p *= 1 + 0.3 * u.x() * u.y() * u.z() + 0.05 * (u.x() * u.x() - u.z());
  }
  return mesh;
}

/// A tip that creeps, slides, jumps and moves close to a vertex, at times outside and at times
/// inside.
class WanderingTip {
 public:
  WanderingTip(const TriangleMesh& mesh, std::uint64_t seed) : mesh_(mesh), random_(seed) {}

  Vector3d next() {
    const double choice = random_.uniform(0, 1);
    if (choice < 0.01) {
      p_W_ = away(0.2 * random_.uniform(0, 1));
    } else if (choice < 0.03) {
      p_W_ = some_vertex();
      p_W_ += away(2e-3 * random_.uniform(0, 1));
    } else {
      const int magnitude = static_cast<int>(random_.bits() % 12);  // 1 um to 2 mm
      p_W_ += away(std::ldexp(1e-6, magnitude));
    }
    if (p_W_.norm() > 0.1) p_W_ *= 0.5;
    const Vector3d to_vertex = some_vertex() - p_W_;
    if (choice > 0.9 && to_vertex.norm() < 0.02) p_W_ += 0.1 * to_vertex;
    return p_W_;
  }

 private:
  // One random draw per statement, because the order of evaluation within an expression is
  // unspecified.
  Vector3d away(double distance) { return distance * random_.direction(); }
  const Vector3d& some_vertex() { return mesh_.vertices[random_.bits() % mesh_.vertices.size()]; }

  const TriangleMesh& mesh_;
  support::Random random_;
  Vector3d p_W_{0.08, 0, 0};
};

struct Answers {
  std::uint64_t hash = 0;
  double touched = 0;  // fraction of them
};

Answers ask(const TriangleMesh& mesh, TrackerChoice tracker, int questions) {
  ContactChoice choice;
  choice.tracker = tracker;
  const auto touch = build_object_touch(mesh, choice, {.spring = {.stiffness = 1000}}).value();
  WanderingTip tip(mesh, 7);
  support::RunHash hash;
  driver::DeviceState state;
  state.dt = 1e-3;
  int touched = 0;
  for (int i = 0; i < questions; ++i) {
    state.p_WT = tip.next();
    const driver::ForceCommand answer = touch->update(state);
    for (int k = 0; k < 3; ++k) {
      hash.add(answer.f_T_W[k]);
      hash.add(answer.touch.p_WP[k]);
    }
    hash.add(answer.touch.feature);
    touched += answer.touch.in_contact ? 1 : 0;
    ++state.tick;
  }
  return {hash.value(), static_cast<double>(touched) / questions};
}

// Detects any changed bit of an answer. An intended change stores new hashes and is explained in
// the changelog. gcc and clang have these hashes.
TEST(RandomQuestions, HaveTheStoredAnswers) {
  const bool all = support::long_form();
  struct Stored {
    const char* name;
    int subdivisions;
    TrackerChoice tracker;
    std::uint64_t few, many;
  };
  for (const Stored& stored : {
           Stored{"compact, 320", 2, TrackerChoice::kPacked, 0x9bd789bd3e6c9833,
                  0x64e4d317a4922256},
           Stored{"edge_planes, 320", 2, TrackerChoice::kEdgePlanes, 0x3dcf70ae24c36d1e,
                  0xc7ad7d21c30680ff},
           Stored{"god_object, 320", 2, TrackerChoice::kGodObject, 0x9856ca583ec9fce6,
                  0xebd18b6e8738b939},
           Stored{"offset, 320", 2, TrackerChoice::kOffset, 0x02aaa8b930a915d2, 0xcb5b02b3af580824},
           Stored{"compact, 20,480", 5, TrackerChoice::kPacked, 0xed13b1183c641360,
                  0x9e197dddc913c72a},
           Stored{"edge_planes, 20,480", 5, TrackerChoice::kEdgePlanes, 0xa2e0fa1923190c11,
                  0xf0f1f1f18f231ca8},
           Stored{"god_object, 20,480", 5, TrackerChoice::kGodObject, 0x49d2969a83c1e331,
                  0x8f084ba6f54aa37c},
           Stored{"offset, 20,480", 5, TrackerChoice::kOffset, 0x146ac999375b7eee,
                  0xf5a60faa140e4c21},
       }) {
    const TriangleMesh mesh = lumpy_ball(stored.subdivisions);
    const Answers answers = ask(mesh, stored.tracker, all ? 1'250'000 : 10'000);
    std::printf("%s triangles: hash 0x%016llx, %.0f %% in contact\n", stored.name,
                static_cast<unsigned long long>(answers.hash), 100 * answers.touched);
    EXPECT_EQ(answers.hash, all ? stored.many : stored.few) << stored.name;
    EXPECT_GT(answers.touched, 0.2) << stored.name;
  }
}

}  // namespace
}  // namespace thimble::render
