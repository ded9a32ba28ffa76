#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "support/boards/raw_hid.h"
#include "support/scratch.h"

namespace thimble::support {

/// Builds a root folder that looks to Thimble like a machine: the files of /sys, /dev, /proc and
/// /etc that Thimble reads.
class FakeUsb {
 public:
  /// Starts with a machine that has USB and no devices. `name` separates tests.
  explicit FakeUsb(std::string_view name) : root_(scratch_folder() / name) {
    std::filesystem::create_directories(root_ / "sys/bus/usb/devices");
    write("proc/sys/kernel/sched_rt_runtime_us", "950000");
    plug("usb1", "1d6b", "0002", "", 1, 1, "480");
  }

  const std::filesystem::path& root() const { return root_; }

  /// Writes a file and creates its folders.
  void write(const std::filesystem::path& file, std::string_view text) const {
    std::filesystem::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text << '\n';
  }

  /// Adds a device; `port` is the kernel's name ("1-4" or, behind a hub, "1-4.2").
  void plug(const std::string& port, std::string_view vendor, std::string_view product,
            std::string_view serial, int bus, int device, std::string_view speed = "12") const {
    const std::filesystem::path folder = device_folder(port);
    write(folder / "idVendor", vendor);
    write(folder / "idProduct", product);
    if (!serial.empty()) write(folder / "serial", serial);
    write(folder / "busnum", std::to_string(bus));
    write(folder / "devnum", std::to_string(device));
    write(folder / "speed", speed);
    write(folder / "power/control", "on");
    char node[40];
    std::snprintf(node, sizeof node, "dev/bus/usb/%03d/%03d", bus, device);
    write(node, "");
  }

  /// Adds an interface with a driver to a device.
  void bind(const std::string& port, int interface, const std::string& driver) const {
    const auto folder = root_ / interface_folder(port, interface);
    std::filesystem::create_directories(folder);
    const auto drivers = root_ / "sys/bus/usb/drivers" / driver;
    std::filesystem::create_directories(drivers);
    std::filesystem::create_directory_symlink(drivers, folder / "driver");
  }

  /// Adds a hidraw node to an interface, with reports of `bytes` in each direction (0: no
  /// descriptor).
  void add_hidraw(const std::string& port, int interface, const std::string& node,
                  unsigned char bytes = 8, unsigned page = 0xffab) const {
    const auto hid = interface_folder(port, interface) / "0003:0000:0000.0001";
    std::filesystem::create_directories(root_ / hid / "hidraw" / node);
    if (bytes > 0) {
      const auto descriptor = raw_hid_descriptor(bytes, bytes, page);
      std::ofstream(root_ / hid / "report_descriptor", std::ios::binary)
          .write(reinterpret_cast<const char*>(descriptor.data()),
                 static_cast<std::streamsize>(descriptor.size()));
    }
    write("dev/" + node, "");
  }

  /// Sets the product string of a device.
  void call(const std::string& port, std::string_view product) const {
    write(device_folder(port) / "product", product);
  }

  /// Adds a serial port to an interface.
  void add_tty(const std::string& port, int interface, const std::string& node) const {
    std::filesystem::create_directories(root_ / interface_folder(port, interface) / "tty" / node);
    write("dev/" + node, "");
  }

  std::filesystem::path device_folder(const std::string& port) const {
    return std::filesystem::path("sys/bus/usb/devices") / port;
  }

  void unplug(const std::string& port) const {
    std::filesystem::remove_all(root_ / device_folder(port));
  }

 private:
  std::filesystem::path interface_folder(const std::string& port, int interface) const {
    return device_folder(port) / (port + ":1." + std::to_string(interface));
  }

  std::filesystem::path root_;
};

}  // namespace thimble::support
