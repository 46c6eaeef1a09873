// Wall-clock time in milliseconds.
#pragma once

#include <chrono>

namespace clshade::cli {

class Stopwatch {
  public:
    /// Milliseconds since the start or the last lap; starts the next lap.
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const std::chrono::duration<double, std::milli> passed = now - start_;
        start_ = now;
        return passed.count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace clshade::cli
