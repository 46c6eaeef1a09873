// Values in generated kernel code. Some are known already: arithmetic on them happens here, in double precision, and
// what is written into the kernel is a number.
#pragma once

#include <glm/glm.hpp>

#include <string>
#include <string_view>

namespace clshade {

/// A number known on the host, or an expression of type `real` (grey) or `rgb` in kernel code.
struct Value {
    bool known = true;
    bool grey = true; ///< one component for all channels
    glm::dvec3 number{0.0};
    std::string text; ///< of an expression
    /// How tightly the expression binds: an operand of `*` must be at least a product.
    enum class Binding { sum, product, atom } binding = Binding::atom;

    [[nodiscard]] static Value of(double number) { return of(glm::dvec3(number)); }
    [[nodiscard]] static Value of(const glm::dvec3& number);
    /// A variable or a call of type real, or of type rgb.
    [[nodiscard]] static Value real(std::string text);
    [[nodiscard]] static Value rgb(std::string text);

    [[nodiscard]] bool is(double value) const { return known && number == glm::dvec3(value); }
};

[[nodiscard]] Value product(const Value& a, const Value& b);
[[nodiscard]] Value sum(const Value& a, const Value& b);
[[nodiscard]] Value difference(const Value& a, const Value& b);
/// 1 - a
[[nodiscard]] Value complement(const Value& a);

/// As an operand where a real or a float may stand: "0.5f", "i.nl". Grey values only.
[[nodiscard]] std::string scalar_text(const Value& value);
/// As an argument of type real: "splat(0.5f)", "i.nl". Grey values only.
[[nodiscard]] std::string real_text(const Value& value);
/// As an argument of type rgb: "make_rgb(...)", "grey(i.nl)", "albedo".
[[nodiscard]] std::string rgb_text(const Value& value);

/// "NAME(a, b)" for grey arguments, "NAME_rgb(a, b)" if one of them has three channels.
[[nodiscard]] Value call(std::string_view name, std::initializer_list<Value> arguments);
/// The same with first arguments that are the same for all channels.
[[nodiscard]] Value call(std::string_view name, std::string_view first, std::initializer_list<Value> arguments);

/// A float literal that gives the same number back: "0.1f", "512.0f".
[[nodiscard]] std::string float_literal(double number);

/// Breaks a line at 120 columns, after a comma or a `|`; continuation lines are indented by four more.
[[nodiscard]] std::string wrapped(std::string_view line);

/// Lines of a function's body. What they name are constants of the function, or members of a struct that another
/// function reads.
class CodeBlock {
  public:
    /// `owner` empty: constants. Else the struct variable whose members are set, such as "m".
    explicit CodeBlock(int indent, std::string owner = {});

    /// One statement, wrapped at 120 columns.
    void line(std::string_view text);
    /// Gives an expression a name, so that it is evaluated once. Known numbers and plain names stay what they are.
    [[nodiscard]] Value name(std::string_view name, const Value& value);
    /// The same for a constant of the function, whatever the owner.
    [[nodiscard]] Value local(std::string_view name, const Value& value);
    /// A local for an expression that would not be named otherwise: three known numbers.
    [[nodiscard]] Value local_colour(std::string_view name, const Value& value);
    /// Names a value of another type; returns the text that stands for it.
    std::string declare(std::string_view type, std::string_view name, std::string_view expression);

    [[nodiscard]] const std::string& text() const { return text_; }
    /// Declarations of the members that were named, "    real a;" lines.
    [[nodiscard]] const std::string& members() const { return members_; }

  private:
    std::string indent_;
    std::string owner_;
    std::string text_;
    std::string members_;
};

} // namespace clshade
