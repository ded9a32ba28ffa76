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

  /// Returns whether the library gave a handle.
  bool good() const noexcept { return id_ >= 0; }
  hid_t id() const noexcept { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Returns the lock that whatever uses the library in this process holds, and whatever forks a
/// child that uses it: of a lock of the library's own that another thread holds at that moment the
/// child would wait for ever.
inline std::mutex& hdf5_mutex() noexcept {
  static std::mutex mutex;
  return mutex;
}

/// Keeps the library from printing its own stack of errors: Thimble says what happened. Before
/// anything else of the library: then it does not tidy up at the program's end either, which on a
/// full disk ends in a crash (HDF5 1.10); every handle here has an owner that closes it.
inline void silence_hdf5() noexcept {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace thimble::session
