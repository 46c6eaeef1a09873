#include "host/shading/code_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace clshade {

namespace {

using Binding = Value::Binding;

Value expression(bool grey, std::string text, Binding binding) {
    return {.known = false, .grey = grey, .number = glm::dvec3(0.0), .text = std::move(text), .binding = binding};
}

/// The operand of an operator that binds as tightly as `outer`.
std::string operand(const Value& value, Binding outer) {
    const std::string text = scalar_text(value);
    return !value.known && value.binding < outer ? fmt::format("({})", text) : text;
}

bool is_name(const std::string& text) {
    return std::all_of(text.begin(), text.end(),
                       [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.'; });
}

} // namespace

Value Value::of(const glm::dvec3& number) {
    Value value;
    value.number = number;
    value.grey = number.x == number.y && number.x == number.z;
    return value;
}

Value Value::real(std::string text) {
    return expression(true, std::move(text), Binding::atom);
}

Value Value::rgb(std::string text) {
    return expression(false, std::move(text), Binding::atom);
}

Value product(const Value& a, const Value& b) {
    if (a.known && b.known) {
        return Value::of(a.number * b.number);
    }
    if (a.is(0.0) || b.is(0.0)) {
        return Value::of(0.0);
    }
    if (a.is(1.0)) {
        return b;
    }
    if (b.is(1.0)) {
        return a;
    }
    if (a.grey && b.grey) {
        return expression(true, fmt::format("{} * {}", operand(a, Binding::product), operand(b, Binding::product)),
                          Binding::product);
    }
    if (a.grey || b.grey) {
        const Value& colour = a.grey ? b : a;
        const Value& scale = a.grey ? a : b;
        return Value::rgb(fmt::format("scale_rgb({}, {})", rgb_text(colour), real_text(scale)));
    }
    return Value::rgb(fmt::format("multiply_rgb({}, {})", rgb_text(a), rgb_text(b)));
}

Value sum(const Value& a, const Value& b) {
    if (a.known && b.known) {
        return Value::of(a.number + b.number);
    }
    if (a.is(0.0)) {
        return b;
    }
    if (b.is(0.0)) {
        return a;
    }
    if (a.grey && b.grey) {
        return expression(true, fmt::format("{} + {}", scalar_text(a), scalar_text(b)), Binding::sum);
    }
    return Value::rgb(fmt::format("add_rgb({}, {})", rgb_text(a), rgb_text(b)));
}

Value difference(const Value& a, const Value& b) {
    if (a.known && b.known) {
        return Value::of(a.number - b.number);
    }
    if (b.is(0.0)) {
        return a;
    }
    if (a.grey && b.grey) {
        return expression(true, fmt::format("{} - {}", scalar_text(a), operand(b, Binding::product)), Binding::sum);
    }
    return Value::rgb(fmt::format("subtract_rgb({}, {})", rgb_text(a), rgb_text(b)));
}

Value complement(const Value& a) {
    if (a.known || a.grey) {
        return difference(Value::of(1.0), a);
    }
    return Value::rgb(fmt::format("complement({})", a.text));
}

std::string float_literal(double number) {
    std::string text = fmt::format("{}", static_cast<float>(number));
    if (text.find_first_of(".e") == std::string::npos) {
        text += ".0";
    }
    return text + "f";
}

std::string scalar_text(const Value& value) {
    if (!value.known) {
        return value.text;
    }
    const std::string text = float_literal(value.number.x);
    return value.number.x < 0.0 ? fmt::format("({})", text) : text;
}

std::string real_text(const Value& value) {
    return value.known ? fmt::format("splat({})", float_literal(value.number.x)) : value.text;
}

std::string rgb_text(const Value& value) {
    if (value.grey) {
        return fmt::format("grey({})", real_text(value));
    }
    if (value.known) {
        return fmt::format("make_rgb(splat({}), splat({}), splat({}))", float_literal(value.number.x),
                           float_literal(value.number.y), float_literal(value.number.z));
    }
    return value.text;
}

Value call(std::string_view name, std::string_view first, std::initializer_list<Value> arguments) {
    const bool grey = std::all_of(arguments.begin(), arguments.end(), [](const Value& v) { return v.grey; });
    std::vector<std::string> texts;
    if (!first.empty()) {
        texts.emplace_back(first);
    }
    for (const Value& argument : arguments) {
        texts.push_back(grey ? real_text(argument) : rgb_text(argument));
    }
    const std::string text = fmt::format("{}{}({})", name, grey ? "" : "_rgb", fmt::join(texts, ", "));
    return grey ? Value::real(text) : Value::rgb(text);
}

Value call(std::string_view name, std::initializer_list<Value> arguments) {
    return call(name, "", arguments);
}

std::string wrapped(std::string_view line) {
    constexpr std::size_t widest = 120;
    const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
    std::string text;
    std::string rest(line);
    while (rest.size() > widest) {
        const std::size_t comma = rest.rfind(", ", widest - 2);
        const std::size_t bar = rest.rfind(" | ", widest - 2);
        const std::size_t at = comma == std::string::npos ? bar
                               : bar == std::string::npos ? comma
                                                          : std::max(comma, bar);
        if (at == std::string::npos || at <= indent + 8) {
            break;
        }
        text += rest.substr(0, at + (at == bar ? 2 : 1)) + "\n";
        rest = std::string(indent + 4, ' ') + rest.substr(at + (at == bar ? 3 : 2));
    }
    return text + rest + "\n";
}

CodeBlock::CodeBlock(int indent, std::string owner)
    : indent_(static_cast<std::size_t>(indent), ' '), owner_(std::move(owner)) {}

void CodeBlock::line(std::string_view text) {
    text_ += text.empty() ? "\n" : wrapped(indent_ + std::string(text));
}

std::string CodeBlock::declare(std::string_view type, std::string_view name, std::string_view expression) {
    if (owner_.empty()) {
        line(fmt::format("const {} {} = {};", type, name, expression));
        return std::string(name);
    }
    members_ += fmt::format("    {} {};\n", type, name);
    std::string member = fmt::format("{}.{}", owner_, name);
    line(fmt::format("{} = {};", member, expression));
    return member;
}

Value CodeBlock::name(std::string_view name, const Value& value) {
    if (value.known || is_name(value.text)) {
        return value;
    }
    const std::string text = declare(value.grey ? "real" : "rgb", name, value.text);
    return value.grey ? Value::real(text) : Value::rgb(text);
}

Value CodeBlock::local(std::string_view name, const Value& value) {
    if (value.known || is_name(value.text)) {
        return value;
    }
    line(fmt::format("const {} {} = {};", value.grey ? "real" : "rgb", name, value.text));
    return value.grey ? Value::real(std::string(name)) : Value::rgb(std::string(name));
}

Value CodeBlock::local_colour(std::string_view name, const Value& value) {
    if (!value.known || value.grey) {
        return local(name, value);
    }
    line(fmt::format("const rgb {} = {};", name, rgb_text(value)));
    return Value::rgb(std::string(name));
}

} // namespace clshade
