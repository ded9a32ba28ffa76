#include "thimble/session/servo_thread.h"

#include "thimble/session/session.h"

namespace thimble::session {

ServoThread::ServoThread(bool real_time) {
  if (real_time) awake_ = std::make_unique<driver::CpuLatencyRequest>();
  thread_ = std::thread([this, real_time] {
    if (real_time) grant_ = driver::enter_real_time();
    asked_.store(true);
    asked_.notify_all();
    order_.wait(Order::kNone);
    if (order_.load() == Order::kRun) end_ = session_->run(*stop_);
    ended_.store(true);
  });
  asked_.wait(false);
  if (!awake_) return;
  grant_.cpu_awake = awake_->granted();
  if (!awake_->granted()) {
    grant_.advice += (grant_.advice.empty() ? "" : " ") + awake_->advice();
  }
}

ServoThread::~ServoThread() {
  Order none = Order::kNone;
  order_.compare_exchange_strong(none, Order::kLeave);
  order_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void ServoThread::begin(Session& session, const std::atomic<bool>& stop) {
  session_ = &session;
  stop_ = &stop;
  order_.store(Order::kRun);
  order_.notify_all();
}

driver::ServoEnd ServoThread::join() {
  if (thread_.joinable()) thread_.join();
  return end_;
}

driver::Result<void> check_real_time(const driver::RealTimeGrant& grant, bool allowed) {
  if (grant.fifo || allowed) return {};
  return driver::Error{
      "A real arm requires real-time priority: without it any other program can delay the loop "
      "while a motor pulls. " +
      grant.advice + " To run without it at your own risk, pass --no-real-time."};
}

}  // namespace thimble::session
