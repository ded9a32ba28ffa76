#include "work_account.h"

namespace thimble::driver {

void WorkAccount::restart() noexcept {
  begun_ = false;
  efforts_.fill(Eigen::Vector3d::Zero());
  programs_.fill(Eigen::Vector3d::Zero());
  f_program_W_.setZero();
  program_ = false;
  stored_ = 0;
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

void WorkAccount::explain(EnergyFlow& flow, double stored, const Eigen::Vector3d& f_program_W,
                          double damping, double dt) noexcept {
  flow.f_program_W = f_program_W;
  program_ = program_ || (f_program_W.array() != 0).any();
  // If the stored energy was or is zero, storages have appeared or vanished; that is not a change
  // of them.
  const bool kept = stored != 0 && stored_ != 0;
  if (kept) flow.stored_change = stored - stored_;
  stored_ = stored;
  if (program_) flow.work -= programs_[delay_].dot(flow.move_W);
  if (kept || program_) flow.dissipated = dt > 0 ? damping * flow.move_W.squaredNorm() / dt : 0;
}

void WorkAccount::hold() noexcept {
  if (program_) {
    for (std::size_t i = delay_; i > 0; --i) programs_[i] = programs_[i - 1];
  }
  for (std::size_t i = delay_; i > 0; --i) efforts_[i] = efforts_[i - 1];
}

void WorkAccount::sent(const Eigen::Vector3d& effort) noexcept {
  hold();
  efforts_[0] = effort;
  if (program_) programs_[0] = f_program_W_;
}

}  // namespace thimble::driver
