#include "host/gbuffer/camera_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace clshade {

namespace {

/// splitmix64 (Steele, Lea, Flood 2014): the same draws on every machine.
class Draws {
  public:
    std::size_t below(std::size_t count) {
        state_ += 0x9e3779b97f4a7c15U;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
        return static_cast<std::size_t>((z ^ (z >> 31U)) % count);
    }
    std::vector<Sight> pick(std::span<const Sight> sights, std::size_t count) {
        std::vector<Sight> picked;
        for (std::size_t i = 0; i < count; ++i) {
            picked.push_back(sights[below(sights.size())]);
        }
        return picked;
    }

  private:
    std::uint64_t state_ = 0x5eed;
};

/// A sight that agrees is within a pixel or two of its pixel; hypotheses from few sights are coarser.
constexpr double fine_threshold = 1.0;
constexpr double coarse_threshold = 4.0;
/// With this share of the sights explained there is nothing left to search for.
constexpr double enough = 0.9;
/// A left-handed world must explain this much more than a right-handed one: the mirror image of a camera behind a plane
/// sees the plane as the camera does.
constexpr double mirror_margin = 0.02;

bool is_mirrored(const FittedCamera& camera) {
    return glm::determinant(camera.rotation) < 0.0;
}

double fine_agreement(const FittedCamera& camera, std::span<const Sight> sights) {
    return agreement(camera, sights, fine_threshold) + 0.1 * agreement(camera, sights, 8.0 * fine_threshold);
}

FoundCamera found(FittedCamera camera, std::span<const Sight> sights, Freedom freedom) {
    camera = refine(camera, sights, freedom);
    return {camera, freedom, median_of(sight_errors(camera, sights))};
}

/// Medians of a few thousand errors scatter by a few per cent; a freedom must gain more than that to be taken. The
/// absolute part is what single-precision positions cost.
bool explains_as_well(double simple_median, double free_median) {
    return simple_median <= 1.1 * free_median + 0.002;
}

/// Refines a guess with as little freedom as the sights allow.
FoundCamera refine_simplest(const FittedCamera& guess, std::span<const Sight> sights) {
    FittedCamera centred = guess;
    if (!guess.orthographic) {
        centred.centre = glm::dvec2(0.0);
    }
    FoundCamera best = found(centred, sights, Freedom::none);
    // Below this no more freedom is needed: a shift of the lens by a pixel leaves more.
    constexpr double nothing_left = 0.003;
    if (!guess.orthographic && best.median_error > nothing_left) {
        FoundCamera shifted = found(guess, sights, Freedom::centre);
        const FoundCamera from_best = found(best.camera, sights, Freedom::centre);
        shifted = from_best.median_error < shifted.median_error ? from_best : shifted;
        // Back to the centred camera from the shifted one, in case the way there was blocked.
        FittedCamera recentred = shifted.camera;
        recentred.centre = glm::dvec2(0.0);
        const FoundCamera again = found(recentred, sights, Freedom::none);
        best = again.median_error < best.median_error ? again : best;
        best = explains_as_well(best.median_error, shifted.median_error) ? best : shifted;
    }
    // Stretched pixels are rare and never announced: only for a gain that noise cannot give.
    if (best.median_error > 0.05) {
        const FoundCamera stretched = found(best.camera, sights, Freedom::centre_and_aspect);
        best = stretched.median_error < 0.5 * best.median_error ? stretched : best;
    }
    return best;
}

/// Guesses ordered by how much of a share of the sights they explain.
class Shortlist {
  public:
    explicit Shortlist(std::span<const Sight> sights) : sights_(sights) {}

    void add(const std::optional<FittedCamera>& camera) {
        if (camera) {
            entries_.emplace_back(agreement(*camera, sights_, coarse_threshold), *camera);
            std::stable_sort(entries_.begin(), entries_.end(),
                             [](const auto& a, const auto& b) { return a.first > b.first; });
            entries_.resize(std::min<std::size_t>(entries_.size(), 4));
        }
    }
    [[nodiscard]] double best() const { return entries_.empty() ? 0.0 : entries_.front().first; }
    [[nodiscard]] const std::vector<std::pair<double, FittedCamera>>& entries() const { return entries_; }

  private:
    std::span<const Sight> sights_;
    std::vector<std::pair<double, FittedCamera>> entries_;
};

/// Draws needed to meet one clean sample of `size` with certainty 0.999 when `share` of the sights is clean.
int draws_needed(double share, std::size_t size, int most) {
    const double clean = std::pow(std::clamp(share, 0.0, 0.999), static_cast<double>(size));
    const double needed = std::log(1e-3) / std::log1p(-clean);
    return clean > 0.0 && needed < most ? static_cast<int>(needed) + 1 : most;
}

/// Sights near the plane that holds the most of them; positions are of size one.
std::vector<Sight> dominant_plane(std::span<const Sight> sights, Draws& draws) {
    constexpr double thickness = 1e-3;
    glm::dvec3 best_normal(0.0);
    double best_offset = 0.0;
    std::size_t best_count = 0;
    for (int i = 0; i < 60; ++i) {
        const std::vector<Sight> three = draws.pick(sights, 3);
        const glm::dvec3 normal =
            glm::cross(three[1].position - three[0].position, three[2].position - three[0].position);
        if (!(glm::length(normal) > 1e-6)) {
            continue;
        }
        const glm::dvec3 unit = glm::normalize(normal);
        const double offset = glm::dot(unit, three[0].position);
        const auto count =
            static_cast<std::size_t>(std::count_if(sights.begin(), sights.end(), [&](const Sight& sight) {
                return std::abs(glm::dot(unit, sight.position) - offset) < thickness;
            }));
        if (count > best_count) {
            best_count = count;
            best_normal = unit;
            best_offset = offset;
        }
    }
    std::vector<Sight> inside;
    for (const Sight& sight : sights) {
        if (std::abs(glm::dot(best_normal, sight.position) - best_offset) < thickness) {
            inside.push_back(sight);
        }
    }
    return inside;
}

std::optional<FoundCamera> best_of(const std::vector<FoundCamera>& cameras, std::span<const Sight> sights) {
    std::optional<FoundCamera> best;
    double best_score = 0.0;
    for (const FoundCamera& camera : cameras) {
        const double score = fine_agreement(camera.camera, sights) - (is_mirrored(camera.camera) ? mirror_margin : 0.0);
        if (!best || score > best_score) {
            best = camera;
            best_score = score;
        }
    }
    return best;
}

enum class Effort {
    quick,    ///< the solution from all sights, good or bad
    thorough, ///< from random few too, if that one does not explain nearly all
};

/// One kind of camera (perspective or orthographic).
std::optional<FoundCamera> search_kind(std::span<const Sight> sights, bool orthographic, Effort effort) {
    const auto solve = [&](std::span<const Sight> some) {
        return orthographic ? affine_camera(some) : dlt_camera(some);
    };
    std::vector<FoundCamera> cameras;
    if (const auto guess = solve(sights)) {
        cameras.push_back(refine_simplest(*guess, sights));
        if (agreement(cameras.front().camera, sights, fine_threshold) > enough &&
            !is_mirrored(cameras.front().camera)) {
            return cameras.front();
        }
    }
    if (effort == Effort::quick) {
        return best_of(cameras, sights);
    }
    Draws draws;
    const std::vector<Sight> jury = draws.pick(sights, std::min<std::size_t>(sights.size(), 500));
    Shortlist shortlist(jury);
    const std::size_t smallest = orthographic ? 4 : 6;
    constexpr int most_draws = 400;
    for (int i = 0; i < draws_needed(shortlist.best(), smallest, most_draws); ++i) {
        // Larger samples bear more noise, smaller ones more outliers.
        shortlist.add(solve(draws.pick(sights, i % 4 == 3 ? 2 * smallest : smallest)));
    }
    if (!orthographic) {
        const std::vector<Sight> plane = dominant_plane(sights, draws);
        shortlist.add(plane_camera(plane));
        for (int i = 0; i < 40 && plane.size() >= 6; ++i) {
            shortlist.add(plane_camera(draws.pick(plane, 6)));
        }
    }
    for (const auto& [score, guess] : shortlist.entries()) {
        cameras.push_back(refine_simplest(guess, sights));
        if (agreement(cameras.back().camera, sights, fine_threshold) > score - 0.01 &&
            !is_mirrored(cameras.back().camera)) {
            break; // finely explains what the guess explained coarsely
        }
    }
    return best_of(cameras, sights);
}

/// Enough sights to search with, spread evenly over all of them.
std::vector<Sight> every_few(std::span<const Sight> sights, std::size_t most) {
    std::vector<Sight> some;
    const std::size_t count = std::min(sights.size(), most);
    for (std::size_t i = 0; i < count; ++i) {
        some.push_back(sights[i * sights.size() / count]);
    }
    return some;
}

bool explains_enough(const std::optional<FoundCamera>& found, std::span<const Sight> sights) {
    return found && agreement(found->camera, sights, fine_threshold) > enough;
}

/// The simpler one wins a draw: perspective holds the orthographic camera as a limit.
std::optional<FoundCamera> simpler_of(const std::optional<FoundCamera>& perspective,
                                      const std::optional<FoundCamera>& orthographic, std::span<const Sight> sights) {
    if (!perspective || !orthographic) {
        return perspective ? perspective : orthographic;
    }
    const bool as_well =
        explains_as_well(orthographic->median_error, perspective->median_error) &&
        fine_agreement(orthographic->camera, sights) > fine_agreement(perspective->camera, sights) - mirror_margin;
    return as_well ? orthographic : perspective;
}

/// The orthographic camera that a perspective one may stand for, from the sights that it explains. Empty, at the price
/// of one linear fit, for nearly every perspective picture.
std::optional<FoundCamera> orthographic_twin(const FoundCamera& perspective, std::span<const Sight> sights) {
    std::vector<Sight> explained;
    for (const Sight& sight : sights) {
        if (sight_error(perspective.camera, sight) < fine_threshold) {
            explained.push_back(sight);
        }
    }
    const auto guess = affine_camera(explained);
    if (!guess || median_of(sight_errors(*guess, explained)) > fine_threshold) {
        return std::nullopt;
    }
    return refine_simplest(*guess, sights);
}

} // namespace

std::optional<FoundCamera> search_camera(std::span<const Sight> sights) {
    const std::vector<Sight> some = every_few(sights, 1000);
    auto perspective = search_kind(some, false, Effort::quick);
    std::optional<FoundCamera> orthographic;
    if (!explains_enough(perspective, some)) {
        orthographic = search_kind(some, true, Effort::quick);
        if (!explains_enough(orthographic, some)) {
            perspective = search_kind(some, false, Effort::thorough);
            if (!explains_enough(perspective, some)) {
                orthographic = search_kind(some, true, Effort::thorough);
            }
        }
    }
    auto best = simpler_of(perspective, orthographic, some);
    if (best && !best->camera.orthographic) {
        best = simpler_of(best, orthographic_twin(*best, some), some);
    }
    return best ? std::optional(found(best->camera, sights, best->freedom)) : std::nullopt;
}

} // namespace clshade
