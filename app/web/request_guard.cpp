#include "web/request_guard.h"

#include <sys/random.h>

#include <array>
#include <cstddef>

namespace thimble::web {
namespace {

constexpr std::size_t kTokenBytes = 16;
constexpr std::string_view kAsk = "?token=";
constexpr const char* kNotOurs = "Requests from other pages are refused.";
constexpr const char* kWrongToken =
    "The token is wrong; open the address printed by `thimble view --web`.";
constexpr const char* kNothingElse = "No such page.";

// Compares in constant time: the duration does not depend on how many characters match.
bool same(std::string_view a, std::string_view b) {
  unsigned different = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < b.size(); ++i) {
    different |=
        static_cast<unsigned char>(b[i]) ^ static_cast<unsigned char>(i < a.size() ? a[i] : '\0');
  }
  return different == 0;
}

bool is_here(std::string_view host, std::uint16_t port) {
  const std::string with_port = ":" + std::to_string(port);
  return host == "127.0.0.1" + with_port || host == "localhost" + with_port;
}

}  // namespace

driver::Result<RequestGuard> RequestGuard::make() {
  std::array<unsigned char, kTokenBytes> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    return driver::Error{
        "The kernel returned no random numbers (getrandom) for the access token, so the page is "
        "not served."};
  }
  std::string token;
  for (const unsigned char byte : bytes) {
    token += "0123456789abcdef"[byte >> 4];
    token += "0123456789abcdef"[byte & 15];
  }
  return RequestGuard(std::move(token));
}

std::string RequestGuard::refuse_place(const Request& request, std::uint16_t port) {
  if (!is_here(request.host, port)) {
    return "Open this page as 127.0.0.1 or localhost with its own port; over ssh, forward the same "
           "port (ssh -L).";
  }
  constexpr std::string_view kScheme = "http://";
  if (!request.origin.empty() && (!request.origin.starts_with(kScheme) ||
                                  !same(request.origin.substr(kScheme.size()), request.host))) {
    return kNotOurs;
  }
  return {};
}

std::string RequestGuard::refuse(const Request& request, std::string_view path,
                                 std::uint16_t port) const {
  if (std::string wrong = refuse_place(request, port); !wrong.empty()) return wrong;
  const std::size_t query = request.target.find('?');
  const std::string_view asked =
      query == std::string_view::npos ? std::string_view{} : request.target.substr(query);
  if (!asked.starts_with(kAsk) || !same(asked.substr(kAsk.size()), token_)) {
    return kWrongToken;
  }
  if (request.target.substr(0, query) != path) return kNothingElse;
  return {};
}

std::string RequestGuard::refuse_change(const Request& request, std::string_view path,
                                        std::uint16_t port) const {
  if (std::string wrong = refuse_place(request, port); !wrong.empty()) return wrong;
  if (request.origin.empty()) return kNotOurs;
  if (!same(request.token, token_)) return kWrongToken;
  if (request.target != path) return kNothingElse;
  return {};
}

}  // namespace thimble::web
