// SPDX-License-Identifier: Apache-2.0
// The cases that wait for an integrator, a light or a camera: a row here moves to its group when that is
// there.
#include "stability/catalogue.h"

namespace clrt {

const std::vector<WaitingCase>& waiting_cases() {
    constexpr const char* BIDIRECTIONAL = "a bidirectional integrator";
    constexpr const char* FROM_LIGHTS = "integrators that trace from lights";
    constexpr const char* METROPOLIS = "a Metropolis integrator";
    static const std::vector<WaitingCase> cases = {
        {"C05", "SunAsABall", "R = 6.96e8 at 1.5e11, a scene of size 1", "E = pi L (R / d)^2",
         "lights that are spheres, outside the frame of the triangles"},
        {"C07", "InstanceStress", "instances scaled by (1, 1e-3, 1e3), sheared, mirrored, singular",
         "the flattened mesh", "instances"},
        {"T07", "WaterInGlass", "coinciding, overlapping and parted boundaries",
         "products of Fresnel factors", "media that know what they lie in (a stack of priorities)"},
        {"F03", "Bidirectional", "every way to make a path of k scatterings", "Le kd^k",
         "bidirectional path tracing"},
        {"F08", "LightTracing", "the sum of splats", "the captured flux", "light tracing"},
        {"L05", "SphereLight", "R / d from 1e-6 to 0.999999, and from inside", "pi L (R / d)^2 cos",
         "lights that are spheres"},
        {"A05", "Splats", "1e8 equal splats on one pixel", "exact sum",
         "an integrator that splats: light tracing, bidirectional or Metropolis"},
        {"B02", "CoincidentVertices", "vertices to connect at the same place", "none; counted",
         BIDIRECTIONAL},
        {"B03", "IntegratorsAgree", "six scenes by path tracing, light tracing, bidirectional and Metropolis",
         "each other", FROM_LIGHTS},
        {"B04", "WeightsSumToOne", "all strategies of paths up to 20 vertices, densities 1e-30 to 1e30", "1",
         BIDIRECTIONAL},
        {"B05", "DeltaChains", "light through glass, mirror and glass; other windows and sizes",
         "the same mean", BIDIRECTIONAL},
        {"B06", "ShadingNormals", "smooth normals traced from lights", "path tracing", FROM_LIGHTS},
        {"M01", "BlackScene", "a scene whose bootstrap paths carry nothing", "black", METROPOLIS},
        {"M02", "RareLight", "light that one bootstrap path in a million finds, 256 seeds",
         "closed form of the brightness", METROPOLIS},
        {"M03", "StartUpBias", "a million chains of one mutation", "closed form", METROPOLIS},
        {"M04", "BadProposals", "one proposal in 1e4 infinite or NaN", "the run without them; counters",
         METROPOLIS},
        {"M05", "ConstantTarget", "a furnace, where all paths carry the same",
         "acceptance 1, exact brightness", METROPOLIS},
        {"M06", "SmallSteps", "1e9 small steps of a coordinate", "stays in [0, 1)", METROPOLIS},
    };
    return cases;
}

} // namespace clrt
