#include "host/prefilter/filter_run.h"

#include "host/prefilter/filter_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace clshade {

namespace {

/// One local size for all launches: each further one would be compiled anew.
constexpr std::size_t work_group = 32;
/// Launches are cut to about this long, so that progress is told and other work gets its turn.
constexpr double wanted_milliseconds = 30.0;
constexpr double first_groups = 8.0;

/// A buffer that holds the given constants.
template <class T>
Buffer constant_buffer(Device& device, std::span<const T> values) {
    Buffer buffer(device, values.size_bytes(), Access::read);
    buffer.write(std::as_bytes(values));
    return buffer;
}

struct PictureBuffers {
    FilterPicture picture; ///< its texels are let go: only the device reads them
    Buffer texels;
    Buffer rows;
    Buffer half_angles;

    PictureBuffers(Device& device, const LatLong& source)
        : picture(filter_picture(source)), texels(constant_buffer(device, std::span<const float>(picture.texels))),
          rows(constant_buffer(device, std::span<const float>(picture.rows))),
          half_angles(constant_buffer(device, std::span<const float>(picture.half_angles))) {
        picture.texels = {};
    }
};

/// One map to make.
struct Map {
    double shininess = 0.0;        ///< of the lobe; 0: the cosine
    double source_shininess = 0.0; ///< of the lobe that decides on the source
    int cells = 0;
    std::vector<float>* values = nullptr;
};

std::vector<Map> maps_of(FilteredSet& set) {
    std::vector<Map> maps;
    for (int level = 0; level < radiance_levels; ++level) {
        const double n = level_shininess(level);
        maps.push_back({n, n, level_cells(level), &set.radiance[static_cast<std::size_t>(level)]});
    }
    maps.push_back({0.0, irradiance_source_shininess, irradiance_cells, &set.irradiance});
    // Sharp lobes first, so that each source can be halved from the one before.
    std::stable_sort(maps.begin(), maps.end(),
                     [](const Map& a, const Map& b) { return a.source_shininess > b.source_shininess; });
    return maps;
}

/// Work of a map in texels, for the progress.
double work_of(const Map& map, int width, int height) {
    const double rows = source_height(width, height, map.source_shininess);
    const double reach = map.shininess == 0.0 ? 0.5 : std::min(1.0, 42.0 / map.shininess);
    return rows * rows * reach * map.cells * map.cells;
}

class FilterRun {
  public:
    FilterRun(Device& device, const Program& program, const std::function<void(double)>& progress, double all_work)
        : device_(&device), kernel_(program, "filter_environment"), progress_(&progress), all_work_(all_work) {}

    void make(const Map& map, const PictureBuffers& source, double work) {
        const FilterSource constants = filter_source_constants(source.picture, map.shininess, map.cells);
        const std::vector<FilterDirection> directions = filter_directions(source.picture, map.cells);
        const Buffer constant = constant_buffer(*device_, std::span(&constants, 1));
        const Buffer direction = constant_buffer(*device_, std::span<const FilterDirection>(directions));
        const auto side = static_cast<std::size_t>(map.cells) + 1;
        map.values->resize(side * side * 3);
        Buffer result(*device_, map.values->size() * sizeof(float), Access::read_write);
        kernel_.set_argument(0, source.texels);
        kernel_.set_argument(1, source.rows);
        kernel_.set_argument(2, source.half_angles);
        kernel_.set_argument(3, constant);
        kernel_.set_argument(4, direction);
        kernel_.set_argument(5, result);
        run(directions.size(), work);
        result.read(std::as_writable_bytes(std::span(*map.values)));
        join_border(*map.values, map.cells);
        done_ += work;
    }

    [[nodiscard]] double kernel_milliseconds() const { return kernel_milliseconds_; }

  private:
    void run(std::size_t directions, double work) {
        double groups = first_groups;
        for (std::size_t first = 0; first < directions;) {
            const std::size_t end = std::min(directions, first + static_cast<std::size_t>(groups) * work_group);
            kernel_.set_argument(6, static_cast<int>(first));
            kernel_.set_argument(7, static_cast<int>(end));
            kernel_.launch((end - first + work_group - 1) / work_group * work_group, work_group);
            const double milliseconds = kernel_.wait_milliseconds();
            kernel_milliseconds_ += milliseconds;
            if (*progress_) {
                (*progress_)((done_ + work * static_cast<double>(end) / static_cast<double>(directions)) / all_work_);
            }
            const double growth = std::clamp(wanted_milliseconds / std::max(milliseconds, 0.01), 0.25, 8.0);
            groups = std::max(1.0, std::ceil(growth * groups));
            first = end;
        }
    }

    Device* device_;
    Kernel kernel_;
    const std::function<void(double)>* progress_;
    double all_work_;
    double done_ = 0.0;
    double kernel_milliseconds_ = 0.0;
};

} // namespace

FilterCost filter_on_device(Device& device, const SourceSet& kernels, const ProgramCache& cache, int lanes,
                            const LatLong& image, const std::function<void(double)>& progress, FilteredSet& set) {
    Program program(device, kernels, filter_kernel_file, fmt::format("-DLANES={}", lanes), cache);
    const std::vector<Map> maps = maps_of(set);
    double all_work = 0.0;
    for (const Map& map : maps) {
        all_work += work_of(map, image.width, image.height);
    }
    FilterRun run(device, program, progress, all_work);
    LatLong source = filter_source(image, maps.front().source_shininess);
    std::optional<PictureBuffers> buffers;
    for (const Map& map : maps) {
        const int wanted = source_height(image.width, image.height, map.source_shininess);
        if (!buffers || source.height > wanted) {
            buffers.reset();
            while (source.height > wanted) {
                source = halved(source);
            }
            buffers.emplace(device, source);
        }
        run.make(map, *buffers, work_of(map, image.width, image.height));
    }
    program.store_binary();
    return {run.kernel_milliseconds(), program.report().milliseconds};
}

} // namespace clshade
