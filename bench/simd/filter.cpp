// A pre-filter as a careful engineer writes it in C++: for every vertex of the octahedral grid a loop over the rows and
// columns that the lobe reaches, vectorised by the compiler (OpenMP simd, relaxed floating point).
#include "bench/simd/kernel_set.h"
#include "bench/simd/powers.h"
#include "bench/simd/rivals.h"

namespace clshade::rivals {

namespace {

constexpr int vector_texels = 16; // the longest there is
constexpr double pi = 3.14159265358979323846;

struct Direction {
    double x, y, z;
};

/// Unit vector of vertex (i, j): filter_layout.h, GRID.
Direction vertex_direction(int cells, int i, int j) {
    double x = 2.0 * i / cells - 1.0;
    double y = 2.0 * j / cells - 1.0;
    const double z = 1.0 - __builtin_fabs(x) - __builtin_fabs(y);
    if (z < 0.0) {
        const double folded = (1.0 - __builtin_fabs(y)) * (x < 0.0 ? -1.0 : 1.0);
        y = (1.0 - __builtin_fabs(x)) * (y < 0.0 ? -1.0 : 1.0);
        x = folded;
    }
    const double scale = 1.0 / __builtin_sqrt(x * x + y * y + z * z);
    return {x * scale, y * scale, z * scale};
}

struct Sums {
    float red, green, blue, weight;
};

/// A run of one row's texels. w - R and not R.w: the dot product's rounding is magnified n times.
template <bool Cosine>
Sums sum_run(const SkySource& source, float half_exponent, int row, float rx, float ry, float dz, int first, int last) {
    const size_t start = static_cast<size_t>(row) * static_cast<size_t>(source.width);
    const float* const red = source.red + start;
    const float* const green = source.green + start;
    const float* const blue = source.blue + start;
    const float* const cosine = source.column_cosine;
    const float* const sine = source.column_sine;
    const float s = source.row_sine[row];
    float r = 0.0F, g = 0.0F, b = 0.0F, w = 0.0F;
#pragma omp simd reduction(+ : r, g, b, w)
    for (int x = first; x < last; ++x) {
        const float dx = s * cosine[x] - rx;
        const float dy = s * sine[x] - ry;
        const float h = smaller(0.25F * (dx * dx + dy * dy + dz * dz), 0.9999999F); // (1 - R.w)/2
        const float weight =
            Cosine ? larger(1.0F - 2.0F * h, 0.0F) : power_of_two(larger(half_exponent * log_of_rest(h), -60.0F));
        r += weight * red[x];
        g += weight * green[x];
        b += weight * blue[x];
        w += weight;
    }
    return {r, g, b, w};
}

template <bool Cosine>
void filter_vertex(const SkySource& source, const SkyLobe& lobe, const Direction& direction, float* out) {
    const double polar = __builtin_atan2(__builtin_hypot(direction.x, direction.y), direction.z);
    const double azimuth = __builtin_atan2(direction.y, direction.x);
    const double angle = 2.0 * __builtin_asin(__builtin_sqrt(static_cast<double>(lobe.reach)));
    const double texel = pi / source.height;
    const double sine = __builtin_sin(polar);
    int first_row = static_cast<int>(__builtin_floor((polar - angle) / texel - 0.5));
    int last_row = static_cast<int>(__builtin_ceil((polar + angle) / texel - 0.5)) + 1;
    first_row = first_row < 0 ? 0 : first_row;
    last_row = last_row > source.height ? source.height : last_row;
    const double middle = (0.5 - azimuth / (2.0 * pi)) * source.width - 0.5;

    double r = 0.0, g = 0.0, b = 0.0, w = 0.0;
    for (int row = first_row; row < last_row; ++row) {
        // sin^2(dtheta/2) + sin theta sin theta_R sin^2(dphi/2) <= reach
        const double half = 0.5 * ((row + 0.5) * texel - polar);
        const double left = static_cast<double>(lobe.reach) - __builtin_sin(half) * __builtin_sin(half);
        const double along = static_cast<double>(source.row_sine[row]) * sine;
        int first = 0;
        int last = source.width;
        if (left < along) {
            const double reach = 2.0 * __builtin_asin(__builtin_sqrt(left > 0.0 ? left / along : 0.0));
            const double columns = reach / (2.0 * pi) * source.width;
            const int from = static_cast<int>(__builtin_floor(middle - columns));
            // Whole vectors: the texels beyond weigh next to nothing, a loop's rest one by one costs more.
            const int count = static_cast<int>(__builtin_ceil(middle + columns)) + 1 - from;
            const int to = from + (count + vector_texels - 1) / vector_texels * vector_texels;
            if (to - from < source.width) {
                first = from;
                last = to;
            }
        }
        const auto rx = static_cast<float>(direction.x);
        const auto ry = static_cast<float>(direction.y);
        const float dz = source.row_cosine[row] - static_cast<float>(direction.z);
        const auto area = static_cast<double>(source.row_area[row]);
        const auto add = [&](int begin, int end) {
            const Sums sums = sum_run<Cosine>(source, lobe.half_exponent, row, rx, ry, dz, begin, end);
            r += area * static_cast<double>(sums.red);
            g += area * static_cast<double>(sums.green);
            b += area * static_cast<double>(sums.blue);
            w += area * static_cast<double>(sums.weight);
        };
        if (first < 0) { // the run goes around the seam
            add(first + source.width, source.width);
            add(0, last);
        } else if (last > source.width) {
            add(first, source.width);
            add(0, last - source.width);
        } else {
            add(first, last);
        }
    }
    out[0] = static_cast<float>(r / w);
    out[1] = static_cast<float>(g / w);
    out[2] = static_cast<float>(b / w);
}

} // namespace

void CLSHADE_RIVALS(filter)(const SkySource& source, const SkyLobe& lobe, float* out, size_t begin, size_t end) {
    const auto side = static_cast<size_t>(lobe.cells) + 1;
    for (size_t v = begin; v < end; ++v) {
        const Direction direction =
            vertex_direction(lobe.cells, static_cast<int>(v % side), static_cast<int>(v / side));
        (lobe.cosine ? filter_vertex<true> : filter_vertex<false>)(source, lobe, direction, out + 3 * v);
    }
}

} // namespace clshade::rivals
