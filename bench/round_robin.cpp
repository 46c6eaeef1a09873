#include "bench/round_robin.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <numeric>
#include <random>

namespace clshade {

namespace {

/// Runs one contestant; its time is kept unless this is a warm-up.
void take_turn(const Contestant& contestant, Timings& timings, bool keep) {
    if (!timings.error.empty()) {
        return;
    }
    try {
        const double milliseconds = contestant.run();
        if (keep) {
            timings.milliseconds.push_back(milliseconds);
        }
    } catch (const std::exception& failure) {
        timings.error = failure.what();
    }
}

} // namespace

std::vector<Timings> run_round_robin(const std::vector<Contestant>& contestants, const RoundSettings& settings) {
    std::vector<Timings> all(contestants.size());
    std::vector<std::size_t> order(contestants.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto one_round = [&](bool keep, bool with_slow) {
        for (const std::size_t i : order) {
            if (with_slow || !contestants[i].slow) {
                take_turn(contestants[i], all[i], keep);
            }
        }
    };
    for (int round = 0; round < settings.warm_up; ++round) {
        one_round(false, round == 0);
    }
    std::mt19937 shuffler(settings.rounds > 0 ? static_cast<unsigned>(settings.rounds)
                                              : 1U); // the same orders each run
    const auto start = std::chrono::steady_clock::now();
    const auto spent = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
    for (int round = 0; round < settings.max_rounds && (round < settings.rounds || spent() < settings.seconds);
         ++round) {
        // A new order every round: whoever always ran after the same rival would always find that rival's caches.
        std::shuffle(order.begin(), order.end(), shuffler);
        one_round(true, round < settings.slow_rounds);
    }
    return all;
}

} // namespace clshade
