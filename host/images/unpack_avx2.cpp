// The loops of unpack.h for x86 processors with AVX2 and F16C, whatever the compiler was told to build for.
#include "host/images/unpack.h"

#if defined(__x86_64__) && defined(__GNUC__)

#include <cpuid.h>
#include <immintrin.h>

#include <cstdint>

#define CLSHADE_AVX2 __attribute__((target("avx2,f16c")))

namespace clshade {

namespace {

const __m128i* vector_at(const std::byte* bytes) {
    return reinterpret_cast<const __m128i*>(bytes);
}

CLSHADE_AVX2 void widen_halves(const std::byte* halves, std::size_t count, float* out) {
    std::size_t i = 0;
    for (; i + 8 <= count; i += 8) {
        _mm256_storeu_ps(out + i, _mm256_cvtph_ps(_mm_loadu_si128(vector_at(halves + 2 * i))));
    }
    portable_loops().widen_halves(halves + 2 * i, count - i, out + i);
}

CLSHADE_AVX2 void merge_halves(const std::byte* even, const std::byte* odd, std::size_t count, float* out) {
    std::size_t i = 0;
    for (; i + 16 <= count; i += 16) {
        const __m128i low = _mm_loadu_si128(vector_at(even + i));
        const __m128i high = _mm_loadu_si128(vector_at(odd + i));
        _mm256_storeu_ps(out + i, _mm256_cvtph_ps(_mm_unpacklo_epi8(low, high)));
        _mm256_storeu_ps(out + i + 8, _mm256_cvtph_ps(_mm_unpackhi_epi8(low, high)));
    }
    portable_loops().merge_halves(even + i, odd + i, count - i, out + i);
}

CLSHADE_AVX2 void merge_bytes(const std::byte* even, const std::byte* odd, std::size_t pairs, std::byte* out) {
    std::size_t i = 0;
    for (; i + 32 <= pairs; i += 32) {
        // Unpacking works within halves of a vector: bring quarters 0 2 1 3 there first.
        const __m256i low =
            _mm256_permute4x64_epi64(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(even + i)), 0xd8);
        const __m256i high =
            _mm256_permute4x64_epi64(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(odd + i)), 0xd8);
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(out + 2 * i), _mm256_unpacklo_epi8(low, high));
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(out + 2 * i + 32), _mm256_unpackhi_epi8(low, high));
    }
    portable_loops().merge_bytes(even + i, odd + i, pairs - i, out + 2 * i);
}

CLSHADE_AVX2 void add_up(std::span<std::byte> bytes) {
    // As the portable loop, in both halves of a vector; then the lower half's total is added to the upper one.
    const __m256i bias = _mm256_set1_epi8(-128);
    const __m256i last = _mm256_set1_epi8(15);
    __m256i before = _mm256_set1_epi8(-128);
    std::size_t i = 0;
    for (; i + 32 <= bytes.size(); i += 32) {
        auto* at = reinterpret_cast<__m256i*>(bytes.data() + i);
        __m256i sum = _mm256_add_epi8(_mm256_loadu_si256(at), bias);
        sum = _mm256_add_epi8(sum, _mm256_slli_si256(sum, 1));
        sum = _mm256_add_epi8(sum, _mm256_slli_si256(sum, 2));
        sum = _mm256_add_epi8(sum, _mm256_slli_si256(sum, 4));
        sum = _mm256_add_epi8(sum, _mm256_slli_si256(sum, 8));
        const __m256i totals = _mm256_shuffle_epi8(sum, last);
        const __m256i lower = _mm256_permute2x128_si256(totals, totals, 0x08); // zero, lower half
        sum = _mm256_add_epi8(sum, lower);
        _mm256_storeu_si256(at, _mm256_add_epi8(sum, before));
        const __m256i upper = _mm256_permute2x128_si256(totals, totals, 0x01); // halves swapped
        before = _mm256_add_epi8(before, _mm256_add_epi8(totals, upper));
    }
    auto value = static_cast<std::uint8_t>(_mm_cvtsi128_si32(_mm256_castsi256_si128(before)));
    for (; i < bytes.size(); ++i) {
        value = static_cast<std::uint8_t>(value + std::to_integer<std::uint8_t>(bytes[i]) - 128U);
        bytes[i] = std::byte{value};
    }
}

bool has_f16c() {
    unsigned a = 0;
    unsigned b = 0;
    unsigned c = 0;
    unsigned d = 0;
    return __get_cpuid(1, &a, &b, &c, &d) != 0 && (c & bit_F16C) != 0;
}

} // namespace

const UnpackLoops* avx2_loops() {
    static constexpr UnpackLoops loops{widen_halves, merge_halves, merge_bytes, add_up};
    static const bool usable = __builtin_cpu_supports("avx2") != 0 && has_f16c();
    return usable ? &loops : nullptr;
}

} // namespace clshade

#else

namespace clshade {

const UnpackLoops* avx2_loops() {
    return nullptr;
}

} // namespace clshade

#endif
