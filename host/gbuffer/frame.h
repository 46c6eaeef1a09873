// A frame: the one thing both evaluators (device and reference) take. Scene and G-buffer are joined here, so that
// neither evaluator knows files, names or roles; each implements the pixel rules below on its own.
//
// PIXEL RULES (public interface, "Output image"; models.md section 0). For every pixel, in this order:
//  1. Non-finite: if any plane that the frame names (planes of roles, of parameters and of Cryptomatte claims, of
//     materials that claim the pixel or not alike) holds NaN or Inf at the pixel, every output is 0 and the pixel is
//     counted. One exception: +Inf in the depth plane is a background sentinel, not an error. A normal whose squared
//     length overflows a float counts as non-finite too.
//  2. Coverage c = coverage plane clamped to [0, 1], or 1 without that plane.
//  3. Surface: raw normal n = plane (unorm encoding: 2 (plane / c) - 1). There is a surface if |n| >= 1e-6, c > 0, and
//     not (no coverage plane and depth >= 6e4 with a depth plane). No surface: every output including alpha is 0.
//  4. N = normalised n, turned by camera_to_world for camera-space normals.
//  5. Eye and position. The position is valid if the frame has a position plane and not (depth plane and depth >= 6e4)
//     and, where the pixel rays are known, not (no depth plane and position = (0,0,0)).
//     Perspective: E = normalize(eye - P) where the position is valid; otherwise E = -normalize(ray direction) of the
//     pixel where rays are known; otherwise (an eye but neither position nor rays) E = -view_axis.
//     Orthographic: E = -view_axis (the camera's +Z) everywhere.
//     P for point and spot lights: the position plane where valid; else from depth (planar: origin + depth * direction
//     with direction . view_axis = 1; ray: origin + depth * normalize(direction)), also when depth is a sentinel
//     (then the light is practically absent).
//  6. Parameters: plane value, divided by c where `averaged` (c > 0 holds here), times scale plus offset, then convert,
//     then clamped: f0, albedo to [0, 1], absorption to >= 0 (values beyond by more than 1e-3 are counted as clamped),
//     every shininess to [0, 65536], emission to >= 0. ggx_roughness: 2/r^4 - 2; smoothness: r = 1 - x;
//     oren_nayar_sigma: 2/x^2; index_of_refraction: ((x-1)/(x+1))^2 with x at least 1; division by zero gives the upper
//     clamp.
//     Tangent: t = plane (unorm encoding: 2 (plane / c) - 1; camera space: turned as the normal), or a constant in
//     world space. u = t - (t.N) N. Where |t| < 1e-6, |t|^2 overflows a float or |u| < 1e-4 |t| the tangent is missing
//     or parallel to the normal: the pixel is counted, and T is the first axis of the frame that Duff et al. ("Building
//     an Orthonormal Basis, Revisited", JCGT 2017) build on N alone; else T = u/|u|. B = N x T.
//  7. Material: the first in the list that claims the pixel, `default` (the first) where none does. An `ids` claim
//     holds where the material_id plane's value, rounded to the nearest whole number (halves to the even one), is in
//     the list; a Cryptomatte claim where the rank 0 id of its plane has the claim's bits. A value of the material_id
//     plane further than 0.01 from a whole number is counted as a fractional id (on covered pixels).
//  8. Lights: L, E_0 as in scene.h. NL = N.L; no light unless NL > 0. NE = max(N.E, 1e-4) wherever formulas say N.E.
//     With m = sqrt(max(|L+E|^2, 1e-12)): H = (L+E)/m, E.H = |L+E|^2/(2 m), N.H = max(N.(L+E), 1e-12)/m, so that a
//     surface seen from behind needs no case of its own. NH^0 = 1. gamma = E.L - NE NL with the clamped NE;
//     cos(dphi) = gamma/(sin sin) is clamped to [-1, 1].
//  9. Combination, per light (models.md section 5, interface by interface). Layers k = 0 (top) to K-1 (base), c = E.H.
//     Index of a layer's medium against air: n_k = (1 + sqrt f0)/(1 - sqrt f0); spectral: f0 = R_k(1) in air. A layer
//     with lobe `none`, or above the base with f0 = 0, has no interface: it reflects and bends nothing whatever lies
//     above (F_k = r_k = 0), only its absorption counts; its medium takes the index m_k = m_{k-1} of the one above.
//     Else m_k = n_k. m_{-1} = 1: air. f0 may differ between channels; everything holds per channel. r_k = ((m_k -
//     m_{k-1})/(m_k + m_{k-1}))^2 (spectral: the conductor's R at normal incidence against m_{k-1}). `outer`: an
//     interface met from air, m_{k-1} = 1. fresnel = constant: outer: F_k = Schlick with f0 = r_k at c (blinn_phong:
//     the Gaussian form; spectral: R_k(c)).
//       Not outer: F_k = r_k. Specular of layer k: norm_k(n) lobe_k F_k prod_{j<k} (1 - F_j)(1 - r_j).
//       Diffuse: f_d times prod_{j<K-1} (outer: 1 - F_j; else: 1 - r_j U_j) times (1 - r_{K-1} U_{K-1}) with
//       U_k = prod_{j<k} (1 - r_j); if the base is outer and its lobe blinn_phong_exact: 1 - Schlick(r, N.L) instead.
//     fresnel = exact: F_k = the dielectric (spectral: conductor) Fresnel formula for m_k against m_{k-1} at the cosine
//       c_{k-1} = sqrt(1 - (1 - c^2)/m_{k-1}^2) in the medium above. Specular: norm_k lobe_k F_k prod_{j<k} (1 -
//       F_j)^2. Diffuse: f_d (1 - F_{K-1}) prod_{j<K-1} (1 - F_j)^2.
//     norm: blinn_phong, blinn_phong_spectral linear (fresnel = exact: exact); blinn_phong_exact exact; anisotropic the
//     closed form of section 3.
//     Absorption: the specular part of layer k and the diffuse part (k = K-1) are multiplied by prod_{j<k} A_j, A_j by
//     section 5 with layer j's absorption and, for `original`, angles refracted by m_j.
//     Radiance = (diffuse f_cos + specular f_cos) E_0.
// 10. Output: (sum over lights + emission) * c, alpha = c. AOV diffuse and specular: their sums * c without emission;
//     one AOV per light: its share * c. A result that does not fit in a float is 0 and counted as non-finite.
#pragma once

#include "host/base/plane_slab.h"
#include "host/gbuffer/image_layout.h"
#include "host/scene/scene.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace clshade {

/// Index of a plane in a frame's slab; absent: -1.
using PlaneIndex = int;
inline constexpr PlaneIndex no_plane = -1;

struct RolePlanes {
    std::array<PlaneIndex, 3> normal{no_plane, no_plane, no_plane}; ///< always present
    std::array<PlaneIndex, 3> position{no_plane, no_plane, no_plane};
    PlaneIndex depth = no_plane;
    PlaneIndex coverage = no_plane;
    PlaneIndex material_id = no_plane;
};

/// A parameter bound to planes: constant if planes[0] == no_plane; a one-channel source stands in all three entries.
struct BoundParameter {
    std::array<PlaneIndex, 3> planes{no_plane, no_plane, no_plane};
    glm::dvec3 constant{0.0};
    double scale = 1.0;
    double offset = 0.0;
    Conversion convert = Conversion::none;
    bool averaged = true; ///< the plane was averaged over coverage: divide by it

    [[nodiscard]] bool is_constant() const { return planes[0] == no_plane; }
    /// One plane (or one constant) for all three components.
    [[nodiscard]] bool is_grey() const { return planes[0] == planes[1] && planes[0] == planes[2]; }
};

/// A Cryptomatte name as pixels carry it.
struct CryptomatteClaim {
    std::string name;
    PlaneIndex plane = no_plane; ///< rank 0 ids
    std::uint32_t bits = 0;      ///< of the float that stands for the name
};

struct BoundLayer {
    SpecularModel specular = SpecularModel::none;
    BoundParameter f0;          ///< in air; not of spectral layers
    BoundParameter shininess;   ///< not of anisotropic layers
    BoundParameter shininess_u; ///< anisotropic
    BoundParameter shininess_v;
    BoundParameter tangent;    ///< anisotropic: constant in world space, or planes like the normal's; see rule 6
    Metal metal;               ///< spectral
    BoundParameter absorption; ///< of the layer's medium; constant 0 in the base
};

/// Parameters that the models do not use are constants of 0. A spectral layer has only constant f0 above it.
struct BoundMaterial {
    std::string name;
    std::vector<std::int64_t> ids;
    std::vector<CryptomatteClaim> cryptomatte;
    FresnelModel fresnel = FresnelModel::constant;
    AbsorptionModel absorption = AbsorptionModel::none; ///< none where no layer absorbs
    std::vector<BoundLayer> layers = {BoundLayer{}};    ///< top first, never empty
    DiffuseModel diffuse = DiffuseModel::none;          ///< of the base
    BoundParameter albedo;
    BoundParameter diffuse_shininess; ///< of the Oren-Nayar models

    [[nodiscard]] BoundLayer& base() { return layers.back(); }
    [[nodiscard]] const BoundLayer& base() const { return layers.back(); }
};

/// What a material is made of, as a stable key: "blinn_phong.lambert"; with several layers
/// "layers2.blinn_phong.lambert.constant.approximated" (lobes top first, joined by '+' where they differ). A single
/// layer with fresnel = exact: "blinn_phong.lambert.exact".
[[nodiscard]] std::string model_key(const BoundMaterial& material);

/// World-space view of the frame. A pixel's centre is at (x + 0.5, y + 0.5), x and y counted from the top left corner
/// of the data window; origin and direction are affine in it:
///   origin(x, y) = origin + (x + 0.5) origin_dx + (y + 0.5) origin_dy, direction likewise,
/// with direction . view_axis = 1 for every pixel. Perspective: the origin is the eye. Orthographic: the direction is
/// view_axis.
struct View {
    bool orthographic = false;
    bool has_rays = false;                ///< false: only eye and camera_to_world are known
    glm::dvec3 eye{0.0};                  ///< perspective only
    glm::dvec3 view_axis{0.0, 0.0, -1.0}; ///< unit, the way the camera looks
    glm::dmat3 camera_to_world{1.0};
    glm::dvec3 origin{0.0}, origin_dx{0.0}, origin_dy{0.0};
    glm::dvec3 direction{0.0}, direction_dx{0.0}, direction_dy{0.0};
};

/// Everything needed to shade one picture. Lights are in world space (the default scene's already turned).
struct Frame {
    std::string file; ///< for messages
    Window data_window;
    Window display_window;
    double pixel_aspect = 1.0;
    PlaneSlab planes;
    std::vector<std::string> plane_names; ///< full channel name of each plane
    RolePlanes roles;
    NormalSpace normal_space = NormalSpace::world;
    NormalEncoding normal_encoding = NormalEncoding::signed_values;
    DepthKind depth_kind = DepthKind::planar;
    View view;
    std::vector<Light> lights;
    std::vector<BoundMaterial> materials; ///< never empty; the first takes pixels no other claims
    BoundParameter emission;              ///< used only if has_emission
    bool has_emission = false;
    std::vector<std::string> warnings; ///< what may be wrong with the picture
    std::vector<std::string> notes;    ///< what was found out and is no fault, such as a recovered camera's residual
};

/// Which outputs are wanted beside R, G, B, A.
struct AovSelection {
    bool diffuse = false;
    bool specular = false;
    bool lights = false;
};

/// What an evaluator counted.
struct PixelCounts {
    std::uint64_t nonfinite = 0;      ///< pixels set to 0 by rule 1 or 10
    std::uint64_t clamped = 0;        ///< pixels with a parameter clamped by rule 6
    std::uint64_t fractional_ids = 0; ///< rule 7
    std::uint64_t no_tangent = 0; ///< rule 6: pixels of anisotropic materials with a tangent missing or parallel to N
};

/// Names of the output planes in order: R, G, B, A, then diffuse.R, ..., specular.R, ..., light.<name>.R, ...
[[nodiscard]] std::vector<std::string> output_plane_names(const Frame& frame, const AovSelection& aovs);

} // namespace clshade
