// Values that are worked out when somebody asks for them first.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace clshade::reference {

/// A fixed number of values, each made on demand by a pure function. Threads need no lock: one of them stores a value,
/// others that meet it half made use a copy of their own, which is the same.
template <class T>
class LazyTable {
  public:
    explicit LazyTable(std::size_t size) : states_(size), values_(size) {}

    [[nodiscard]] std::size_t size() const { return values_.size(); }

    /// `make` is called without arguments and must give the same value at every call for this index.
    template <class Make>
    [[nodiscard]] T at(std::size_t index, const Make& make) const {
        std::atomic<std::uint8_t>& state = states_[index];
        if (state.load(std::memory_order_acquire) == ready) {
            return values_[index];
        }
        const T value = make();
        std::uint8_t expected = empty;
        if (state.compare_exchange_strong(expected, busy, std::memory_order_relaxed)) {
            values_[index] = value;
            state.store(ready, std::memory_order_release);
        }
        return value;
    }

  private:
    static constexpr std::uint8_t empty = 0;
    static constexpr std::uint8_t busy = 1;
    static constexpr std::uint8_t ready = 2;

    mutable std::vector<std::atomic<std::uint8_t>> states_;
    mutable std::vector<T> values_;
};

} // namespace clshade::reference
