// Drives a plugged arm through the kernel and prints PASS or FAIL. Runs inside the virtual machine:
//   usb_check find ARM                            waits until the arm is listed
//   usb_check name ARM                            prints its name for `thimble run --device`
//   usb_check kernel ARM                          checks its descriptors in the kernel
//   usb_check vector ARM                          checks the tip positions of fixed reports
//   usb_check listen ARM                          counts the reports that it sends unasked
//   usb_check wrong ARM                           sends messages of another length
//   usb_check fresh ARM [FIRMWARE]                checks that its first position is current
//   usb_check denied ARM                          checks that this user cannot open it
//   usb_check touch ARM TICKS TRACE [FIRMWARE]    runs ticks in contact and writes their trace
//   usb_check hang ARM [FIRMWARE]                 stays in contact until it is killed
//   usb_check replug ARM PIPE [FIRMWARE]          disconnects the arm in contact
//   usb_check fault ARM PIPE "FAULT" [FIRMWARE]   causes a fault in contact
//   usb_check compare ARM TRACE DEVICE_TRACE      compares the traces of driver and arm
//   usb_check program ARM LOG AXES CSV TRACE      writes the trace of a program of `thimble exec`
//   usb_check descriptor ARM                      prints the HID report descriptor, as bytes
//   usb_check gadget ARM NODE                     runs the arm behind a HID gadget
//   usb_check hide FILE SEED [cables]             prints an arm file with hidden constants
//   usb_check identified ARM FILE HIDDEN WRITTEN DELAY    compares identified and true constants
#include <dirent.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "support/heap_guard.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/driver/wire_link.h"
#include "usb/board_checks.h"
#include "usb/hid_gadget.h"
#include "usb/hidden_file.h"
#include "usb/program_trace.h"
#include "usb/trace_compare.h"
#include "usb/virtual_arm.h"

namespace thimble::usb_test {
namespace {

constexpr std::int64_t kTick_ns = 1'000'000;

int open_descriptors() {
  int count = 0;
  DIR* folder = opendir("/proc/self/fd");
  if (folder == nullptr) return -1;
  while (readdir(folder) != nullptr) ++count;
  closedir(folder);
  return count;
}

/// Stores the result of each tick in memory that was allocated before.
struct Recorder {
  std::vector<driver::TickRecord> records;

  void operator()(const driver::TickRecord& record) noexcept {
    if (records.size() < records.capacity()) records.push_back(record);
  }
};

/// An open arm, ready for contact.
struct Bench {
  driver::WallClock clock{0};  // one processor: a spinning loop would block the kernel
  driver::FoundArm found;
  std::unique_ptr<driver::Device> device;
};

driver::Result<std::unique_ptr<Bench>> open_bench(const VirtualArm& arm) {
  auto bench = std::make_unique<Bench>();
  auto found = arm.find();
  if (!found) return found.error();
  bench->found = *found;
  auto wire = arm.open(*found, bench->clock);
  if (!wire) return wire.error();
  auto device =
      driver::Device::open(std::make_unique<driver::WireLink>(std::move(*wire), arm.protocol()),
                           check_settings(), bench->clock.now_ns());
  if (!device) return device.error();
  bench->device = std::move(*device);
  return bench;
}

double force_of(const driver::TickRecord& record) {
  return std::hypot(record.f_sent_W[0], record.f_sent_W[1], record.f_sent_W[2]);
}

int find(const VirtualArm& arm) {
  const auto found = arm.find();
  if (!found) return verdict(false, arm.name + " listed", found.error().message);
  return verdict(found->serial == arm.serial(), arm.name + " listed",
                 found->arm + " at " + found->node + ", serial " + found->serial);
}

int denied(const VirtualArm& arm) {
  const auto found = arm.find();
  if (!found) return verdict(false, arm.name + " denied", found.error().message);
  const driver::WallClock clock(0);
  const auto wire = arm.open(*found, clock);
  const bool reported = !wire && wire.error().message.find("70-thimble.rules") != std::string::npos;
  return verdict(reported && !found->accessible, arm.name + " closed to strangers",
                 wire ? "it was opened" : wire.error().message);
}

/// Opens an arm whose hand has moved since the last program ended. A report that had waited in the
/// board since then would have an old position.
int fresh(const VirtualArm& arm) {
  constexpr double kMovedMax = 0.002;  // m; the hand moves 0.13 mm per tick
  auto opened = open_bench(arm);
  if (!opened) return verdict(false, arm.name + " opened", opened.error().message);
  Bench& bench = **opened;
  const Eigen::Vector3d first = bench.device->state().p_WT;
  Eigen::Vector3d last = first;
  for (int i = 0; i < 4; ++i) {
    const std::int64_t now_ns = bench.clock.now_ns();
    last = bench.device->read(now_ns, now_ns + 2 * kTick_ns).p_WT;
    bench.device->write({});
  }
  const double moved = (last - first).norm();
  return verdict(moved < kMovedMax, arm.name + " opened again",
                 "its first position is " + std::to_string(1e3 * moved) + " mm from the fifth");
}

int touch(const VirtualArm& arm, std::uint64_t ticks, const std::string& trace) {
  const int descriptors = open_descriptors();
  Recorder recorder;
  recorder.records.reserve(ticks);
  driver::ServoEnd end = driver::ServoEnd::kDone;
  driver::WireCounters wire;
  int heap_calls = 0;
  {
    auto bench = open_bench(arm);
    if (!bench) return verdict(false, arm.name + " opened", bench.error().message);
    verdict((*bench)->found.accessible, arm.name + " opened by a normal user",
            (*bench)->found.node);
    if (!(*bench)->device->activate()) return verdict(false, arm.name + " activated", "no");
    Wall wall = arm.wall();
    const std::atomic<bool> stop{false};
    heap_calls = support::heap_calls_of([&] {
      end = driver::run_servo(*(*bench)->device, (*bench)->clock, driver::ForceLaw(wall),
                              driver::TickSink(recorder), {.period_ns = kTick_ns, .ticks = ticks},
                              stop);
    });
    wire = (*bench)->device->wire_counters();
  }
  write_trace(recorder.records, wire.refused, trace);
  double force_max = 0;
  std::size_t contact = 0;
  for (const driver::TickRecord& record : recorder.records) {
    force_max = std::max(force_max, force_of(record));
    contact += record.in_contact ? 1U : 0U;
  }
  int bad = verdict(end == driver::ServoEnd::kDone && contact > recorder.records.size() / 10,
                    arm.name + " touched",
                    std::to_string(recorder.records.size()) + " ticks, " + std::to_string(contact) +
                        " in contact, " + std::to_string(force_max) + " N at most; " +
                        std::to_string(wire.reports) + " reports, " + std::to_string(wire.skipped) +
                        " skipped, " + std::to_string(wire.missing) + " ticks without, " +
                        std::to_string(wire.rejected) + " rejected, " +
                        std::to_string(wire.refused) + " refused");
  bad += verdict(heap_calls == 0, arm.name + " allocates no memory",
                 std::to_string(heap_calls) + " calls of new and delete in all ticks");
  bad += verdict(open_descriptors() == descriptors, arm.name + " closed",
                 std::to_string(open_descriptors() - descriptors) + " descriptors left open");
  return bad;
}

void order(const std::string& pipe, const std::string& line) {
  std::ofstream(pipe) << line << std::endl;
}

/// Runs single ticks, so that a check can examine each one and continue after a fault.
class Ticker {
 public:
  Ticker(Bench& bench, const VirtualArm& arm)
      : bench_(bench), wall_(arm.wall()), due_ns_(bench.clock.now_ns()) {}

  void tick() {
    due_ns_ = std::max(due_ns_ + kTick_ns, bench_.clock.now_ns());
    bench_.clock.sleep_until_ns(due_ns_);
    const std::int64_t now_ns = bench_.clock.now_ns();
    const driver::DeviceState& state = bench_.device->read(now_ns, now_ns);
    const driver::ForceCommand command = wall_(state);
    bench_.device->write(command);
    longest_ns = std::max(longest_ns, bench_.clock.now_ns() - now_ns);
    force = bench_.device->f_sent_W().norm();
    force_max = std::max(force_max, force);
    in_contact = command.touch.in_contact;
    ++ticks;
  }
  /// Runs ticks until the condition is true, up to a maximum.
  template <class Condition>
  bool until(Condition&& condition, int ticks_max) {
    for (int i = 0; i < ticks_max; ++i) {
      tick();
      if (condition()) return true;
    }
    return false;
  }

  double force = 0, force_max = 0;
  bool in_contact = false;
  int ticks = 0;
  std::int64_t longest_ns = 0;

 private:
  Bench& bench_;
  Wall wall_;
  std::int64_t due_ns_;
};

int hang(const VirtualArm& arm) {
  auto bench = open_bench(arm);
  if (!bench) return verdict(false, arm.name + " opened", bench.error().message);
  if (!(*bench)->device->activate()) return 1;
  Ticker ticker(**bench, arm);
  bool reported = false;
  for (;;) {
    ticker.tick();
    if (reported || ticker.force < 0.5) continue;
    reported = true;
    std::printf("touching\n");
    std::fflush(stdout);
  }
}

int replug(const VirtualArm& arm, const std::string& pipe) {
  auto opened = open_bench(arm);
  if (!opened) return verdict(false, arm.name + " opened", opened.error().message);
  Bench& bench = **opened;
  if (!bench.device->activate()) return verdict(false, arm.name + " activated", "no");
  Ticker ticker(bench, arm);
  const bool contact = ticker.until([&] { return ticker.force > 0.5; }, 3000);
  int bad = verdict(contact, arm.name + " in contact", std::to_string(ticker.force) + " N");
  order(pipe, "unplug for=300");
  const int begin = ticker.ticks;
  const bool lost = ticker.until(
      [&] { return bench.device->fault() == driver::Fault::kTransportLost && ticker.force == 0; },
      1000);
  bad += verdict(lost, arm.name + " pulled in contact",
                 "zero force and '" + std::string(driver::name(bench.device->fault())) +
                     "' after " + std::to_string(ticker.ticks - begin) + " ticks");

  // In another thread: find the arm by its serial number and offer the new wire.
  std::atomic<bool> offered{false};
  std::string trouble;
  std::thread side([&] {
    // The old entry may still be listed for a short time; use one that opens.
    for (int i = 0; i < 300 && !offered; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      const auto again = arm.find(arm.serial(), 1000);
      if (!again) continue;
      bench.device->close_lost_link();
      auto wire = arm.open(*again, bench.clock);
      if (!wire) {
        trouble = wire.error().message;
        continue;
      }
      if (const auto taken = bench.device->offer(
              std::make_unique<driver::WireLink>(std::move(*wire), arm.protocol()));
          !taken) {
        trouble = taken.error().message;
        continue;
      }
      offered.store(true);
    }
  });
  const bool back =
      ticker.until([&] { return bench.device->wire_counters().replugged > 0; }, 15000);
  side.join();
  bad += verdict(back, arm.name + " found again by its serial number",
                 back ? "loop alive, " + std::to_string(ticker.ticks) + " ticks" : trouble);
  double force_before_asked = 0;
  const bool contact_again = ticker.until(
      [&] {
        force_before_asked = std::max(force_before_asked, ticker.force);
        return ticker.in_contact;
      },
      3000);
  bad += verdict(contact_again && force_before_asked == 0, arm.name + " idle until activated",
                 std::to_string(force_before_asked) + " N in contact before");
  // The hand of a simulated arm does not move it, so its counters restart at its present pose,
  // which was its home pose. The session checks the pose (replug_watch).
  bench.device->ask_to_activate(driver::HomeCheck::kPassed);
  const bool active = ticker.until([&] { return ticker.force > 0.2; }, 3000);
  bad +=
      verdict(active, arm.name + " active after activation", std::to_string(ticker.force) + " N");
  return bad;
}

/// Returns whether the driver gets no reports during a fault, so that it must stop.
bool must_stop(const VirtualArm& arm, const std::string& fault) {
  // An arm that only answers messages is silent if its messages are lost.
  if (fault.starts_with("lost out")) return arm.answers();
  if (fault.find(" out") != std::string::npos) return false;
  if (fault.starts_with("lost")) return true;
  // A converter can deliver additional bytes, which are not a message and are skipped.
  if (fault.starts_with("long")) return !arm.is_falcon();
  // The mbed board numbers its reports, so an old one is detected.
  if (fault.starts_with("stale")) return arm.name == "woodenhaptics";
  return fault.starts_with("silence") || fault.starts_with("short") || fault.starts_with("stall");
}

int fault(const VirtualArm& arm, const std::string& pipe, const std::string& line) {
  auto opened = open_bench(arm);
  if (!opened) return verdict(false, arm.name + " opened", opened.error().message);
  Bench& bench = **opened;
  if (!bench.device->activate()) return verdict(false, arm.name + " activated", "no");
  Ticker ticker(bench, arm);
  if (!ticker.until([&] { return ticker.force > 0.5; }, 3000)) {
    return verdict(false, arm.name + " in contact", "never");
  }
  const driver::WireCounters before = bench.device->wire_counters();
  ticker.longest_ns = 0;
  order(pipe, line);
  const int begin = ticker.ticks;
  int stopped_after = -1;
  for (int i = 0; i < 250; ++i) {
    ticker.tick();
    if (stopped_after < 0 && bench.device->fault() != driver::Fault::kNone && ticker.force == 0) {
      stopped_after = ticker.ticks - begin;
    }
  }
  order(pipe, "heal");
  const driver::WireCounters after = bench.device->wire_counters();
  const driver::Fault named = bench.device->fault();
  // Silence is a fault after 20 ms; the command itself reaches the arm after one or two ticks.
  constexpr int kStopTicks = 30;
  const bool stop_kept =
      !must_stop(arm, line) || (stopped_after >= 0 && stopped_after <= kStopTicks);
  const bool limit_kept = ticker.force_max <= check_settings().limits.force_max + 1e-9;
  const auto more = [](std::uint64_t now, std::uint64_t then) {
    return std::to_string(now - then);
  };
  const std::string counted = "rejected " + more(after.rejected, before.rejected) + ", missing " +
                              more(after.missing, before.missing) + ", skipped " +
                              more(after.skipped, before.skipped) + ", refused " +
                              more(after.refused, before.refused) + ", repeated " +
                              more(after.repeated, before.repeated);
  const std::string stop =
      stopped_after >= 0 ? std::to_string(stopped_after) : std::string("continues");
  const std::string name(driver::name(named));
  // For the table of all cells: arm, fault, name of the fault in the driver, ticks to zero force,
  // promise, force, counters, longest tick.
  std::printf("CELL %s|%s|%s|%s|%s|%.3f|%s|%lld\n", arm.name.c_str(), line.c_str(), name.c_str(),
              stop.c_str(), must_stop(arm, line) ? "zero in 30" : "within 3 N", ticker.force_max,
              counted.c_str(), static_cast<long long>(ticker.longest_ns / 1000));
  return verdict(stop_kept && limit_kept, arm.name + " with " + line,
                 "fault '" + name + "', zero force after (ticks): " + stop + "; at most " +
                     std::to_string(ticker.force_max) + " N; " + counted);
}

int run(const std::vector<std::string>& words) {
  const auto word = [&](std::size_t i) { return i < words.size() ? words[i] : std::string(); };
  VirtualArm arm{.name = word(1), .firmware = {}};
  const std::string& what = words[0];
  if (what == "find") return find(arm);
  if (what == "name") {
    const auto found = arm.find();
    std::printf("%s\n", found ? found->name().c_str() : "");
    return found ? 0 : 1;
  }
  if (what == "kernel") return check_kernel(arm);
  if (what == "vector") return check_vectors(arm);
  if (what == "listen") return check_unasked(arm);
  if (what == "wrong") return check_wrong_length(arm);
  if (what == "fresh") {
    arm.firmware = word(2);
    return fresh(arm);
  }
  if (what == "denied") return denied(arm);
  if (what == "hang") {
    arm.firmware = word(2);
    return hang(arm);
  }
  if (what == "descriptor") return print_report_descriptor(arm.name);
  if (what == "gadget") return run_gadget(arm.name, word(2));
  if (what == "compare") return compare_traces(arm, word(2), word(3));
  if (what == "hide") return print_hidden_file(word(1), word(2), word(3) == "cables");
  if (what == "identified") {
    return check_identified(word(1), word(2), word(3), word(4), word(5));
  }
  if (what == "program") return trace_of_program(arm, word(2), word(3), word(4), word(5));
  if (what == "touch") {
    arm.firmware = word(4);
    return touch(arm, std::strtoull(word(2).c_str(), nullptr, 10), word(3));
  }
  if (what == "replug") {
    arm.firmware = word(3);
    return replug(arm, word(2));
  }
  if (what == "fault") {
    arm.firmware = word(4);
    return fault(arm, word(2), word(3));
  }
  return verdict(false, what, "is not a known check");
}

}  // namespace
}  // namespace thimble::usb_test

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 2) return 2;
  const int descriptors = thimble::usb_test::open_descriptors();
  const int bad = thimble::usb_test::run(words);
  const int left = thimble::usb_test::open_descriptors() - descriptors;
  if (left == 0) return bad;
  return thimble::usb_test::verdict(false, words[1] + " after " + words[0],
                                    std::to_string(left) + " descriptors left open");
}
