#include "bench/worker_pool.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace clshade {

struct WorkerPool::State {
    std::mutex mutex;
    std::condition_variable wake;
    unsigned generation = 0; ///< of runs; guarded by the mutex
    bool closing = false;    ///< guarded by the mutex

    // One run. Written by the caller before the generation is raised.
    const Work* work = nullptr;
    std::size_t count = 0;
    std::size_t chunk = 1;
    std::atomic<std::size_t> next{0};
    std::atomic<int> awake{0};
    std::atomic<bool> go{false};
    std::atomic<int> done{0};
    std::vector<std::jthread> workers; ///< last: joined before what they use is gone

    /// Spins, but lets others run when the machine has fewer processors than we have threads.
    template <class Condition>
    static void spin_until(const Condition& condition) {
        for (int i = 0; !condition(); ++i) {
            if (i > 1000) {
                std::this_thread::yield();
            }
        }
    }

    void take_chunks() {
        for (;;) {
            const std::size_t begin = next.fetch_add(chunk, std::memory_order_relaxed);
            if (begin >= count) {
                return;
            }
            (*work)(begin, std::min(count, begin + chunk));
        }
    }

    void serve() {
        unsigned seen = 0;
        for (;;) {
            {
                std::unique_lock lock(mutex);
                wake.wait(lock, [&] { return closing || generation != seen; });
                if (closing) {
                    return;
                }
                seen = generation;
            }
            awake.fetch_add(1);
            spin_until([&] { return go.load(); });
            take_chunks();
            done.fetch_add(1);
        }
    }
};

WorkerPool::WorkerPool(int threads) : state_(std::make_unique<State>()) {
    for (int i = 1; i < threads; ++i) {
        state_->workers.emplace_back([state = state_.get()] { state->serve(); });
    }
}

WorkerPool::~WorkerPool() {
    {
        const std::lock_guard lock(state_->mutex);
        state_->closing = true;
    }
    state_->wake.notify_all();
}

double WorkerPool::run(std::size_t count, std::size_t chunk, const Work& work) {
    State& state = *state_;
    const int others = static_cast<int>(state.workers.size());
    state.work = &work;
    state.count = count;
    state.chunk = std::max<std::size_t>(chunk, 1);
    state.next = 0;
    state.awake = 0;
    state.done = 0;
    state.go = false;
    {
        const std::lock_guard lock(state.mutex);
        ++state.generation;
    }
    state.wake.notify_all();
    State::spin_until([&] { return state.awake.load() == others; });
    const auto start = std::chrono::steady_clock::now();
    state.go = true;
    state.take_chunks();
    State::spin_until([&] { return state.done.load() == others; });
    const auto end = std::chrono::steady_clock::now();
    return std::chrono::duration<double, std::milli>(end - start).count();
}

int WorkerPool::threads() const {
    return static_cast<int>(state_->workers.size()) + 1;
}

} // namespace clshade
