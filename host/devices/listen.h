// Sockets that devices listen on.
#pragma once
#include <string>

#include "devices/file_handle.h"

namespace pliant::devices {

enum class Transport { udp, tcp };

/// A socket that does not block, and where it listens.
struct Listening {
  FileHandle socket;
  int port = 0;  ///< the one that the system chose if 0 was given
};

/// Binds, and for TCP listens. `place` is PORT, on this machine's loopback alone, or ADDRESS:PORT with a numeric IPv4 address,
/// for example 0.0.0.0:5000 for all networks. Throws Error: `usage` for another text, `bad_input` if the system refuses.
/// `device` is the whole text of the device, for messages.
Listening listen_at(Transport transport, const std::string& place, const std::string& device);

/// A whole number of decimal digits in [least, most], or -1.
long whole_number(const std::string& text, long least, long most);

}  // namespace pliant::devices
