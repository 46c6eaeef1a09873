// Floats to samples of output files and back: roundings, clamps, the byte shuffles of ZIP, sRGB.
#include "host/images/pack.h"
#include "host/images/unpack.h"

#include <gtest/gtest.h>
#include <half.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <vector>

namespace clshade {
namespace {

TEST(Pack, HalvesRoundAsImathDoes) {
    std::mt19937 random(7);
    std::vector<float> values;
    for (unsigned bits = 0; bits < 0x7c00U; ++bits) { // every half, every midpoint, and their neighbours
        half low;
        half high;
        low.setBits(static_cast<unsigned short>(bits));
        high.setBits(static_cast<unsigned short>(std::min(bits + 1, 0x7bffU)));
        const float middle = 0.5F * (static_cast<float>(low) + static_cast<float>(high));
        for (const float value :
             {static_cast<float>(low), middle, std::nextafter(middle, 0.0F), std::nextafter(middle, 1e9F)}) {
            values.push_back(value);
            values.push_back(-value);
        }
    }
    for (int i = 0; i < 200000; ++i) {
        const float value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        if (!std::isnan(value) && (std::fabs(value) < 65520.0F || std::isinf(value))) {
            values.push_back(value);
        }
    }
    std::vector<std::uint16_t> packed(values.size());
    EXPECT_EQ(pack_halves(values, packed.data()), 0U);
    for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_EQ(packed[i], half(values[i]).bits()) << values[i];
    }
    EXPECT_EQ(pack_halves_portable(values, packed.data()), 0U);
    for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_EQ(packed[i], half(values[i]).bits()) << values[i];
    }
}

TEST(Pack, BothWaysToHalvesGiveTheSameBitsAndCounts) {
    std::mt19937 random(8);
    std::vector<float> values(1U << 20U); // any bits, NaN and what is too large among them
    for (float& value : values) {
        value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    }
    for (unsigned bits = 0x477fe000U - 5; bits < 0x477ff000U + 5; ++bits) { // 65504 to 65520
        values.push_back(std::bit_cast<float>(bits));
        values.push_back(-std::bit_cast<float>(bits));
    }
    std::vector<std::uint16_t> portable(values.size());
    std::vector<std::uint16_t> chosen(values.size());
    const std::size_t clamped = pack_halves_portable(values, portable.data());
    EXPECT_GT(clamped, values.size() / 3);
    EXPECT_EQ(pack_halves(values, chosen.data()), clamped);
    ASSERT_EQ(chosen, portable);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const bool too_large = std::isfinite(values[i]) && std::fabs(values[i]) >= 65520.0F;
        if (std::isnan(values[i])) { // a quiet one; Imath keeps signalling ones
            ASSERT_GT(portable[i] & 0x7fffU, 0x7e00U - 1U);
            ASSERT_EQ(portable[i] >> 15U, std::bit_cast<std::uint32_t>(values[i]) >> 31U);
            continue;
        }
        const half expected = too_large ? half(std::copysign(65504.0F, values[i])) : half(values[i]);
        ASSERT_EQ(portable[i], expected.bits()) << std::bit_cast<std::uint32_t>(values[i]);
    }
    for (std::size_t length = 0; length < 40; ++length) { // any length, at any alignment
        std::vector<std::uint16_t> few(41, 0xabcd);
        const std::span<const float> part(values.data() + length, length);
        pack_halves(part, few.data() + 1);
        EXPECT_EQ(few[0], 0xabcd);
        EXPECT_TRUE(std::equal(part.begin(), part.end(), few.begin() + 1, [](float value, std::uint16_t bits) {
            std::uint16_t one = 0;
            pack_halves_portable(std::span(&value, 1), &one);
            return one == bits;
        }));
        EXPECT_TRUE(std::all_of(few.begin() + 1 + static_cast<std::ptrdiff_t>(length), few.end(),
                                [](std::uint16_t bits) { return bits == 0xabcd; }));
    }
}

TEST(Pack, ShufflesComeBack) {
    std::mt19937 random(9);
    for (std::size_t pairs = 1; pairs < 300; ++pairs) {
        std::vector<std::uint16_t> values(pairs);
        std::generate(values.begin(), values.end(), [&] { return static_cast<std::uint16_t>(random()); });
        std::vector<std::byte> split(2 * pairs);
        split_bytes(values, split.data(), split.data() + pairs);
        std::vector<std::byte> differences(split.size());
        make_differences(split, differences.data());
        undo_differences(differences);
        ASSERT_EQ(differences, split);
        for (std::size_t i = 0; i < pairs; ++i) {
            ASSERT_EQ(static_cast<unsigned>(split[i]) + 256U * static_cast<unsigned>(split[pairs + i]), values[i]);
        }
    }
}

TEST(Pack, SrgbFollowsTheStandard) {
    for (int i = 0; i < 256; ++i) { // every code comes back from its own linear value
        const double v = i / 255.0;
        const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
        EXPECT_EQ(srgb_byte(static_cast<float>(linear)), i);
    }
    EXPECT_EQ(srgb_byte(std::numeric_limits<float>::infinity()), 255);
    EXPECT_EQ(unit_byte(0.5F), 128);
    EXPECT_EQ(unit_byte(std::nanf("")), 0);
}

} // namespace
} // namespace clshade
