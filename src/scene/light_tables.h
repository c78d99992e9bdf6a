// SPDX-License-Identifier: Apache-2.0
// What next-event estimation chooses lights by: power, or a mixture that no scene defeats.
#pragma once

#include "options/sampling_options.h"
#include "scene/scene.h"

#include <vector>

namespace clrt {

/// Probabilities of the kinds of light in next-event estimation; they add up to 1, or all are 0.
struct KindShares {
    double emitters = 0, environment = 0, lights = 0;
};

/// The part `even` evenly over the groups (their numbers, each below `group_count`) and by power within a
/// group, the rest in proportion to the powers: with a half, no light has less than half of what the better
/// of the two rules gives it. With a single group the powers alone. `powers` are positive.
std::vector<double> mixed_weights(const std::vector<double>& powers, const std::vector<u32>& groups,
                                  u32 group_count, double even = 0.5);

/// What portals let in; without them what the table of an environment map sends into the bounding sphere, and
/// 0 for a constant sky, which has none.
double environment_power(const Scene& scene);

/// Tabulates emissive triangles, and point lights with suns. LightSampler::MIXTURE: the groups are the
/// objects of the file, apart by material, and each point light and sun.
void tabulate_lights(LightSampler sampler, Scene& scene);

/// The same rule over the kinds of light that next-event estimation finds, by the luminance that each sends
/// into the bounding sphere: a scene's size in any unit changes no share. Of an environment map it counts
/// what the table stands for (SkySampling); a constant sky is left to BSDF sampling, which follows its only
/// feature, the cosine.
KindShares kind_shares(LightSampler sampler, const Scene& scene);

/// Radius of the sphere about the origin in which all triangles are, a ground too: what distant light must
/// meet. A little more than that, so that no rounding leaves a corner out.
double emission_radius(const Scene& scene);

/// Where light paths start.
struct EmissionPlan {
    /// Probabilities of the kinds of light: in proportion to the luminance that each sends into the sphere of
    /// emission_radius, or, where there are, into those of the casters.
    KindShares kinds;
    /// The part of all that light that meets the casters, at most 1, about; 1 where there are none. So many
    /// light paths for each pixel are as dense at the casters as one that is not aimed.
    double aimed = 1;
};

/// A constant sky counts where light paths must find all light; the hits of paths from the eye find its light
/// without noise. A background that only the camera sees is no light.
EmissionPlan plan_emission(const Scene& scene, bool must_find_all);

} // namespace clrt
