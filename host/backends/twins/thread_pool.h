// A few persistent threads that share the pieces of each pass. The assignment of pieces to threads does not affect any bit:
// no piece reads or writes what another piece of the pass writes.
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
  /// `threads` includes the calling thread; 0: as many as available to the process.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  [[nodiscard]] int threads() const { return threads_; }

  /// Calls piece(i) once for each i = 0 .. threads() - 1 and returns when all are done. The other threads use the default
  /// floating-point environment, the caller keeps its own. `piece` must not throw.
  ///
  /// The caller does not wait for a thread that has not started: it takes over its piece. It does wait for a thread that the
  /// operating system preempted within a piece, which can take milliseconds if other programs compete for the cores; after
  /// that it runs alone for a while.
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
  /// On its own cache line, since threads take pieces concurrently.
  struct alignas(64) Ticket {
    std::atomic<std::uint32_t> pass{0};  // number of the last pass in which this piece was taken
  };
  [[nodiscard]] bool works_alone() const { return alone_until_ != Clock::time_point{} && Clock::now() < alone_until_; }
  void share(Call call, const void* work);
  /// Runs the pieces of `pass` that are not taken yet, from `first` on.
  void work_through(std::uint32_t pass, int first);
  void serve(int thread);
  void note_wait(Clock::duration own, Clock::duration waited);

  const int threads_;
  std::unique_ptr<Ticket[]> tickets_;
  Call call_ = nullptr;
  const void* work_ = nullptr;
  alignas(64) std::atomic<std::uint32_t> pass_{0};
  alignas(64) std::atomic<int> done_{0};  // number of completed pieces of this pass
  std::atomic<bool> stop_{false};
  Clock::time_point alone_until_{};
  Clock::duration alone_{};
  std::vector<std::thread> workers_;
};

}  // namespace pliant::ref
