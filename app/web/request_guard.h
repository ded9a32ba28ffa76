#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "thimble/driver/result.h"

namespace thimble::web {

/// Access control of the local web server. A request needs the token. Web pages of other origins
/// are refused, whatever name they have given our address (DNS rebinding). Real-time: never from
/// the servo thread.
class RequestGuard {
 public:
  /// The fields of a request that are checked; empty: absent.
  struct Request {
    std::string_view target;  ///< Path and query of the request.
    std::string_view host;    ///< Header `Host`.
    std::string_view origin;  ///< Header `Origin`: origin of the page; every browser sends it.
    /// Header `X-Thimble-Token`. A page of another origin cannot send it without a preflight
    /// request.
    std::string_view token{};
  };

  /// Makes a token of 128 random bits from the kernel (getrandom). Fails if the kernel returns
  /// none.
  static driver::Result<RequestGuard> make();

  /// Returns the token as 32 hexadecimal digits.
  const std::string& token() const noexcept { return token_; }
  /// Returns why a request for `path` on `port` is refused, as a sentence; empty: it is allowed.
  std::string refuse(const Request& request, std::string_view path, std::uint16_t port) const;
  /// Returns why a request that changes something is refused. In addition to the checks of
  /// `refuse`, it needs an Origin, and its token must be in a header and not in the URL.
  std::string refuse_change(const Request& request, std::string_view path,
                            std::uint16_t port) const;

 private:
  static std::string refuse_place(const Request& request, std::uint16_t port);
  explicit RequestGuard(std::string token) : token_(std::move(token)) {}

  std::string token_;
};

}  // namespace thimble::web
