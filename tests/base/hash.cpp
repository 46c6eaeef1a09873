#include "host/base/hash.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace clshade {
namespace {

TEST(Hash, MatchesThePublishedValueOfNothing) {
    // XXH3 128 bits of the empty input with seed 0, as in the xxHash test suite.
    EXPECT_EQ(hash_hex(std::string_view()), "99aa06d3014798d86001c324468d497f");
}

TEST(Hash, DependsOnEveryByte) {
    const std::string text = "__kernel void shade() {}";
    std::set<std::string> hashes{hash_hex(text)};
    for (std::size_t i = 0; i < text.size(); ++i) {
        std::string changed = text;
        changed[i] = static_cast<char>(changed[i] ^ 1);
        hashes.insert(hash_hex(changed));
    }
    EXPECT_EQ(hashes.size(), text.size() + 1);
}

TEST(Hash, TextAndItsBytesAgree) {
    const std::string text = "bytes";
    EXPECT_EQ(hash_hex(text), hash_hex(std::as_bytes(std::span(text))));
    EXPECT_EQ(hash_hex(text).size(), 32U);
}

} // namespace
} // namespace clshade
