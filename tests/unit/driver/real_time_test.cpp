#include "thimble/driver/real_time.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "support/scratch.h"

namespace thimble::driver {
namespace {

namespace fs = std::filesystem;

class CpuLatencyTest : public ::testing::Test {
 protected:
  CpuLatencyTest() : root_(support::scratch_folder() / "latency") {
    fs::remove_all(root_);
    fs::create_directories(root_ / "dev");
  }

  /// Returns whether this process has the file open.
  bool held() const {
    for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
      std::error_code gone;
      if (fs::read_symlink(entry.path(), gone) == file()) return true;
    }
    return false;
  }
  fs::path file() const { return fs::canonical(root_ / "dev") / "cpu_dma_latency"; }

  fs::path root_;
};

TEST_F(CpuLatencyTest, ForbidsSleepWhileItLives) {
  std::ofstream(file()).close();
  {
    const CpuLatencyRequest request(root_);
    EXPECT_TRUE(request.granted());
    EXPECT_EQ(request.advice(), "");
    EXPECT_TRUE(held());
    std::ifstream in(file(), std::ios::binary);
    const std::string asked{std::istreambuf_iterator<char>(in), {}};
    EXPECT_EQ(asked, std::string(4, '\0'));  // 0 us as the kernel reads it: 32 bits
  }
  EXPECT_FALSE(held());
}

TEST_F(CpuLatencyTest, ReportsARefusal) {
  const CpuLatencyRequest request(root_);
  EXPECT_FALSE(request.granted());
  EXPECT_NE(request.advice().find("cpu_dma_latency was refused"), std::string::npos);
  EXPECT_NE(request.advice().find("thimble doctor"), std::string::npos);
}

TEST_F(CpuLatencyTest, ReportsAnUnusableInterface) {
  fs::create_directory(file());
  const CpuLatencyRequest request(root_);
  EXPECT_FALSE(request.granted());
  EXPECT_NE(request.advice(), "");
}

}  // namespace
}  // namespace thimble::driver
