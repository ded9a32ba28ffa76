#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "support/fault_cell.h"
#include "thimble/driver/fault.h"

namespace thimble::support {

/// Counts the non-zero forces from index `from` on: those that reached an arm after a fault began.
inline int forces_since(const std::vector<Eigen::Vector3d>& taken, std::size_t from) {
  return static_cast<int>(
      std::count_if(taken.begin() + static_cast<std::ptrdiff_t>(std::min(from, taken.size())),
                    taken.end(), [](const Eigen::Vector3d& f) { return !f.isZero(0); }));
}

/// One row of the table of faults (tests/acceptance/FAULTS.md) for an arm behind a vendor's library
/// or service: the promise, and whether the checks since its construction have passed.
class LinkFaultRow {
 public:
  /// `arm`: the library or service; `more`: the number of messages with a force that may still
  /// reach the arm.
  LinkFaultRow(std::string_view fault, std::string_view arm, driver::Fault cause, int more)
      : fault_(fault), arm_(arm), cause_(cause), more_(more), parts_(parts()) {}
  LinkFaultRow(const LinkFaultRow&) = delete;
  LinkFaultRow& operator=(const LinkFaultRow&) = delete;
  ~LinkFaultRow() {
    record_fault(fault_, arm_, "link",
                 "off: " + std::string(driver::name(cause_)) + "; at most " +
                     std::to_string(more_) + " more with a force",
                 parts() == parts_ ? "met" : "NOT MET", "");
  }

  driver::Fault cause() const { return cause_; }
  int more() const { return more_; }

 private:
  static int parts() {
    return testing::UnitTest::GetInstance()->current_test_info()->result()->total_part_count();
  }

  std::string fault_, arm_;
  driver::Fault cause_;
  int more_;
  int parts_;  // number of failures of the test before
};

}  // namespace thimble::support
