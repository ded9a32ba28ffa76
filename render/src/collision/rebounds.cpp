#include "collision/rebounds.h"

namespace thimble::render {

void Rebounds::note(const btManifoldPoint& point, btRigidBody& a, btRigidBody& b,
                    const btVector3& arm_a, const btVector3& arm_b, btScalar closing,
                    btScalar restitution) noexcept {
  if (!(closing > slow_) || all_.size() == all_.capacity()) return;
  Rebound one;
  one.a = &a;
  one.b = &b;
  one.point = &point;
  one.normal = point.m_normalWorldOnB;
  one.arm_a = arm_a;
  one.arm_b = arm_b;
  one.wanted = restitution * closing;
  all_.push_back(one);
}

bool Rebounds::any() noexcept {
  std::erase_if(all_, [](const Rebound& one) { return !(one.point->getAppliedImpulse() > 0); });
  return !all_.empty();
}

btVector3 Rebounds::Rebound::apart() const noexcept {
  return a->getVelocityInLocalPoint(arm_a) - b->getVelocityInLocalPoint(arm_b);
}

// The velocity apart that an impulse of 1 gives along a way.
btScalar Rebounds::Rebound::gain(const btVector3& way) const noexcept {
  return a->computeImpulseDenominator(arm_a + a->getCenterOfMassPosition(), way) +
         b->computeImpulseDenominator(arm_b + b->getCenterOfMassPosition(), way);
}

void Rebounds::Rebound::push(const btVector3& impulse_W) noexcept {
  a->applyImpulse(impulse_W, arm_a);
  b->applyImpulse(-impulse_W, arm_b);
}

void Rebounds::Rebound::part() noexcept {
  const btScalar total =
      std::max<btScalar>(impulse + (wanted - normal.dot(apart())) / gain(normal), 0);
  push((total - impulse) * normal);
  impulse = total;
}

// Friction, up to its coefficient times the impulse of the rebound.
void Rebounds::Rebound::slow_down() noexcept {
  const btVector3 velocity = apart();
  const btVector3 along = velocity - normal * normal.dot(velocity);
  const btScalar speed = along.length();
  if (!(speed > 0)) return;
  const btVector3 way = along / speed;
  btVector3 total = rub - speed / gain(way) * way;
  const btScalar most = point->m_combinedFriction * impulse;
  const btScalar size = total.length();
  if (size > most) total *= most / size;
  push(total - rub);
  rub = total;
}

void Rebounds::solve() noexcept {
  constexpr int kRounds = 20;  // [chosen: a row of ten bodies]
  for (int round = 0; round < kRounds; ++round) {
    for (Rebound& one : all_) {
      one.part();
      one.slow_down();
    }
  }
}

void Rebounds::give(double share) noexcept {
  for (Rebound& one : all_) one.push(share * (one.impulse * one.normal + one.rub));
}

}  // namespace thimble::render
