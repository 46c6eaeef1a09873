#include "host/prefilter/ambient_run.h"

#include "host/prefilter/ambient_plan.h"

#include <fmt/format.h>

#include <cstddef>
#include <span>
#include <string>

namespace clshade {

namespace {

constexpr std::size_t work_group = 32;
constexpr std::size_t table_columns = ambient_cosines + 1;
constexpr std::size_t table_rows = ambient_exponents + 1;

template <class T>
Buffer constant_buffer(Device& device, std::span<const T> values) {
    Buffer buffer(device, values.size_bytes(), Access::read);
    buffer.write(std::as_bytes(values));
    return buffer;
}

/// Three channels of every vertex: channel c of vertex (i, j) at (3 j + c) ambient_pitch + i.
std::vector<float> integrate(Device& device, const SourceSet& kernels, const ProgramCache& cache,
                             const std::string& options, int lanes, bool linear, double bend,
                             std::span<const float> coefficients) {
    Program program(device, kernels, ambient_kernel_file, options, cache);
    const Buffer eyes = constant_buffer(device, std::span<const float>(ambient_eyes()));
    const Buffer rows = constant_buffer(device, std::span<const AmbientRow>(ambient_rows(linear)));
    const Buffer nodes = constant_buffer(device, std::span<const float>(ambient_nodes()));
    const Buffer curve = constant_buffer(device, coefficients);
    std::vector<float> values(3 * table_rows * ambient_pitch);
    Buffer result(device, values.size() * sizeof(float), Access::read_write);
    Kernel kernel(program, "ambient_brdf");
    kernel.set_argument(0, eyes);
    kernel.set_argument(1, rows);
    kernel.set_argument(2, nodes);
    kernel.set_argument(3, curve);
    kernel.set_argument(4, static_cast<int>(coefficients.size() / 3));
    kernel.set_argument(5, static_cast<float>(bend));
    kernel.set_argument(6, result);
    kernel.set_argument(7, ambient_pitch);
    kernel.set_argument(8, static_cast<int>(table_rows));
    const std::size_t items = table_rows * ambient_pitch / static_cast<std::size_t>(lanes);
    kernel.launch((items + work_group - 1) / work_group * work_group, work_group);
    static_cast<void>(kernel.wait_milliseconds());
    result.read(std::as_writable_bytes(std::span(values)));
    program.store_binary();
    return values;
}

/// The first `channels` channels interleaved, without the padding; row j times factors[j].
std::vector<float> interleaved(std::span<const float> values, std::size_t channels, std::span<const double> factors) {
    std::vector<float> table;
    table.reserve(channels * table_rows * table_columns);
    for (std::size_t j = 0; j < table_rows; ++j) {
        for (std::size_t i = 0; i < table_columns; ++i) {
            for (std::size_t c = 0; c < channels; ++c) {
                const auto value = static_cast<double>(values[(3 * j + c) * ambient_pitch + i]);
                table.push_back(static_cast<float>(value * factors[j]));
            }
        }
    }
    return table;
}

} // namespace

AmbientTables ambient_on_device(Device& device, const SourceSet& kernels, const ProgramCache& cache, int lanes) {
    // No curve; a buffer cannot be empty.
    const std::vector<float> values = integrate(device, kernels, cache, fmt::format("-DLANES={}", lanes), lanes, false,
                                                1.0, std::vector<float>(3, 0.0F));
    const std::vector<double> same(table_rows, 1.0);
    std::vector<double> linear;
    for (int j = 0; j <= ambient_exponents; ++j) {
        const double n = ambient_shininess(j);
        linear.push_back(linear_normaliser(n) / exact_normaliser(n));
    }
    return {interleaved(values, 2, same), interleaved(values, 2, linear)};
}

std::vector<float> spectral_on_device(Device& device, const SourceSet& kernels, const ProgramCache& cache, int lanes,
                                      const ReflectanceCurve& curve, bool linear) {
    std::vector<float> coefficients;
    for (const glm::dvec3& c : curve.coefficients) {
        for (int channel = 0; channel < 3; ++channel) {
            coefficients.push_back(static_cast<float>(c[channel]));
        }
    }
    const std::vector<float> values = integrate(device, kernels, cache, fmt::format("-DLANES={} -DSPECTRAL=1", lanes),
                                                lanes, linear, curve.bend, coefficients);
    return interleaved(values, 3, std::vector<double>(table_rows, 1.0));
}

} // namespace clshade
