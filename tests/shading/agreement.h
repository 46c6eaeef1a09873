// Shared by the shading tests: shading on the CPU device and comparing with the reference.
#pragma once

#include "host/gbuffer/random_gbuffer.h"
#include "host/reference/compare.h"
#include "host/reference/reference.h"
#include "host/reference/rounding.h"
#include "host/reference/tolerance.h"
#include "host/shading/kernel_library.h"
#include "host/shading/shader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace clshade {

/// The device the tests run on: the CPU, since every machine that builds clshade has PoCL.
inline Device& test_device() {
    static Device device(select_device(list_devices(), "cpu"));
    return device;
}

inline ShadedImage shade(Frame& frame, int lanes, AovSelection aovs = {}, std::size_t band = 0) {
    Shader shader(test_device(), kernel_sources(), ProgramCache::disabled(),
                  {.aovs = aovs, .lanes = lanes, .max_memory = 0, .pixels_per_launch = band});
    return shader.shade(frame);
}

/// The inputs of the worst pixel, for the message.
inline std::string describe_worst(const Frame& frame, const reference::Comparison::Worst& worst) {
    std::string text;
    if (worst.x >= 0) {
        for (const auto& [name, value] : reference::describe_pixel(frame, worst.x, worst.y)) {
            text += "\n  " + name + " " + std::to_string(value);
        }
    }
    return text;
}

/// The tolerance of the least exact of the frame's materials.
inline reference::Tolerance tolerance_of(const Frame& frame) {
    reference::Tolerance loosest;
    for (const BoundMaterial& material : frame.materials) {
        const reference::Tolerance tolerance = reference::default_tolerance(material, frame.environment.has_value());
        loosest = tolerance.rel > loosest.rel ? tolerance : loosest;
    }
    return loosest;
}

/// What single precision can reach, at every pixel: the default tolerance of `clshade check`.
inline void expect_agreement(const ShadedImage& device, const reference::Image& expected, const Frame& frame,
                             const std::string& what) {
    const auto tolerance = tolerance_of(frame);
    const auto scale = reference::rounding_scale(frame, 2);
    for (int plane = 0; plane + 3 <= static_cast<int>(device.plane_names.size()); plane += plane == 0 ? 4 : 3) {
        const auto result = reference::compare(device.planes, expected, scale, tolerance, {}, plane, 3);
        EXPECT_TRUE(reference::passes(result, tolerance))
            << what << ", plane " << device.plane_names[static_cast<std::size_t>(plane)] << ": " << result.outside
            << " pixels outside, worst at " << result.worst.x << "," << result.worst.y << ": " << result.worst.device
            << " for " << result.worst.reference << describe_worst(frame, result.worst);
    }
    for (int y = 0; y < expected.height; ++y) {
        for (int x = 0; x < expected.width; ++x) {
            const double alpha = expected.planes[3][static_cast<std::size_t>(y) * expected.width + x];
            EXPECT_EQ(device.planes.at(3, x, y), static_cast<float>(alpha)) << what << " alpha at " << x << "," << y;
        }
    }
    EXPECT_EQ(device.counts.nonfinite, expected.counts.nonfinite) << what;
    EXPECT_EQ(device.counts.clamped, expected.counts.clamped) << what;
    EXPECT_EQ(device.counts.fractional_ids, expected.counts.fractional_ids) << what;
    EXPECT_EQ(device.counts.no_tangent, expected.counts.no_tangent) << what;
}

} // namespace clshade
