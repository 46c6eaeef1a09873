#include "host/shading/parameter_code.h"

#include <fmt/format.h>

#include <algorithm>

namespace clshade {

std::string ParameterReader::component(const BoundParameter& parameter, std::size_t index) const {
    std::string value = fmt::format("load_input(in, {})", parameter.planes[index]);
    if (parameter.averaged && frame_->roles.coverage != no_plane) {
        value = fmt::format("averaged({}, s)", value);
    }
    if (parameter.scale != 1.0 || parameter.offset != 0.0) {
        value =
            fmt::format("scaled({}, {}, {})", value, float_literal(parameter.scale), float_literal(parameter.offset));
    }
    switch (parameter.convert) {
    case Conversion::none:
        return value;
    case Conversion::ggx_roughness:
        return fmt::format("shininess_from_ggx_roughness({})", value);
    case Conversion::smoothness:
        return fmt::format("shininess_from_smoothness({})", value);
    case Conversion::oren_nayar_sigma:
        return fmt::format("shininess_from_oren_nayar_sigma({})", value);
    case Conversion::index_of_refraction:
        return fmt::format("f0_from_index({})", value);
    }
    return value;
}

Value ParameterReader::raw(const BoundParameter& parameter, const std::string& name) {
    if (parameter.is_grey()) {
        return block_->local(name, Value::real(component(parameter, 0)));
    }
    return block_->local(name, Value::rgb(fmt::format("make_rgb({}, {}, {})", component(parameter, 0),
                                                      component(parameter, 1), component(parameter, 2))));
}

Value ParameterReader::reflectance(const BoundParameter& parameter, const std::string& name) {
    if (parameter.is_constant()) {
        return Value::of(parameter.constant);
    }
    const Value value = raw(parameter, "raw_" + name);
    clamped_.push_back(fmt::format("outside_unit({})", rgb_text(value)));
    return block_->name(name, call("clamp_unit", {value}));
}

Value ParameterReader::shininess(const BoundParameter& parameter, const std::string& name) {
    if (parameter.is_constant()) {
        return Value::of(std::clamp(parameter.constant.x, 0.0, 65536.0)); // a conversion may leave the range
    }
    return block_->name(name, Value::real(fmt::format("clamp_shininess({})", component(parameter, 0))));
}

Value ParameterReader::absorption(const BoundParameter& parameter, const std::string& name) {
    if (parameter.is_constant()) {
        return Value::of(parameter.constant);
    }
    const Value value = raw(parameter, "raw_" + name);
    clamped_.push_back(fmt::format("below_zero({})", rgb_text(value)));
    const std::string text = value.grey ? fmt::format("larger({}, splat(0.0f))", value.text)
                                        : fmt::format("larger_rgb({}, 0.0f)", value.text);
    return block_->name(name, value.grey ? Value::real(text) : Value::rgb(text));
}

Value ParameterReader::emission(const BoundParameter& parameter, const std::string& name) {
    if (parameter.is_constant()) {
        return Value::of(glm::max(parameter.constant, glm::dvec3(0.0)));
    }
    const Value value = raw(parameter, "raw_" + name);
    return block_->name(name, Value::rgb(fmt::format("larger_rgb({}, 0.0f)", rgb_text(value))));
}

std::string ParameterReader::tangent(const BoundParameter& parameter) const {
    if (parameter.is_constant()) {
        const double length = glm::length(parameter.constant);
        const glm::dvec3 t = length > 0.0 ? parameter.constant / length : glm::dvec3(0.0);
        return fmt::format("make_vec3(splat({}), splat({}), splat({}))", float_literal(t.x), float_literal(t.y),
                           float_literal(t.z));
    }
    return fmt::format("load_direction(in, {}, {}, {}, s.unpremultiply, frame)", parameter.planes[0],
                       parameter.planes[1], parameter.planes[2]);
}

} // namespace clshade
