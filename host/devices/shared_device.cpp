#include "devices/shared_device.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>

#include "devices/file_handle.h"
#include "devices/packet.h"
#include "pliant/error.h"

namespace pliant::devices {
namespace {

/// A driver that publishes while we copy makes us copy again, not more often than this: the next tick reads it.
constexpr int kTries = 4;

bool good_name(const std::string& name) {
  const auto good = [](unsigned char c) { return std::isalnum(c) != 0 || c == '.' || c == '_' || c == '-'; };
  return !name.empty() && name.size() <= 200 && name.front() != '.' && std::all_of(name.begin(), name.end(), good);
}

}  // namespace

SharedDevice::SharedDevice(const std::string& name, const std::string& text) : path_("/" + name) {
  if (!good_name(name)) {
    throw Error(ErrorCode::usage, fmt::format("haptic device \"{}\": the name is \"{}\", expected 1 to 200 letters, digits, "
                                              "'.', '_' and '-', the first no '.'",
                                              text, name));
  }
  const auto fail = [&](const std::string& why) {
    throw Error(ErrorCode::bad_input, fmt::format("haptic device \"{}\": {}", text, why));
  };
  FileHandle handle(shm_open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  created_ = static_cast<bool>(handle);
  if (!created_) handle = FileHandle(shm_open(path_.c_str(), O_RDWR | O_CLOEXEC, 0));
  struct stat state {};
  if (!handle || fstat(handle.get(), &state) != 0) fail(fmt::format("cannot open the shared memory: {}", std::strerror(errno)));
  // Whoever comes first may not have come further than creating it.
  if (state.st_size == 0 && ftruncate(handle.get(), sizeof(pliant_haptic_shared)) == 0)
    state.st_size = sizeof(pliant_haptic_shared);
  if (state.st_size != sizeof(pliant_haptic_shared)) {
    fail(fmt::format("the shared memory has {} bytes, expected {}", state.st_size, sizeof(pliant_haptic_shared)));
  }
  void* memory = mmap(nullptr, sizeof(pliant_haptic_shared), PROT_READ | PROT_WRITE, MAP_SHARED, handle.get(), 0);
  if (memory == MAP_FAILED) fail(fmt::format("cannot map the shared memory: {}", std::strerror(errno)));
  shared_ = static_cast<pliant_haptic_shared*>(memory);
  const std::uint32_t magic = __atomic_load_n(&shared_->magic, __ATOMIC_ACQUIRE);
  if (magic == 0) {
    __atomic_store_n(&shared_->version, PLIANT_HAPTIC_VERSION, __ATOMIC_RELAXED);
    __atomic_store_n(&shared_->size, sizeof(pliant_haptic_shared), __ATOMIC_RELAXED);
    __atomic_store_n(&shared_->magic, PLIANT_HAPTIC_SHARED_MAGIC, __ATOMIC_RELEASE);
  } else if (magic != PLIANT_HAPTIC_SHARED_MAGIC ||
             __atomic_load_n(&shared_->version, __ATOMIC_RELAXED) != PLIANT_HAPTIC_VERSION ||
             __atomic_load_n(&shared_->size, __ATOMIC_RELAXED) != sizeof(pliant_haptic_shared)) {
    munmap(memory, sizeof(pliant_haptic_shared));
    fail("the shared memory does not begin with PLHS, version 1, size 256");
  }
}

SharedDevice::~SharedDevice() {
  munmap(shared_, sizeof(pliant_haptic_shared));
  if (created_) shm_unlink(path_.c_str());
}

DeviceSample SharedDevice::read() noexcept {
  std::array<std::uint64_t, sizeof(pliant_haptic_pose) / 8> words;
  const pliant_haptic_pose_slot& slot = shared_->pose;
  if (__atomic_load_n(&slot.sequence, __ATOMIC_RELAXED) == sequence_) return newest_;
  std::uint64_t sequence = 0;
  for (int i = 0; i < kTries && sequence == 0; ++i) {
    sequence = pliant_haptic_copy(&slot.sequence, slot.words, words.data(), words.size());
  }
  if (sequence == 0 || sequence == sequence_) return newest_;
  sequence_ = sequence;
  DeviceSample sample;
  if (const Refusal why = read_pose(Bytes(reinterpret_cast<const std::uint8_t*>(words.data()), sizeof words), sample);
      why != nullptr) {
    counter_.refuse(why);
    return newest_;
  }
  senders_number_ = sample.number;
  sample.number = counter_.receive();
  newest_ = sample;
  return newest_;
}

void SharedDevice::write(const DeviceWrench& wrench) noexcept {
  pliant_haptic_wrench packet = wrench_packet(wrench);
  packet.number = wrench.number == newest_.number ? senders_number_ : 0;
  std::array<std::uint64_t, sizeof packet / 8> words;
  std::memcpy(words.data(), &packet, sizeof packet);
  pliant_haptic_publish(&shared_->wrench.sequence, shared_->wrench.words, words.data(), words.size());
}

}  // namespace pliant::devices
