#include "usb/trace_compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

namespace thimble::usb_test {
namespace {

using Counts = std::array<std::int32_t, 3>;
using Numbers = std::array<double, 3>;

struct Tick {
  int fresh = 0;
  Counts counts{};
  Numbers f_sent{};
};

/// A packet as received by the arm.
struct Report {
  std::uint64_t number = 0;  // counted by the arm; two in one frame cause a missing number
  std::int64_t sampled_frame = 0, sampled_ns = 0;
  Counts counts{};
  Numbers exact{};
};
struct Message {
  std::int64_t frame = 0, time_ns = 0;  // frame: the frame of its line in the trace
  Counts values{};
};

struct DriverTrace {
  std::size_t refused = 0;  // messages that the wire refused
  std::vector<Tick> ticks;
};

DriverTrace read_driver(const std::string& file) {
  std::ifstream in(file);
  DriverTrace trace;
  std::vector<Tick>& ticks = trace.ticks;
  Tick t;
  in >> trace.refused;
  while (in >> t.fresh >> t.counts[0] >> t.counts[1] >> t.counts[2] >> t.f_sent[0] >> t.f_sent[1] >>
         t.f_sent[2]) {
    ticks.push_back(t);
  }
  return trace;
}

struct DeviceTrace {
  std::vector<Report> reports;
  std::map<std::uint64_t, Message> messages;  // by number; two in one frame cause a missing number
};

DeviceTrace read_device(const std::string& file) {
  std::ifstream in(file);
  DeviceTrace trace;
  std::uint64_t reports_before = 0, messages_before = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    int motors_on = 0;
    Numbers currents{}, p_BT{};
    std::uint64_t messages = 0;
    Report r;
    Message m;
    words >> m.frame >> r.number >> r.sampled_frame >> r.counts[0] >> r.counts[1] >> r.counts[2] >>
        r.exact[0] >> r.exact[1] >> r.exact[2] >> messages >> m.values[0] >> m.values[1] >>
        m.values[2] >> currents[0] >> currents[1] >> currents[2] >> p_BT[0] >> p_BT[1] >> p_BT[2] >>
        motors_on >> r.sampled_ns >> m.time_ns;
    if (!words) break;  // the last line may be incomplete
    if (r.number != reports_before) trace.reports.push_back(r);
    if (messages != messages_before) trace.messages[messages] = m;
    reports_before = r.number;
    messages_before = messages;
  }
  return trace;
}

/// Returns the motor values for a force at these counts, by tau = J^T f, in the wire's unit (mA, or
/// motor values of the Falcon, also 1000 per ampere).
Numbers values_for(const driver::Arm& arm, const Tick& tick) {
  driver::ArmReading reading;
  reading.counts = tick.counts;
  const driver::ArmPose pose = arm.pose(reading);
  const Eigen::Vector3d force(tick.f_sent[0], tick.f_sent[1], tick.f_sent[2]);
  const Eigen::Vector3d tau = pose.J_BT.transpose() * force;
  Numbers values{};
  for (std::size_t i = 0; i < 3; ++i) {
    const driver::MotorDrive& drive = arm.drives()[i];
    if (drive.sign == 0) continue;  // no such motor
    values[i] = 1000 * tau[static_cast<Eigen::Index>(i)] /
                (drive.sign * drive.ratio * drive.torque_constant);
  }
  return values;
}

struct Match {
  std::size_t wrong = 0, compared = 0, left_out = 0;
  double worst = 0;
  std::vector<std::uint64_t> message_of;  // number of each tick's message, 0 if it is missing
  std::vector<bool> certain;              // whether no other number is possible
};

/// Marks the ticks whose message is certainly that of `message_of`. Without refused messages all
/// are. Otherwise a tick in free motion, whose message equals those of its neighbours, may belong
/// to a neighbouring message: it is certain only between two ticks whose messages are unlike all
/// nearby ones, and if no message was left out between these two.
void mark_certain(const std::vector<Numbers>& wanted, std::size_t refused, Match& match) {
  const std::size_t count = wanted.size();
  match.certain.assign(count, refused == 0);
  if (refused == 0) return;
  const auto unlike_nearby = [&](std::size_t i) {
    if (match.message_of[i] == 0) return false;
    const std::size_t begin = i - std::min(i, refused + 1), end = std::min(count, i + refused + 2);
    for (std::size_t k = begin; k < end; ++k) {
      double off = 0;
      for (std::size_t m = 0; m < 3; ++m)
        off = std::max(off, std::abs(wanted[k][m] - wanted[i][m]));
      if (k != i && off <= 2) return false;  // quanta; a match may be 0.51 off
    }
    return true;
  };
  std::size_t before = SIZE_MAX;
  for (std::size_t i = 0; i < count; ++i) {
    if (!unlike_nearby(i)) continue;
    const bool same =
        before != SIZE_MAX && match.message_of[i] - match.message_of[before] == i - before;
    for (std::size_t k = same ? before : i; k <= i; ++k) match.certain[k] = true;
    before = i;
  }
}

double difference(const Message& message, const Numbers& wanted) {
  double off = 0;
  for (std::size_t k = 0; k < 3; ++k) off = std::max(off, std::abs(message.values[k] - wanted[k]));
  return off;
}

/// Compares the messages from `first` on with the ticks in order. The number of ticks without a
/// message may equal the number of refused messages: if a message is that of the next tick, the
/// message of this tick was refused.
Match match_messages(const std::vector<Numbers>& wanted, const DeviceTrace& trace,
                     std::uint64_t first, std::size_t refused) {
  // Rounding adds half a quantum, the precision of the trace a hundredth.
  constexpr double kOff = 0.51;
  constexpr std::size_t kWrongMax = 50;  // the ticks do not begin here
  Match match;
  match.message_of.assign(wanted.size(), 0);
  for (std::size_t i = 0; i < wanted.size() && match.wrong < kWrongMax; ++i) {
    const std::uint64_t number = first + i - match.left_out;
    const auto found = trace.messages.find(number);
    if (found == trace.messages.end()) continue;
    const double off = difference(found->second, wanted[i]);
    // Several in a row may have been refused.
    bool of_later = false;
    for (std::size_t k = i + 1; k < wanted.size() && k - i <= refused - match.left_out; ++k) {
      of_later = of_later || difference(found->second, wanted[k]) <= kOff;
    }
    if (off > kOff && of_later) {
      ++match.left_out;
      continue;
    }
    ++match.compared;
    match.message_of[i] = number;
    if (off > kOff) ++match.wrong;
    match.worst = std::max(match.worst, off);
  }
  return match;
}

int say(bool pass, const std::string& what, const std::string& detail) {
  std::printf("%s %s: %s\n", pass ? "PASS" : "FAIL", what.c_str(), detail.c_str());
  return pass ? 0 : 1;
}

}  // namespace

void write_trace(const std::vector<driver::TickRecord>& records, std::uint64_t refused,
                 const std::string& file) {
  std::FILE* out = std::fopen(file.c_str(), "we");
  if (out == nullptr) return;
  std::fprintf(out, "%llu\n", static_cast<unsigned long long>(refused));
  for (const driver::TickRecord& r : records) {
    std::fprintf(out, "%d %d %d %d %.9f %.9f %.9f\n", r.fresh ? 1 : 0, r.counts[0], r.counts[1],
                 r.counts[2], r.f_sent_W[0], r.f_sent_W[1], r.f_sent_W[2]);
  }
  std::fclose(out);
}

int compare_traces(const VirtualArm& arm, const std::string& driver_trace,
                   const std::string& device_trace) {
  const DriverTrace driven = read_driver(driver_trace);
  const std::vector<Tick>& ticks = driven.ticks;
  const DeviceTrace trace = read_device(device_trace);
  const auto protocol = arm.protocol();
  if (ticks.size() < 100 || trace.reports.size() < 100) {
    return say(false, arm.name + " traces", "too short to compare");
  }

  // Positions: each position of the driver is one of the reports that the arm sent, in order. The
  // trace has one line per frame, so it lacks one of two reports in a frame. Such a report must not
  // be matched with a later one with the same counts: the arm moves to and fro, and all later ticks
  // would then be compared with future reports. Number of reports to search in addition to one for
  // each tick since the last match [chosen].
  constexpr std::size_t kAhead = 8;
  std::size_t at = 0, last_tick = 0, unknown = 0, lacking = 0;
  std::vector<std::size_t> seen(ticks.size(), SIZE_MAX);
  double worst_count = 0;
  const auto find = [&](std::size_t begin, std::size_t end, const Counts& counts) {
    std::size_t k = begin;
    while (k < end && trace.reports[k].counts != counts) ++k;
    return k;
  };
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    if (ticks[i].fresh == 0) continue;
    const std::size_t end = std::min(trace.reports.size(), at + (i - last_tick) + kAhead);
    std::size_t k = find(at, end, ticks[i].counts);
    if (k == end) {
      const bool gap = trace.reports[end - 1].number - trace.reports[at].number > end - 1 - at;
      if (gap && last_tick > 0) {
        ++lacking;
        continue;
      }
      k = find(at, trace.reports.size(), ticks[i].counts);
    }
    if (k == trace.reports.size()) {
      ++unknown;
      continue;
    }
    at = seen[i] = k;
    last_tick = i;
    for (std::size_t leg = 0; leg < 3; ++leg) {
      const double off = std::abs(trace.reports[k].counts[leg] - trace.reports[k].exact[leg]);
      worst_count = std::max(worst_count, off);
    }
  }
  const std::uint64_t left_out =
      trace.reports.back().number + 1 - trace.reports.front().number - trace.reports.size();
  int bad = say(unknown == 0 && lacking <= left_out && worst_count <= 1, arm.name + " position",
                std::to_string(unknown) + " unknown positions of " + std::to_string(ticks.size()) +
                    ", " + std::to_string(lacking) + " of " + std::to_string(left_out) +
                    " reports that share a frame, " + std::to_string(worst_count) +
                    " counts off at most");

  // Forces: the messages of the ticks are consecutive messages of the arm; the driver sent a few
  // before the first.
  std::vector<Numbers> wanted;
  wanted.reserve(ticks.size());
  for (const Tick& tick : ticks) wanted.push_back(values_for(*protocol, tick));
  Match best;
  std::uint64_t best_first = 0;
  const std::uint64_t last = trace.messages.empty() ? 0 : trace.messages.rbegin()->first;
  for (std::uint64_t first = 1; first + wanted.size() <= last + 1 + driven.refused; ++first) {
    Match match = match_messages(wanted, trace, first, driven.refused);
    const bool better = best_first == 0 || match.wrong < best.wrong;
    if (!better) continue;
    best = std::move(match);
    best_first = first;
  }
  mark_certain(wanted, driven.refused, best);
  bad += say(best_first != 0 && best.wrong == 0 && best.compared > wanted.size() * 9 / 10,
             arm.name + " force",
             std::to_string(best.compared) + " messages compared, " + std::to_string(best.wrong) +
                 " wrong, " + std::to_string(best.worst) + " quanta off at most; " +
                 std::to_string(best.left_out) + " of " + std::to_string(driven.refused) +
                 " refused ones omitted");

  // Delay: only for reports whose counts differ from those of all nearby reports, so that the tick
  // certainly responds to this report, and only where its message is certain. One in a hundred may
  // still be matched with a later report, whose response then seems too early.
  constexpr std::size_t kNear = 25;  // reports before and after [chosen]
  std::vector<double> delays;        // ms
  std::size_t early = 0;             // responses within the frame of their report
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const std::size_t k = seen[i];
    if (k == SIZE_MAX || k < kNear || k + kNear >= trace.reports.size()) continue;
    const Report& report = trace.reports[k];
    std::size_t alike = 0;
    for (std::size_t j = k - kNear; j <= k + kNear; ++j) {
      alike += trace.reports[j].counts == report.counts ? 1 : 0;
    }
    // The trace lacks no report nearby, with which the tick could be matched instead.
    const bool whole =
        trace.reports[k + kNear].number - trace.reports[k - kNear].number == 2 * kNear;
    const bool sure = alike == 1 && whole && best.certain[i];
    const auto message = trace.messages.find(best.message_of[i]);
    if (!sure || message == trace.messages.end()) continue;
    if (message->second.frame <= report.sampled_frame) {
      // The report with the same counts before the message is the one to which it responds.
      bool answers_another = false;
      for (std::size_t j = k; j-- > 0 && !answers_another;) {
        answers_another = trace.reports[j].counts == report.counts &&
                          trace.reports[j].sampled_frame < message->second.frame;
      }
      if (answers_another) continue;
      ++early;
    }
    delays.push_back(1e-6 * static_cast<double>(message->second.time_ns - report.sampled_ns));
  }
  std::sort(delays.begin(), delays.end());
  if (delays.size() < 10) return bad + say(false, arm.name + " delay", "too few moving ticks");
  const auto part = [&](double share) {
    return delays[static_cast<std::size_t>(share * static_cast<double>(delays.size() - 1))];
  };
  std::printf("FIGURE %s.delay_median %.3f ms\n", arm.name.c_str(), part(0.5));
  std::printf("FIGURE %s.delay_99 %.3f ms\n", arm.name.c_str(), part(0.99));
  std::printf("FIGURE %s.delay_1 %.3f ms\n", arm.name.c_str(), part(0.01));
  // A response in the next frame takes a frame of 1 ms, less the difference of the places of both
  // packets in their frames, which bulk transfers may have [chosen: at most a tenth of a frame].
  return bad + say(100 * early <= delays.size() && part(0.5) >= 0.9, arm.name + " delay",
                   "from encoder to force " + std::to_string(part(0.5)) + " ms, 99 in 100 " +
                       std::to_string(part(0.99)) + " at most; " + std::to_string(early) + " of " +
                       std::to_string(delays.size()) + " answered in their own frame");
}

}  // namespace thimble::usb_test
