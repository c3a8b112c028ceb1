#include "devices/listen.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "pliant/error.h"

namespace pliant::devices {

long whole_number(const std::string& text, long least, long most) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  if (text.empty() || text.size() > 9 || !std::all_of(text.begin(), text.end(), digit)) return -1;
  const long number = std::strtol(text.c_str(), nullptr, 10);
  return number >= least && number <= most ? number : -1;
}

Listening listen_at(Transport transport, const std::string& place, const std::string& device) {
  const std::size_t colon = place.rfind(':');
  const std::string host = colon == std::string::npos ? "127.0.0.1" : place.substr(0, colon);
  const std::string port_text = colon == std::string::npos ? place : place.substr(colon + 1);
  const long port = whole_number(port_text, 0, 65535);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  if (port < 0 || inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1) {
    throw Error(ErrorCode::usage, fmt::format("haptic device \"{}\": got \"{}\", expected a port from 0 to 65535, or a numeric "
                                              "IPv4 address and a port, for example 0.0.0.0:5000",
                                              device, place));
  }
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  const int kind = transport == Transport::udp ? SOCK_DGRAM : SOCK_STREAM;
  Listening result{FileHandle(socket(AF_INET, kind | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)), 0};
  const int handle = result.socket.get(), on = 1;
  socklen_t size = sizeof address;
  bool good = handle >= 0;
  if (good && transport == Transport::tcp) setsockopt(handle, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  good = good && bind(handle, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  good = good && (transport == Transport::udp || listen(handle, 4) == 0);
  good = good && getsockname(handle, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  if (!good) {
    throw Error(ErrorCode::bad_input,
                fmt::format("haptic device \"{}\": cannot listen on {}:{}: {}", device, host, port_text, std::strerror(errno)));
  }
  result.port = ntohs(address.sin_port);
  return result;
}

}  // namespace pliant::devices
