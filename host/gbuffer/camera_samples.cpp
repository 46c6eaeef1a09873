#include "host/gbuffer/camera_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace clshade {

namespace {

constexpr std::size_t sample_target = 4000;
constexpr std::size_t enough = sample_target / 4;
constexpr std::size_t enough_whole_pixels = 200; // edges would add more doubt than knowledge
constexpr float depth_sentinel = 6e4F;           // beyond: background
constexpr std::size_t most_kept = 1U << 18U;     // all of a coarse lattice

/// Coverage must be larger. The second takes edges too.
constexpr std::array<float, 2> least_coverages{0.999F, 0.0F};

/// A sample as the planes have it.
struct Candidate {
    int x = 0;
    int y = 0;
    std::array<float, 3> position{};
    float depth = 0.0F;
    float coverage = 1.0F;
};

CameraSample sample_of(const Candidate& candidate) {
    CameraSample sample;
    sample.pixel = {candidate.x + 0.5, candidate.y + 0.5};
    for (int i = 0; i < 3; ++i) {
        sample.position[i] = static_cast<double>(candidate.position[static_cast<std::size_t>(i)]);
    }
    sample.depth = static_cast<double>(candidate.depth);
    return sample;
}

/// Is the position at this pixel of the band that of a surface?
std::optional<Candidate> candidate_at(const Frame& band, int x, int row) {
    const RolePlanes& roles = band.roles;
    Candidate candidate;
    candidate.x = x;
    candidate.y = band.first_row + row;
    if (roles.coverage != no_plane) {
        candidate.coverage = band.planes.at(roles.coverage, x, row);
        if (!(candidate.coverage > 0.0F)) {
            return std::nullopt;
        }
    }
    if (roles.depth != no_plane) {
        candidate.depth = band.planes.at(roles.depth, x, row);
        if (!(candidate.depth > 0.0F) || !(candidate.depth < depth_sentinel)) {
            return std::nullopt;
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        candidate.position.at(i) = band.planes.at(roles.position.at(i), x, row);
    }
    const double size = glm::length(sample_of(candidate).position);
    if (!std::isfinite(size) || (roles.depth == no_plane && size == 0.0)) {
        return std::nullopt;
    }
    return candidate;
}

/// Calls `found(candidate)` for the candidates on every `step`-th pixel of every `step`-th row of the picture.
template <typename Found>
void visit_lattice(const VisitRows& rows, int step, const Found& found) {
    const int start = step / 2;
    rows([&](const Frame& band) {
        const int steps_above = band.first_row > start ? (band.first_row - start + step - 1) / step : 0;
        const int end = band.first_row + band.planes.height();
        for (int y = start + steps_above * step; y < end; y += step) {
            for (int x = start; x < band.planes.width(); x += step) {
                if (const auto candidate = candidate_at(band, x, y - band.first_row)) {
                    found(*candidate);
                }
            }
        }
    });
}

/// What a lattice holds above some coverage.
struct Lot {
    int step = 1;
    float least_coverage = 0.0F;
    std::size_t count = 0;
    std::vector<Candidate> kept; ///< the first of them

    void add(const Candidate& candidate) {
        if (count < most_kept) {
            kept.push_back(candidate);
        }
        ++count;
    }
};
using Lots = std::array<Lot, least_coverages.size()>;

/// The second lot is whole only where the first has not enough: else nobody asks for it.
Lots gather(const VisitRows& rows, int step) {
    Lots lots;
    for (std::size_t i = 0; i < lots.size(); ++i) {
        lots.at(i).step = step;
        lots.at(i).least_coverage = least_coverages.at(i);
    }
    Lot& whole = lots.front();
    Lot& any = lots.back();
    visit_lattice(rows, step, [&](const Candidate& candidate) {
        if (candidate.coverage > whole.least_coverage) {
            whole.add(candidate);
        }
        if (whole.count < enough) {
            any.add(candidate);
        }
    });
    return lots;
}

/// All of a lot, or `sample_target` spread evenly over it.
std::vector<CameraSample> pick(const Lot& lot, const VisitRows& rows) {
    std::vector<CameraSample> picked;
    const bool all = lot.count <= sample_target;
    const auto wanted = [&](std::size_t i) { return all ? i : i * lot.count / sample_target; };
    const std::size_t size = all ? lot.count : sample_target;
    picked.reserve(size);
    if (lot.count <= most_kept) {
        for (std::size_t i = 0; i < size; ++i) {
            picked.push_back(sample_of(lot.kept[wanted(i)]));
        }
        return picked;
    }
    std::size_t index = 0; // too many to be kept: they are looked for again
    visit_lattice(rows, lot.step, [&](const Candidate& candidate) {
        if (candidate.coverage > lot.least_coverage) {
            if (picked.size() < size && index == wanted(picked.size())) {
                picked.push_back(sample_of(candidate));
            }
            ++index;
        }
    });
    return picked;
}

} // namespace

std::vector<CameraSample> collect_samples(const Window& data_window, const VisitRows& rows) {
    const double pixels = static_cast<double>(data_window.width()) * data_window.height();
    const int coarse_step = std::max(1, static_cast<int>(std::sqrt(pixels / 65536.0)));
    const Lots coarse = gather(rows, coarse_step);
    std::optional<Lots> fine; // every pixel; only where the lattice does not give enough
    const Lot* best = &coarse.front();
    for (std::size_t i = 0; i < least_coverages.size(); ++i) {
        if (coarse.at(i).count > best->count) {
            best = &coarse.at(i);
        }
        if (best->count < enough && coarse_step > 1) {
            if (!fine) {
                fine = gather(rows, 1);
            }
            if (fine->at(i).count > best->count) {
                best = &fine->at(i);
            }
        }
        if (best->count >= enough_whole_pixels) {
            break;
        }
    }
    return pick(*best, rows);
}

} // namespace clshade
