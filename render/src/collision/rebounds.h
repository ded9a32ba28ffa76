#pragma once

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thimble::render {

/// Rebounds of one step, in Bullet's units. Bullet's own rebounds begin from where the bodies are
/// at the end of a tick, which is inside of each other. Here bodies that approach are first stopped
/// where they touch, and then get their speed apart, and the friction of that.
class Rebounds {
 public:
  /// Keeps room for `most` contacts; approaches below `slow` do not rebound. Real-time: never from
  /// the servo thread.
  void prepare(std::size_t most, btScalar slow) {
    all_.reserve(most);
    slow_ = slow;
  }

  // All of the following are Real-time: safe.

  void clear() noexcept { all_.clear(); }
  /// Notes a contact of two bodies before their step: its places from their centres, the speed with
  /// which it closes, and its restitution.
  void note(const btManifoldPoint& point, btRigidBody& a, btRigidBody& b, const btVector3& arm_a,
            const btVector3& arm_b, btScalar closing, btScalar restitution) noexcept;
  /// Removes contacts that were not reached; returns whether any is left.
  bool any() noexcept;
  /// Adds the impulses to the velocities after the step.
  void solve() noexcept;
  /// Adds a share (0 to 1) of the impulses that `solve` has found.
  void give(double share) noexcept;

 private:
  struct Rebound {
    btRigidBody* a = nullptr;
    btRigidBody* b = nullptr;
    const btManifoldPoint* point = nullptr;
    btVector3 normal;        // from b to a
    btVector3 arm_a, arm_b;  // from the centres to the contact
    btScalar wanted = 0;     // speed apart after the step
    btScalar impulse = 0;
    btVector3 rub{0, 0, 0};  // impulse of friction

    btVector3 apart() const noexcept;
    btScalar gain(const btVector3& way) const noexcept;
    void push(const btVector3& impulse) noexcept;
    void part() noexcept;
    void slow_down() noexcept;
  };

  std::vector<Rebound> all_;
  btScalar slow_ = 0;
};

/// Returns the largest share (0 to 1) at which a quadratic function is at most `most`: from its
/// values at 0, 1/2 and 1. If there is none, that of its minimum. Real-time: safe.
inline double share_within(double most, double none, double half, double all) noexcept {
  if (all <= most) return 1;
  const double square = 2 * (all + none) - 4 * half;
  const double slope = all - none - square;
  if (!(square > 0)) return most > none ? (most - none) / (all - none) : 0;
  const double root = slope * slope + 4 * square * (most - none);
  return std::clamp((std::sqrt(std::max(root, 0.0)) - slope) / (2 * square), 0.0, 1.0);
}

}  // namespace thimble::render
