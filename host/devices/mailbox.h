// A lock-free mailbox from one thread to another: the reader gets the newest value that the writer has published.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>

namespace pliant::devices {

/// Three slots: the writer fills one, the reader reads another, and the third, the last one published, lies between them. Each
/// side takes its slot by one exchange, so that neither ever waits. One writer and one reader at a time. Values are never
/// destroyed by the exchange: a slot keeps the memory of its vectors.
template <class T>
class Mailbox {
 public:
  Mailbox() = default;
  explicit Mailbox(const T& initial) : slots_{Slot{initial}, Slot{initial}, Slot{initial}} {}
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;

  // For the writer.

  /// The slot to fill; it holds an older published value.
  T& draft() { return slots_[writing_].value; }
  void publish() {
    const std::uint32_t before = between_.exchange(writing_ | kFresh, std::memory_order_acq_rel);
    writing_ = before & kIndex;
  }
  void publish(const T& value) {
    draft() = value;
    publish();
  }

  // For the reader.

  /// Takes the newest value if there is one that the reader has not seen. Returns whether there was.
  bool take() {
    if ((between_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    const std::uint32_t before = between_.exchange(reading_, std::memory_order_acq_rel);
    reading_ = before & kIndex;
    return true;
  }
  /// The value taken last.
  [[nodiscard]] const T& newest() const { return slots_[reading_].value; }
  [[nodiscard]] T& newest() { return slots_[reading_].value; }

 private:
  static constexpr std::uint32_t kIndex = 3, kFresh = 4;
  struct alignas(64) Slot {
    T value{};
  };
  std::array<Slot, 3> slots_;
  alignas(64) std::atomic<std::uint32_t> between_{1};
  alignas(64) std::uint32_t writing_ = 0;
  alignas(64) std::uint32_t reading_ = 2;
};

}  // namespace pliant::devices
