#include "host/base/aligned_buffer.h"

#include "host/base/error.h"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>

namespace clshade {

namespace {
constexpr std::size_t page = 4096;
constexpr std::size_t mebibyte = std::size_t{1} << 20U;
} // namespace

AlignedBuffer::AlignedBuffer(std::size_t size) : size_(size) {
    if (size == 0) {
        return;
    }
    if (size > (std::numeric_limits<std::size_t>::max() - page) / sizeof(float)) {
        throw RuntimeFailure(fmt::format("cannot address {} floats; use a smaller image", size));
    }
    const std::size_t bytes = (size * sizeof(float) + page - 1) / page * page;
    data_ = static_cast<float*>(std::aligned_alloc(page, bytes));
    if (data_ == nullptr) {
        throw RuntimeFailure(fmt::format("out of memory for {} MiB of image planes; use a smaller image or --max-mem",
                                         bytes / mebibyte));
    }
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
