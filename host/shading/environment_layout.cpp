#include "host/shading/environment_layout.h"

#include "host/environment/filter_layout.h"

#include <algorithm>
#include <cmath>

namespace clshade {

namespace {

constexpr std::size_t ambient_cells =
    static_cast<std::size_t>(ambient_cosines) * static_cast<std::size_t>(ambient_exponents);

std::size_t cells_of(int side) {
    return static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
}

bool same_metal(const Metal& a, const Metal& b) {
    return std::equal(a.samples.begin(), a.samples.end(), b.samples.begin(), b.samples.end(),
                      [](const ComplexIndex& x, const ComplexIndex& y) {
                          return x.wavelength == y.wavelength && x.n == y.n && x.k == y.k;
                      });
}

bool same(const MetalMap& a, const MetalMap& b) {
    return a.linear == b.linear && same_metal(a.metal, b.metal);
}

bool same(const AmbientCurve& a, const AmbientCurve& b) {
    return a.shininess == b.shininess && a.linear == b.linear && a.scale_factor == b.scale_factor &&
           a.bias_factor == b.bias_factor;
}

bool same(const BlendedLevel& a, const BlendedLevel& b) {
    return a.shininess == b.shininess;
}

template <class T>
const T* find_same(const std::vector<T>& all, const T& wanted) {
    const auto found = std::find_if(all.begin(), all.end(), [&wanted](const T& one) { return same(one, wanted); });
    return found == all.end() ? nullptr : &*found;
}

template <class T>
bool all_same(const std::vector<T>& a, const std::vector<T>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const T& x, const T& y) { return same(x, y) && x.first == y.first; });
}

} // namespace

MapsLayout::MapsLayout() : records_(irradiance_record() + cells_of(irradiance_cells)) {}

BlendedLevel MapsLayout::ask_level(double shininess) {
    BlendedLevel level{shininess, records_, level_cells(static_cast<int>(level_at(shininess)))};
    if (const BlendedLevel* known = find_same(blended_, level)) {
        return *known;
    }
    records_ += cells_of(level.cells);
    blended_.push_back(level);
    return level;
}

std::size_t MapsLayout::ask_metal(const Metal& metal, bool linear) {
    MetalMap map{metal, linear, records_};
    if (const MetalMap* known = find_same(metals_, map)) {
        return known->first;
    }
    records_ += ambient_cells;
    metals_.push_back(map);
    return map.first;
}

std::size_t MapsLayout::ask_curve(double shininess, bool linear, double scale_factor, double bias_factor) {
    const AmbientCurve curve{shininess, linear, scale_factor, bias_factor, ambient_floats()};
    if (const AmbientCurve* known = find_same(curves_, curve)) {
        return known->first;
    }
    curves_.push_back(curve);
    return curve.first;
}

std::size_t MapsLayout::ambient_floats() const {
    return 2 * ambient_cells * pair_floats + curves_.size() * curve_floats;
}

bool operator==(const MapsLayout& a, const MapsLayout& b) {
    return a.levels() == b.levels() && all_same(a.blended(), b.blended()) && all_same(a.metals(), b.metals()) &&
           all_same(a.curves(), b.curves());
}

double level_at(double shininess) {
    return std::clamp(std::log2(sharpest_shininess / std::max(shininess, 1.0)), 0.0,
                      static_cast<double>(radiance_levels - 1));
}

std::size_t level_record(int level) {
    std::size_t record = 0;
    for (int above = 0; above < level; ++above) {
        record += cells_of(level_cells(above));
    }
    return record;
}

std::size_t irradiance_record() {
    return level_record(radiance_levels);
}

std::size_t ambient_table_float(bool linear) {
    return linear ? ambient_cells * pair_floats : 0;
}

double streak_shininess(double shininess_u, double shininess_v) {
    const double wide = 1.0 / std::max(std::min(shininess_u, shininess_v), 1.0);
    const double narrow = 1.0 / std::max(std::max(shininess_u, shininess_v), 1.0);
    return 1.0 / std::max(narrow, wide / 8.0);
}

} // namespace clshade
