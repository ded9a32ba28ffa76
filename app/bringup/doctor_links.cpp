#include "bringup/doctor_links.h"

#include <algorithm>

#include "links/dhd/dhd_library.h"
#include "links/haply/haply_link.h"
#include "links/hd/hd_library.h"

namespace thimble::app {
namespace {

using driver::BoardKind;
using driver::Certainty;
using driver::FoundArm;

/// Returns whether it is the USB side of an arm that its service drives.
bool is_haply_on_usb(const FoundArm& arm) {
  return arm.certainty == Certainty::kUnsupported && arm.arm == "Haply Inverse3";
}

}  // namespace

std::string mend_for_closed(const FoundArm& arm) {
  if (is_haply_on_usb(arm)) {
    return "Use it by its vendor's service, which lists it in `thimble devices` as another line; "
           "this line is never opened.";
  }
  if (arm.arm == "Force Dimension") {
    const auto library = driver::dhd::library();
    return library
               ? std::string("Plug it in again.")
               : library.error().message +
                     " Install the vendor's SDK and set FDSDK to its folder, or "
                     "THIMBLE_DHD_LIBRARY to its libdrd.so.3; Thimble drives the arm through it.";
  }
  const auto library = driver::hd::library();
  if (library) return "Plug it in again.";
  return library.error().message +
         " Install OpenHaptics and the arm's driver (they need libncurses5 and the group of its "
         "node), "
         "or set THIMBLE_HD_LIBRARY to libHD.so; Thimble drives the arm through it.";
}

Finding examine_linked(const FoundArm& arm) {
  const std::string name = arm.arm + " " + arm.name() + ": ";
  if (!arm.trouble.empty()) {
    return {Health::kProblem,
            name + "its service on " + arm.address + " has it, but it cannot be used.",
            arm.trouble};
  }
  return {Health::kGood,
          name + "its service on " + arm.address + " has it" +
              (arm.software.empty() ? ", and tells no versions of it" : " (" + arm.software + ")") +
              ". Untried on hardware.",
          {}};
}

std::vector<Finding> examine_services(const std::vector<FoundArm>& arms) {
  const bool on_usb = std::any_of(arms.begin(), arms.end(), is_haply_on_usb);
  const bool served = std::any_of(arms.begin(), arms.end(), [](const FoundArm& arm) {
    return arm.board == BoardKind::kHaplyService;
  });
  if (!on_usb || served) return {};
  const auto asked = driver::haply::find_arms(driver::haply::port_of_user());
  const std::string why = asked ? "It runs, and lists no Inverse3." : asked.error().message;
  return {{Health::kProblem, "An Inverse3 is plugged in, but no service tells of it. " + why,
           "Install and start Haply's Inverse Service; if it listens elsewhere, set "
           "THIMBLE_HAPLY_PORT to its WebSocket port"}};
}

}  // namespace thimble::app
