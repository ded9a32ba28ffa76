#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace thimble::support {

/// libusb with one scripted FTDI converter on its bus, for programs that link fake_libusb.cpp. Its
/// functions replace the library's. The script, written in advance, gives the result of each read
/// and how messages are accepted. While the script runs, nothing here uses the heap, so that a heap
/// guard counts only the code under test.
class FakeLibusb {
 public:
  static constexpr std::size_t kChatMax = 4096;

  /// Result of one read.
  struct Read {
    int status = 0;  ///< A libusb_transfer_status.
    std::array<std::byte, 64> bytes{};
    std::size_t size = 0;
  };

  /// Resets to a converter at bus 1, device 7.
  void reset() { *this = FakeLibusb(); }

  /// Makes the next read return two status bytes and this text.
  void say(std::string_view text);
  /// Makes the next read end with this libusb_transfer_status and no data.
  void fail(int status);

  bool answers = false;   ///< Each accepted message is answered by `answer`.
  bool takes = true;      ///< Messages complete at once; otherwise they stay pending.
  int write_status = 0;   ///< Result of a message.
  int interruptions = 0;  ///< Number of following calls that a signal interrupts.
  int read_code = 0;      ///< Result of a read without data; 0: a timeout.
  std::array<int, 4> requests_refused{-1, -1, -1, -1};  ///< Numbers of control requests that fail.
  int submit_code = 0;                                  ///< Result of submitting a transfer.
  int open_code = 0;                                    ///< Result of opening the device.
  std::string_view answer;                              ///< Without the status bytes.

  int transfers = 0;      ///< Allocated and not freed.
  int under_way = 0;      ///< Submitted and not complete.
  int handles = 0;        ///< Open devices.
  int contexts = 0;       ///< Open contexts.
  int claimed = 0;        ///< Interfaces claimed and not released.
  int cleared_halts = 0;  ///< Endpoints whose halt was cleared.
  int control_requests = 0;
  std::uint64_t messages = 0;  ///< Accepted messages.
  std::array<std::byte, 64> last_message{};
  std::size_t last_message_size = 0;

  // State of the library's functions.
  std::array<void*, 8> waiting{};
  bool take_read(Read& read);

 private:
  std::array<Read, kChatMax> chat_{};
  std::size_t chat_begin_ = 0, chat_end_ = 0;
};

/// Returns the only instance.
FakeLibusb& fake_libusb();

}  // namespace thimble::support
