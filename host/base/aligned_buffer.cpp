#include "host/base/aligned_buffer.h"

#include "host/base/error.h"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#endif

namespace clshade {

namespace {
constexpr std::size_t page = 4096;
constexpr std::size_t huge_page = std::size_t{1} << 21U;
constexpr std::size_t mebibyte = std::size_t{1} << 20U;
} // namespace

AlignedBuffer::AlignedBuffer(std::size_t size) : size_(size) {
    if (size == 0) {
        return;
    }
    if (size > (std::numeric_limits<std::size_t>::max() - page) / sizeof(float)) {
        throw RuntimeFailure(fmt::format("cannot address {} floats; use a smaller image", size));
    }
    // A kernel follows a dozen streams and more: with small pages it would miss the TLB in each of them every 1024
    // pixels. Small pictures are not worth the rounding.
    const std::size_t unit = size * sizeof(float) >= 4 * huge_page ? huge_page : page;
    const std::size_t bytes = (size * sizeof(float) + unit - 1) / unit * unit;
    data_ = static_cast<float*>(std::aligned_alloc(unit, bytes));
    if (data_ == nullptr) {
        throw RuntimeFailure(fmt::format("out of memory for {} MiB of image planes; use a smaller image or --max-mem",
                                         bytes / mebibyte));
    }
#ifdef MADV_HUGEPAGE
    if (unit == huge_page) {
        static_cast<void>(madvise(data_, bytes, MADV_HUGEPAGE)); // a wish: small pages do as well
    }
#endif
    std::memset(data_, 0, bytes);
}

AlignedBuffer::~AlignedBuffer() {
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
