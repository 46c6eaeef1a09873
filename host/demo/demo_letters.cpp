// The word on the stage, drawn with lines and arcs. x-height 1, pen radius pen, ascenders to 1.5.
#include "host/demo/demo_letters.h"

namespace clshade::demo {

namespace {

constexpr float low = pen;
constexpr float high = 1.0F - pen;
constexpr float tall = 1.5F - pen;
constexpr float bowl = 0.5F - pen; // radius of the round letters' centre line

std::vector<Stroke> letter_c() {
    return {arc({0.5F, 0.5F}, bowl, 48.0F, 312.0F)};
}

std::vector<Stroke> letter_l() {
    return {line({pen, low}, {pen, tall})};
}

/// Two half bowls joined by a bar, with terminals that curl by a quarter.
std::vector<Stroke> letter_s() {
    const float r = (high - low) / 4.0F;
    const float left = low + r;
    const float right = 0.72F - low - r;
    const float upper = high - r;
    const float lower = low + r;
    return {arc({right, upper}, r, 15.0F, 90.0F),  line({left, high}, {right, high}),
            arc({left, upper}, r, 90.0F, 270.0F),  line({left, 0.5F}, {right, 0.5F}),
            arc({right, lower}, r, -90.0F, 90.0F), line({left, low}, {right, low}),
            arc({left, lower}, r, 195.0F, 270.0F)};
}

std::vector<Stroke> letter_h() {
    const float r = 0.28F;
    const float top = high - r;
    return {line({pen, low}, {pen, tall}), arc({pen + r, top}, r, 0.0F, 180.0F),
            line({pen + 2.0F * r, top}, {pen + 2.0F * r, low})};
}

std::vector<Stroke> letter_a() {
    return {arc({0.5F, 0.5F}, bowl, 0.0F, 360.0F), line({0.5F + bowl, low}, {0.5F + bowl, high})};
}

std::vector<Stroke> letter_d() {
    return {arc({0.5F, 0.5F}, bowl, 0.0F, 360.0F), line({0.5F + bowl, low}, {0.5F + bowl, tall})};
}

std::vector<Stroke> letter_e() {
    return {arc({0.5F, 0.5F}, bowl, 0.0F, 318.0F), line({0.5F - bowl, 0.5F}, {0.5F + bowl, 0.5F})};
}

} // namespace

std::vector<Letter> word() {
    return {{letter_c(), 0.90F}, {letter_l(), 2.0F * pen}, {letter_s(), 0.72F}, {letter_h(), 0.56F + 2.0F * pen},
            {letter_a(), 1.0F},  {letter_d(), 1.0F},       {letter_e(), 1.0F}};
}

} // namespace clshade::demo
