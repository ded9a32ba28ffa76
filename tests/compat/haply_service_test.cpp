// The service compatible with an Inverse3's, with Thimble's own driver for that arm as its client.
// Both run in this process.
#include "compat/haply/haply_service.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include "compat/haply/service_message.h"
#include "exec_rig.h"
#include "thimble/driver/device.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/real_arm.h"
#include "vendors/haply/haply_link.h"
#include "vendors/haply/haply_message.h"
#include "vendors/linked_arms.h"

namespace thimble::compat {
namespace {

using Eigen::Vector3d;

/// `thimble exec --serve haply` in this process. In real time.
class HaplyService : public ::testing::Test {
 protected:
  HaplyService() {
    auto listening =
        haply::Service::listen(0, [this](const std::string& sentence) { refusal_ = sentence; });
    EXPECT_TRUE(listening) << listening.error().message;
    if (listening) service_ = std::move(listening).value();
    // Opening is slow on a busy machine, and the driver does not wait for it.
    for (int look = 0; look < 30'000 && service_ && !service_->ready(); ++look) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  ~HaplyService() override {
    device_.reset();
    service_.reset();
  }

  /// Opens the first arm like a run on an Inverse3, with retries, because the machine may be busy.
  std::unique_ptr<driver::Device> open(driver::Clock& clock) const {
    const auto arm = scene::load_arm("inverse3");
    auto link = driver::haply::open_link("0001", service_->port(), clock);
    EXPECT_TRUE(arm && link) << link.error().message;
    if (!arm || !link) return nullptr;
    driver::DeviceSettings settings = scene::device_settings(*arm, 1000);
    settings.silence_limit_ns = 2'000'000'000;
    settings.limits.stall_ns = 900'000'000;
    settings.limits.watchdog_ns = 1'000'000'000;
    settings.limits.speed_max = 20;
    settings.motion = {};
    auto device = driver::Device::open(std::move(link).value(), settings, clock.now_ns());
    EXPECT_TRUE(device) << device.error().message;
    if (!device || !(*device)->activate()) return nullptr;
    return std::move(device).value();
  }

  template <class Done>
  bool ticks_until(driver::Device& device, const Vector3d& f_T_W, Done&& done) {
    for (int tick = 0; tick < 5000; ++tick) {
      clock_.sleep_until_ns(clock_.now_ns() + 1'000'000);
      device.read(clock_.now_ns(), 0);
      device.write({.f_T_W = f_T_W, .touch = {}});
      if (done()) return true;
    }
    return false;
  }

  ExecRig rig_;
  driver::WallClock clock_{0};
  std::string refusal_;  // written before `refused` counts one
  std::unique_ptr<haply::Service> service_;
  std::unique_ptr<driver::Device> device_;
};

TEST_F(HaplyService, OwnClientMovesTheSimulatedArm) {
  device_ = open(clock_);
  ASSERT_NE(device_, nullptr);
  const Vector3d f_W(0.3, -0.2, 0.4);
  EXPECT_TRUE(
      ticks_until(*device_, f_W, [&] { return (rig_.motors.force_W() - f_W).norm() < 0.02; }))
      << "force of the motors: " << rig_.motors.force_W().transpose();
  ArmReading there;
  ASSERT_TRUE(arms::read(0, there));
  const Vector3d p_WT = Eigen::Map<const Vector3d>(there.p_WT.data());
  EXPECT_LT((device_->state().p_WT - p_WT).norm(), 1e-3);
  EXPECT_EQ(device_->fault(), driver::Fault::kNone) << driver::describe(device_->fault());
}

TEST_F(HaplyService, ExitOfAProgramRemovesItsForce) {
  device_ = open(clock_);
  ASSERT_NE(device_, nullptr);
  ASSERT_TRUE(ticks_until(*device_, {0.4, 0, 0}, [&] { return rig_.motors.force_W().x() > 0.3; }));
  device_.reset();
  for (int look = 0; look < 2000 && rig_.motors.force_W().norm() > 0.02; ++look) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_LT(rig_.motors.force_W().norm(), 0.02);
}

TEST_F(HaplyService, EndsWhileAProgramRequestsForces) {
  device_ = open(clock_);
  ASSERT_NE(device_, nullptr);
  ASSERT_TRUE(ticks_until(*device_, {0.4, 0, 0}, [&] { return rig_.motors.force_W().x() > 0.3; }));
  service_->leave();
  EXPECT_TRUE(ticks_until(*device_, {0.4, 0, 0}, [&] { return device_->lost(); }));
  EXPECT_EQ(device_->fault(), driver::Fault::kTransportLost);
  for (int look = 0; look < 5000 && !service_->ended(); ++look) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(service_->ended());
  EXPECT_FALSE(arms::is_open(0));
}

TEST_F(HaplyService, ProgramOfOtherUserIsRefused) {
  if (geteuid() != 0) GTEST_SKIP() << "only root may act as another user";
  const pid_t other = fork();
  if (other == 0) {
    alarm(60);
    if (setgid(65534) != 0 || setuid(65534) != 0) _exit(2);
    const int program = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(service_->port());
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(program, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) _exit(3);
    const std::string request =
        "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n";
    // Closed without an answer; a reset is allowed too.
    if (send(program, request.data(), request.size(), MSG_NOSIGNAL) < 0) _exit(0);
    char byte = 0;
    _exit(recv(program, &byte, 1, 0) > 0 ? 4 : 0);
  }
  int status = 0;
  waitpid(other, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(service_->programs(), 0);
  EXPECT_EQ(service_->refused(), 1);
  EXPECT_NE(refusal_.find("a process of user 65534"), std::string::npos) << refusal_;
}

TEST_F(HaplyService, IsRecognisedAsThimble) {
  const auto arms = driver::haply::find_arms(service_->port(), 30'000'000'000);
  ASSERT_TRUE(arms) << arms.error().message;
  EXPECT_TRUE(arms->front().stand_in);
}

TEST_F(HaplyService, IsIgnoredByDeviceAuto) {
  setenv("THIMBLE_HAPLY_PORT", std::to_string(service_->port()).c_str(), 1);
  const auto found = driver::find_linked_arms();
  unsetenv("THIMBLE_HAPLY_PORT");
  ASSERT_EQ(found.size(), 1U);
  const auto chosen = scene::choose_arm(found, "auto");
  ASSERT_TRUE(chosen) << chosen.error().message;
  EXPECT_FALSE(chosen->has_value());
  EXPECT_NE(scene::boards_left_out(found).find("--serve haply"), std::string::npos);
  EXPECT_TRUE(scene::choose_arm(found, "0001")->has_value()) << "a name selects it explicitly";
}

TEST_F(HaplyService, SecondServiceOnAPortIsRefused) {
  const auto second = haply::Service::listen(service_->port());
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("choose another port"), std::string::npos);
}

TEST(HaplyServiceMessage, OwnDriverParsesTheMessages) {
  haply::ReportedArm arm;
  arm.device_id = haply::device_id_of(0);
  arm.reading.p_WT = {0.01, -0.02, 0.03};
  arm.reading.v_WT = {0.1, 0.2, -0.3};
  arm.reading.buttons = 5;
  arm.facts.has_orientation = true;
  // A quarter turn about the world's z.
  arm.reading.R_WT = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  const auto first = driver::haply::read_first(haply::state_message({&arm, 1}, 7, true));
  ASSERT_TRUE(first) << first.error().message;
  ASSERT_EQ(first->size(), 1u);
  EXPECT_EQ(first->front().trouble, "");
  driver::haply::ArmState state;
  ASSERT_EQ(driver::haply::read_state(haply::state_message({&arm, 1}, 7, false), "0001", state),
            driver::haply::StateRead::kOk);
  const auto file = scene::load_arm("inverse3");
  ASSERT_TRUE(file);
  EXPECT_LT((file->p_WB + file->R_WB * state.p_BT - Vector3d(0.01, -0.02, 0.03)).norm(), 1e-12);
  EXPECT_LT((file->R_WB * state.v_BT - Vector3d(0.1, 0.2, -0.3)).norm(), 1e-12);
  EXPECT_TRUE(state.has_grip);
  EXPECT_EQ(state.buttons, 5);
  Eigen::Matrix3d turned;
  turned << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_LT((file->R_WB * state.R_BT - turned).norm(), 1e-12);
  arm.ready = false;
  EXPECT_EQ(driver::haply::read_state(haply::state_message({&arm, 1}, 7, false), "0001", state),
            driver::haply::StateRead::kRejected);
}

TEST(HaplyServiceMessage, ParsesForcesOfOwnDriver) {
  const haply::Request request =
      haply::read_request(driver::haply::force_message("0001", {1, -2, 0.5}));
  EXPECT_TRUE(request.wrong.empty());
  ASSERT_TRUE(request.force_of("0001"));
  EXPECT_LT((*request.force_of("0001") - Vector3d(1, -2, 0.5)).norm(), 1e-9);
  EXPECT_FALSE(request.force_of("0002"));
}

}  // namespace
}  // namespace thimble::compat
