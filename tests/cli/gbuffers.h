// Small inputs, good and bad, made when needed.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace clshade::tests {

/// A plane of a test picture: name and value at (x, y).
struct TestPlane {
    std::string name;
    std::function<float(int, int)> value;
};

inline constexpr int test_width = 48;
inline constexpr int test_height = 40;

/// Planes of a bumpy surface before a camera at (0, 0, 5) that looks along -Z: Normal.XYZ, Position.XYZ, Depth.Z,
/// Albedo.RGB (1 to the left, 0.2 to the right), Roughness.V.
[[nodiscard]] std::vector<TestPlane> surface_planes();
/// The same with one more plane.
[[nodiscard]] std::vector<TestPlane> surface_planes_and(const TestPlane& more);
/// Without the planes whose names start with `prefix`.
[[nodiscard]] std::vector<TestPlane> surface_planes_without(const std::string& prefix);

/// Writes float EXR with the camera in the header.
void write_gbuffer(const std::filesystem::path& file, const std::vector<TestPlane>& planes);
/// The same without a camera in the header.
void write_gbuffer_without_camera(const std::filesystem::path& file, const std::vector<TestPlane>& planes);

/// Deep scan lines with one sample everywhere.
void write_deep(const std::filesystem::path& file);
/// Luminance and sub-sampled chroma: Y, RY, BY.
void write_subsampled(const std::filesystem::path& file);
/// A good file whose header says another data window (no more than patched bytes).
void write_with_data_window(const std::filesystem::path& file, int x_min, int y_min, int x_max, int y_max);

/// Planes of a picture, decoded.
struct Decoded {
    int width = 0;
    int height = 0;
    std::vector<std::string> names;
    std::vector<std::vector<float>> planes; ///< in the order of names
    [[nodiscard]] const std::vector<float>& plane(const std::string& name) const;
};
[[nodiscard]] Decoded decode(const std::filesystem::path& file);

} // namespace clshade::tests
