// Rounding to single precision without leaving double.
#pragma once

namespace clshade {

/// The nearest number with the 24 bits of a float, by Veltkamp's splitting; |x| below 1e299. Not by conversion to float
/// and back: GCC 12 drops that pair of conversions where its SLP vectoriser takes several at once (-O2 and above), and
/// then hi = (float)x, lo = x - (double)hi gives lo = 0.
[[nodiscard]] constexpr double rounded_to_float(double x) {
    const double scaled = x * (0x1p29 + 1.0);
    return scaled - (scaled - x);
}

} // namespace clshade
