// SPDX-License-Identifier: Apache-2.0
// What the textbooks say of a set of lobes, in double precision: values, densities, albedos. The albedos of
// the first facet come from whoever asks; tests/kernel/albedo_test.cpp checks the tables that the kernels
// take them from.
#pragma once

#include "probes/bsdf_probe.h"

#include <cstddef>
#include <glm/vec3.hpp>

namespace clrt::reference {

struct BsdfReference {
    glm::dvec3 value{0}; ///< BSDF times |cos_i|
    double pdf_w = 0;    ///< of sampling it, per steradian
};

/// The colour of a reflection whose half vector meets the directions at this cosine.
glm::dvec3 reflection_color(const LobeSet& set, double cosine);

/// Colour of the light that meets more than one facet (Kulla and Conty 2017), by the mean loss.
glm::dvec3 multiple_color(const LobeSet& set, double mean_loss);

/// Whether the matte lobe gets what a reflection by Schlick's Fresnel leaves.
bool is_coupled(const LobeSet& set);

/// Albedo of the matte lobe beside the others; `o`: the first facet's, seen from the eye.
glm::dvec3 matte_albedo(const LobeSet& set, const AlbedoSample& o);

/// Sum of the lobes and density of the mixture between local directions; `o` and `i`: the first facet's
/// albedos towards them, `there`: the mean loss on the other side of a dielectric.
BsdfReference bsdf_eval(const LobeSet& set, const glm::dvec3& wo, const glm::dvec3& wi, const AlbedoSample& o,
                        const AlbedoSample& i, double there);

/// What the first facets of a lossless rough lobe send on, by quadrature over visible normals: F G2 / G1
/// where the reflection leaves above the surface, (1 - F) G2 / G1 where the refraction leaves below.
double first_facet_albedo(const LobeSet& set, const glm::dvec3& wo, size_t radii, size_t angles);

} // namespace clrt::reference
