#pragma once

#include <hdf5.h>

#include <mutex>
#include <utility>

namespace thimble::session {

/// Owns one handle of the HDF5 library and closes it. Real-time: never from the servo thread.
class H5Handle {
 public:
  H5Handle(hid_t id, herr_t (*close)(hid_t)) noexcept : id_(id), close_(close) {}
  H5Handle(H5Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  H5Handle& operator=(H5Handle&&) = delete;
  H5Handle(const H5Handle&) = delete;
  H5Handle& operator=(const H5Handle&) = delete;
  ~H5Handle() {
    if (id_ >= 0) close_(id_);
  }

  /// Returns whether the handle is valid.
  bool good() const noexcept { return id_ >= 0; }
  hid_t id() const noexcept { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Returns the lock for the HDF5 library. All code of this process that uses the library, or forks
/// a child that uses it, must hold it. Otherwise a child could inherit an internal lock of the
/// library, held by another thread, and wait forever.
inline std::mutex& hdf5_mutex() noexcept {
  static std::mutex mutex;
  return mutex;
}

/// Prevents the library from printing its error stack; Thimble reports errors itself. Call it
/// before any other function of the library. It also disables the library's cleanup at exit, which
/// crashes on a full disk (HDF5 1.10); every handle here has an owner that closes it.
inline void silence_hdf5() noexcept {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace thimble::session
