// Wall-clock time in milliseconds.
#pragma once

#include <chrono>

namespace clshade {

class Stopwatch {
  public:
    [[nodiscard]] double milliseconds() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }
    /// Milliseconds since the start or the last lap; starts the next lap.
    double lap() {
        const double passed = milliseconds();
        start_ = std::chrono::steady_clock::now();
        return passed;
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace clshade
