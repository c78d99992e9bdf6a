// SPDX-License-Identifier: Apache-2.0
// Single light paths of a scene: the integrators' own functions, sample by sample, without camera and film,
// whose rounding would hide the last digits.
#pragma once

#include "probes/ray_device.h"
#include "probes/scratch_scene.h"
#include "render/prepared_scene.h"
#include "stability/stability_case.h"

#include <glm/vec3.hpp>
#include <vector>

namespace clrt {

/// The program of a build, one a device.
KernelProbe& path_probe(const ProbeDevice& device, Build build);

/// A scene on the device in every build but naive; the programs are made once a device.
class PathProbe {
public:
    /// Loads the scene; its camera is not used. Its options give depth, roulette and seed.
    PathProbe(const ProbeDevice& device, const ScratchScene& scene)
        : PathProbe(device, scene.load(), scene.options) {}
    PathProbe(const ProbeDevice& device, Scene scene, Options options);

    /// What the integrators get; a case may change it.
    RenderParams params{};
    const Scene& scene() const { return prepared_.planned->scene; }

    /// The ray from one point towards another, both in the scene's units.
    TestRay ray(const glm::dvec3& origin, const glm::dvec3& at) const;

    /// The radiance along each ray, `samples` of them one after the other.
    std::vector<glm::dvec3> radiance(Build build, Integrator integrator, const std::vector<TestRay>& rays,
                                     size_t samples = 1) const;

private:
    const ProbeDevice& device_;
    PreparedScene prepared_;
};

/// The builds that PathProbe has: single and double. FAST is left out: it would cost the seconds of a program
/// to show what the arithmetic cases show.
std::vector<Build> path_builds(const CaseRun& run);

} // namespace clrt
