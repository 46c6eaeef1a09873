// The scene as a user writes it (TOML, version = 1): value types only. No OpenCL, no image formats, no files but the
// scene's own.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clshade {

/// Where in the scene file something was written. Line 0: not from a file; `file` is then the --set or --model
/// argument, or empty for the default scene.
struct SourceLocation {
    std::string file;
    int line = 0;
    int column = 0;
};

/// "FILE:LINE:COL: " to start a message with; "FILE: " for line 0, empty without a file.
[[nodiscard]] std::string message_prefix(const SourceLocation& where);

/// What is done to a channel after scale and offset (interface, "Scene file").
enum class Conversion {
    none,
    ggx_roughness,       ///< n = 2/r^4 - 2
    smoothness,          ///< r = 1 - x, then as ggx_roughness
    oren_nayar_sigma,    ///< n = 2/x^2
    index_of_refraction, ///< F0 = ((x-1)/(x+1))^2, x taken at least 1; made by the key `ior`, no name in scene files
};

/// A material parameter: three constants, or the planes of a role or layer.
struct Parameter {
    /// Empty: `constant` holds. One entry: a role's name, a layer's name or a full channel name. Three entries: three
    /// single channels.
    std::vector<std::string> channels;
    glm::dvec3 constant{0.0}; ///< a scalar parameter stands in all three components
    double scale = 1.0;       ///< applied to the channel, before `convert`
    double offset = 0.0;
    Conversion convert = Conversion::none;
    SourceLocation where;

    [[nodiscard]] bool is_constant() const { return channels.empty(); }
    [[nodiscard]] static Parameter of(double value) { return of(glm::dvec3(value)); }
    [[nodiscard]] static Parameter of(glm::dvec3 value) {
        Parameter p;
        p.constant = value;
        return p;
    }
    [[nodiscard]] static Parameter from(std::string channel, Conversion convert = Conversion::none) {
        Parameter p;
        p.channels = {std::move(channel)};
        p.convert = convert;
        return p;
    }
};

enum class SpecularModel {
    none,                    ///< no interface: neither reflects nor bends; as a base leaves the diffuse part unweighted
    blinn_phong,             ///< models.md section 2
    blinn_phong_exact,       ///< models.md section 1
    blinn_phong_anisotropic, ///< models.md section 3
    blinn_phong_spectral,    ///< models.md section 4
};

enum class DiffuseModel {
    none,
    lambert,
    oren_nayar,              ///< 8.6, the deck's improved qualitative model
    oren_nayar_full,         ///< 8.1
    oren_nayar_qualitative,  ///< 8.2
    oren_nayar_simplified_1, ///< 8.3
    oren_nayar_simplified_2, ///< 8.4
    oren_nayar_shininess,    ///< 8.5
};

/// How the interfaces of a stack reflect (models.md section 5).
enum class FresnelModel {
    constant, ///< Gaussian Schlick where light meets the stack, constants for normal incidence inside
    exact,    ///< the dielectric formula at the refracted angle, exact normalisers
};

/// How the media of a stack absorb (models.md section 5).
enum class AbsorptionModel {
    approximated, ///< max(0, 1 - a' (1/NL + 1/NE)); `absorption` is a'
    original,     ///< exp(-alpha d (1/NL' + 1/NE')), refracted; `absorption` is alpha d
    none,
};

/// What a stack's media take from an environment's light (models.md section 7).
enum class AmbientAbsorption {
    deck,        ///< diffuse max(0, 1 - a' (2 + 1/NE)), specular max(0, 1 - 2 a'/NE)
    clamped,     ///< diffuse with the clamp inside the integral; specular as the deck
    exponential, ///< 2 E_3(a') exp(-a'/NE) and exp(-2 a'/NE)
};

/// Whether an environment's light for lower layers is lessened by the interface that it meets from air.
enum class AmbientTransmittance {
    fresnel, ///< T = 1 - F(n1; N.E)
    none,    ///< T = 1: the deck's formulas to the letter
};

/// How Oren-Nayar models take an environment's light (models.md section 9).
enum class AmbientDiffuse {
    precise,  ///< 9.1: closed form of D, S of 9.4
    fit,      ///< 9.1: its polynomial
    coarse,   ///< 9.3
    coarsest, ///< 9.3: one reciprocal
    full,     ///< 9.2: D of the full model, which depends on the albedo
    order1,   ///< 9.5: D as `precise`, exact order-1 terms in place of S
};

/// Where an environment's up is: the axis of the world that row 0 of the picture lies at.
enum class UpAxis { z, y };

/// What diffuse surfaces see of the environment.
enum class AmbientSource {
    sh2,            ///< SH bands 0 and 1
    sh3,            ///< SH bands 0 to 2
    irradiance_map, ///< the full irradiance
};

/// Every value there is, in the order of the enumerations.
inline constexpr std::array all_specular_models{
    SpecularModel::none, SpecularModel::blinn_phong, SpecularModel::blinn_phong_exact,
    SpecularModel::blinn_phong_anisotropic, SpecularModel::blinn_phong_spectral};
inline constexpr std::array all_diffuse_models{DiffuseModel::none,
                                               DiffuseModel::lambert,
                                               DiffuseModel::oren_nayar,
                                               DiffuseModel::oren_nayar_full,
                                               DiffuseModel::oren_nayar_qualitative,
                                               DiffuseModel::oren_nayar_simplified_1,
                                               DiffuseModel::oren_nayar_simplified_2,
                                               DiffuseModel::oren_nayar_shininess};
inline constexpr std::array all_fresnel_models{FresnelModel::constant, FresnelModel::exact};
inline constexpr std::array all_absorption_models{AbsorptionModel::approximated, AbsorptionModel::original,
                                                  AbsorptionModel::none};
inline constexpr std::array all_ambient_absorptions{AmbientAbsorption::deck, AmbientAbsorption::clamped,
                                                    AmbientAbsorption::exponential};
inline constexpr std::array all_ambient_transmittances{AmbientTransmittance::fresnel, AmbientTransmittance::none};
inline constexpr std::array all_ambient_diffuses{AmbientDiffuse::precise, AmbientDiffuse::fit,
                                                 AmbientDiffuse::coarse,  AmbientDiffuse::coarsest,
                                                 AmbientDiffuse::full,    AmbientDiffuse::order1};
inline constexpr std::array all_up_axes{UpAxis::z, UpAxis::y};
inline constexpr std::array all_ambient_sources{AmbientSource::sh2, AmbientSource::sh3, AmbientSource::irradiance_map};

/// Names as written in a scene file.
[[nodiscard]] std::string_view name_of(SpecularModel model);
[[nodiscard]] std::string_view name_of(FresnelModel model);
[[nodiscard]] std::string_view name_of(AbsorptionModel model);
[[nodiscard]] std::string_view name_of(DiffuseModel model);
[[nodiscard]] std::string_view name_of(Conversion convert);
[[nodiscard]] std::string_view name_of(AmbientAbsorption absorption);
[[nodiscard]] std::string_view name_of(AmbientTransmittance transmittance);
[[nodiscard]] std::string_view name_of(AmbientDiffuse ambient);
[[nodiscard]] std::string_view name_of(UpAxis up);
[[nodiscard]] std::string_view name_of(AmbientSource source);

/// Complex index of refraction n + i k at a wavelength.
struct ComplexIndex {
    double wavelength = 0.0; ///< nanometres
    double n = 1.0;          ///< above 0
    double k = 0.0;          ///< 0 or more
};

/// Optical constants for blinn_phong_spectral: piecewise linear between the samples, clamped outside.
struct Metal {
    std::string name;                  ///< "gold", "copper" or the file's name as written
    std::vector<ComplexIndex> samples; ///< at least two, wavelengths rising
};

struct Specular {
    SpecularModel model = SpecularModel::blinn_phong;
    Parameter f0 = Parameter::of(0.04); ///< in air, 0..1 per channel; `ior` in the scene file sets ((n-1)/(n+1))^2
    Parameter shininess = Parameter::of(64.0);   ///< 0..65536
    Parameter shininess_u = Parameter::of(64.0); ///< anisotropic: along the tangent
    Parameter shininess_v = Parameter::of(64.0); ///< anisotropic: across it
    /// Anisotropic: a constant in world space, or three channels in the space and encoding of the normal, any length.
    /// Absent: the tangent role.
    std::optional<Parameter> tangent;
    Metal metal; ///< spectral
};

struct Diffuse {
    DiffuseModel model = DiffuseModel::lambert;
    Parameter albedo = Parameter::of(0.5);            ///< 0..1 per channel
    std::optional<Parameter> shininess;               ///< absent: the specular shininess of the base
    AmbientDiffuse ambient = AmbientDiffuse::precise; ///< key `ambient`; of the Oren-Nayar models
};

/// One layer of a stack: the lobe of its upper interface, and what its medium takes from light passing through.
struct Layer {
    Specular specular;
    Parameter absorption = Parameter::of(0.0); ///< 0 or more per channel; a constant 0 in the base
    SourceLocation where;
};

inline constexpr std::size_t most_layers = 8;

/// A stack of one to eight layers, top first; the last is the base and alone has a diffuse part.
struct Material {
    std::string name = "default";
    std::vector<std::int64_t> ids;  ///< values of the material_id plane
    std::vector<std::string> names; ///< Cryptomatte names; `default` has neither ids nor names
    SourceLocation names_where;
    FresnelModel fresnel = FresnelModel::constant;
    AbsorptionModel absorption_model = AbsorptionModel::approximated;
    AmbientAbsorption absorption_ibl = AmbientAbsorption::deck;
    AmbientTransmittance transmittance_ibl = AmbientTransmittance::fresnel;
    std::vector<Layer> layers = {Layer{}};
    Diffuse diffuse;
    SourceLocation where;

    [[nodiscard]] Specular& base() { return layers.back().specular; }
    [[nodiscard]] const Specular& base() const { return layers.back().specular; }
};

enum class LightType { distant, point, spot };

struct Light {
    std::string name;
    LightType type = LightType::distant;
    /// Direction the light travels, any length. World space, or camera space (+X right, +Y up, looks along -Z) for the
    /// lights of the default scene.
    glm::dvec3 direction{0.0, 0.0, -1.0};
    bool in_camera_space = false;
    glm::dvec3 position{0.0}; ///< world space, scene units
    /// distant: irradiance E_0 on a surface facing the light; point, spot: intensity, E_0 = power / distance^2.
    /// Colour is multiplied in.
    glm::dvec3 power{1.0};
    double cone_angle = 0.0;    ///< spot: half-angle from the axis in radians, (0, pi]; no light beyond
    double cone_softness = 0.0; ///< 0..1: smoothstep (over the angle) from cone_angle (1 - softness) to cone_angle
    SourceLocation where;
};

/// Light from all around: [environment].
struct Environment {
    /// As written, relative to the scene file (environment_path): a lat-long .hdr or .exr, or a folder that `clshade
    /// prefilter` wrote. Empty: the built-in studio.
    std::string image;
    glm::dvec3 intensity{1.0}; ///< 0 or more; multiplies the picture
    std::optional<UpAxis> up;  ///< absent: what the picture says of itself, else z
    double rotation = 0.0;     ///< radians, counter-clockwise about the up axis
    AmbientSource diffuse = AmbientSource::sh2;
    /// The studio of the default scene: its frame is the camera's (+X right, +Y up, looks along -Z), `up` has no say.
    bool in_camera_space = false;
    SourceLocation where;
};

/// How a camera sees: what is known beyond its place.
enum class Lens { unknown, fov_x, fov_y, orthographic };

struct Camera {
    glm::dmat4 matrix_world{1.0}; ///< camera to world, column vectors; looks along -Z, +Y up
    Lens lens = Lens::unknown;
    double lens_value = 0.0; ///< full field of view in radians, or the orthographic height in scene units
    SourceLocation where;
};

/// The keys of [camera] that are written somewhere; what is not comes from elsewhere.
struct CameraKeys {
    std::optional<glm::dmat4> matrix_world;
    Lens lens = Lens::unknown;
    double lens_value = 0.0; ///< as in Camera
    SourceLocation where;
};

/// Cameras of single frames: [camera.frames.N] and `file` of [camera] (host/scene/frame_camera.h).
struct FrameCameras {
    CameraKeys shared;            ///< [camera] itself
    std::map<int, Camera> listed; ///< [camera.frames.N], completed from [camera]
    std::string file;             ///< side files as written, with a place for the frame number; empty: none
    SourceLocation file_where;
};

enum class NormalSpace { world, camera };
enum class NormalEncoding { signed_values, unorm };
enum class DepthKind { planar, ray };

/// [gbuffer]: overrides of the automatic role detection, by role name.
struct RoleOverride {
    std::string role;
    /// One entry: a layer (suffixes are found) or a full channel name; more: single channels. The one entry "none"
    /// leaves the role empty.
    std::vector<std::string> channels;
    SourceLocation where;
};

struct GBufferSettings {
    std::vector<RoleOverride> roles;
    NormalSpace normal_space = NormalSpace::world;
    NormalEncoding normal_encoding = NormalEncoding::signed_values;
    DepthKind depth_kind = DepthKind::planar;
};

/// Parameters of the `default` material (materials[0]) that nobody wrote and that are chosen from the roles the file
/// has. Where a flag is set, the parameter in materials[0] holds only the last fallback:
///   albedo: albedo role, else 0.5.   f0: F0 role, else 0.04.
///   shininess (of the base's specular lobe): roughness role by ggx_roughness, else shininess role, else 64.
struct AutomaticParameters {
    bool albedo = false;
    bool f0 = false;
    bool shininess = false;
};

struct Scene {
    std::string file;             ///< empty for the default scene
    std::optional<Camera> camera; ///< of every frame that has none of its own; empty if [camera] lacks matrix_world
    std::optional<FrameCameras> frame_cameras;
    GBufferSettings gbuffer;
    std::vector<Light> lights;
    std::optional<Environment> environment;
    bool background = false;         ///< [output] background: the environment stands behind the objects; needs one
    std::vector<Material> materials; ///< never empty; the first is `default`
    /// The file has no [material.default] and neither --set nor --model touch it: all flags of `automatic` are set.
    /// Where only --set or --model touch it, this is false and `automatic` keeps the flags of what they left alone.
    /// Binding needs `automatic` only.
    bool automatic_material = false;
    AutomaticParameters automatic;
    bool emission_mapped = false; ///< [gbuffer] names the emission role
};

/// Where the environment's picture or set lies: `image` from the scene file's folder, as paths of metal tables are.
/// Empty without an environment and for the built-in studio.
[[nodiscard]] std::filesystem::path environment_path(const Scene& scene);

/// The scene used without --scene: automatic material; one distant key light over the camera's left shoulder and the
/// built-in studio around, both in camera space.
[[nodiscard]] Scene default_scene();

} // namespace clshade
