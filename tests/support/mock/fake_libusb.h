#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace thimble::support {

/// Libusb with one scripted FTDI converter on its bus, for programs that link fake_libusb.cpp:
/// its functions stand in for the library's. A chat is written beforehand: what each read of the
/// converter comes to, and how it takes messages. Nothing here asks the heap for anything once the
/// chat runs, so that a heap guard sees the code under test alone.
class FakeLibusb {
 public:
  static constexpr std::size_t kChatMax = 4096;

  /// What one read comes to.
  struct Read {
    int status = 0;  ///< A libusb_transfer_status.
    std::array<std::byte, 64> bytes{};
    std::size_t size = 0;
  };

  /// Begins anew with a converter at bus 1, device 7.
  void reset() { *this = FakeLibusb(); }

  /// Lets the next read bring two status bytes and this text.
  void say(std::string_view text);
  /// Lets the next read end so (a libusb_transfer_status) with nothing.
  void fail(int status);

  bool answers = false;   ///< Each message that is taken is answered by `answer`.
  bool takes = true;      ///< Messages complete at once; otherwise they stay under way.
  int write_status = 0;   ///< What a message comes to.
  int interruptions = 0;  ///< So many calls from now on are interrupted by a signal.
  int read_code = 0;      ///< What a read of the line that brings nothing comes to, 0: a timeout.
  std::array<int, 4> requests_refused{-1, -1, -1, -1};  ///< Numbers of control requests that fail.
  int submit_code = 0;                                  ///< What handing a transfer over answers.
  int open_code = 0;                                    ///< What opening the device answers.
  std::string_view answer;                              ///< Without the status bytes.

  int transfers = 0;      ///< Made and not freed.
  int under_way = 0;      ///< Handed over and not complete.
  int handles = 0;        ///< Open devices.
  int contexts = 0;       ///< Open contexts.
  int claimed = 0;        ///< Interfaces claimed and not given back.
  int cleared_halts = 0;  ///< Endpoints whose halt was cleared.
  int control_requests = 0;
  std::uint64_t messages = 0;  ///< Messages taken.
  std::array<std::byte, 64> last_message{};
  std::size_t last_message_size = 0;

  // For the functions of the library.
  std::array<void*, 8> waiting{};
  bool take_read(Read& read);

 private:
  std::array<Read, kChatMax> chat_{};
  std::size_t chat_begin_ = 0, chat_end_ = 0;
};

/// Returns the only one.
FakeLibusb& fake_libusb();

}  // namespace thimble::support
