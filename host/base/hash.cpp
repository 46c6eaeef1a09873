#include "host/base/hash.h"

#include "host/base/error.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <fstream>
#include <memory>
#include <new>
#include <vector>

namespace clshade {

namespace {

std::string hex(const XXH128_hash_t& hash) {
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

} // namespace

std::string hash_hex(std::span<const std::byte> bytes) {
    return hex(XXH3_128bits(bytes.data(), bytes.size()));
}

std::string hash_hex(std::string_view text) {
    return hash_hex(std::as_bytes(std::span(text)));
}

std::string file_hash_hex(const std::filesystem::path& file) {
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
    if (state == nullptr || XXH3_128bits_reset(state.get()) == XXH_ERROR) {
        throw std::bad_alloc();
    }
    constexpr std::size_t piece = std::size_t{1} << 20U;
    std::vector<char> buffer(piece);
    std::ifstream stream(file, std::ios::binary);
    while (stream) {
        stream.read(buffer.data(), static_cast<std::streamsize>(piece));
        XXH3_128bits_update(state.get(), buffer.data(), static_cast<std::size_t>(stream.gcount()));
    }
    if (!stream.eof()) {
        throw RuntimeFailure(fmt::format("{}: cannot be read; check path and permissions", file.string()));
    }
    return hex(XXH3_128bits_digest(state.get()));
}

} // namespace clshade
