#include "bringup/doctor_timing.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <string>
#include <system_error>

#include "thimble/driver/discovery.h"

namespace thimble::bringup {
namespace {

namespace fs = std::filesystem;
using driver::read_line;

// Allowed wake-up latency: a twentieth of a period of 1 kHz, which a hand cannot feel. [chosen]
constexpr long kWakeMax_us = 50;

fs::path below(const SystemInfo& system, const char* path) {
  return system.root / fs::path(path).relative_path();
}

/// Returns the folders of the processors ("cpu0", "cpu1", ...).
std::vector<fs::path> processors(const SystemInfo& system) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const auto& entry :
       fs::directory_iterator(below(system, "/sys/devices/system/cpu"), ignored)) {
    const std::string name = entry.path().filename().string();
    const bool numbered = name.size() > 3 && name.compare(0, 3, "cpu") == 0 &&
                          std::all_of(name.begin() + 3, name.end(),
                                      [](unsigned char c) { return c >= '0' && c <= '9'; });
    if (numbered) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

void look_at_priority(const SystemInfo& system, bool arm, std::vector<Finding>& findings) {
  if (system.real_time_priority_max >= 80) {
    findings.push_back({Health::kGood, "You may run at real-time priority.", {}});
  } else {
    findings.push_back(
        {arm ? Health::kProblem : Health::kAdvice,
         "You may not run at real-time priority 80, so other programs can delay the loop while "
         "motors are on. Commands that apply force to a real arm refuse to run without it unless "
         "you pass --no-real-time.",
         "echo '@plugdev - rtprio 80' | sudo tee /etc/security/limits.d/thimble.conf, then log in "
         "again"});
  }
  const std::string runtime = read_line(below(system, "/proc/sys/kernel/sched_rt_runtime_us"));
  // The default gives a real-time thread 950 ms of each second, far more than the loop needs.
  if (!runtime.empty() && std::atol(runtime.c_str()) >= 0 && std::atol(runtime.c_str()) < 500000) {
    findings.push_back(
        {Health::kAdvice,
         "The kernel stops real-time threads after " + runtime + " us of each second.",
         "sudo sysctl -w kernel.sched_rt_runtime_us=950000"});
  }
}

void look_at_preemption(const SystemInfo& system, std::vector<Finding>& findings) {
  // PREEMPT_RT kernels have 1 there [S kernel/ksysfs.c of the RT patches]; all name it in the
  // output of "uname -v", which is this file.
  const std::string version = read_line(below(system, "/proc/sys/kernel/version"));
  if (read_line(below(system, "/sys/kernel/realtime")) == "1" ||
      version.find("PREEMPT_RT") != std::string::npos) {
    findings.push_back({Health::kGood, "The kernel is a real-time kernel (PREEMPT_RT).", {}});
  } else if (!version.empty()) {
    findings.push_back({Health::kAdvice,
                        "The kernel is not a real-time kernel (PREEMPT_RT): some ticks may be late "
                        "by a millisecond or more.",
                        "sudo apt install linux-image-rt-amd64, then boot that kernel; `thimble "
                        "bench` measures whether the current one is good enough"});
  }
}

void look_at_governor(const SystemInfo& system, std::vector<Finding>& findings) {
  std::set<std::string> others;
  bool any = false;
  for (const fs::path& cpu : processors(system)) {
    const std::string governor = read_line(cpu / "cpufreq/scaling_governor");
    any |= !governor.empty();
    if (!governor.empty() && governor != "performance") others.insert(governor);
  }
  if (!any) return;  // most virtual machines
  if (others.empty()) {
    findings.push_back(
        {Health::kGood,
         "The CPU frequency governor is performance: the processors run at full speed.",
         {}});
    return;
  }
  std::string names;
  for (const std::string& name : others) names.append(names.empty() ? "" : ", ").append(name);
  findings.push_back({Health::kAdvice,
                      "The CPU frequency governor is " + names +
                          ": it lowers the CPU frequency for a loop that mostly waits.",
                      "echo performance | sudo tee "
                      "/sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"});
}

/// Returns the wake-up latency of the deepest enabled sleep state, us.
long deepest_wake_us(const SystemInfo& system) {
  long longest = 0;
  for (const fs::path& cpu : processors(system)) {
    std::error_code ignored;
    for (const auto& state : fs::directory_iterator(cpu / "cpuidle", ignored)) {
      if (read_line(state.path() / "disable") == "1") continue;
      longest = std::max(longest, std::atol(read_line(state.path() / "latency").c_str()));
    }
  }
  return longest;
}

void look_at_sleep(const SystemInfo& system, std::vector<Finding>& findings) {
  const long wake_us = deepest_wake_us(system);
  if (wake_us <= kWakeMax_us) return;
  const fs::path latency = below(system, "/dev/cpu_dma_latency");
  if (access(latency.c_str(), W_OK) == 0) {
    findings.push_back({Health::kGood,
                        "Idle processors take " + std::to_string(wake_us) +
                            " us to wake up; a run reduces this with /dev/cpu_dma_latency, to "
                            "which you have access.",
                        {}});
    return;
  }
  std::error_code missing;
  const bool there = fs::exists(latency, missing);
  findings.push_back(
      {Health::kAdvice,
       "Idle processors take " + std::to_string(wake_us) + " us to wake up, and " +
           (there ? "you may not write to /dev/cpu_dma_latency to keep them awake."
                  : "the kernel has no /dev/cpu_dma_latency to keep them awake."),
       there ? "echo 'KERNEL==\"cpu_dma_latency\", GROUP=\"plugdev\", MODE=\"0660\"' | sudo tee "
               "/etc/udev/rules.d/71-thimble-latency.rules && sudo udevadm control --reload && "
               "sudo udevadm trigger /dev/cpu_dma_latency"
             : "sudo cpupower idle-set -D " + std::to_string(kWakeMax_us)});
}

}  // namespace

std::vector<Finding> examine_timing(const SystemInfo& system, bool arm) {
  std::vector<Finding> findings;
  look_at_priority(system, arm, findings);
  look_at_preemption(system, findings);
  look_at_governor(system, findings);
  look_at_sleep(system, findings);
  return findings;
}

}  // namespace thimble::bringup
