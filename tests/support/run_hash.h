#pragma once

#include <cstdint>
#include <cstring>

#include "thimble/driver/tick_record.h"

namespace thimble::support {

/// Combines the bits of a run in one number, so that a test can store the result of a run [FNV-1a,
/// 64 bit].
class RunHash {
 public:
  template <class T>
  void add(const T& value) {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (const unsigned char byte : bytes) hash_ = (hash_ ^ byte) * 0x100000001b3u;
  }

  /// Adds everything of a tick except its timing on the wall clock.
  void add(const driver::TickRecord& row) {
    add(row.tick);
    add(row.time_ns);
    add(row.counts);
    add(row.q);
    add(row.p_WT);
    add(row.v_WT);
    add(row.p_WP);
    add(row.n_W);
    add(row.f_wanted_W);
    add(row.f_sent_W);
    add(row.depth);
    add(row.feature);
    add(row.hops);
    add(row.in_contact);
  }

  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace thimble::support
