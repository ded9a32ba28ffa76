#include "work_account.h"

namespace thimble::driver {

void WorkAccount::restart() noexcept {
  begun_ = false;
  efforts_.fill(Eigen::Vector3d::Zero());
}

EnergyFlow WorkAccount::flow(const Eigen::Vector3d& x, const Eigen::Vector3d& p_WT,
                             const Eigen::Vector3d& f_sent_W, double held) noexcept {
  EnergyFlow flow;
  if (begun_) {
    flow = {.work = efforts_[delay_].dot(x - x_),
            .move_W = p_WT - p_WT_,
            .f_sent_W = f_sent_W,
            .held = held};
  }
  begun_ = true;
  x_ = x;
  p_WT_ = p_WT;
  return flow;
}

void WorkAccount::hold() noexcept {
  for (std::size_t i = delay_; i > 0; --i) efforts_[i] = efforts_[i - 1];
}

void WorkAccount::sent(const Eigen::Vector3d& effort) noexcept {
  hold();
  efforts_[0] = effort;
}

}  // namespace thimble::driver
