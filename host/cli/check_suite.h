// What `check` compares without INPUT: every model there is, on random G-buffers.
#pragma once

#include "host/gbuffer/frame.h"
#include "host/gbuffer/random_gbuffer.h"

#include <cstdint>
#include <string>
#include <vector>

namespace clshade::cli {

/// One random G-buffer of the suite with one material.
struct SuiteCase {
    StackShape shape;
    std::string preset; ///< the material is this preset, whatever the shape; empty: a random one of the shape
    std::string label;  ///< tells cases with the same stack apart: "skin", "random3"; often empty
};

/// Every lobe with every diffuse model that makes sense, single layers with exact Fresnel, stacks of two layers with
/// every model of Fresnel and absorption, deeper stacks, random stacks drawn from `seed`, and every preset.
[[nodiscard]] std::vector<SuiteCase> check_suite(std::uint64_t seed);

/// The G-buffer of a case. The same seed gives the same bytes.
[[nodiscard]] Frame frame_of(const SuiteCase& suite_case, int width, int height, std::uint64_t seed);

/// Name of the case in reports, unique in a suite: the material's model_key, "KEY@LABEL" for a case with a label.
[[nodiscard]] std::string name_of(const SuiteCase& suite_case, const Frame& frame);

/// Name of the case's layers in --dump: the label, or the model_key without one. Shorter than name_of, since channel
/// names have at most 255 characters.
[[nodiscard]] std::string layer_of(const SuiteCase& suite_case, const Frame& frame);

} // namespace clshade::cli
