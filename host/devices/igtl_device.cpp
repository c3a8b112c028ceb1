#include "devices/igtl_device.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <ctime>

namespace pliant::devices {
namespace {

constexpr timespec kLook{0, 500000};  ///< how often a wrench is looked for while there is a client

}  // namespace

IgtlDevice::IgtlDevice(const std::string& place, const std::string& text) : listening_(listen_at(Transport::tcp, place, text)) {
  start();
}

void IgtlDevice::serve() {
  while (!stopping()) {
    const auto events = static_cast<short>(sent_ < sending_.size() ? POLLIN | POLLOUT : POLLIN);
    std::array<pollfd, 3> waiting{pollfd{listening_.socket.get(), POLLIN, 0}, pollfd{stop_handle(), POLLIN, 0},
                                  pollfd{client_.get(), events, 0}};  // a negative handle is left out
    ppoll(waiting.data(), waiting.size(), client_ ? &kLook : nullptr, nullptr);
    if ((waiting[2].revents & ~POLLOUT) != 0) receive();
    if (client_) {
      send();
    } else {
      newest_wrench();  // for nobody
    }
    if (waiting[0].revents != 0) welcome();
  }
}

void IgtlDevice::welcome() {
  FileHandle client(accept4(listening_.socket.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!client) return;
  const int on = 1;
  setsockopt(client.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  client_ = std::move(client);
  stream_ = IgtlStream();
  sent_ = sending_.size();
}

void IgtlDevice::receive() {
  const ssize_t got = recv(client_.get(), bytes_.data(), bytes_.size(), 0);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (got <= 0) {
    client_.reset();
    return;
  }
  Bytes rest(bytes_.data(), static_cast<std::size_t>(got));
  while (!rest.empty() && !stream_.lost()) {
    Bytes message;
    Refusal why = nullptr;
    rest = rest.subspan(stream_.take(rest, message, why));
    DeviceSample sample;
    if (!message.empty()) why = read_igtl_pose(message, sample);
    if (why != nullptr) {
      refuse(why);
    } else if (!message.empty()) {
      publish(sample);
    }
  }
  if (stream_.lost()) client_.reset();
}

/// A message that has begun must be sent whole; wrenches that come meanwhile make room for the newest.
void IgtlDevice::send() {
  while (client_) {
    if (sent_ == sending_.size()) {
      const std::optional<DeviceWrench> wrench = newest_wrench();
      if (!wrench) return;
      write_igtl_wrench(*wrench, sending_);
      sent_ = 0;
    }
    const ssize_t went = ::send(client_.get(), sending_.data() + sent_, sending_.size() - sent_, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (went < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (went <= 0) {
      client_.reset();
    } else {
      sent_ += static_cast<std::size_t>(went);
    }
  }
}

}  // namespace pliant::devices
