// A made-up sequence of G-buffers on disk: what the batch rows decode, shade and encode.
//
// Spheres on a textured ground under an open sky, seen by a camera that swings about them; every pixel by formulas, so
// that a picture of any size is written in bands. Albedo, normals and roughness have detail down to the pixel and a
// grain as renderers leave it, so that files compress as G-buffers do.
#pragma once

#include "host/base/plane_slab.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace clshade {

struct SequenceFormat {
    int width = 1920;
    int height = 1080;
    bool half = true;                ///< every channel, ids too: they are small
    std::string compression = "zip"; ///< as in ExrSettings
};

/// The 16 channels in the order of the planes: "N.X", ..., "P.X", ..., "Z", "albedo.R", ..., "f0.R", ..., "roughness",
/// "coverage", "material_id". Names that the roles find without help.
[[nodiscard]] std::span<const std::string_view> sequence_channels();

/// Rows [first_row, first_row + planes.height()) of frame `index` (from 0) of a picture planes.width() pixels wide and
/// `height` high, into 16 planes. Units are metres; the sky has depth 65504 and coverage 0, ids are whole numbers to 5.
void fill_sequence_band(PlaneSlab& planes, int first_row, int height, int index);

/// Writes frame `index` with its camera in the header (worldToCamera, worldToNDC): memory for a band only. Throws as
/// ExrWriter does.
void write_sequence_frame(const std::filesystem::path& file, const SequenceFormat& format, int index);

} // namespace clshade
