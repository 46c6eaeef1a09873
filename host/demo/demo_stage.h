// What stands on the demo's stage: shapes, where they are, what they are made of.
#pragma once

#include "host/demo/demo_shapes.h"

#include <glm/glm.hpp>

#include <vector>

namespace clshade::demo {

/// Values of the material_id plane; the demo's scene file names the same numbers.
enum class Substance {
    none = 0,
    stage = 1,
    plinth = 2,
    letters = 3,
    plastic = 4,
    gold = 5,
    copper = 6,
    car_paint = 7,
    chalk = 8,
    rubber = 9,
    steel = 10,
};

enum class Shape { sphere, box, cylinder, letter };

/// One object of the stage.
struct Object {
    Shape shape = Shape::sphere;
    Substance substance = Substance::none;
    glm::vec3 centre{0.0F};
    glm::vec3 size{1.0F}; ///< sphere, cylinder: radius in x (height / 2 in z); box: half sizes; letter: scale in x
    float rounding = 0.0F;
    float bound = 1.0F;     ///< radius of a sphere about the centre that holds the object
    float variation = 0.0F; ///< 0..1, told to the substance: place in a row, letter in the word
    std::vector<Stroke> strokes;

    /// Signed distance of a world-space point.
    [[nodiscard]] float distance(glm::vec3 p) const;
    /// Unit normal at a point of the surface.
    [[nodiscard]] glm::vec3 normal(glm::vec3 p) const;
};

struct Stage {
    std::vector<Object> objects;
    /// 0..1: how open the surroundings of a surface point are; baked into the reflectances as game assets do, because
    /// punctual lights cast no shadow.
    [[nodiscard]] float openness(glm::vec3 p, glm::vec3 normal) const;
};

/// Z up, the ground at z = 0, the camera's side at -Y.
[[nodiscard]] Stage build_stage();

/// Reflectances of a surface point.
struct Look {
    glm::vec3 albedo{0.0F};
    glm::vec3 f0{0.04F};
    float roughness = 0.5F;
};

/// Paints an object: checks, stripes, rings and gradients.
[[nodiscard]] Look look_of(const Object& object, glm::vec3 p);

} // namespace clshade::demo
