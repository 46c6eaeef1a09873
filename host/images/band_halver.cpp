#include "host/images/band_halver.h"

#include "host/environment/lat_long.h"

#include <fmt/format.h>

#include <stdexcept>

namespace clshade {

BandHalver::BandHalver(int width, int height, int halvings) : row_floats_(static_cast<std::size_t>(width) * 3) {
    for (int i = 0; i < halvings; ++i) {
        if (width % 2 != 0 || height % 2 != 0) {
            throw std::invalid_argument(fmt::format("{}x{} texels cannot be halved", width, height));
        }
        Stage stage;
        stage.width = width;
        stage.height = height;
        stage.half.resize(static_cast<std::size_t>(width / 2) * 3);
        stages_.push_back(std::move(stage));
        width /= 2;
        height /= 2;
    }
    result_.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
}

void BandHalver::push(std::span<const float> rows) {
    if (stages_.empty()) {
        result_.insert(result_.end(), rows.begin(), rows.end());
        return;
    }
    for (; rows.size() >= row_floats_; rows = rows.subspan(row_floats_)) {
        push_row(0, rows.first(row_floats_));
    }
}

void BandHalver::push_row(std::size_t index, std::span<const float> row) {
    if (index == stages_.size()) {
        result_.insert(result_.end(), row.begin(), row.end());
        return;
    }
    Stage& stage = stages_[index];
    if (!stage.waiting) {
        stage.upper.assign(row.begin(), row.end());
        stage.waiting = true;
        return;
    }
    stage.waiting = false;
    halve_rows(stage.upper, row, upper_share(stage.width, stage.height, stage.pair++), stage.half);
    push_row(index + 1, stage.half);
}

} // namespace clshade
