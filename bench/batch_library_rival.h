// The least that any tool of this kind must do: decode the planes of each frame, encode a picture of its own. Nothing
// is computed. With OpenEXR as it comes, every core busy, in each of the ways that may be fastest.
#pragma once

#include "host/base/plane_slab.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

/// A picture as a file has it: planes of R, G, B and A one after the other, half or float.
struct StoredPicture {
    int width = 0;
    int height = 0;
    bool half = true;
    std::vector<std::byte> samples;
};

/// R, G, B and A of an EXR file. Throws RuntimeFailure.
[[nodiscard]] StoredPicture read_stored_picture(const std::filesystem::path& file);

/// Largest |a - b| / (1e-3 + |b|) over R, G, B and A; infinite for pictures of different sizes and for NaN.
[[nodiscard]] double stored_difference(const StoredPicture& a, const StoredPicture& b);

struct BareWork {
    std::vector<std::filesystem::path> inputs;
    std::vector<std::filesystem::path> outputs; ///< one per input; replaced
    std::vector<std::string> channels;          ///< decoded, into float planes
    std::string compression;                    ///< of the outputs
    std::shared_ptr<const StoredPicture> picture;
    int threads = 1;
};

enum class LibraryPath {
    pool,        ///< C++ API, its pool of threads, one frame after the other
    pool_frames, ///< C++ API, its pool of threads, two frames at once
    frames,      ///< C++ API, no pool, as many frames at once as there are threads
    core,        ///< C API for decoding (C++ for encoding), as many frames at once as there are threads
};
/// For people: "OpenEXR C++, pool of threads".
[[nodiscard]] std::string_view description_of(LibraryPath path);

/// The ways that can read this compression: OpenEXR 3.1's C API knows no DWA.
[[nodiscard]] std::span<const LibraryPath> library_paths(std::string_view input_compression);

/// Does the work once and returns its time in milliseconds. Leaves OpenEXR's pool without threads. Throws
/// RuntimeFailure naming the file.
double decode_and_encode(const BareWork& work, LibraryPath path);

/// One file's channels into planes of its size, as decode_and_encode does it.
void decode_with(const std::filesystem::path& file, std::span<const std::string> channels, LibraryPath path,
                 PlaneSlab& planes);

} // namespace clshade
