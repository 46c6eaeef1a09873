#include "host/images/stamp.h"

#include "host/images/completion.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <cstring>
#include <new>

namespace clshade {

namespace {

constexpr std::string_view before_bytes = "bytes=";
constexpr std::string_view before_head = " head=";
constexpr std::string_view before_hash = " xxh3=";
constexpr std::size_t decimal_digits = 20;
static_assert(before_bytes.size() + before_head.size() + before_hash.size() + 2 * decimal_digits + stamp_hash_digits ==
              stamp_length);

/// Takes `count` digits off the text. Capitals are not ours.
std::optional<std::uint64_t> take_digits(std::string_view& text, std::size_t count, unsigned base) {
    std::uint64_t value = 0;
    for (const char c : text.substr(0, count)) {
        unsigned digit = base;
        if (c >= '0' && c <= '9') {
            digit = static_cast<unsigned>(c - '0');
        } else if (c >= 'a' && c <= 'f') {
            digit = static_cast<unsigned>(c - 'a') + 10U;
        }
        if (digit >= base || value > (~std::uint64_t{0} - digit) / base) {
            return std::nullopt;
        }
        value = value * base + digit;
    }
    text.remove_prefix(count);
    return value;
}

bool take_word(std::string_view& text, std::string_view word) {
    if (!text.starts_with(word)) {
        return false;
    }
    text.remove_prefix(word.size());
    return true;
}

std::string_view as_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Takes a text that ends with a zero.
std::optional<std::string_view> take_name(std::string_view& bytes) {
    const std::size_t end = bytes.find('\0');
    if (end == std::string_view::npos) {
        return std::nullopt;
    }
    const std::string_view name = bytes.substr(0, end);
    bytes.remove_prefix(end + 1);
    return name;
}

std::string big_endian(std::uint32_t value) {
    return {static_cast<char>(value >> 24U), static_cast<char>(value >> 16U), static_cast<char>(value >> 8U),
            static_cast<char>(value)};
}

} // namespace

std::string stamp_text(const Stamp& stamp) {
    return fmt::format("{}{:020}{}{:020}{}{:016x}", before_bytes, stamp.bytes, before_head, stamp.head, before_hash,
                       stamp.hash);
}

std::optional<Stamp> parse_stamp(std::string_view text) {
    if (text.size() != stamp_length || !take_word(text, before_bytes)) {
        return std::nullopt;
    }
    const auto bytes = take_digits(text, decimal_digits, 10);
    if (!bytes || !take_word(text, before_head)) {
        return std::nullopt;
    }
    const auto head = take_digits(text, decimal_digits, 10);
    if (!head || !take_word(text, before_hash)) {
        return std::nullopt;
    }
    const auto hash = take_digits(text, stamp_hash_digits, 16);
    if (!hash) {
        return std::nullopt;
    }
    return Stamp{*bytes, *head, *hash};
}

StreamHash::StreamHash() : state_(XXH3_createState()) {
    if (state_ == nullptr) {
        throw std::bad_alloc();
    }
    XXH3_64bits_reset(state_.get());
}

void StreamHash::add(std::span<const std::byte> bytes) {
    XXH3_64bits_update(state_.get(), bytes.data(), bytes.size());
}

std::uint64_t StreamHash::value() const {
    return XXH3_64bits_digest(state_.get());
}

std::optional<ExrStampPlace> find_exr_stamp(std::span<const std::byte> first_bytes) {
    constexpr std::string_view magic("\x76\x2f\x31\x01\x02", 5); // and version 2
    constexpr std::size_t fixed = 8;
    const std::string_view all = as_text(first_bytes);
    if (all.size() < fixed || !all.starts_with(magic)) {
        return std::nullopt;
    }
    ExrStampPlace place;
    std::string_view left = all.substr(fixed);
    while (!left.empty() && left.front() != '\0') {
        const auto name = take_name(left);
        const auto type = take_name(left);
        std::int32_t size = 0;
        if (!name || !type || left.size() < sizeof(size)) {
            return std::nullopt;
        }
        std::memcpy(&size, left.data(), sizeof(size)); // little-endian, as hosts are (unpack.h)
        left.remove_prefix(sizeof(size));
        if (size < 0 || static_cast<std::size_t>(size) > left.size()) {
            return std::nullopt;
        }
        const std::string_view value = left.substr(0, static_cast<std::size_t>(size));
        if (*type == "string" && *name == job_attribute) {
            place.job = value;
        } else if (*type == "string" && *name == completion_attribute && value.size() == stamp_length) {
            place.offset = all.size() - left.size();
        }
        left.remove_prefix(value.size());
    }
    if (place.offset == 0) {
        return std::nullopt;
    }
    return place;
}

std::uint32_t png_crc(std::span<const std::byte> bytes) {
    return libdeflate_crc32(0, bytes.data(), bytes.size());
}

std::string png_text_chunk(std::string_view keyword, std::string_view text) {
    const std::string named = fmt::format("tEXt{}{}{}", keyword, '\0', text);
    return big_endian(static_cast<std::uint32_t>(named.size() - 4)) + named +
           big_endian(png_crc(std::as_bytes(std::span(named))));
}

} // namespace clshade
