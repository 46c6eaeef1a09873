// First guesses for camera_fit: linear solutions from a few or all sights.
#include "host/gbuffer/camera_fit.h"
#include "host/gbuffer/small_linear_algebra.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace clshade {

namespace {

/// Centre and scale that bring pixels to about one: without them the linear systems mix units and lose digits.
struct PixelFrame {
    glm::dvec2 centre{0.0};
    double scale = 1.0;
    [[nodiscard]] glm::dvec2 operator()(const glm::dvec2& pixel) const { return (pixel - centre) * scale; }
};

PixelFrame pixel_frame(std::span<const Sight> sights) {
    PixelFrame frame;
    for (const Sight& sight : sights) {
        frame.centre += sight.pixel / static_cast<double>(sights.size());
    }
    double spread = 0.0;
    for (const Sight& sight : sights) {
        spread += glm::length(sight.pixel - frame.centre) / static_cast<double>(sights.size());
    }
    frame.scale = spread > 0.0 ? 1.0 / spread : 1.0;
    return frame;
}

/// The same for positions.
struct PositionFrame {
    glm::dvec3 centre{0.0};
    double scale = 1.0;
    [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& position) const { return (position - centre) * scale; }
};

PositionFrame position_frame(std::span<const Sight> sights) {
    PositionFrame frame;
    for (const Sight& sight : sights) {
        frame.centre += sight.position / static_cast<double>(sights.size());
    }
    double spread = 0.0;
    for (const Sight& sight : sights) {
        spread += glm::length(sight.position - frame.centre) / static_cast<double>(sights.size());
    }
    frame.scale = spread > 0.0 ? 1.0 / spread : 1.0;
    return frame;
}

template <std::size_t N>
void add_row(SmallMatrix<N>& gram, const std::array<double, N>& row) {
    for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t j = 0; j < N; ++j) {
            gram[i][j] += row[i] * row[j];
        }
    }
}

/// Is the null vector alone? Two eigenvalues near zero mean degenerate sights.
template <std::size_t N>
bool is_single_null(const Eigensystem<N>& system) {
    SmallVector<N> values = system.values;
    std::sort(values.begin(), values.end());
    return values[1] > 1e-13 * values[N - 1];
}

bool is_finite(const FittedCamera& camera) {
    double sum = camera.focal + camera.centre.x + camera.centre.y + camera.eye.x + camera.eye.y + camera.eye.z;
    for (int i = 0; i < 3; ++i) {
        sum += camera.rotation[i].x + camera.rotation[i].y + camera.rotation[i].z;
    }
    return std::isfinite(sum) && camera.focal > 0.0;
}

/// Rows to the columns GLM stores.
glm::dmat3 from_rows(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::transpose(glm::dmat3(a, b, c));
}

} // namespace

std::optional<FittedCamera> dlt_camera(std::span<const Sight> sights) {
    if (sights.size() < 6) {
        return std::nullopt;
    }
    const PixelFrame to_pixel = pixel_frame(sights);
    const PositionFrame to_position = position_frame(sights);
    SmallMatrix<12> gram{};
    for (const Sight& sight : sights) {
        const glm::dvec2 u = to_pixel(sight.pixel);
        const glm::dvec3 p = to_position(sight.position);
        add_row<12>(gram, {p.x, p.y, p.z, 1.0, 0.0, 0.0, 0.0, 0.0, -u.x * p.x, -u.x * p.y, -u.x * p.z, -u.x});
        add_row<12>(gram, {0.0, 0.0, 0.0, 0.0, p.x, p.y, p.z, 1.0, -u.y * p.x, -u.y * p.y, -u.y * p.z, -u.y});
    }
    const Eigensystem<12> system = symmetric_eigensystem(gram);
    if (!is_single_null(system)) {
        return std::nullopt;
    }
    const SmallVector<12> v = system.vector(system.smallest());
    std::array<glm::dvec3, 3> m{glm::dvec3(v[0], v[1], v[2]), glm::dvec3(v[4], v[5], v[6]),
                                glm::dvec3(v[8], v[9], v[10])};
    glm::dvec3 last(v[3], v[7], v[11]);
    // The scale of a projective matrix is free; most sights lie in front of the camera.
    std::size_t behind = 0;
    for (const Sight& sight : sights) {
        behind += glm::dot(m[2], to_position(sight.position)) + last.z < 0.0 ? 1 : 0;
    }
    const double size = glm::length(m[2]) * (2 * behind > sights.size() ? -1.0 : 1.0);
    if (!(std::abs(size) > 1e-12)) {
        return std::nullopt; // an orthographic camera
    }
    for (glm::dvec3& row : m) {
        row /= size;
    }
    last /= size;
    // m = K R with K upper triangular, by orthogonalisation from the last row up.
    const glm::dvec3 forward = m[2];
    const glm::dvec2 centre(glm::dot(m[0], forward), glm::dot(m[1], forward));
    const glm::dvec3 down_scaled = m[1] - centre.y * forward;
    const glm::dvec3 down = glm::normalize(down_scaled);
    glm::dvec3 right_scaled = m[0] - centre.x * forward;
    right_scaled -= down * glm::dot(right_scaled, down);
    const glm::dvec3 right = glm::normalize(right_scaled);
    FittedCamera camera;
    camera.rotation = from_rows(right, down, forward);
    camera.focal = std::sqrt(glm::length(down_scaled) * glm::length(right_scaled)) / to_pixel.scale;
    camera.centre = to_pixel.centre + centre / to_pixel.scale;
    const glm::dvec3 eye = -(glm::inverse(from_rows(m[0], m[1], m[2])) * last);
    camera.eye = to_position.centre + eye / to_position.scale;
    return is_finite(camera) ? std::optional(camera) : std::nullopt;
}

std::optional<FittedCamera> affine_camera(std::span<const Sight> sights) {
    if (sights.size() < 4) {
        return std::nullopt;
    }
    const PositionFrame to_position = position_frame(sights);
    SmallMatrix<4> gram{};
    SmallVector<4> right_x{};
    SmallVector<4> right_y{};
    for (const Sight& sight : sights) {
        const glm::dvec3 p = to_position(sight.position);
        const std::array<double, 4> row{p.x, p.y, p.z, 1.0};
        add_row<4>(gram, row);
        for (std::size_t i = 0; i < 4; ++i) {
            right_x[i] += row[i] * sight.pixel.x;
            right_y[i] += row[i] * sight.pixel.y;
        }
    }
    const Eigensystem<4> system = symmetric_eigensystem(gram);
    if (!(system.values[system.smallest()] > 1e-10 * static_cast<double>(sights.size()))) {
        return std::nullopt; // in one plane
    }
    const auto x = solve_positive(gram, right_x, 4);
    const auto y = solve_positive(gram, right_y, 4);
    if (!x || !y) {
        return std::nullopt;
    }
    const glm::dvec3 across((*x)[0], (*x)[1], (*x)[2]);
    const glm::dvec3 downwards((*y)[0], (*y)[1], (*y)[2]);
    const glm::dvec3 right = glm::normalize(across);
    const glm::dvec3 down = glm::normalize(downwards - right * glm::dot(right, downwards));
    FittedCamera camera;
    camera.orthographic = true;
    camera.rotation = from_rows(right, down, glm::cross(right, down));
    camera.focal = std::sqrt(glm::length(across) * glm::length(downwards)) * to_position.scale;
    camera.eye = to_position.centre;
    camera.centre = {(*x)[3], (*y)[3]};
    return is_finite(camera) ? std::optional(camera) : std::nullopt;
}

std::optional<FittedCamera> plane_camera(std::span<const Sight> sights) {
    if (sights.size() < 4) {
        return std::nullopt;
    }
    // The plane: origin and two axes across the direction of least spread.
    const PositionFrame to_position = position_frame(sights);
    SmallMatrix<3> spread{};
    for (const Sight& sight : sights) {
        const glm::dvec3 p = to_position(sight.position);
        add_row<3>(spread, {p.x, p.y, p.z});
    }
    const Eigensystem<3> axes = symmetric_eigensystem(spread);
    const SmallVector<3> n = axes.vector(axes.smallest());
    const glm::dvec3 normal(n[0], n[1], n[2]);
    const glm::dvec3 helper = std::abs(normal.x) < 0.7 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 e1 = glm::normalize(glm::cross(normal, helper));
    const glm::dvec3 e2 = glm::cross(normal, e1);
    // Homography from plane coordinates to pixels.
    const double pixel_scale = pixel_frame(sights).scale; // the centre must stay in the middle of the window
    SmallMatrix<9> gram{};
    for (const Sight& sight : sights) {
        const glm::dvec3 p = to_position(sight.position);
        const double a = glm::dot(p, e1);
        const double b = glm::dot(p, e2);
        const glm::dvec2 u = sight.pixel * pixel_scale;
        add_row<9>(gram, {a, b, 1.0, 0.0, 0.0, 0.0, -u.x * a, -u.x * b, -u.x});
        add_row<9>(gram, {0.0, 0.0, 0.0, a, b, 1.0, -u.y * a, -u.y * b, -u.y});
    }
    const Eigensystem<9> system = symmetric_eigensystem(gram);
    if (!is_single_null(system)) {
        return std::nullopt;
    }
    const SmallVector<9> v = system.vector(system.smallest());
    std::array<glm::dvec3, 3> h{glm::dvec3(v[0], v[3], v[6]), glm::dvec3(v[1], v[4], v[7]),
                                glm::dvec3(v[2], v[5], v[8])};
    // K^-1 h1 and K^-1 h2 are orthogonal and of equal length, K = diag(f, f, 1) (Zhang 2000, section 3.1):
    // two equations in q = 1 / f^2.
    const glm::dvec2 slope(h[0].x * h[1].x + h[0].y * h[1].y,
                           h[0].x * h[0].x + h[0].y * h[0].y - h[1].x * h[1].x - h[1].y * h[1].y);
    const glm::dvec2 constant(h[0].z * h[1].z, h[0].z * h[0].z - h[1].z * h[1].z);
    const double q = -glm::dot(slope, constant) / glm::dot(slope, slope);
    if (!(q > 0.0) || !std::isfinite(q)) {
        return std::nullopt;
    }
    const double focal = 1.0 / std::sqrt(q);
    for (glm::dvec3& column : h) {
        column = {column.x / focal, column.y / focal, column.z};
    }
    double size = 0.5 * (glm::length(h[0]) + glm::length(h[1]));
    if (h[2].z < 0.0) {
        size = -size; // the plane's origin, amid the sights, lies in front of the camera
    }
    const glm::dvec3 r1 = glm::normalize(h[0] / size);
    const glm::dvec3 r2_raw = h[1] / size;
    const glm::dvec3 r2 = glm::normalize(r2_raw - r1 * glm::dot(r1, r2_raw));
    FittedCamera camera;
    camera.rotation = glm::dmat3(r1, r2, glm::cross(r1, r2)) * glm::transpose(glm::dmat3(e1, e2, glm::cross(e1, e2)));
    camera.focal = focal / pixel_scale;
    const glm::dvec3 eye = -(glm::transpose(camera.rotation) * (h[2] / size));
    camera.eye = to_position.centre + eye / to_position.scale;
    return is_finite(camera) ? std::optional(camera) : std::nullopt;
}

} // namespace clshade
