// A few persistent threads that share the pieces of one pass after another. Who does which piece changes no bit: pieces write
// what no other piece of the pass reads or writes.
#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace pliant::ref {

class ThreadPool {
 public:
  /// The calling thread is one of them; 0 means as many as the process may use.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  [[nodiscard]] int threads() const { return threads_; }

  /// piece(i) for i = 0 .. threads() - 1, each once; returns when all are done. The other threads have the default
  /// floating-point environment, the caller keeps its own. `piece` must not throw.
  ///
  /// Nobody waits for a thread that has not begun: the caller takes its piece. It waits for one that the operating system has
  /// stopped in the middle of a piece, which can take milliseconds where other programs want the cores; after that it works
  /// alone for a while.
  template <class Piece>
  void run(const Piece& piece) {
    if (threads_ == 1 || works_alone()) {
      for (int i = 0; i < threads_; ++i) piece(i);
      return;
    }
    share([](const void* work, int i) { (*static_cast<const Piece*>(work))(i); }, &piece);
  }

 private:
  using Clock = std::chrono::steady_clock;
  using Call = void (*)(const void* work, int piece);
  /// On a cache line of its own: threads take pieces at the same time.
  struct alignas(64) Ticket {
    std::atomic<std::uint32_t> pass{0};  // the last one in which this piece was taken
  };
  [[nodiscard]] bool works_alone() const { return alone_until_ != Clock::time_point{} && Clock::now() < alone_until_; }
  void share(Call call, const void* work);
  /// The pieces of `pass` that nobody has taken, from `first` on.
  void work_through(std::uint32_t pass, int first);
  void serve(int thread);
  void note_wait(Clock::duration own, Clock::duration waited);

  const int threads_;
  std::unique_ptr<Ticket[]> tickets_;
  Call call_ = nullptr;
  const void* work_ = nullptr;
  alignas(64) std::atomic<std::uint32_t> pass_{0};
  alignas(64) std::atomic<int> done_{0};  // pieces of this pass
  std::atomic<bool> stop_{false};
  Clock::time_point alone_until_{};
  Clock::duration alone_{};
  std::vector<std::thread> workers_;
};

}  // namespace pliant::ref
