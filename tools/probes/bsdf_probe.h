// SPDX-License-Identifier: Apache-2.0
// Evaluates and samples the kernels' BSDF over arrays of local directions, for one set of lobes at a time.
#pragma once

#include "kernels/shared/scene_types.h"
#include "probes/kernel_probe.h"
#include "probes/merl_file.h"
#include "probes/random_inputs.h"
#include "scene/scene.h"

#include <memory>
#include <string>
#include <vector>

namespace clrt {

/// What a BSDF is made of; eta is the index on wo's side over the index on the other.
struct LobeSet {
    std::string name;
    u32 lobes = 0;
    glm::dvec3 matte{0}, specular{0}, transmission{0};
    double alpha_x = 0, alpha_y = 0, eta = 1;
    u32 fresnel = FRESNEL_NONE;
    bool is_importance = false; ///< carried; else radiance
    double glass = 0; ///< weight of the glass beside other lobes; matte and transmission have it inside
    double coat = 0, coat_alpha = 1;
    glm::dvec3 sheen{0};
    double sheen_alpha = 1;
    bool is_inside = false;                  ///< of glass with a coat or a sheen: wo is below it
    std::shared_ptr<const Scene> measured{}; ///< of LOBE_MEASURED: its first BRDF
    bool has_textbook = true;                ///< tests/support/bsdf_reference.h knows it

    /// The index ratio across, and from the other side.
    double crossed_eta() const { return lobes & LOBE_PANE ? 1 : eta; }
    LobeSet from_other_side() const;
};

/// All lobe sets that material rules make: matte, glossy with and without Fresnel, mirrors, dielectrics from
/// both sides.
std::vector<LobeSet> all_lobe_sets();

/// The lobe of a measured BRDF, by way of a file of its own.
LobeSet measured_set(const std::string& name, const BrdfFunction& brdf, const MerlCounts& counts);

/// The set of that name among all_lobe_sets().
LobeSet lobe_set(const std::string& name);

struct BsdfValues {
    std::vector<glm::dvec3> value; ///< BSDF times |cos_i|
    std::vector<double> pdf_w, pdf_w_reverse;
};

struct BsdfSamples {
    std::vector<glm::dvec3> wi, weight;
    std::vector<double> pdf_w, eta; ///< eta 0: no direction was found

    /// The directions that were found.
    std::vector<glm::dvec3> found() const;
};

/// What rough facets lose of light from a direction and what Schlick's part of them reflects, and the means
/// over all directions (scattering/albedo.h). Of dielectrics only the losses, on the direction's side.
struct AlbedoSample {
    double loss, schlick, mean_loss, mean_schlick;
};

/// The program; its surface is tilted, so that frames take part. Directions are local, z is the normal.
class BsdfProbe {
public:
    explicit BsdfProbe(const ProbeDevice& device, const ProbeOptions& options = {});

    /// `normal_g`: the geometric normal, local.
    BsdfValues eval(const LobeSet& set, const std::vector<glm::dvec3>& wo, const std::vector<glm::dvec3>& wi,
                    const glm::dvec3& normal_g = {0, 0, 1});
    /// `u`: the number that chooses the lobe and the two that choose the direction.
    BsdfSamples sample(const LobeSet& set, const std::vector<glm::dvec3>& wo,
                       const std::vector<glm::dvec3>& u, const glm::dvec3& normal_g = {0, 0, 1});
    /// By the kernels' tables; for the roughness of a set.
    std::vector<AlbedoSample> albedos(const LobeSet& set, const std::vector<glm::dvec3>& w);
    /// True if connecting such a BSDF to a light can succeed.
    bool has_smooth_lobe(const LobeSet& set);

    const KernelProbe& probe() const { return probe_; }

private:
    Kernel prepare(const char* name, const LobeSet& set, const std::vector<glm::dvec3>& a,
                   const std::vector<glm::dvec3>& b, const glm::dvec3& normal_g);
    const ProbeDevice& device_;
    KernelProbe probe_;
};

/// `count` directions of one cosine and azimuth, in float.
std::vector<glm::dvec3> repeated(const glm::dvec3& value, size_t count);

/// Triples of independent numbers of the sampler's lattice.
std::vector<glm::dvec3> random_triples(size_t count, u32 seed);

} // namespace clrt
