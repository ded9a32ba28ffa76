#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "thimble/driver/result.h"

namespace thimble::web {

/// Who may see a page that is served on this computer: who knows its token, and no web page of
/// anybody else, whatever name it has given our address (DNS rebinding). Real-time: never from the
/// servo thread.
class RequestGuard {
 public:
  /// What a request names of itself; empty: it does not.
  struct Request {
    std::string_view target;  ///< Path and query, as the request has them.
    std::string_view host;    ///< Its Host.
    std::string_view origin;  ///< Its Origin: the page that asks, which every browser names.
    /// Its X-Thimble-Token, which no page of somebody else's can send without being asked first.
    std::string_view token{};
  };

  /// Makes a token out of 128 bits of the kernel's (getrandom). The error says that it gave none.
  static driver::Result<RequestGuard> make();

  /// Returns 32 digits of hexadecimal.
  const std::string& token() const noexcept { return token_; }
  /// Returns what is wrong with a request for `path` on `port`, as a sentence; empty: nothing.
  std::string refuse(const Request& request, std::string_view path, std::uint16_t port) const;
  /// Returns what is wrong with a request that would change something: as above, but it names its
  /// Origin, and its token stands in a header and not in its address.
  std::string refuse_change(const Request& request, std::string_view path,
                            std::uint16_t port) const;

 private:
  static std::string refuse_place(const Request& request, std::uint16_t port);
  explicit RequestGuard(std::string token) : token_(std::move(token)) {}

  std::string token_;
};

}  // namespace thimble::web
