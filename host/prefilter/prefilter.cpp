#include "host/prefilter/prefilter.h"

#include "host/base/hash.h"
#include "host/environment/sh.h"
#include "host/prefilter/ambient_run.h"
#include "host/prefilter/blob.h"
#include "host/prefilter/filter_run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <span>
#include <stdexcept>
#include <utility>

namespace clshade {

namespace {

/// Counts changes to the results that the kernels' text does not show: layout, sources, sums on the host.
constexpr int result_version = 1;

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// What a result is stored under: everything that it depends on, each part with its length.
std::string identity_of(const DeviceInfo& device, const SourceSet& kernels, const std::string& kernel_file, int lanes,
                        const std::string& what) {
    std::string text;
    for (const std::string& part :
         {fmt::format("prefilter {} {}", result_version, lanes), what, kernels.expand(kernel_file), device.platform,
          device.name, device.driver, device.version}) {
        text += fmt::format("{}:{}\n", part.size(), part);
    }
    return hash_hex(std::string_view(text));
}

void warn_of_misfit(const ProgramCache& cache, const std::string& identity) {
    spdlog::warn("cache: {} is no such result as it should be; it is dropped and made anew", identity);
    cache.discard(identity);
}

constexpr std::size_t table_vertices =
    static_cast<std::size_t>(ambient_cosines + 1) * static_cast<std::size_t>(ambient_exponents + 1);

/// `count` floats from the cache, or made and stored.
template <class Make>
std::vector<float> cached_floats(const ProgramCache& cache, const std::string& identity, std::size_t count,
                                 const Make& make) {
    if (const auto bytes = cache.load(identity)) {
        if (auto values = unpack_floats(*bytes, count)) {
            return std::move(*values);
        }
        warn_of_misfit(cache, identity);
    }
    std::vector<float> values = make();
    cache.store(identity, pack(values));
    return values;
}

} // namespace

Prefilter::Prefilter(Device& device, SourceSet kernels, ProgramCache cache, int lanes)
    : device_(&device), kernels_(std::move(kernels)), cache_(std::move(cache)), lanes_(lanes) {
    if (lanes != 1 && lanes != 4 && lanes != 8 && lanes != 16) {
        throw std::invalid_argument(fmt::format("{} lanes: kernels come in 1, 4, 8 and 16", lanes));
    }
}

FilteredSet Prefilter::filter(const LatLong& image, const std::function<void(double)>& progress,
                              PrefilterReport* report) {
    const auto start = Clock::now();
    if (image.height < 1 || image.width != 2 * image.height) {
        throw std::invalid_argument(
            fmt::format("{}: {} x {} texels are no lat-long picture", image.name, image.width, image.height));
    }
    const std::string hash = content_hash(image);
    const std::string identity = identity_of(device_->info(), kernels_, filter_kernel_file, lanes_, "maps of " + hash);
    std::optional<FilteredSet> set;
    if (const auto bytes = cache_.load(identity)) {
        set = unpack_set(*bytes);
        if (!set) {
            warn_of_misfit(cache_, identity);
        }
    }
    const bool from_cache = set.has_value();
    FilterCost cost;
    if (!set) {
        set.emplace();
        cost = filter_on_device(*device_, kernels_, cache_, lanes_, image, progress, *set);
        set->sh = sh_of(image);
        set->mean = mean_radiance(image);
        check_sizes(*set);
        cache_.store(identity, pack(*set));
    }
    set->name = image.name;
    set->hash = hash;
    set->up = image.up;
    if (progress) {
        progress(1.0);
    }
    if (report != nullptr) {
        *report = {.from_cache = from_cache,
                   .milliseconds = milliseconds_since(start),
                   .kernel_milliseconds = cost.kernel_milliseconds,
                   .build_milliseconds = cost.build_milliseconds};
    }
    return std::move(*set);
}

AmbientTables Prefilter::ambient_tables() {
    const std::string identity = identity_of(device_->info(), kernels_, ambient_kernel_file, lanes_, "ambient tables");
    constexpr std::size_t half = 2 * table_vertices;
    const std::vector<float> both = cached_floats(cache_, identity, 2 * half, [&] {
        AmbientTables made = ambient_on_device(*device_, kernels_, cache_, lanes_);
        made.exact.insert(made.exact.end(), made.linear.begin(), made.linear.end());
        return made.exact;
    });
    const std::span<const float> all(both);
    const auto exact = all.first(half);
    const auto linear = all.subspan(half);
    return {{exact.begin(), exact.end()}, {linear.begin(), linear.end()}};
}

std::vector<float> Prefilter::spectral_table(const ReflectanceCurve& curve, bool linear) {
    if (curve.coefficients.empty()) {
        throw std::invalid_argument("a reflectance curve without coefficients");
    }
    std::string what = fmt::format("spectral table {} {:a}", linear ? "linear" : "exact", curve.bend);
    for (const glm::dvec3& c : curve.coefficients) {
        what += fmt::format(" {:a} {:a} {:a}", c.x, c.y, c.z);
    }
    const std::string identity = identity_of(device_->info(), kernels_, ambient_kernel_file, lanes_, what);
    return cached_floats(cache_, identity, 3 * table_vertices,
                         [&] { return spectral_on_device(*device_, kernels_, cache_, lanes_, curve, linear); });
}

} // namespace clshade
