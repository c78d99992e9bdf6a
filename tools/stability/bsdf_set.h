// SPDX-License-Identifier: Apache-2.0
// The BSDFs of all lobe sets as probed expressions, so that cases go through them in every build.
#pragma once

#include "probes/bsdf_probe.h"
#include "stability/probe_set.h"

#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace clrt {

/// Directions and random numbers for one BSDF after another.
struct BsdfInputs {
    Columns columns = Columns(8);

    size_t size() const { return columns[0].size(); }
    /// `set`: index into all_lobe_sets(); `alpha` replaces its roughness unless 0. `rest`: wi for eval, the
    /// numbers for lobe and direction for sample.
    void add(size_t set, double alpha, const glm::dvec3& wo, const glm::dvec3& rest);
    /// One line for the worst input.
    std::string describe(size_t i) const;
};

/// The outputs of "eval": value (three), density.
enum BsdfEval { EVAL_VALUE = 0, EVAL_PDF = 3 };
/// The outputs of "sample": direction, weight, density, relative index or 0 where none was found; what eval
/// says of the direction.
enum BsdfSampled {
    SAMPLED_WI = 0,
    SAMPLED_WEIGHT = 3,
    SAMPLED_PDF = 6,
    SAMPLED_ETA = 7,
    SAMPLED_VALUE = 8,
    SAMPLED_EVAL_PDF = 11
};

/// "eval" and "sample" over BsdfInputs, in a frame that rounds nothing. One a device.
ProbeSet& bsdf_probes(const ProbeDevice& device);

/// The first of all_lobe_sets(), for which cases know what to expect: those with a textbook's formula.
std::vector<LobeSet> textbook_sets();

/// True for sets that light sampling can meet.
bool is_smooth(const LobeSet& set);

/// A direction of three outputs.
inline glm::dvec3 output_vector(const std::vector<std::vector<double>>& outputs, int first, size_t i) {
    return {outputs[size_t(first)][i], outputs[size_t(first) + 1][i], outputs[size_t(first) + 2][i]};
}

} // namespace clrt
