#include "program/program.h"

#include <utility>

#include "pliant/error.h"

namespace pliant {

BufferId Program::find(const std::string& name) const {
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    if (buffers[i].name == name) return first + static_cast<BufferId>(i);
  }
  return -1;
}

BufferId Program::add(Buffer buffer) {
  if (buffer.role == BufferRole::state && buffer.carry == Carry::undeclared)
    throw Error(ErrorCode::internal, "the state buffer " + buffer.name + " does not declare what an edit does to it");
  buffers.push_back(std::move(buffer));
  return first + static_cast<BufferId>(buffers.size()) - 1;
}

}  // namespace pliant
