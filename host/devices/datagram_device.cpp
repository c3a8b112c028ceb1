#include "devices/datagram_device.h"

#include <poll.h>
#include <sys/socket.h>

#include <cstring>

namespace pliant::devices {
namespace {

/// Numbers this far below the newest are those of a sender that has started anew; nearer ones were overtaken.
constexpr std::uint64_t kOvertaken = 1000;

std::size_t write_packet(const DeviceWrench& wrench, std::span<std::uint8_t> bytes) {
  const pliant_haptic_wrench packet = wrench_packet(wrench);
  std::memcpy(bytes.data(), &packet, sizeof packet);
  return sizeof packet;
}

}  // namespace

const DatagramFormat kPackets{read_pose, write_packet};

DatagramDevice::DatagramDevice(const DatagramFormat& format, const std::string& place, const std::string& text)
    : format_(format), listening_(listen_at(Transport::udp, place, text)) {
  start();
}

DeviceSample DatagramDevice::read() noexcept {
  if (arrived_.take()) {
    const Arrived& newest = arrived_.newest();
    read_[newest.sample.number % read_.size()] = {newest.sample.number, newest.senders_number};
  }
  return arrived_.newest().sample;
}

void DatagramDevice::write(const DeviceWrench& wrench) noexcept {
  const sockaddr_in& to = arrived_.newest().sender;
  if (wrench.number == 0 || to.sin_port == 0) return;
  const Numbers& numbers = read_[wrench.number % read_.size()];
  DeviceWrench answer = wrench;
  answer.number = numbers.ours == wrench.number ? numbers.senders : 0;
  std::array<std::uint8_t, 512> bytes;
  const std::size_t size = format_.write(answer, bytes);
  // A full or absent receiver loses the datagram, as on the way: the next wrench is newer.
  sendto(listening_.socket.get(), bytes.data(), size, MSG_DONTWAIT | MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&to),
         sizeof to);
}

void DatagramDevice::serve() {
  std::array<pollfd, 2> waiting{pollfd{listening_.socket.get(), POLLIN, 0}, pollfd{stop_handle(), POLLIN, 0}};
  while (!stopping()) {
    poll(waiting.data(), waiting.size(), -1);
    if (waiting[0].revents != 0) receive();
  }
}

void DatagramDevice::receive() {
  while (!stopping()) {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t got =
        recvfrom(listening_.socket.get(), bytes_.data(), bytes_.size(), MSG_TRUNC, reinterpret_cast<sockaddr*>(&from), &size);
    if (got < 0) return;
    const auto length = static_cast<std::size_t>(got);
    if (length > bytes_.size()) {
      refuse("a datagram of more than 2048 bytes");
      continue;
    }
    DeviceSample sample;
    if (const Refusal why = format_.read(Bytes(bytes_.data(), length), sample); why != nullptr) {
      refuse(why);
      continue;
    }
    const bool same = from.sin_port == sender_.sin_port && from.sin_addr.s_addr == sender_.sin_addr.s_addr;
    const std::uint64_t number = sample.number;
    if (same && number > 1 && number <= newest_ && newest_ - number < kOvertaken) {
      refuse("a datagram that is not newer than the newest");
      continue;
    }
    sender_ = from;
    newest_ = number;
    count(sample);
    arrived_.publish({sample, number, from});
  }
}

}  // namespace pliant::devices
