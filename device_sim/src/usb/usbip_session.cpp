#include "usb/usbip_session.h"
#include "usb/setup_packet.h"
#include "usb/usb_description.h"

#include <algorithm>
#include <array>
#include <utility>

namespace thimble::device_sim::usb {
namespace {

// Linux's errno values, which the protocol uses [Linux, usbip_protocol.rst; uapi errno.h]. Written
// out because those of other systems differ.
constexpr std::int32_t kStalled = -32;    // EPIPE
constexpr std::int32_t kBabble = -75;     // EOVERFLOW
constexpr std::int32_t kUnlinked = -104;  // ECONNRESET
constexpr std::int32_t kNoEndpoint = -2;  // ENOENT

std::uint32_t bit_of(std::uint8_t address) noexcept {
  return 1U << ((address & 0x0fU) + ((address & 0x80U) != 0 ? 16U : 0U));
}

}  // namespace

UsbipSession::UsbipSession(UsbDevice& device, std::string bus_id)
    : device_(device), bus_id_(std::move(bus_id)), pipe_(device) {}

void UsbipSession::receive(std::span<const std::byte> bytes, bool available) {
  input_.insert(input_.end(), bytes.begin(), bytes.end());
  std::size_t taken = 0;
  while (state_ != State::kClosing) {
    const std::span<const std::byte> rest = std::span<const std::byte>(input_).subspan(taken);
    const std::size_t size = state_ == State::kAsking ? ask(rest, available) : command(rest);
    if (size == 0) break;
    taken += size;
  }
  input_.erase(input_.begin(), input_.begin() + static_cast<std::ptrdiff_t>(taken));
}

// Returns whether a message is complete. After an invalid one, the start of the next is unknown.
bool UsbipSession::whole(Decode decoded) noexcept {
  if (decoded == Decode::kInvalid) state_ = State::kClosing;
  return decoded == Decode::kWhole;
}

std::size_t UsbipSession::ask(std::span<const std::byte> bytes, bool available) {
  UsbipRequest request;
  if (!whole(decode_request(bytes, request))) return 0;
  const UsbDescription* offer = available ? &device_.description() : nullptr;
  if (request.kind == UsbipRequest::Kind::kList) {
    output_ = encode_list(offer, bus_id_);
    state_ = State::kClosing;
  } else {
    if (request.bus_id != bus_id_) offer = nullptr;
    output_ = encode_import(offer, bus_id_);
    state_ = offer != nullptr ? State::kAttached : State::kClosing;
  }
  return request.size;
}

std::size_t UsbipSession::command(std::span<const std::byte> bytes) {
  UsbipCommand decoded;
  if (!whole(decode_command(bytes, decoded))) return 0;
  if (decoded.kind == UsbipCommand::Kind::kUnlink) {
    unlink(decoded);
    return decoded.size;
  }
  if (pending_.size() >= kPendingMax) {
    state_ = State::kClosing;
    return 0;
  }
  ++counters_.submitted;
  Transfer transfer;
  transfer.sequence = decoded.sequence;
  transfer.address = decoded.endpoint;
  if (decoded.to_host && decoded.endpoint != 0) transfer.address |= 0x80U;
  transfer.setup = decode_setup(decoded.setup);
  transfer.data.resize(decoded.length);
  if (!decoded.to_host) {
    std::copy_n(bytes.begin() + kUsbipHeaderSize, decoded.length, transfer.data.begin());
  }
  pending_.push_back(std::move(transfer));
  return decoded.size;
}

void UsbipSession::unlink(const UsbipCommand& command) {
  const auto found = std::find_if(pending_.begin(), pending_.end(), [&](const Transfer& t) {
    return t.sequence == command.unlinked;
  });
  const bool waits = found != pending_.end();
  if (waits) {
    pending_.erase(found);
    ++counters_.unlinked;
  }
  append_unlink_reply(output_, command.sequence, waits ? kUnlinked : 0);
}

template <class Chosen>
void UsbipSession::run_chosen(std::int64_t frame, Chosen&& chosen) {
  // An endpoint with a waiting transfer, or with a packet in this frame, is done for this frame.
  std::uint32_t done = 0;
  for (auto transfer = pending_.begin(); transfer != pending_.end() && takes_more();) {
    const std::uint32_t bit = bit_of(transfer->address);
    if ((done & bit) != 0 || !chosen(*transfer)) {
      ++transfer;
      continue;
    }
    const Step step = run(*transfer, frame);
    if (step == Step::kGone) {
      state_ = State::kClosing;
      return;
    }
    const EndpointDescription* endpoint = device_.description().endpoint(transfer->address);
    const bool bulk = endpoint != nullptr && endpoint->kind == TransferKind::kBulk;
    if (step == Step::kWaits || !bulk) done |= bit;
    transfer = step == Step::kComplete ? pending_.erase(transfer) : std::next(transfer);
  }
}

bool UsbipSession::is_bulk_out(const Transfer& transfer) const noexcept {
  if ((transfer.address & 0x80U) != 0) return false;
  const EndpointDescription* endpoint = device_.description().endpoint(transfer.address);
  return endpoint != nullptr && endpoint->kind == TransferKind::kBulk;
}

bool UsbipSession::has_bulk_to_send() const noexcept {
  return state_ == State::kAttached &&
         std::any_of(pending_.begin(), pending_.end(),
                     [this](const Transfer& transfer) { return is_bulk_out(transfer); });
}

void UsbipSession::send_bulk() {
  if (state_ != State::kAttached) return;
  run_chosen(0, [this](const Transfer& transfer) { return is_bulk_out(transfer); });
}

void UsbipSession::frame(std::int64_t time_ns) {
  if (state_ != State::kAttached) return;
  run_chosen(time_ns / UsbDevice::kFrame_ns, [](const Transfer&) { return true; });
}

UsbipSession::Step UsbipSession::run(Transfer& transfer, std::int64_t frame) {
  if (transfer.address == 0) return run_control(transfer);
  const EndpointDescription* endpoint = device_.description().endpoint(transfer.address);
  if (endpoint == nullptr || pipe_.configuration() == 0) return complete(transfer, kNoEndpoint);
  if (pipe_.halted(transfer.address)) {
    ++counters_.stalled;
    return complete(transfer, kStalled);
  }
  const bool interrupt = endpoint->kind == TransferKind::kInterrupt;
  if (interrupt && endpoint->interval > 1 && frame % endpoint->interval != 0) return Step::kWaits;
  return run_packets(transfer, *endpoint);
}

UsbipSession::Step UsbipSession::run_control(Transfer& transfer) {
  const std::size_t size = std::min<std::size_t>(transfer.setup.length, transfer.data.size());
  const PacketResult result =
      pipe_.transfer(transfer.setup, std::span<std::byte>(transfer.data).first(size));
  switch (result.answer) {
    case Answer::kDone:
      // Data to the device were moved completely; data from it only as far as it had any.
      transfer.moved = transfer.setup.to_host() ? std::min(result.size, size) : size;
      return complete(transfer, 0);
    case Answer::kNak:
      return Step::kWaits;
    case Answer::kGone:
      return Step::kGone;
    case Answer::kStall:
      break;
  }
  ++counters_.stalled;
  return complete(transfer, kStalled);
}

UsbipSession::Step UsbipSession::run_packets(Transfer& transfer,
                                             const EndpointDescription& endpoint) {
  const bool interrupt = endpoint.kind == TransferKind::kInterrupt;
  const int packets = interrupt ? 1 : kBulkPackets;
  for (int i = 0; i < packets; ++i) {
    const std::span<std::byte> rest = std::span<std::byte>(transfer.data).subspan(transfer.moved);
    const std::size_t wanted = std::min<std::size_t>(rest.size(), endpoint.packet_size);
    std::array<std::byte, UsbDevice::kPacketMax> packet{};
    const PacketResult result = endpoint.to_host()
                                    ? device_.in(endpoint.address, packet)
                                    : device_.out(endpoint.address, rest.first(wanted));
    if (result.answer == Answer::kNak) return Step::kWaits;
    if (result.answer == Answer::kGone) return Step::kGone;
    if (result.answer == Answer::kStall) {
      pipe_.halt(endpoint.address);
      ++counters_.stalled;
      return complete(transfer, kStalled);
    }
    if (!endpoint.to_host()) {
      transfer.moved += wanted;
      if (transfer.moved == transfer.data.size()) return complete(transfer, 0);
      continue;
    }
    const bool babble = result.size > rest.size() || result.size > endpoint.packet_size;
    const std::size_t size = std::min({result.size, rest.size(), packet.size()});
    std::copy_n(packet.begin(), size, rest.begin());
    transfer.moved += size;
    if (babble) {
      ++counters_.babbled;
      return complete(transfer, kBabble);
    }
    const bool last = size < endpoint.packet_size || transfer.moved == transfer.data.size();
    if (last) return complete(transfer, 0);
  }
  return Step::kWaits;
}

UsbipSession::Step UsbipSession::complete(const Transfer& transfer, std::int32_t status) {
  const bool to_host =
      transfer.address == 0 ? transfer.setup.to_host() : (transfer.address & 0x80U) != 0;
  const std::span<const std::byte> data(transfer.data.data(), to_host ? transfer.moved : 0);
  append_submit_reply(output_, transfer.sequence, status,
                      static_cast<std::uint32_t>(transfer.moved), data);
  if (status == 0) ++counters_.completed;
  return Step::kComplete;
}

}  // namespace thimble::device_sim::usb
