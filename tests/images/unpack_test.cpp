// The loops under the decoders: every kind of processor must give the same bits.
#include "host/images/unpack.h"

#include <gtest/gtest.h>
#include <half.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace clshade {
namespace {

class Loops : public ::testing::TestWithParam<const char*> {
  protected:
    void SetUp() override {
        loops_ = std::string(GetParam()) == "avx2" ? avx2_loops() : &portable_loops();
        if (loops_ == nullptr) {
            GTEST_SKIP() << "this processor has no AVX2";
        }
    }
    const UnpackLoops* loops_ = nullptr;
};

/// Of IEEE 754: widening is exact; a NaN keeps sign and payload and has its quiet bit set.
std::uint32_t widened(std::uint16_t bits) {
    half value;
    value.setBits(bits);
    const bool nan = (bits & 0x7c00U) == 0x7c00U && (bits & 0x3ffU) != 0;
    if (nan) {
        return ((bits & 0x8000U) << 16U) | 0x7fc00000U | ((bits & 0x3ffU) << 13U);
    }
    return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

TEST_P(Loops, EveryHalf) {
    constexpr std::size_t count = 65536;
    std::vector<std::uint16_t> halves(count);
    std::iota(halves.begin(), halves.end(), std::uint16_t{0});
    std::vector<std::byte> even(count);
    std::vector<std::byte> odd(count);
    for (std::size_t i = 0; i < count; ++i) {
        even[i] = static_cast<std::byte>(i & 255U);
        odd[i] = static_cast<std::byte>(i >> 8U);
    }
    // From each start modulo a vector, so that all values pass through the loop and through what it leaves over.
    for (std::size_t start = 0; start < 17; ++start) {
        std::vector<float> plain(count, -1.0F);
        std::vector<float> merged(count, -1.0F);
        loops_->widen_halves(reinterpret_cast<const std::byte*>(halves.data() + start), count - start, plain.data());
        loops_->merge_halves(even.data() + start, odd.data() + start, count - start, merged.data());
        for (std::size_t i = start; i < count; ++i) {
            const std::uint32_t expected = widened(static_cast<std::uint16_t>(i));
            ASSERT_EQ(std::bit_cast<std::uint32_t>(plain[i - start]), expected) << i;
            ASSERT_EQ(std::bit_cast<std::uint32_t>(merged[i - start]), expected) << i;
        }
        if (start > 0) {
            ASSERT_EQ(plain[count - start], -1.0F); // not one sample too many
            ASSERT_EQ(merged[count - start], -1.0F);
        }
    }
}

TEST_P(Loops, EveryHalfAloneAndAtAnyAlignment) {
    for (unsigned i = 0; i < 65536; ++i) {
        const auto bits = static_cast<std::uint16_t>(i);
        std::byte bytes[3];
        std::memcpy(bytes + 1, &bits, 2);
        float out[2] = {-1.0F, -1.0F};
        loops_->widen_halves(bytes + 1, 1, out);
        ASSERT_EQ(std::bit_cast<std::uint32_t>(out[0]), widened(bits)) << i;
        ASSERT_EQ(out[1], -1.0F);
    }
}

TEST_P(Loops, BytesOfAnyLength) {
    std::mt19937 random(5);
    for (std::size_t length = 0; length < 200; ++length) {
        std::vector<std::byte> bytes(length);
        for (std::byte& byte : bytes) {
            byte = static_cast<std::byte>(random());
        }
        std::vector<std::byte> expected = bytes; // as OpenEXR's file format has it
        for (std::size_t i = 1; i < length; ++i) {
            expected[i] =
                static_cast<std::byte>(std::to_integer<int>(expected[i - 1]) + std::to_integer<int>(bytes[i]) - 128);
        }
        std::vector<std::byte> summed = bytes;
        loops_->undo_differences(summed);
        ASSERT_EQ(summed, expected) << length;

        std::vector<std::byte> merged(length / 2 * 2 + 1, std::byte{77});
        loops_->merge_bytes(bytes.data(), bytes.data() + length / 2, length / 2, merged.data());
        for (std::size_t i = 0; i < length / 2; ++i) {
            ASSERT_EQ(merged[2 * i], bytes[i]) << length;
            ASSERT_EQ(merged[2 * i + 1], bytes[length / 2 + i]) << length;
        }
        ASSERT_EQ(merged.back(), std::byte{77});
    }
}

INSTANTIATE_TEST_SUITE_P(All, Loops, ::testing::Values("portable", "avx2"));

TEST(Unpack, UnsignedIntegersAreRoundedToNearest) {
    const std::uint32_t values[] = {0, 1, 16777217, 16777219, 4294967295U};
    float out[5];
    unpack_row(SampleType::uint32, reinterpret_cast<const std::byte*>(values), 5, out);
    EXPECT_EQ(out[1], 1.0F);
    EXPECT_EQ(out[2], 16777216.0F);
    EXPECT_EQ(out[3], 16777220.0F);
    EXPECT_EQ(out[4], 4294967296.0F);
}

TEST(Unpack, RunsMustFillTheirPlaceExactly) {
    const auto bytes = [](std::initializer_list<int> list) {
        std::vector<std::byte> result;
        for (const int value : list) {
            result.push_back(static_cast<std::byte>(value));
        }
        return result;
    };
    std::vector<std::byte> out(5);
    EXPECT_TRUE(undo_runs(bytes({2, 9, 254, 7, 8}), out)); // three nines, two as they are
    EXPECT_EQ(out, bytes({9, 9, 9, 7, 8}));
    EXPECT_FALSE(undo_runs(bytes({2, 9, 254, 7}), out));
    EXPECT_FALSE(undo_runs(bytes({2, 9}), out));
    EXPECT_FALSE(undo_runs(bytes({5, 9}), out));
    EXPECT_FALSE(undo_runs(bytes({2}), out));
}

} // namespace
} // namespace clshade
