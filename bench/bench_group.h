// Rows of one picture size, which share one set of planes and run in turns with all their rivals.
#pragma once

#include "bench/bench_environment.h"
#include "bench/bench_rows.h"
#include "bench/benchmark.h"
#include "bench/contest.h"
#include "bench/round_robin.h"

#include <map>
#include <string>
#include <vector>

namespace clshade {

class BenchGroup {
  public:
    /// All rows of one size. Refers to the studio, which it asks for if a row stands in it. Throws RuntimeFailure when
    /// the planes do not fit.
    BenchGroup(Device& device, const BenchOptions& options, BenchStudio& studio, std::vector<BenchRow> rows);

    /// Prepares and checks every row and rival; `tell` is called before each row.
    void prepare(const std::function<void(const std::string& what)>& tell);
    /// Runs the rounds.
    void run();

    /// One per row, in their order.
    [[nodiscard]] std::vector<BenchResult> results() const;
    [[nodiscard]] int width() const { return frame_.planes.width(); }
    [[nodiscard]] int height() const { return frame_.planes.height(); }
    /// Median of a row of this group by name ("shade.blinn_phong.lambert.distant1"), if it was timed.
    [[nodiscard]] std::optional<double> median_ms(std::string_view row) const;
    /// Paired ratio of two rows, if both were timed.
    [[nodiscard]] std::optional<double> ratio(std::string_view row, std::string_view baseline) const;

  private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    /// A rival of a row: what is known before the rounds, and whose times to compare with.
    struct Pairing {
        RivalResult result;
        std::size_t contestant = none;
    };
    struct Entrant {
        BenchRow row;
        bool reported = true; ///< false: only others are measured against it
        BenchResult result;
        std::size_t contestant = none;
        std::shared_ptr<PreparedFrame> prepared;
        std::vector<Pairing> pairings;
    };
    struct Known {
        std::size_t contestant = none;
        double max_error = 0.0;
    };

    /// Takes rows in that only others are measured against.
    void add_missing_baselines();
    void prepare_row(Entrant& entrant);
    [[nodiscard]] std::optional<BoundEnvironment> environment_of(const BenchScene& scene);
    void check_against_reference(const PlaneSlab& picture) const;
    [[nodiscard]] Pairing pair_with(Rival rival, const Entrant& entrant, const PlaneSlab& picture);
    [[nodiscard]] Known enter(RivalEntry entry, const std::string& name, const PlaneSlab& picture);
    [[nodiscard]] BenchResult result_of(const Entrant& entrant) const;
    [[nodiscard]] RivalResult measured(RivalResult rival, std::size_t contestant, const Timings& ours) const;
    [[nodiscard]] RivalResult measured(const BenchBaseline& baseline, const Timings& ours) const;
    [[nodiscard]] const Entrant* find(std::string_view row) const;
    /// Null unless the row was timed without an error.
    [[nodiscard]] const Timings* timings_of(std::string_view row) const;

    Device* device_;
    BenchOptions options_;
    BenchStudio* studio_;
    Frame frame_;
    Shader shader_;
    std::shared_ptr<PictureMemory> memory_; ///< of every row and rival
    RivalMaker maker_;
    std::vector<Entrant> entrants_;
    std::vector<Contestant> contestants_;
    std::map<std::string, Known> known_; ///< rivals that take part, by id
    std::vector<Timings> timings_;       ///< one per contestant
};

} // namespace clshade
