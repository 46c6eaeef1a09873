#include "tests/cli/gbuffers.h"

#include "host/images/image_reader.h"
#include "host/images/image_writer.h"
#include "tests/cli/run_program.h"

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace clshade::tests {

namespace {

// Hand-made normals: a wave in both directions, unit length.
std::array<float, 3> normal_at(int x, int y) {
    const double nx = 0.6 * std::sin(0.35 * x);
    const double ny = 0.5 * std::cos(0.3 * y);
    const double length = std::sqrt(nx * nx + ny * ny + 1.0);
    return {static_cast<float>(nx / length), static_cast<float>(ny / length), static_cast<float>(1.0 / length)};
}

void write(const std::filesystem::path& file, const std::vector<TestPlane>& planes, bool with_camera) {
    PlaneSlab slab(test_width, test_height, static_cast<int>(planes.size()));
    OutputImage image;
    image.data_window = {0, 0, test_width - 1, test_height - 1};
    image.display_window = image.data_window;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const int plane = static_cast<int>(i);
        for (int y = 0; y < test_height; ++y) {
            for (int x = 0; x < test_width; ++x) {
                slab.at(plane, x, y) = planes[i].value(x, y);
            }
        }
        image.channels.push_back({planes[i].name, &slab, plane, true});
    }
    if (with_camera) {
        glm::dmat4 world_to_camera(1.0); // rows: x right, y up, z forward (-Z), translation
        world_to_camera[2][2] = -1.0;
        world_to_camera[3][2] = 5.0;
        image.matrices["worldToCamera"] = world_to_camera;
    }
    ExrSettings settings;
    settings.half = false;
    write_exr(file, image, settings);
}

Imf::Header header_of(std::initializer_list<const char*> channels, Imf::PixelType type) {
    Imf::Header header(test_width, test_height);
    for (const char* channel : channels) {
        header.channels().insert(channel, Imf::Channel(type));
    }
    return header;
}

} // namespace

std::vector<TestPlane> surface_planes() {
    const auto left = [](int x, int /*y*/) { return x < test_width / 2 ? 1.0F : 0.2F; };
    std::vector<TestPlane> planes;
    const std::array<std::string, 3> axes{"X", "Y", "Z"};
    for (std::size_t c = 0; c < axes.size(); ++c) {
        planes.push_back({"Normal." + axes[c], [c](int x, int y) { return normal_at(x, y)[c]; }});
    }
    planes.push_back(
        {"Position.X", [](int x, int /*y*/) { return 0.05F * (static_cast<float>(x) - 0.5F * test_width); }});
    planes.push_back(
        {"Position.Y", [](int /*x*/, int y) { return 0.05F * (0.5F * test_height - static_cast<float>(y)); }});
    planes.push_back({"Position.Z", [](int x, int y) { return 0.1F * normal_at(x, y)[2]; }});
    planes.push_back({"Depth.Z", [](int x, int y) { return 5.0F - 0.1F * normal_at(x, y)[2]; }});
    for (const char* name : {"Albedo.R", "Albedo.G", "Albedo.B"}) {
        planes.push_back({name, left});
    }
    planes.push_back({"Roughness.V", [](int /*x*/, int /*y*/) { return 0.4F; }});
    return planes;
}

std::vector<TestPlane> surface_planes_and(const TestPlane& more) {
    std::vector<TestPlane> planes = surface_planes_without(more.name);
    planes.push_back(more);
    return planes;
}

std::vector<TestPlane> surface_planes_without(const std::string& prefix) {
    std::vector<TestPlane> planes = surface_planes();
    std::erase_if(planes, [&](const TestPlane& plane) { return plane.name.starts_with(prefix); });
    return planes;
}

void write_gbuffer(const std::filesystem::path& file, const std::vector<TestPlane>& planes) {
    write(file, planes, true);
}

void write_gbuffer_without_camera(const std::filesystem::path& file, const std::vector<TestPlane>& planes) {
    write(file, planes, false);
}

void write_deep(const std::filesystem::path& file) {
    Imf::Header header = header_of({"Z"}, Imf::FLOAT);
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    Imf::DeepScanLineOutputFile output(file.c_str(), header);
    std::vector<unsigned> counts(std::size_t{test_width} * test_height, 1);
    std::vector<float> values(counts.size(), 2.0F);
    std::vector<float*> samples(counts.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        samples[i] = &values[i];
    }
    const auto bytes = [](void* data) { return static_cast<char*>(data); };
    Imf::DeepFrameBuffer buffer;
    buffer.insertSampleCountSlice(
        Imf::Slice(Imf::UINT, bytes(counts.data()), sizeof(unsigned), sizeof(unsigned) * test_width));
    buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, bytes(samples.data()), sizeof(float*), sizeof(float*) * test_width,
                                      sizeof(float)));
    output.setFrameBuffer(buffer);
    output.writePixels(test_height);
}

void write_subsampled(const std::filesystem::path& file) {
    Imf::Header header = header_of({"Y"}, Imf::HALF);
    header.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
    header.channels().insert("BY", Imf::Channel(Imf::HALF, 2, 2));
    std::vector<std::uint16_t> zeros(std::size_t{test_width} * test_height, 0);
    char* data = static_cast<char*>(static_cast<void*>(zeros.data()));
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice(Imf::HALF, data, 2, std::size_t{2} * test_width));
    buffer.insert("RY", Imf::Slice(Imf::HALF, data, 2, test_width, 2, 2));
    buffer.insert("BY", Imf::Slice(Imf::HALF, data, 2, test_width, 2, 2));
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(buffer);
    output.writePixels(test_height);
}

void write_with_data_window(const std::filesystem::path& file, int x_min, int y_min, int x_max, int y_max) {
    write_gbuffer(file, surface_planes());
    std::string bytes = bytes_of(file);
    const std::string attribute("dataWindow\0box2i\0", 17);
    const std::size_t found = bytes.find(attribute);
    if (found == std::string::npos) {
        throw std::runtime_error("no data window in " + file.string());
    }
    std::size_t at = found + attribute.size() + 4; // after the attribute's size
    for (const int bound : {x_min, y_min, x_max, y_max}) {
        const auto value = std::bit_cast<std::uint32_t>(bound);
        for (unsigned shift = 0; shift < 32; shift += 8) {
            bytes[at++] = static_cast<char>((value >> shift) & 0xFFU);
        }
    }
    write_bytes(file, bytes);
}

const std::vector<float>& Decoded::plane(const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
        throw std::runtime_error("no plane " + name);
    }
    return planes[static_cast<std::size_t>(found - names.begin())];
}

Decoded decode(const std::filesystem::path& file) {
    const ImageLayout layout = read_layout(file);
    FramePlan plan;
    Decoded decoded;
    for (std::size_t i = 0; i < layout.channels.size(); ++i) {
        plan.channels.push_back(static_cast<int>(i));
        decoded.names.push_back(layout.channels[i].name);
    }
    plan.frame.data_window = layout.parts.at(0).data_window;
    decoded.width = plan.frame.data_window.width();
    decoded.height = plan.frame.data_window.height();
    plan.frame.planes = PlaneSlab(decoded.width, decoded.height, static_cast<int>(plan.channels.size()));
    read_planes(file, layout, plan, 1);
    for (int p = 0; p < plan.frame.planes.count(); ++p) {
        std::vector<float>& pixels = decoded.planes.emplace_back();
        for (int y = 0; y < decoded.height; ++y) {
            const auto row = plan.frame.planes.row(p, y);
            pixels.insert(pixels.end(), row.begin(), row.end());
        }
    }
    return decoded;
}

} // namespace clshade::tests
