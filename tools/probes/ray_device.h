// SPDX-License-Identifier: Apache-2.0
// Traces arrays of rays through a scene on the test device by the renderer's own functions, in a given
// layout.
#pragma once

#include "bvh/bvh.h"
#include "kernels/shared/render_types.h"
#include "options/options.h"
#include "probes/kernel_probe.h"
#include "render/scene_buffers.h"
#include "scene/scene.h"

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// "Unbounded": REAL_FAR of kernels/numerics/real.h.
constexpr float FAR_AWAY = 1e18f;

/// A ray as the kernels read it, in every precision.
struct TestRay {
    vec4 origin;    ///< w: t_max
    vec4 direction; ///< w: 0
};

/// Rounds to float; the direction is made unit first.
TestRay make_ray(const glm::dvec3& origin, const glm::dvec3& direction, float t_max = FAR_AWAY);

/// The ray from one point towards another, unbounded.
TestRay make_ray_to(const glm::dvec3& origin, const glm::dvec3& target);

/// A hit; floats are widened, so that equal bits stay equal bits.
struct TestHit {
    double t, b1, b2;
    u32 triangle;     ///< NO_INDEX: a miss
    u32 instance = 0; ///< whose triangle it is; 0: the scene's own, or a miss
};

/// Bit for bit equality, where -0 differs from 0.
bool operator==(const TestHit& a, const TestHit& b);
inline bool operator!=(const TestHit& a, const TestHit& b) {
    return !(a == b);
}

/// Other kernel files than the device's; the name tells them apart.
struct KernelVariant {
    std::string name;
    KernelFiles files;
};

/// What may be chosen about the tree and the programs.
struct RayDeviceOptions {
    BvhLayout layout = BvhLayout::BVH8;
    BvhQuality quality = BvhQuality::FAST;
    Precision precision = Precision::SINGLE;
    EffectMask effects = 0;
    std::vector<std::string> defines = {};
    std::optional<float> extent =
        {}; ///< the scene's, where `extent_of` would meet coordinates that are not finite
    const KernelVariant* variant = nullptr; ///< nullptr: the device's kernels
};

/// The program of these options, one a device. What RayDevice runs, and what a test may compile for other
/// devices.
KernelProbe& ray_probe(const ProbeDevice& device, const RayDeviceOptions& options);

/// What RayDevice::lights_seen gives.
constexpr u32 NO_LIGHT = 0, LIGHT_SEEN = 1, LIGHT_HIDDEN = 2;

/// The point of a surface and its offset bound.
struct TestPoint {
    glm::dvec3 position;
    double offset;
};

/// A scene on a device. Its programs are built once a device for each layout, precision, mask and set of
/// defines ("NAME=value").
class RayDevice {
public:
    RayDevice(const ProbeDevice& device, const Scene& scene, const RayDeviceOptions& options);
    RayDevice(const ProbeDevice& device, const Scene& scene, BvhLayout layout,
              Precision precision = Precision::SINGLE, EffectMask effects = 0);

    /// scene_closest_hit for every ray.
    std::vector<TestHit> closest(const std::vector<TestRay>& rays) const;

    /// The same by testing all triangles of the scene with triangle_edges, without a tree.
    std::vector<TestHit> closest_of_all(const std::vector<TestRay>& rays) const;

    /// scene_any_hit for every ray: 1 or 0.
    std::vector<u32> any(const std::vector<TestRay>& rays) const;

    /// Rays that leave the surfaces at `hits` of `rays` in the given directions (surface_at, surface_origin).
    /// Every hit must be one; origins are rounded to float.
    std::vector<TestRay> leaving(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits,
                                 const std::vector<glm::dvec3>& directions) const;

    /// The unit geometric normal of surface_at for every hit (x, y, z) and the offset bound (w), rounded to
    /// float.
    std::vector<vec4> normals(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits) const;

    /// 1 where a ray meets its surface from the front, else 0.
    std::vector<u32> fronts(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits) const;

    /// The position of surface_at for every hit, in the kernels' precision.
    std::vector<TestPoint> points(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits) const;

    /// For every hit, whether the point of the emitters that the numbers in `numbers` (x, y in [0, 1)) choose
    /// is seen.
    std::vector<u32> lights_seen(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits,
                                 const std::vector<vec4>& numbers) const;

    /// Computes at every call, without copying anything, the surfaces at the hits and where rays back along
    /// their way leave them: to be timed.
    std::function<void()> leaver(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits) const;

    /// Traces the rays by scene_closest_hit at every call, without copying anything: to be timed.
    std::function<void()> tracer(const std::vector<TestRay>& rays) const;

    /// All hits along every ray, found one after the other with the `after` of scene_closest_hit; at most 16.
    /// Needs EFFECT_CUT_OUT.
    std::vector<std::vector<u32>> layers(const std::vector<TestRay>& rays) const;

    /// The triangles that visible_hit finds, each ray with random numbers of its own.
    std::vector<u32> visible(const std::vector<TestRay>& rays) const;

    /// visible_share of every ray.
    std::vector<float> shares(const std::vector<TestRay>& rays) const;

    const Bvh& bvh() const { return bvh_; }

private:
    Kernel make_kernel(const std::string& name, const std::vector<TestRay>& rays,
                       const cl::Buffer& out) const;
    template <class Out>
    std::vector<Out> trace(const std::string& kernel, const std::vector<TestRay>& rays,
                           size_t per_ray = 1) const;
    std::vector<TestHit> trace_hits(const std::string& kernel, const std::vector<TestRay>& rays) const;
    Kernel make_surface_kernel(const std::string& name, const std::vector<TestRay>& rays,
                               const std::vector<TestHit>& hits, const std::vector<vec4>& in,
                               const cl::Buffer& out) const;
    template <class Out>
    std::vector<Out> at_surfaces(const std::string& kernel, const std::vector<TestRay>& rays,
                                 const std::vector<TestHit>& hits, const std::vector<vec4>& in) const;

    const ProbeDevice& device_;
    KernelProbe& probe_;
    Precision precision_;
    Bvh bvh_;
    SceneBuffers buffers_;
    RenderParams params_{};
};

} // namespace clrt
