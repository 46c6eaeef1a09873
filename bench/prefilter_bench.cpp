#include "bench/prefilter_bench.h"

#include "bench/bench_environment.h"
#include "bench/bench_rows.h"
#include "bench/fresh_build.h"
#include "bench/prefilter_rival.h"
#include "bench/round_robin.h"
#include "bench/statistics.h"
#include "host/base/error.h"
#include "host/prefilter/prefilter.h"
#include "host/reference/environment_map.h"
#include "host/shading/shader.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <utility>

namespace clshade {

namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Of sampled vertices of one map; `expected` has the value of a vertex.
template <class Expected>
double map_error(const std::vector<float>& map, int cells, std::mt19937& random, const Expected& expected) {
    constexpr int samples = 32;
    const auto side = static_cast<std::uint32_t>(cells) + 1;
    double worst = 0.0;
    for (int k = 0; k < samples; ++k) {
        const std::uint32_t i = random() % side;
        const std::uint32_t j = random() % side;
        const glm::dvec3 b = expected(static_cast<int>(i), static_cast<int>(j));
        const std::size_t at = 3 * (static_cast<std::size_t>(j) * side + i);
        const glm::dvec3 a(map.at(at), map.at(at + 1), map.at(at + 2));
        for (int c = 0; c < 3; ++c) {
            const double error = std::abs(a[c] - b[c]) / std::max({b.r, b.g, b.b});
            worst = std::isnan(error) ? std::numeric_limits<double>::infinity() : std::max(worst, error);
        }
    }
    return worst;
}

double prefilter_error(const FilteredSet& set, const reference::EnvironmentMap& expected) {
    std::mt19937 random(1); // the same vertices for everybody
    double worst = 0.0;
    for (int level = 0; level < radiance_levels; ++level) {
        const reference::DirectionGrid& grid = expected.level(level);
        worst = std::max(worst, map_error(set.radiance[static_cast<std::size_t>(level)], grid.cells(), random,
                                          [&grid](int i, int j) { return grid.vertex(i, j); }));
    }
    return std::max(worst, map_error(set.irradiance, irradiance_cells, random, [&expected](int i, int j) {
                        const glm::dvec2 place(2.0 * i / irradiance_cells - 1.0, 2.0 * j / irradiance_cells - 1.0);
                        return expected.irradiance_over_pi(reference::direction_of_octahedral(place));
                    }));
}

void require_right(double error) {
    if (!(error <= prefilter_tolerance)) {
        throw RuntimeFailure(fmt::format("the filtered maps differ from sums in double precision by {:.2g}, more than "
                                         "{:.2g}; run clshade check",
                                         error, prefilter_tolerance));
    }
}

/// The device's pre-filter at work on one environment.
class Filtering {
  public:
    Filtering(Device& device, const BenchOptions& options, std::shared_ptr<LatLong> image)
        : folder_(new_mark()), cache_(folder_.path()), image_(std::move(image)),
          prefilter_(device, marked_sources(options.kernel_dir, {"filter.cl"}, new_mark()), cache_,
                     options.lanes > 0 ? options.lanes : automatic_lanes(device.info())) {}

    /// Into an empty cache, which then has program and result.
    [[nodiscard]] FilteredSet first(double& milliseconds) {
        const Clock::time_point start = Clock::now();
        FilteredSet set = prefilter_.filter(*image_, {});
        milliseconds = milliseconds_since(start);
        kept_ = files();
        return set;
    }

    [[nodiscard]] double from_cache() {
        PrefilterReport report;
        const double milliseconds = timed(*image_, report);
        if (!report.from_cache) {
            throw RuntimeFailure("the cache did not keep the result; see the log");
        }
        return milliseconds;
    }

    /// A picture nobody has filtered yet; the program comes from the cache.
    [[nodiscard]] double anew() {
        if (!other_) {
            other_ = *image_;
        }
        other_->rgb[0] += 1e-3F;
        PrefilterReport report;
        const double milliseconds = timed(*other_, report);
        if (report.from_cache) {
            throw RuntimeFailure("the cache took one picture for another; clear it");
        }
        for (const std::filesystem::path& file : files()) {
            if (!kept_.contains(file)) {
                std::error_code ignored;
                std::filesystem::remove(file, ignored);
            }
        }
        return milliseconds;
    }

  private:
    [[nodiscard]] double timed(const LatLong& image, PrefilterReport& report) {
        const Clock::time_point start = Clock::now();
        const FilteredSet set = prefilter_.filter(image, {}, &report);
        return milliseconds_since(start);
    }

    [[nodiscard]] std::set<std::filesystem::path> files() const {
        std::set<std::filesystem::path> all;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
            if (entry.is_regular_file()) {
                all.insert(entry.path());
            }
        }
        return all;
    }

    BuildFolder folder_;
    ProgramCache cache_;
    std::shared_ptr<LatLong> image_;
    std::optional<LatLong> other_;
    Prefilter prefilter_;
    std::set<std::filesystem::path> kept_;
};

/// Floats of a whole set.
std::size_t floats_of(const FilteredSet& set) {
    std::size_t count = set.irradiance.size();
    for (const std::vector<float>& level : set.radiance) {
        count += level.size();
    }
    return count;
}

/// The rows of one environment.
class PrefilterGroup {
  public:
    PrefilterGroup(Device& device, const BenchOptions& options, std::vector<PrefilterRow> rows)
        : device_(&device), options_(options), rows_(std::move(rows)) {}

    [[nodiscard]] std::vector<BenchResult> run() {
        image_ = std::make_shared<LatLong>(sunny_sky(rows_.front().height, options_.seed));
        filtering_ = std::make_shared<Filtering>(*device_, options_, image_);
        const FilteredSet set = filtering_->first(cold_ms_);
        bytes_ = (image_->rgb.size() + floats_of(set)) * sizeof(float);
        const reference::EnvironmentMap expected(image_);
        error_ = prefilter_error(set, expected);
        require_right(error_);
        cached_ms_ = filtering_->from_cache();
        for (const PrefilterRow& row : rows_) {
            enter(row, expected);
        }
        timings_ = run_round_robin(contestants_, settings());
        std::vector<BenchResult> results;
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            results.push_back(result_of(i));
        }
        return results;
    }

  private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    void enter(const PrefilterRow& row, const reference::EnvironmentMap& expected) {
        ours_.push_back(contestants_.size());
        if (row.cached) {
            contestants_.push_back({row.key(), [filtering = filtering_] { return filtering->from_cache(); }});
            return;
        }
        contestants_.push_back({row.key(), [filtering = filtering_] { return filtering->anew(); }});
        rival_.name = name_of(Rival::openmp_simd);
        if (device_->info().kind != DeviceKind::cpu) {
            rival_.status = BenchStatus::skipped;
            rival_.reason = "runs on the host, which is another machine part than this device";
            return;
        }
        const int threads = options_.threads > 0 ? options_.threads : static_cast<int>(device_->info().compute_units);
        const auto rival = std::make_shared<PrefilterRival>(threads);
        rival_.max_error = prefilter_error(rival->filter(*image_), expected);
        if (!(rival_.max_error <= prefilter_tolerance)) {
            rival_.status = BenchStatus::error;
            rival_.reason = fmt::format("its maps are off by {:.2g}, more than {:.2g}; a rival that computes something "
                                        "else is not timed",
                                        rival_.max_error, prefilter_tolerance);
            return;
        }
        rival_contestant_ = contestants_.size();
        contestants_.push_back({rival_.name, [rival, image = image_] {
                                    const Clock::time_point start = Clock::now();
                                    const FilteredSet filtered = rival->filter(*image);
                                    return milliseconds_since(start);
                                }});
    }

    /// These take seconds and not milliseconds: few rounds tell enough, and everything has run once already.
    [[nodiscard]] RoundSettings settings() const {
        RoundSettings settings;
        settings.warm_up = 0;
        settings.rounds = options_.quick ? 1 : std::min(options_.rounds, 3);
        settings.seconds = options_.quick ? 0.0 : options_.seconds * static_cast<double>(rows_.size());
        return settings;
    }

    [[nodiscard]] BenchResult result_of(std::size_t index) const {
        const PrefilterRow& row = rows_[index];
        BenchResult result;
        result.key = row.key();
        result.width = row.width;
        result.height = row.height;
        result.environments = 1;
        result.layers = 0;
        result.lanes = options_.lanes > 0 ? options_.lanes : automatic_lanes(device_->info());
        const Timings& ours = timings_.at(ours_[index]);
        if (!ours.error.empty()) {
            result.status = BenchStatus::error;
            result.reason = ours.error;
            return result;
        }
        const double texels = static_cast<double>(row.width) * row.height;
        result.rounds = static_cast<int>(ours.milliseconds.size());
        result.median_ms = median(ours.milliseconds);
        result.min_ms = percentile(ours.milliseconds, 0.0);
        result.spread = spread(ours.milliseconds);
        result.bytes_per_pixel = static_cast<double>(bytes_) / texels;
        result.mpix_per_s = texels * 1e-3 / result.median_ms;
        result.gb_per_s = static_cast<double>(bytes_) * 1e-6 / result.median_ms;
        result.build_cold_ms = cold_ms_;
        result.build_cached_ms = cached_ms_;
        result.max_error = error_;
        if (!row.cached) {
            result.against.push_back(measured_rival(ours));
        }
        return result;
    }

    [[nodiscard]] RivalResult measured_rival(const Timings& ours) const {
        RivalResult rival = rival_;
        if (rival_contestant_ == none) {
            return rival;
        }
        const Timings& theirs = timings_.at(rival_contestant_);
        if (!theirs.error.empty()) {
            rival.status = BenchStatus::error;
            rival.reason = theirs.error;
            return rival;
        }
        rival.rounds = static_cast<int>(theirs.milliseconds.size());
        rival.median_ms = median(theirs.milliseconds);
        rival.min_ms = percentile(theirs.milliseconds, 0.0);
        rival.ratio = paired_ratio(ours.milliseconds, theirs.milliseconds);
        return rival;
    }

    Device* device_;
    BenchOptions options_;
    std::vector<PrefilterRow> rows_;
    std::shared_ptr<LatLong> image_;
    std::shared_ptr<Filtering> filtering_;
    std::size_t bytes_ = 0;
    double cold_ms_ = 0.0;
    double cached_ms_ = 0.0;
    double error_ = 0.0;
    std::vector<std::size_t> ours_; ///< contestants, one per row
    RivalResult rival_;
    std::size_t rival_contestant_ = none;
    std::vector<Contestant> contestants_;
    std::vector<Timings> timings_;
};

BenchResult failed(const PrefilterRow& row, const std::string& reason) {
    BenchResult result;
    result.key = row.key();
    result.width = row.width;
    result.height = row.height;
    result.environments = 1;
    result.layers = 0;
    result.status = BenchStatus::error;
    result.reason = reason;
    return result;
}

} // namespace

double prefilter_error(const FilteredSet& set, const LatLong& image) {
    return prefilter_error(set, reference::EnvironmentMap(std::make_shared<const LatLong>(image)));
}

std::vector<BenchResult> run_prefilter_rows(Device& device, const BenchOptions& options,
                                            const std::vector<PrefilterRow>& rows,
                                            const std::function<void(const std::string&)>& tell) {
    std::vector<std::optional<BenchResult>> results(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (results[i]) {
            continue;
        }
        std::vector<std::size_t> members; // the rows of this environment
        std::vector<PrefilterRow> group;
        for (std::size_t k = i; k < rows.size(); ++k) {
            if (rows[k].height == rows[i].height) {
                members.push_back(k);
                group.push_back(rows[k]);
            }
        }
        tell(fmt::format("pre-filtering {}x{}", rows[i].width, rows[i].height));
        std::vector<BenchResult> made;
        try {
            made = PrefilterGroup(device, options, group).run();
        } catch (const UsageError&) {
            throw; // a wrong --kernel-dir or --lanes is the same for every group
        } catch (const std::exception& failure) {
            for (const PrefilterRow& row : group) {
                made.push_back(failed(row, failure.what()));
            }
        }
        for (std::size_t k = 0; k < members.size(); ++k) {
            results[members[k]] = std::move(made[k]);
        }
    }
    std::vector<BenchResult> all;
    all.reserve(results.size());
    for (std::optional<BenchResult>& result : results) {
        all.push_back(std::move(*result));
    }
    return all;
}

} // namespace clshade
