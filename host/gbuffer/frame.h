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
// 10. Output: (sum over lights + environment + emission) * c, alpha = c. AOV diffuse and specular: their sums * c,
// lights
//     and environment, without emission; one AOV per light and one for the environment: its share * c. A result that
//     does not fit in a float is 0 and counted as non-finite.
// 11. Environment (models.md sections 6, 7, 9; host/environment/filter_layout.h). x = NE = max(N.E, 1e-4) throughout.
//     L(R, n) = trilinear in the grids of the levels: p = (octahedral (x, y) of M R + 1)/2 * cells, cell min(floor p,
//     cells - 1), bilinear in what is left; between levels floor(mip) and floor(mip) + 1 linear in mip =
//     clamp(log2(8192 / max(n, 1)), 0, 13). M = world_to_image, R = 2 x N - E (of any length). All times `intensity`.
//     scale(n), bias(n): bilinear in the ambient table at (128 x, 64 log2(n+1)/13), n at most 8191; the table of the
//     normaliser that the lobe has in rule 9: linear for blinn_phong and blinn_phong_spectral with fresnel = constant,
//     else exact. a = scale + bias.
//     Specular of layer k: S_k prod_{j<k} T_j As_j. S_k = (r_k scale + bias) L where outer; inside r_k a L with fresnel
//     = constant and F_k(x) a L with exact, F_k(x) being rule 9's at c_{k-1} for c = x.
//     T_j = (1 - F_j(x))(1 - r_j), F_j as in rule 9 with x in place of c (constant; inside: F_j = r_j), (1 - F_j(x))^2
//     (exact). transmittance_ibl = none: where outer, F_j(x) counts as 0 (constant: T_j = 1 - r_j; exact: T_j = 1).
//     A layer without interface: S = 0, T = 1.
//     Anisotropic layers: scale and bias at n = sqrt((n_u+2)(n_v+2)) - 2, exact normaliser. In place of L: five lookups
//     along the axis of the smaller exponent. With w = 1/max(min(n_u, n_v), 1), v = max(1/max(max(n_u, n_v), 1), w/8),
//     d = sqrt(max(w - v, 0)) and t the unit axis of the smaller exponent (T where n_u <= n_v, else B): L = sum_q w_q
//     L(R_q, 1/v), H_q = N + z_q d t, R_q = 2 (H_q.E)/(H_q.H_q) H_q - E, nodes z = 0, +-1.3556262, +-2.8569700, weights
//     8/15, 0.22207592, 0.011257411 (Gauss-Hermite: variances along t add up to w).
//     Spectral layers where outer: in place of r_k scale + bias the metal's own table over the same vertices, Norm(n)
//     int NH^n min(1, NL/NE) R_k(EH) dw (per channel, bilinear). Inside (constant): r_k a; exact, inside: F_k(x) a.
//     Diffuse of the base: albedo * weight * E/pi. weight = prod_{j<K-1} Td_j Ad_j times the base's own. Td_j:
//     constant: outer 1 - F_j(x), inside 1 - r_j U_j (rule 9); exact: (1 - F_j(x))^2; transmittance_ibl = none: 1 where
//     outer. The base's own: constant: 1 - r_{K-1} U_{K-1}, times 20/21 if it is outer and blinn_phong_exact; exact: 1
//     - F_{K-1}(x). A base without interface: 1. E/pi: sh2: e = e0 + e1, e0 = L_00 Y_00, e1 = 2/3 sum_m L_1m Y_1m(M N);
//     sh3: + e2 = 1/4 sum_m L_2m Y_2m(M N); irradiance_map: bilinear in its grid at M N. Lambert: max(0, e). Oren-Nayar
//     (every model of it, with n its shininess): max(0, D e0 + S (e - e0)), D and S of section 9 by `ambient`; order1:
//     max(0, D e0 + S (e - e0 - e1) + 3/2 a_N e1 + a_T (t.v)), v the SH linear vector (t.v = sum_m L_1m Y_1m(M t)), t =
//     (E - (N.E) N) normalised (0 where shorter than 1e-6, N.E unclamped). Times intensity; `full` takes rho = the
//     albedo per channel. As_j, Ad_j: the forms of section 7 by absorption_ibl with a' = layer j's absorption and x;
//     absorption none: 1. absorption = original: a' = (1 - exp(-2 alpha d))/2 for deck and clamped, alpha d itself for
//     exponential; approximated: a' itself for all three.
// 12. Background ([output] background): where rule 3 finds no surface, and under a coverage below 1, the environment
//     along the pixel's ray d = normalised direction: result = rule 10's + (1 - c) L(d), alpha = 1; L(d) = the picture
//     itself, bilinear between texel centres (u wraps, poles as in filter_layout.h, SOURCE), times intensity. Pixels of
//     rule 1 stay 0. AOVs have no background.
#pragma once

#include "host/base/plane_slab.h"
#include "host/environment/filtered_set.h"
#include "host/environment/lat_long.h"
#include "host/gbuffer/image_layout.h"
#include "host/scene/scene.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
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
    AmbientAbsorption absorption_ibl = AmbientAbsorption::deck;
    AmbientTransmittance transmittance_ibl = AmbientTransmittance::fresnel;
    std::vector<BoundLayer> layers = {BoundLayer{}}; ///< top first, never empty
    DiffuseModel diffuse = DiffuseModel::none;       ///< of the base
    BoundParameter albedo;
    BoundParameter diffuse_shininess; ///< of the Oren-Nayar models
    AmbientDiffuse ambient = AmbientDiffuse::precise;

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

/// Light from all around, as rule 11 has it.
struct BoundEnvironment {
    glm::dmat3 world_to_image{1.0}; ///< a rotation, perhaps with axes renamed: M
    glm::dvec3 intensity{1.0};
    AmbientSource diffuse = AmbientSource::sh2;
    bool background = false; ///< rule 12; needs the view's rays and `image`
    /// The picture, cleaned. Null if the scene names a set that was pre-filtered before: then both evaluators take
    /// `maps`.
    std::shared_ptr<const LatLong> image;
    /// What kernels read. The reference does not look at it where there is an `image`: it filters by itself.
    std::shared_ptr<const FilteredSet> maps;
};

/// M of an environment whose picture has row 0 at the given axis of the world, turned counter-clockwise about it by
/// `rotation` radians: what stood at azimuth a stands at a + rotation (interface, "Scene file").
[[nodiscard]] glm::dmat3 world_to_image(UpAxis up, double rotation);

/// Everything needed to shade one picture. Lights are in world space (the default scene's already turned).
struct Frame {
    std::string file; ///< for messages
    Window data_window;
    Window display_window;
    double pixel_aspect = 1.0;
    PlaneSlab planes;
    int first_row = 0; ///< of the picture's rows (from the top of the data window) that `planes` hold: one band, or all
    std::vector<std::string> plane_names; ///< full channel name of each plane
    RolePlanes roles;
    NormalSpace normal_space = NormalSpace::world;
    NormalEncoding normal_encoding = NormalEncoding::signed_values;
    DepthKind depth_kind = DepthKind::planar;
    View view;
    std::vector<Light> lights;
    std::optional<BoundEnvironment> environment;
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
    bool environment = false; ///< only of frames with an environment
};

/// What an evaluator counted.
struct PixelCounts {
    std::uint64_t nonfinite = 0;      ///< pixels set to 0 by rule 1 or 10
    std::uint64_t clamped = 0;        ///< pixels with a parameter clamped by rule 6
    std::uint64_t fractional_ids = 0; ///< rule 7
    std::uint64_t no_tangent = 0; ///< rule 6: pixels of anisotropic materials with a tangent missing or parallel to N
};

/// Names of the output planes in order: R, G, B, A, then diffuse.R, ..., specular.R, ..., light.<name>.R, ...,
/// environment.R, ...
[[nodiscard]] std::vector<std::string> output_plane_names(const Frame& frame, const AovSelection& aovs);

} // namespace clshade
