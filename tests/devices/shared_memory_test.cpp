// The device shm:NAME with a driver in another process.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "device_ends.h"
#include "devices/open_device.h"
#include "pliant/c/haptic_packet.h"

namespace pliant::device_test::shared_memory {
namespace {

using devices::open_device;

std::string fresh_name(const char* what) { return std::string("pliant-test-") + what + "-" + std::to_string(getpid()); }

/// The driver's view of the memory.
class Driver {
 public:
  explicit Driver(const std::string& name) {
    const int handle = shm_open(("/" + name).c_str(), O_RDWR, 0);
    EXPECT_GE(handle, 0);
    memory_ = static_cast<pliant_haptic_shared*>(
        mmap(nullptr, sizeof(pliant_haptic_shared), PROT_READ | PROT_WRITE, MAP_SHARED, handle, 0));
    close(handle);
  }
  ~Driver() { munmap(memory_, sizeof *memory_); }
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;
  [[nodiscard]] pliant_haptic_shared& memory() const { return *memory_; }

  void publish(const DeviceSample& sample, std::uint32_t magic = PLIANT_HAPTIC_POSE_MAGIC) const {
    pliant_haptic_pose pose{magic, PLIANT_HAPTIC_VERSION, sizeof pose, sample.buttons, sample.number, sample.time, {}, {}};
    for (int a = 0; a < 3; ++a) pose.position[a] = sample.position[a];
    for (int a = 0; a < 4; ++a) pose.turn[a] = sample.turn[a];
    std::uint64_t words[sizeof pose / 8];
    std::memcpy(words, &pose, sizeof pose);
    pliant_haptic_publish(&memory_->pose.sequence, memory_->pose.words, words, sizeof pose / 8);
  }
  /// Whether there is a wrench.
  bool wrench(pliant_haptic_wrench& wrench) const {
    std::uint64_t words[sizeof wrench / 8];
    if (pliant_haptic_copy(&memory_->wrench.sequence, memory_->wrench.words, words, sizeof wrench / 8) == 0) return false;
    std::memcpy(&wrench, words, sizeof wrench);
    return true;
  }

 private:
  pliant_haptic_shared* memory_ = nullptr;
};

TEST(SharedDevice, ADriverInAnotherProcessIsHeardAndAnswered) {
  const std::string name = fresh_name("process");
  const auto device = open_device("shm:" + name);
  EXPECT_EQ(device->read().number, 0U);
  constexpr int kPoses = 2000;
  const pid_t child = fork();
  if (child == 0) {  // exits 0 if the answer to the last pose has come
    const Driver driver(name);
    for (int i = 0; i < kPoses; ++i) driver.publish(pose_at(i));
    pliant_haptic_wrench wrench{};
    const bool answered = until([&] { return driver.wrench(wrench) && wrench.number == kPoses; });
    _exit(answered && wrench.force[0] == 1.25 && wrench.stamp == pose_at(kPoses - 1).time ? 0 : 1);
  }
  std::uint64_t last = 0;
  EXPECT_TRUE(until([&] {
    const DeviceSample sample = device->read();
    if (sample.number != last) {
      const DeviceSample want = pose_at(static_cast<int>(std::lround((sample.time - 100) * 10)));
      expect_pose(sample, want);  // never a mixture of two poses
      EXPECT_EQ(sample.time, want.time);
    }
    last = sample.number;
    device->write(wrench_for(sample));
    int status = -1;
    if (waitpid(child, &status, WNOHANG) != child) return false;
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    return true;
  }));
  EXPECT_EQ(device->counts().refused, 0U);
}

TEST(SharedDevice, NeverReadsAMixtureOfTwoPoses) {
  pliant_haptic_pose_slot slot{};
  constexpr std::size_t kWords = sizeof slot.words / 8;
  constexpr std::uint64_t kLast = 3000000;
  std::thread writer([&] {
    std::array<std::uint64_t, kWords> words;
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      words.fill(i);
      pliant_haptic_publish(&slot.sequence, slot.words, words.data(), kWords);
    }
  });
  std::array<std::uint64_t, kWords> words{};
  for (std::uint64_t last = 0; last < kLast;) {
    const std::uint64_t sequence = pliant_haptic_copy(&slot.sequence, slot.words, words.data(), kWords);
    if (sequence == 0) continue;
    EXPECT_GE(words[0], last);
    last = words[0];
    EXPECT_EQ(sequence, 2 * last);
    if (std::count(words.begin(), words.end(), last) != static_cast<std::ptrdiff_t>(kWords)) {
      ADD_FAILURE() << "a mixture at " << last;
      break;
    }
  }
  writer.join();
}

TEST(SharedDevice, GarbageIsRefusedOnceAndTheLastPoseStays) {
  const std::string name = fresh_name("garbage");
  const auto device = open_device("shm:" + name);
  const Driver driver(name);
  driver.publish(pose_at(0));
  const DeviceSample good = device->read();
  EXPECT_EQ(good.number, 1U);
  driver.publish(pose_at(1), 7);
  for (int i = 0; i < 5; ++i) expect_pose(device->read(), good);
  EXPECT_EQ(device->counts().refused, 1U);
  EXPECT_EQ(device->counts().last_refusal, "a packet that does not begin with PLHP");
  driver.memory().pose.sequence |= 1;  // a driver that died while it wrote
  expect_pose(device->read(), good);
}

TEST(SharedDevice, WhoeverCreatedTheNameRemovesIt) {
  const std::string name = fresh_name("name"), path = "/dev/shm/" + name;
  {
    const auto first = open_device("shm:" + name);
    {
      const auto second = open_device("shm:" + name);
      Driver(name).publish(pose_at(3));
      EXPECT_EQ(first->read().position, second->read().position);
    }
    EXPECT_EQ(access(path.c_str(), F_OK), 0);
  }
  EXPECT_NE(access(path.c_str(), F_OK), 0);
}

TEST(SharedDevice, OtherMemoryAndBadNamesAreRefused) {
  const auto code_of = [](const std::string& text) {
    try {
      open_device(text);
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::internal;
  };
  EXPECT_EQ(code_of("shm:a/b"), ErrorCode::usage);
  EXPECT_EQ(code_of("shm:.."), ErrorCode::usage);
  EXPECT_EQ(code_of("shm:" + std::string(300, 'a')), ErrorCode::usage);
  const std::string name = fresh_name("other");
  const int handle = shm_open(("/" + name).c_str(), O_RDWR | O_CREAT, 0600);
  ASSERT_EQ(ftruncate(handle, 100), 0);
  EXPECT_EQ(code_of("shm:" + name), ErrorCode::bad_input);
  ASSERT_EQ(ftruncate(handle, sizeof(pliant_haptic_shared)), 0);
  ASSERT_EQ(pwrite(handle, "what", 4, 0), 4);
  EXPECT_EQ(code_of("shm:" + name), ErrorCode::bad_input);
  close(handle);
  shm_unlink(("/" + name).c_str());
}

TEST(SharedDevice, TwoAtOnceKeepApart) {
  const std::string one = fresh_name("one"), two = fresh_name("two");
  const auto left = open_device("shm:" + one), right = open_device("shm:" + two);
  Driver(one).publish(pose_at(1));
  Driver(two).publish(pose_at(2));
  expect_pose(left->read(), pose_at(1));
  expect_pose(right->read(), pose_at(2));
}

}  // namespace
}  // namespace pliant::device_test::shared_memory
