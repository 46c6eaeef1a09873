// What `check` compares without INPUT: every model there is, on random G-buffers.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/gbuffer/random_gbuffer.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace clshade::cli {

/// One random G-buffer of the suite with one material.
struct SuiteCase {
    StackShape shape;
    std::string preset; ///< the material is this preset, whatever the shape; empty: a random one of the shape
    std::string label;  ///< tells cases with the same stack apart: "skin", "random3"; often empty
    std::optional<AmbientSource> environment; ///< lit by an environment too; what diffuse surfaces see of it
    bool lights = true;                       ///< false: by the environment alone
    bool background = false;                  ///< the environment stands behind
    bool environment_aov = false;             ///< its share is a plane of its own, and compared
};

/// Under lights: every lobe with every diffuse model that makes sense, single layers with exact Fresnel, stacks of two
/// layers with every model of Fresnel and absorption, deeper stacks, random stacks drawn from `seed`, and every preset.
/// Then what an environment makes of them (check_suite_environment.cpp).
[[nodiscard]] std::vector<SuiteCase> check_suite(std::uint64_t seed);

/// The part under an environment, most of it with lights as well: every lobe, every diffuse model, every way Oren-Nayar
/// takes it and every source for diffuse surfaces, stacks with every model of Fresnel, absorption and transmittance,
/// random stacks, presets, backgrounds. Labels begin with "environment.".
[[nodiscard]] std::vector<SuiteCase> environment_suite(std::uint64_t seed);

/// What the suite's environments are turned copies of: small, so that the reference, which filters by itself, is quick.
[[nodiscard]] LatLong suite_environment();

/// The G-buffer of a case, with the environment `maps` of `image` where it has one; then half as wide and high, since
/// the reference takes several times as long for it. The same seed gives the same bytes.
[[nodiscard]] Frame frame_of(const SuiteCase& suite_case, int width, int height, std::uint64_t seed,
                             const std::shared_ptr<const LatLong>& image,
                             const std::shared_ptr<const FilteredSet>& maps);

/// Name of the case in reports, unique in a suite: the material's model_key, "KEY@LABEL" for a case with a label.
[[nodiscard]] std::string name_of(const SuiteCase& suite_case, const Frame& frame);

/// Name of the case's layers in --dump, unique in a suite: the label, or the model_key without one; under an
/// environment the whole name where it is not too long. Channel names have at most 255 characters.
[[nodiscard]] std::string layer_of(const SuiteCase& suite_case, const Frame& frame);

} // namespace clshade::cli
