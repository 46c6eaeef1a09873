#include "host/images/unpack.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace clshade {

static_assert(std::endian::native == std::endian::little, "samples are used as they lie in the file");

namespace {

/// IEEE half to float without a branch, so that the compiler vectorises the loop: shift exponent and mantissa into
/// place and rescale by 2^(127-15), which also normalises denormals; Inf and NaN get their exponent back, and NaN the
/// bit that makes it quiet.
float half_to_float(std::uint16_t half) {
    constexpr std::uint32_t infinity_half = 0x7c00U << 13;
    const std::uint32_t magnitude = (half & 0x7fffU) << 13;
    const float scaled = std::bit_cast<float>(magnitude) * 0x1p112F;
    const std::uint32_t finite = std::bit_cast<std::uint32_t>(scaled);
    const std::uint32_t special = magnitude | (magnitude > infinity_half ? 0x7fc00000U : 0x7f800000U);
    const std::uint32_t bits = magnitude >= infinity_half ? special : finite;
    const std::uint32_t sign = (half & 0x8000U) << 16;
    return std::bit_cast<float>(bits | sign);
}

template <typename Sample>
Sample load(const std::byte* at) {
    Sample sample;
    std::memcpy(&sample, at, sizeof(sample));
    return sample;
}

void widen_halves(const std::byte* halves, std::size_t count, float* out) {
    for (std::size_t i = 0; i < count; ++i) {
        out[i] = half_to_float(load<std::uint16_t>(halves + 2 * i));
    }
}

void merge_halves(const std::byte* even, const std::byte* odd, std::size_t count, float* out) {
    for (std::size_t i = 0; i < count; ++i) {
        out[i] = half_to_float(
            static_cast<std::uint16_t>(std::to_integer<unsigned>(even[i]) | (std::to_integer<unsigned>(odd[i]) << 8U)));
    }
}

void merge_bytes(const std::byte* even, const std::byte* odd, std::size_t pairs, std::byte* out) {
    for (std::size_t i = 0; i < pairs; ++i) {
        out[2 * i] = even[i];
        out[2 * i + 1] = odd[i];
    }
}

void add_up(std::span<std::byte> bytes) {
    std::size_t i = 0;
    std::uint8_t last = 128; // makes the first byte stand for itself
#ifdef __SSE2__
    // A running sum of 16 bytes in four shifted additions. What came before is added last, so that a block has to wait
    // for one addition only.
    const __m128i bias = _mm_set1_epi8(-128);
    __m128i before = _mm_set1_epi8(-128);
    for (; i + 16 <= bytes.size(); i += 16) {
        auto* at = reinterpret_cast<__m128i*>(bytes.data() + i);
        __m128i sum = _mm_add_epi8(_mm_loadu_si128(at), bias);
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 1));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 2));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 4));
        sum = _mm_add_epi8(sum, _mm_slli_si128(sum, 8));
        _mm_storeu_si128(at, _mm_add_epi8(sum, before));
        __m128i total = _mm_unpackhi_epi8(sum, sum); // the last byte to all places
        total = _mm_shufflehi_epi16(total, 0xff);
        before = _mm_add_epi8(before, _mm_unpackhi_epi64(total, total));
    }
    last = static_cast<std::uint8_t>(_mm_cvtsi128_si32(before));
#endif
    for (; i < bytes.size(); ++i) {
        last = static_cast<std::uint8_t>(last + std::to_integer<std::uint8_t>(bytes[i]) - 128U);
        bytes[i] = std::byte{last};
    }
}

} // namespace

const UnpackLoops& portable_loops() {
    static constexpr UnpackLoops loops{widen_halves, merge_halves, merge_bytes, add_up};
    return loops;
}

const UnpackLoops& unpack_loops() {
    static const UnpackLoops& loops = avx2_loops() != nullptr ? *avx2_loops() : portable_loops();
    return loops;
}

void unpack_row(SampleType type, const std::byte* samples, std::size_t count, float* out) {
    switch (type) {
    case SampleType::half:
        unpack_loops().widen_halves(samples, count, out);
        break;
    case SampleType::uint32:
        for (std::size_t i = 0; i < count; ++i) {
            out[i] = static_cast<float>(load<std::uint32_t>(samples + 4 * i));
        }
        break;
    case SampleType::float32:
        std::memcpy(out, samples, 4 * count);
        break;
    }
}

void merge_row(SampleType type, const std::byte* even, const std::byte* odd, std::size_t count, float* out) {
    if (type == SampleType::half) {
        unpack_loops().merge_halves(even, odd, count, out);
        return;
    }
    auto* merged = reinterpret_cast<std::byte*>(out);
    unpack_loops().merge_bytes(even, odd, 2 * count, merged);
    if (type == SampleType::uint32) {
        for (std::size_t i = 0; i < count; ++i) {
            out[i] = static_cast<float>(load<std::uint32_t>(merged + 4 * i));
        }
    }
}

void undo_pxr24_row(SampleType type, const std::byte* bytes, std::size_t count, float* out) {
    const auto at = [&](std::size_t byte, std::size_t i) {
        return std::to_integer<std::uint32_t>(bytes[byte * count + i]);
    };
    std::uint32_t sample = 0;
    switch (type) {
    case SampleType::half: {
        // In blocks, so that the processor's own conversion can be used.
        std::array<std::uint16_t, 512> halves{};
        for (std::size_t first = 0; first < count; first += halves.size()) {
            const std::size_t block = std::min(halves.size(), count - first);
            for (std::size_t i = 0; i < block; ++i) {
                sample += at(0, first + i) << 8U | at(1, first + i);
                halves[i] = static_cast<std::uint16_t>(sample);
            }
            unpack_loops().widen_halves(reinterpret_cast<const std::byte*>(halves.data()), block, out + first);
        }
        break;
    }
    case SampleType::uint32:
        for (std::size_t i = 0; i < count; ++i) {
            sample += at(0, i) << 24U | at(1, i) << 16U | at(2, i) << 8U | at(3, i);
            out[i] = static_cast<float>(sample);
        }
        break;
    case SampleType::float32:
        for (std::size_t i = 0; i < count; ++i) {
            sample += at(0, i) << 24U | at(1, i) << 16U | at(2, i) << 8U;
            out[i] = std::bit_cast<float>(sample);
        }
        break;
    }
}

void undo_differences(std::span<std::byte> bytes) {
    unpack_loops().undo_differences(bytes);
}

bool undo_runs(std::span<const std::byte> packed, std::span<std::byte> out) {
    while (!packed.empty()) {
        const int code = std::to_integer<int>(packed[0]); // 0..255
        const int count = code < 128 ? code : code - 256;
        const bool repeat = count >= 0;
        const auto length = static_cast<std::size_t>(repeat ? count + 1 : -count);
        const std::size_t taken = 1 + (repeat ? 1 : length);
        if (packed.size() < taken || out.size() < length) {
            return false;
        }
        if (repeat) {
            std::memset(out.data(), std::to_integer<int>(packed[1]), length);
        } else {
            std::memcpy(out.data(), packed.data() + 1, length);
        }
        packed = packed.subspan(taken);
        out = out.subspan(length);
    }
    return out.empty();
}

} // namespace clshade
