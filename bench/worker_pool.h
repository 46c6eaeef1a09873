// Threads for the C++ rivals. Not OpenMP's: its workers spin for milliseconds after their work is done and would slow
// down whoever runs next in the round. These sleep between two runs, and waking them is not part of the time.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace clshade {

class WorkerPool {
  public:
    /// threads >= 1, the caller among them.
    explicit WorkerPool(int threads);
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;
    WorkerPool(WorkerPool&&) = delete;
    WorkerPool& operator=(WorkerPool&&) = delete;

    /// Work on items [begin, end).
    using Work = std::function<void(std::size_t begin, std::size_t end)>;

    /// Splits [0, count) into chunks that the threads take one after the other (count and chunk in items). Returns the
    /// milliseconds from the moment all threads are awake to the moment the last is done. `work` must not throw.
    double run(std::size_t count, std::size_t chunk, const Work& work);

    [[nodiscard]] int threads() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace clshade
