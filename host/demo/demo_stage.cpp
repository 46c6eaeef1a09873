#include "host/demo/demo_stage.h"

#include "host/demo/demo_letters.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace clshade::demo {

namespace {

constexpr float letter_scale = 0.80F;
constexpr float letter_half_depth = 0.17F;
constexpr float letter_rounding = 0.035F;
constexpr float letter_spacing = 0.20F; // in x-heights
constexpr float letters_y = -1.15F;

Object sphere(Substance substance, glm::vec3 centre, float radius, float variation = 0.0F) {
    return {Shape::sphere, substance, centre, glm::vec3(radius), 0.0F, radius, variation, {}};
}

void add_ground(std::vector<Object>& objects) {
    const float radius = 4.7F;
    const float half_height = 0.09F;
    objects.push_back({Shape::cylinder,
                       Substance::stage,
                       {0.0F, 0.0F, -half_height},
                       {radius, radius, half_height},
                       0.05F,
                       radius + half_height,
                       0.0F,
                       {}});
    const glm::vec3 half(2.95F, 0.72F, 0.28F);
    objects.push_back({Shape::box, Substance::plinth, {0.0F, 1.25F, half.z}, half, 0.06F, glm::length(half), 0.0F, {}});
}

void add_spheres(std::vector<Object>& objects) {
    const std::array<Substance, 5> row{Substance::plastic, Substance::gold, Substance::car_paint, Substance::copper,
                                       Substance::chalk};
    const float radius = 0.54F;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const float x = 1.17F * (static_cast<float>(i) - 2.0F);
        objects.push_back(sphere(row.at(i), {x, 1.25F, 0.56F + radius}, radius));
    }
    // Steel balls in front of the word, from polished to rough.
    const int balls = 7;
    for (int i = 0; i < balls; ++i) {
        const float place = static_cast<float>(i) / static_cast<float>(balls - 1);
        objects.push_back(sphere(Substance::steel, {4.2F * (place - 0.5F), -2.35F, 0.22F}, 0.22F, place));
    }
    objects.push_back(sphere(Substance::rubber, {-3.55F, -0.35F, 0.42F}, 0.42F));
    objects.push_back(sphere(Substance::rubber, {3.55F, -0.20F, 0.30F}, 0.30F));
    objects.push_back(sphere(Substance::car_paint, {3.25F, -1.05F, 0.20F}, 0.20F));
    objects.push_back(sphere(Substance::plastic, {-3.05F, -1.15F, 0.18F}, 0.18F));
}

void add_word(std::vector<Object>& objects) {
    std::vector<Letter> letters = word();
    float width = -letter_spacing;
    for (const Letter& letter : letters) {
        width += letter.width + letter_spacing;
    }
    float x = -0.5F * width;
    for (std::size_t i = 0; i < letters.size(); ++i) {
        Letter& letter = letters[i];
        // Strokes are moved so that the object's centre is theirs: 0.75 is half the height of the tallest letter.
        const glm::vec2 middle(0.5F * letter.width, 0.75F);
        for (Stroke& stroke : letter.strokes) {
            stroke.a -= middle;
            stroke.b -= middle;
        }
        const float bound = letter_scale * glm::length(middle) + letter_half_depth;
        objects.push_back({Shape::letter,
                           Substance::letters,
                           {letter_scale * (x + middle.x), letters_y, letter_scale * middle.y},
                           {letter_scale, letter_half_depth, letter_scale},
                           letter_rounding,
                           bound,
                           static_cast<float>(i) / static_cast<float>(letters.size() - 1),
                           std::move(letter.strokes)});
        x += letter.width + letter_spacing;
    }
}

} // namespace

float Object::distance(glm::vec3 p) const {
    const glm::vec3 q = p - centre;
    switch (shape) {
    case Shape::sphere:
        return glm::length(q) - size.x;
    case Shape::box:
        return rounded_box(q, size, rounding);
    case Shape::cylinder:
        return rounded_cylinder(q, size.x, size.z, rounding);
    case Shape::letter: {
        const float flat = size.x * (distance_to_strokes({q.x / size.x, q.z / size.x}, strokes) - pen);
        return extruded(flat, q.y, size.y, rounding);
    }
    }
    return 0.0F;
}

glm::vec3 Object::normal(glm::vec3 p) const {
    if (shape == Shape::sphere) {
        return glm::normalize(p - centre);
    }
    // Differences along the corners of a tetrahedron: four distances instead of six. The step is far above the rounding
    // of single precision (1e-6 of the scene's size) and far below every rounded edge.
    constexpr float h = 2e-3F;
    constexpr std::array<glm::vec3, 4> corners{glm::vec3(1.0F, -1.0F, -1.0F), glm::vec3(-1.0F, -1.0F, 1.0F),
                                               glm::vec3(-1.0F, 1.0F, -1.0F), glm::vec3(1.0F, 1.0F, 1.0F)};
    glm::vec3 gradient(0.0F);
    for (const glm::vec3& direction : corners) {
        gradient += direction * distance(p + h * direction);
    }
    return glm::normalize(gradient);
}

float Stage::openness(glm::vec3 p, glm::vec3 normal) const {
    constexpr std::array<float, 4> reaches{0.05F, 0.13F, 0.27F, 0.5F};
    std::array<float, 4> nearest = reaches;
    for (const Object& object : objects) {
        const float gap = glm::length(p - object.centre) - object.bound;
        for (std::size_t i = 0; i < reaches.size(); ++i) {
            if (gap < 2.0F * reaches.at(i)) { // farther objects cannot be nearer to the probe than its reach
                nearest.at(i) = std::min(nearest.at(i), object.distance(p + reaches.at(i) * normal));
            }
        }
    }
    float blocked = 0.0F;
    float weight = 0.5F;
    for (std::size_t i = 0; i < reaches.size(); ++i) {
        blocked += weight * (reaches.at(i) - nearest.at(i)) / reaches.at(i);
        weight *= 0.75F;
    }
    constexpr float darkest = 0.15F; // light that bounces into every corner
    return std::clamp(1.0F - (1.0F - darkest) * blocked / 1.35F, darkest, 1.0F);
}

Stage build_stage() {
    Stage stage;
    add_ground(stage.objects);
    add_word(stage.objects);
    add_spheres(stage.objects);
    return stage;
}

} // namespace clshade::demo
