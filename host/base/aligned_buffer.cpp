#include "host/base/aligned_buffer.h"

#include "host/base/error.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>

#if __has_include(<sys/mman.h>)
#define CLSHADE_HAS_MMAP
#include <sys/mman.h>
#endif

namespace clshade {

namespace {
constexpr std::size_t page = 4096;
constexpr std::size_t huge_page = std::size_t{1} << 21U;
constexpr std::size_t mebibyte = std::size_t{1} << 20U;

std::size_t round_up(std::size_t bytes, std::size_t unit) {
    return (bytes + unit - 1) / unit * unit;
}

/// A kernel follows a dozen streams and more: with small pages it would miss the TLB in each of them every 1024 pixels.
/// Small pictures are not worth the rounding.
bool is_large(std::size_t floats) {
#ifdef CLSHADE_HAS_MMAP
    return floats * sizeof(float) >= 4 * huge_page;
#else
    static_cast<void>(floats);
    return false;
#endif
}

std::size_t large_bytes(std::size_t floats) {
    return round_up(floats * sizeof(float), huge_page);
}

/// Straight from the system, which clears pages as they are first touched: to clear them here would take as long as to
/// read a picture into them. Null if there is no room.
void* allocate_large(std::size_t floats) {
#ifdef CLSHADE_HAS_MMAP
    const std::size_t bytes = large_bytes(floats);
    void* mapped = mmap(nullptr, bytes + huge_page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED) {
        return nullptr;
    }
    auto* const first = static_cast<std::byte*>(mapped);
    const std::size_t before =
        round_up(reinterpret_cast<std::uintptr_t>(first), huge_page) - reinterpret_cast<std::uintptr_t>(first);
    if (before > 0) {
        munmap(first, before);
    }
    munmap(first + before + bytes, huge_page - before);
#ifdef MADV_HUGEPAGE
    static_cast<void>(madvise(first + before, bytes, MADV_HUGEPAGE)); // a wish: small pages do as well
#endif
    return first + before;
#else
    static_cast<void>(floats);
    return nullptr;
#endif
}

void* allocate_small(std::size_t floats) {
    const std::size_t bytes = round_up(floats * sizeof(float), page);
    void* const memory = std::aligned_alloc(page, bytes);
    if (memory != nullptr) {
        std::memset(memory, 0, bytes);
    }
    return memory;
}

} // namespace

AlignedBuffer::AlignedBuffer(std::size_t size) : size_(size) {
    if (size == 0) {
        return;
    }
    if (size > (std::numeric_limits<std::size_t>::max() - huge_page - page) / sizeof(float)) {
        throw RuntimeFailure(fmt::format("cannot address {} floats; use a smaller image", size));
    }
    data_ = static_cast<float*>(is_large(size) ? allocate_large(size) : allocate_small(size));
    if (data_ == nullptr) {
        throw RuntimeFailure(fmt::format("out of memory for {} MiB of image planes; use a smaller image or --max-mem",
                                         size * sizeof(float) / mebibyte));
    }
}

AlignedBuffer::~AlignedBuffer() {
#ifdef CLSHADE_HAS_MMAP
    if (data_ != nullptr && is_large(size_)) {
        munmap(data_, large_bytes(size_));
        return;
    }
#endif
    std::free(data_);
}

AlignedBuffer::AlignedBuffer(AlignedBuffer&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

AlignedBuffer& AlignedBuffer::operator=(AlignedBuffer&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
}

} // namespace clshade
