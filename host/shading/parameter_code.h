// Kernel code that reads material parameters: from planes or as numbers, converted and clamped (pixel rule 6).
#pragma once

#include "host/gbuffer/frame.h"
#include "host/shading/code_value.h"

#include <string>
#include <vector>

namespace clshade {

/// Names of masks in kernel code: where a parameter was out of range, where a tangent was missing.
using MaskNames = std::vector<std::string>;

/// Writes the lines that read parameters of one frame into a block.
class ParameterReader {
  public:
    ParameterReader(const Frame& frame, CodeBlock& block) : frame_(&frame), block_(&block) {}

    /// F0 or albedo, 0..1.
    [[nodiscard]] Value reflectance(const BoundParameter& parameter, const std::string& name);
    /// 0..65536
    [[nodiscard]] Value shininess(const BoundParameter& parameter, const std::string& name);
    /// 0 or more
    [[nodiscard]] Value absorption(const BoundParameter& parameter, const std::string& name);
    /// Emission, 0 or more; never counted as clamped.
    [[nodiscard]] Value emission(const BoundParameter& parameter, const std::string& name);
    /// An expression of type vec3 in world space, any length.
    [[nodiscard]] std::string tangent(const BoundParameter& parameter) const;
    /// Expressions of type mask: where what was read lay out of range.
    [[nodiscard]] const MaskNames& clamped() const { return clamped_; }

  private:
    [[nodiscard]] std::string component(const BoundParameter& parameter, std::size_t index) const;
    /// The value before clamping, named `name`.
    [[nodiscard]] Value raw(const BoundParameter& parameter, const std::string& name);

    const Frame* frame_;
    CodeBlock* block_;
    MaskNames clamped_;
};

} // namespace clshade
