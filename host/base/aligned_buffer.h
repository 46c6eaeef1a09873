// Page-aligned, zero-initialised memory that an OpenCL device can use in place.
#pragma once

#include <cstddef>
#include <span>

namespace clshade {

/// Owns `size` floats aligned to a page (4096 bytes), all zero. Move-only.
/// Page alignment and a size that is a multiple of 64 bytes are what drivers ask of CL_MEM_USE_HOST_PTR for zero-copy.
class AlignedBuffer {
  public:
    AlignedBuffer() = default;
    /// Throws RuntimeFailure naming the size when the memory cannot be had.
    explicit AlignedBuffer(std::size_t size);
    ~AlignedBuffer();
    AlignedBuffer(AlignedBuffer&& other) noexcept;
    AlignedBuffer& operator=(AlignedBuffer&& other) noexcept;
    AlignedBuffer(const AlignedBuffer&) = delete;
    AlignedBuffer& operator=(const AlignedBuffer&) = delete;

    [[nodiscard]] float* data() { return data_; }
    [[nodiscard]] const float* data() const { return data_; }
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] std::span<float> span() { return {data_, size_}; }
    [[nodiscard]] std::span<const float> span() const { return {data_, size_}; }

  private:
    float* data_ = nullptr;
    std::size_t size_ = 0;
};

} // namespace clshade
