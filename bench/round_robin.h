// Contestants that run in turns, so that a ratio compares what ran next to each other.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace clshade {

/// One thing to time.
struct Contestant {
    std::string name;
    std::function<double()> run; ///< does the work once; its duration in milliseconds
    bool slow = false;           ///< runs only in the first RoundSettings::slow_rounds rounds
};

struct RoundSettings {
    int warm_up = 2;
    int rounds = 15;       ///< at least
    double seconds = 1.5;  ///< go on until this much time is spent
    int slow_rounds = 3;   ///< rounds that slow contestants take part in, counted from the first
    int max_rounds = 2000; ///< whatever the time left
};

/// What one contestant did. If `run` threw, `error` has the message, and it took no further part.
struct Timings {
    std::vector<double> milliseconds; ///< one per round it took part in, from the first round on
    std::string error;
};

/// Runs all contestants in turns; the result has one entry for each, in their order. Slow contestants warm up once.
[[nodiscard]] std::vector<Timings> run_round_robin(const std::vector<Contestant>& contestants,
                                                   const RoundSettings& settings);

} // namespace clshade
