// Private to host/gbuffer: seeded random values for random_frame. The same on every machine: only + - * / and sqrt,
// which IEEE 754 fixes to the last bit, and no functions of the C library or distributions of the standard library.
// The build turns contraction into fused operations off.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace clshade {

/// splitmix64 (Steele, Lea, Flood 2014).
class RandomGenerator {
  public:
    explicit RandomGenerator(std::uint64_t seed) : state_(seed) {}

    [[nodiscard]] std::uint64_t next();
    /// 0 <= x < 1, multiples of 2^-53.
    [[nodiscard]] double unit();
    [[nodiscard]] double between(double low, double high);
    /// 0 <= x < count.
    [[nodiscard]] int below(int count);
    [[nodiscard]] glm::dvec3 in_unit_ball();
    /// Unit length.
    [[nodiscard]] glm::dvec3 direction();

  private:
    std::uint64_t state_;
};

/// 0 and `largest` each in one of 16; else log-uniform (uniform within each octave) from 2^-4 to `largest`.
[[nodiscard]] double random_shininess(RandomGenerator& random, double largest);

/// 0 and 1 each in one of 10, equal components in three, else anything in 0..1.
[[nodiscard]] glm::dvec3 random_colour(RandomGenerator& random);

/// F0 of a coat: 0 in one of 8, as random_colour in one of 16, else of dielectrics with an index in 1..2.5.
[[nodiscard]] glm::dvec3 random_coat_f0(RandomGenerator& random);

/// Components 0..0.6: all 0 in one of 6, equal ones in two, else each on its own and 0 in one of 6.
[[nodiscard]] glm::dvec3 random_absorption(RandomGenerator& random);

/// A rotation by any angle about any axis, uniform over all of them.
[[nodiscard]] glm::dmat3 random_rotation(RandomGenerator& random);

/// 0 in one of 20, partial in five, else 1.
[[nodiscard]] double random_coverage(RandomGenerator& random);

/// Any length, not normalised; 0 in one of 50. Grazing to the eye or the light, at all angles, one of ten seen from
/// behind, and two of five near the mirror of eye and light, off by a few widths of a lobe of shininess n.
[[nodiscard]] glm::dvec3 random_normal(RandomGenerator& random, const glm::dvec3& eye, const glm::dvec3& light,
                                       double n);

/// Does a tangent make a frame with this normal in float and double alike, far from where pixel rule 6 gives up?
[[nodiscard]] bool is_sound_tangent(const glm::dvec3& tangent, const glm::dvec3& normal);

/// Lengths 0.5..2: 0 in one of 16, parallel to the normal (to a float's precision) in one of 16, else sound.
[[nodiscard]] glm::dvec3 random_tangent(RandomGenerator& random, const glm::dvec3& normal);

} // namespace clshade
