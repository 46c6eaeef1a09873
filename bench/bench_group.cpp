#include "bench/bench_group.h"

#include "bench/build_times.h"
#include "bench/statistics.h"
#include "host/base/error.h"
#include "host/reference/reference.h"
#include "host/shading/kernel_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace clshade {

namespace {

ShaderOptions shader_options(const BenchOptions& options) {
    ShaderOptions chosen;
    chosen.lanes = options.lanes;
    return chosen;
}

int host_threads(const Device& device, const BenchOptions& options) {
    return options.threads > 0 ? options.threads : static_cast<int>(device.info().compute_units);
}

RoundSettings round_settings(const BenchOptions& options, std::size_t rows) {
    RoundSettings settings;
    settings.rounds = options.quick ? 3 : std::max(1, options.rounds);
    settings.seconds = options.quick ? 0.0 : options.seconds * static_cast<double>(rows);
    settings.slow_rounds = options.quick ? 1 : 3;
    return settings;
}

int deepest_stack(const Frame& frame) {
    std::size_t deepest = 0;
    for (const BoundMaterial& material : frame.materials) {
        deepest = std::max(deepest, material.layers.size());
    }
    return static_cast<int>(deepest);
}

/// Fills in a rival's figures.
void compare(RivalResult& rival, std::span<const double> theirs, std::span<const double> ours) {
    rival.rounds = static_cast<int>(theirs.size());
    rival.median_ms = median(theirs);
    rival.min_ms = percentile(theirs, 0.0);
    rival.ratio = paired_ratio(ours, theirs);
}

void fail(BenchResult& result, const std::string& reason) {
    result.status = BenchStatus::error;
    result.reason = reason;
}

} // namespace

BenchGroup::BenchGroup(Device& device, const BenchOptions& options, BenchStudio& studio, std::vector<BenchRow> rows)
    : device_(&device), options_(options), studio_(&studio),
      frame_(make_bench_frame(rows.at(0).width, rows.at(0).height, options.seed)),
      shader_(device, kernel_sources(options.kernel_dir), ProgramCache::standard(), shader_options(options)),
      memory_(std::make_shared<PictureMemory>(device, frame_, bench_outputs)),
      maker_(device, frame_, memory_, host_threads(device, options), shader_.lanes()) {
    for (BenchRow& row : rows) {
        Entrant entrant;
        entrant.row = std::move(row);
        entrants_.push_back(std::move(entrant));
    }
    add_missing_baselines();
}

void BenchGroup::add_missing_baselines() {
    const std::size_t own = entrants_.size();
    for (std::size_t i = 0; i < own; ++i) {
        const std::vector<BenchBaseline> baselines = entrants_[i].row.baselines;
        for (const BenchBaseline& baseline : baselines) {
            for (const BenchScene& scene : baseline.scenes) {
                if (find(row_name(scene)) != nullptr) {
                    continue;
                }
                Entrant entrant;
                entrant.row.name = row_name(scene);
                entrant.row.width = width();
                entrant.row.height = height();
                entrant.row.scene = scene;
                entrant.reported = false;
                entrants_.push_back(std::move(entrant));
            }
        }
    }
}

void BenchGroup::prepare(const std::function<void(const std::string&)>& tell) {
    for (Entrant& entrant : entrants_) {
        tell(entrant.row.key());
        try {
            prepare_row(entrant);
        } catch (const std::exception& failure) {
            fail(entrant.result, failure.what());
        }
    }
}

void BenchGroup::prepare_row(Entrant& entrant) {
    const std::optional<BoundEnvironment> environment = environment_of(entrant.row.scene);
    apply_scene(frame_, entrant.row.scene, environment);
    if (entrant.reported) {
        const BuildTimes build =
            measure_build(*device_, entrant.row.scene, options_.kernel_dir, shader_.lanes(), environment);
        entrant.result.build_cold_ms = build.cold_ms;
        entrant.result.build_cached_ms = build.cached_ms;
    }
    const ShadedImage image = shader_.shade(frame_);
    check_against_reference(image.planes);
    entrant.prepared = std::make_shared<PreparedFrame>(shader_.prepare(frame_, memory_));
    entrant.result.lights = static_cast<int>(frame_.lights.size());
    entrant.result.environments = frame_.environment ? 1 : 0;
    entrant.result.layers = deepest_stack(frame_);
    entrant.contestant = contestants_.size();
    contestants_.push_back({entrant.row.key(), [prepared = entrant.prepared] {
                                prepared->launch();
                                return prepared->wait_milliseconds();
                            }});
    for (const Rival rival : entrant.row.rivals) {
        entrant.pairings.push_back(pair_with(rival, entrant, image.planes));
    }
}

std::optional<BoundEnvironment> BenchGroup::environment_of(const BenchScene& scene) {
    return scene.environment ? std::optional(studio_->environment()) : std::nullopt;
}

void BenchGroup::check_against_reference(const PlaneSlab& picture) const {
    constexpr int samples = 64; // in each direction
    for (int j = 0; j < samples; ++j) {
        for (int i = 0; i < samples; ++i) {
            const int x = (2 * i + 1) * picture.width() / (2 * samples);
            const int y = (2 * j + 1) * picture.height() / (2 * samples);
            const reference::Pixel expected = reference::shade_pixel(frame_, x, y, {});
            for (int c = 0; c < 3; ++c) {
                const double value = expected.radiance[c];
                const double error =
                    std::abs(static_cast<double>(picture.at(c, x, y)) - value) / (1e-3 + std::abs(value));
                if (!(error <= rival_tolerance)) {
                    throw RuntimeFailure(fmt::format("the kernel gives {} at pixel ({}, {}), the reference {}; run "
                                                     "clshade check",
                                                     picture.at(c, x, y), x, y, value));
                }
            }
        }
    }
}

BenchGroup::Pairing BenchGroup::pair_with(Rival rival, const Entrant& entrant, const PlaneSlab& picture) {
    Pairing pairing;
    pairing.result.name = name_of(rival);
    const int planes_in = entrant.prepared->planes_read();
    const int planes_out = std::min(entrant.prepared->planes_written(), 4);
    try {
        const std::string id = rival_id(rival, entrant.row, planes_in, planes_out);
        auto known = known_.find(id);
        if (known == known_.end()) {
            RivalEntry entry = maker_.make(rival, entrant.row, planes_in, planes_out);
            if (entry.status != BenchStatus::ok) {
                pairing.result.status = entry.status;
                pairing.result.reason = entry.reason;
                return pairing;
            }
            known = known_.emplace(id, enter(std::move(entry), id, picture)).first;
        }
        pairing.contestant = known->second.contestant;
        pairing.result.max_error = known->second.max_error;
    } catch (const std::exception& failure) {
        pairing.result.status = BenchStatus::error;
        pairing.result.reason = failure.what();
    }
    return pairing;
}

BenchGroup::Known BenchGroup::enter(RivalEntry entry, const std::string& name, const PlaneSlab& picture) {
    spoil(*memory_);
    (void)entry.run();
    const double error = entry.difference(picture);
    if (!(error <= rival_tolerance)) {
        throw RuntimeFailure(fmt::format("its picture differs from the device's by {:.2g}, more than {:.2g}; a rival "
                                         "that computes something else is not timed",
                                         error, rival_tolerance));
    }
    contestants_.push_back({name, std::move(entry.run), entry.slow});
    return {contestants_.size() - 1, error};
}

void BenchGroup::run() {
    const auto reported = static_cast<std::size_t>(
        std::count_if(entrants_.begin(), entrants_.end(), [](const Entrant& entrant) { return entrant.reported; }));
    timings_ = run_round_robin(contestants_, round_settings(options_, reported));
}

std::vector<BenchResult> BenchGroup::results() const {
    std::vector<BenchResult> all;
    for (const Entrant& entrant : entrants_) {
        if (entrant.reported) {
            all.push_back(result_of(entrant));
        }
    }
    return all;
}

BenchResult BenchGroup::result_of(const Entrant& entrant) const {
    BenchResult result = entrant.result;
    result.key = entrant.row.key();
    result.width = entrant.row.width;
    result.height = entrant.row.height;
    result.lanes = shader_.lanes();
    if (result.status != BenchStatus::ok) {
        return result;
    }
    const Timings& ours = timings_.at(entrant.contestant);
    if (!ours.error.empty()) {
        fail(result, ours.error);
        return result;
    }
    const double pixels = static_cast<double>(result.width) * result.height;
    const auto bytes = static_cast<double>(entrant.prepared->bytes());
    result.rounds = static_cast<int>(ours.milliseconds.size());
    result.median_ms = median(ours.milliseconds);
    result.min_ms = percentile(ours.milliseconds, 0.0);
    result.spread = spread(ours.milliseconds);
    result.bytes_per_pixel = bytes / pixels;
    result.mpix_per_s = pixels * 1e-3 / result.median_ms;
    result.gb_per_s = bytes * 1e-6 / result.median_ms;

    for (const Pairing& pairing : entrant.pairings) {
        result.against.push_back(measured(pairing.result, pairing.contestant, ours));
    }
    for (const BenchBaseline& baseline : entrant.row.baselines) {
        result.against.push_back(measured(baseline, ours));
    }
    return result;
}

RivalResult BenchGroup::measured(RivalResult rival, std::size_t contestant, const Timings& ours) const {
    if (rival.status != BenchStatus::ok) {
        return rival;
    }
    const Timings& theirs = timings_.at(contestant);
    if (theirs.error.empty()) {
        compare(rival, theirs.milliseconds, ours.milliseconds);
    } else {
        rival.status = BenchStatus::error;
        rival.reason = theirs.error;
    }
    return rival;
}

RivalResult BenchGroup::measured(const BenchBaseline& baseline, const Timings& ours) const {
    RivalResult rival;
    std::vector<std::span<const double>> theirs;
    for (const BenchScene& scene : baseline.scenes) {
        const Entrant& entrant = *find(row_name(scene));
        rival.name = baseline.name.empty() ? entrant.row.key() : baseline.name;
        const Timings* timings = timings_of(entrant.row.name);
        if (timings == nullptr) {
            const std::string& reason = entrant.result.reason;
            rival.status = BenchStatus::error;
            rival.reason = reason.empty() ? timings_.at(entrant.contestant).error : reason;
            return rival;
        }
        theirs.emplace_back(timings->milliseconds);
    }
    compare(rival, mean_by_rounds(theirs), ours.milliseconds);
    return rival;
}

const BenchGroup::Entrant* BenchGroup::find(std::string_view row) const {
    const auto found = std::find_if(entrants_.begin(), entrants_.end(),
                                    [row](const Entrant& entrant) { return entrant.row.name == row; });
    return found == entrants_.end() ? nullptr : &*found;
}

const Timings* BenchGroup::timings_of(std::string_view row) const {
    const Entrant* entrant = find(row);
    if (entrant == nullptr || entrant->contestant == none || entrant->result.status != BenchStatus::ok) {
        return nullptr;
    }
    const Timings& timings = timings_.at(entrant->contestant);
    return timings.error.empty() ? &timings : nullptr;
}

std::optional<double> BenchGroup::median_ms(std::string_view row) const {
    const Timings* timings = timings_of(row);
    return timings == nullptr ? std::nullopt : std::optional(median(timings->milliseconds));
}

std::optional<double> BenchGroup::ratio(std::string_view row, std::string_view baseline) const {
    const Timings* ours = timings_of(row);
    const Timings* theirs = timings_of(baseline);
    if (ours == nullptr || theirs == nullptr) {
        return std::nullopt;
    }
    return paired_ratio(ours->milliseconds, theirs->milliseconds);
}

} // namespace clshade
