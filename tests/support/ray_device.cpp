// SPDX-License-Identifier: Apache-2.0
#include "support/ray_device.h"

#include "support/meshes.h"
#include "support/random_inputs.h"

#include <cassert>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <memory>
#include <tuple>

namespace clrt {

namespace {

constexpr size_t MOST_LAYERS = 16;

const char* const KERNELS = R"(
typedef struct {
    real t, b1, b2;
    u32 triangle;
} TracedHit;

static Ray load_ray(global const float4* rays, size_t i)
{
    Ray ray = ray_make(vector_from(rays[2 * i]), vector_from(rays[2 * i + 1]));
    ray.t_max = rays[2 * i].w;
    return ray;
}

static void store_hit(global TracedHit* hits, size_t i, const Hit* hit)
{
    hits[i].t = hit->t;
    hits[i].b1 = hit->b1;
    hits[i].b2 = hit->b2;
    hits[i].triangle = hit->triangle;
}

static Surface load_surface(const Scene* scene, global const float4* rays, global const TracedHit* hits, size_t i)
{
    Hit hit = {hits[i].t, hits[i].b1, hits[i].b2, hits[i].triangle};
    return surface_at(scene, &hit, -vector_from(rays[2 * i + 1]));
}

kernel void trace_closest(const RenderParams params, SCENE_PARAMS, global const float4* restrict rays, const u32 count,
                          global TracedHit* restrict out)
{
    const size_t i = get_global_id(0);
    if (i >= count)
        return;
    const Scene scene = SCENE_MAKE;
    const Ray ray = load_ray(rays, i);
    const Hit after = hit_none(REAL(0.0));
    const Hit hit = scene_closest_hit(&scene, &params, &ray, &after);
    store_hit(out, i, &hit);
}

kernel void trace_all(const RenderParams params, SCENE_PARAMS, global const float4* restrict rays, const u32 count,
                      global TracedHit* restrict out)
{
    const size_t i = get_global_id(0);
    if (i >= count)
        return;
    const Scene scene = SCENE_MAKE;
    const Ray ray = load_ray(rays, i);
    Hit hit = hit_none(ray.t_max);
    if (ray_is_valid(&ray)) {
        const RayShear shear = ray_shear_make(&ray);
        for (u32 k = 0; k < params.width; ++k) {
            real3 p[3];
            surface_corners(&scene, &scene.triangles[k], &p[0], &p[1], &p[2]);
            real x[3], y[3], z[3], u, v, w, det, t_det;
            for (int corner = 0; corner < 3; ++corner) {
                x[corner] = ray_component(p[corner], shear.kx);
                y[corner] = ray_component(p[corner], shear.ky);
                z[corner] = ray_component(p[corner], shear.kz);
            }
            triangle_edges(&shear, x, y, z, &u, &v, &w, &det, &t_det);
            const bool inside =
                (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
            if (!inside || det == 0)
                continue;
            const real t = t_det / det;
            if (t > 0 && hit_is_before(t, k, hit.t, hit.triangle)) {
                hit.t = t;
                hit.b1 = v / det;
                hit.b2 = w / det;
                hit.triangle = k;
            }
        }
    }
    store_hit(out, i, &hit);
}

kernel void trace_any(const RenderParams params, SCENE_PARAMS, global const float4* restrict rays, const u32 count,
                      global u32* restrict out)
{
    const size_t i = get_global_id(0);
    if (i >= count)
        return;
    const Scene scene = SCENE_MAKE;
    const Ray ray = load_ray(rays, i);
    out[i] = scene_any_hit(&scene, &params, &ray) ? 1u : 0u;
}

kernel void trace_layers(const RenderParams params, SCENE_PARAMS, global const float4* restrict rays, const u32 count,
                         global u32* restrict out)
{
    const size_t i = get_global_id(0);
    if (i >= count)
        return;
    const Scene scene = SCENE_MAKE;
    const Ray ray = load_ray(rays, i);
    Hit hit = hit_none(REAL(0.0));
    for (u32 layer = 0; layer < MOST_LAYERS; ++layer) {
        const Hit after = hit;
        hit = scene_closest_hit(&scene, &params, &ray, &after);
        out[i * MOST_LAYERS + layer] = hit.triangle;
        if (hit.triangle == NO_INDEX)
            break;
    }
}

kernel void trace_visible(const RenderParams params, SCENE_PARAMS, global const float4* restrict rays, const u32 count,
                          global u32* restrict out)
{
    const size_t i = get_global_id(0);
    if (i >= count)
        return;
    const Scene scene = SCENE_MAKE;
    const Ray ray = load_ray(rays, i);
    const Sampler sampler = sampler_make(1u, (u32)i, 0u, 0u);
    out[i] = visible_hit(&scene, &params, &sampler, 0u, &ray).triangle;
}

kernel void trace_share(const RenderParams params, SCENE_PARAMS, global const float4* restrict rays, const u32 count,
                        global float* restrict out)
{
    const size_t i = get_global_id(0);
    if (i >= count)
        return;
    const Scene scene = SCENE_MAKE;
    const Ray ray = load_ray(rays, i);
    out[i] = (float)visible_share(&scene, &params, &ray);
}

kernel void surface_leave(SCENE_PARAMS, global const float4* restrict rays, global const TracedHit* restrict hits,
                          const u32 count, global float4* restrict in_out)
{
    const size_t i = get_global_id(0);
    if (i >= count)
        return;
    const Scene scene = SCENE_MAKE;
    const Surface surface = load_surface(&scene, rays, hits, i);
    const real3 origin = surface_origin(&surface, vector_from(in_out[i]));
    in_out[i] = (float4)((float)origin.x, (float)origin.y, (float)origin.z, 0.0f);
}

kernel void surface_normal(SCENE_PARAMS, global const float4* restrict rays, global const TracedHit* restrict hits,
                           const u32 count, global float4* restrict in_out)
{
    const size_t i = get_global_id(0);
    if (i >= count)
        return;
    const Scene scene = SCENE_MAKE;
    const Surface surface = load_surface(&scene, rays, hits, i);
    const real3 n = surface.normal_g;
    in_out[i] = (float4)((float)n.x, (float)n.y, (float)n.z, (float)surface.offset);
}
)";

/// TracedHit as the host lays it out.
struct FloatHit {
    float t, b1, b2;
    u32 triangle;
};
struct DoubleHit {
    double t, b1, b2;
    u32 triangle, padding;
};

KernelProbe& ray_probe(BvhLayout layout, Precision precision, u32 effects) {
    // Never freed, like the test device that they refer to.
    static auto* const probes =
        new std::map<std::tuple<BvhLayout, Precision, u32>, std::unique_ptr<KernelProbe>>;
    std::unique_ptr<KernelProbe>& probe = (*probes)[{layout, precision, effects}];
    if (!probe) {
        ProbeOptions options;
        options.precision = precision;
        options.defines = {fmt::format("BVH_LAYOUT={}", int(layout)),
                           fmt::format("CLRT_EFFECTS={:#x}u", effects),
                           fmt::format("MOST_LAYERS={}u", MOST_LAYERS)};
        probe = std::make_unique<KernelProbe>(
            test_device(), std::vector<std::string>{"geometry/visibility.h", "geometry/surface.h"}, options,
            kernels_under_test());
        probe->add_text(KERNELS);
    }
    return *probe;
}

} // namespace

KernelFiles kernels_under_test() {
    const char* const folder = std::getenv("CLRT_TEST_KERNELS");
    return folder ? read_kernel_files(folder) : embedded_kernel_files();
}

TestRay make_ray(const glm::dvec3& origin, const glm::dvec3& direction, float t_max) {
    const glm::dvec3 d = glm::normalize(direction);
    return {{float(origin.x), float(origin.y), float(origin.z), t_max},
            {float(d.x), float(d.y), float(d.z), 0}};
}

TestRay make_ray_to(const glm::dvec3& origin, const glm::dvec3& target) {
    return make_ray(origin, target - to_dvec3(to_vec4(origin)));
}

bool operator==(const TestHit& a, const TestHit& b) {
    return std::memcmp(&a.t, &b.t, sizeof a.t) == 0 && std::memcmp(&a.b1, &b.b1, sizeof a.b1) == 0 &&
           std::memcmp(&a.b2, &b.b2, sizeof a.b2) == 0 && a.triangle == b.triangle;
}

const char* layout_name(BvhLayout layout) {
    return layout == BvhLayout::BVH8 ? "bvh8" : "bvh2";
}

RayDevice::RayDevice(const Scene& scene, BvhLayout layout, Precision precision, u32 effects, BvhQuality quality)
    : RayDevice(scene, layout, precision, effects, extent_of(scene), quality) {}

RayDevice::RayDevice(const Scene& scene, BvhLayout layout, Precision precision, u32 effects, float extent,
                     BvhQuality quality)
    : probe_(ray_probe(layout, precision, effects)), precision_(precision),
      bvh_(build_bvh(scene.positions, scene.triangles, layout, quality)),
      buffers_(upload_scene(test_device(), scene, bvh_)) {
    params_.scene_extent = extent;
    params_.width = static_cast<u32>(scene.triangles.size()); // how many trace_all tests
}

template <class Out>
std::vector<Out> RayDevice::trace(const std::string& name, const std::vector<TestRay>& rays,
                                  size_t per_ray) const {
    const size_t count = rays.size() * per_ray;
    const cl::Buffer out = create_buffer(test_device(), "traced", count * sizeof(Out));
    Kernel kernel = probe_.kernel(name);
    bind_scene(buffers_, kernel);
    kernel.set("params", params_);
    kernel.set("rays", probe_.upload(rays));
    kernel.set("count", static_cast<u32>(rays.size()));
    kernel.set("out", out);
    probe_.launch(kernel, rays.size());
    return probe_.read<Out>(out, count);
}

std::vector<TestHit> RayDevice::trace_hits(const std::string& name, const std::vector<TestRay>& rays) const {
    std::vector<TestHit> hits;
    hits.reserve(rays.size());
    if (precision_ == Precision::DOUBLE)
        for (const DoubleHit& hit : trace<DoubleHit>(name, rays))
            hits.push_back({hit.t, hit.b1, hit.b2, hit.triangle});
    else
        for (const FloatHit& hit : trace<FloatHit>(name, rays))
            hits.push_back({hit.t, hit.b1, hit.b2, hit.triangle});
    return hits;
}

std::vector<TestHit> RayDevice::closest(const std::vector<TestRay>& rays) const {
    return trace_hits("trace_closest", rays);
}

std::vector<TestHit> RayDevice::closest_of_all(const std::vector<TestRay>& rays) const {
    return trace_hits("trace_all", rays);
}

std::vector<u32> RayDevice::any(const std::vector<TestRay>& rays) const {
    return trace<u32>("trace_any", rays);
}

std::vector<vec4> RayDevice::at_surfaces(const std::string& name, const std::vector<TestRay>& rays,
                                         const std::vector<TestHit>& hits,
                                         const std::vector<vec4>& in) const {
    assert(precision_ == Precision::SINGLE && hits.size() == rays.size() && in.size() == rays.size());
    std::vector<FloatHit> float_hits;
    float_hits.reserve(hits.size());
    for (const TestHit& hit : hits) {
        assert(hit.triangle != NO_INDEX);
        float_hits.push_back({float(hit.t), float(hit.b1), float(hit.b2), hit.triangle});
    }
    const cl::Buffer in_out = create_buffer(test_device(), "surfaces", in.size() * sizeof(vec4));
    check_opencl("filling a buffer", [&] {
        if (!in.empty())
            test_device().queue.enqueueWriteBuffer(in_out, CL_TRUE, 0, in.size() * sizeof(vec4), in.data());
    });
    Kernel kernel = probe_.kernel(name);
    bind_scene(buffers_, kernel);
    kernel.set("rays", probe_.upload(rays));
    kernel.set("hits", probe_.upload(float_hits));
    kernel.set("count", static_cast<u32>(rays.size()));
    kernel.set("in_out", in_out);
    probe_.launch(kernel, rays.size());
    return probe_.read<vec4>(in_out, in.size());
}

std::vector<TestRay> RayDevice::leaving(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits,
                                        const std::vector<glm::dvec3>& directions) const {
    std::vector<vec4> wanted;
    wanted.reserve(directions.size());
    for (const glm::dvec3& direction : directions)
        wanted.push_back(make_ray(glm::dvec3(0), direction).direction);
    const std::vector<vec4> origins = at_surfaces("surface_leave", rays, hits, wanted);
    std::vector<TestRay> result(rays.size());
    for (size_t i = 0; i < result.size(); ++i)
        result[i] = {{origins[i].x, origins[i].y, origins[i].z, FAR_AWAY}, wanted[i]};
    return result;
}

std::vector<vec4> RayDevice::normals(const std::vector<TestRay>& rays,
                                     const std::vector<TestHit>& hits) const {
    return at_surfaces("surface_normal", rays, hits, std::vector<vec4>(rays.size()));
}

std::vector<std::vector<u32>> RayDevice::layers(const std::vector<TestRay>& rays) const {
    const std::vector<u32> words = trace<u32>("trace_layers", rays, MOST_LAYERS);
    std::vector<std::vector<u32>> result(rays.size());
    for (size_t i = 0; i < rays.size(); ++i)
        for (size_t layer = 0; layer < MOST_LAYERS && words[i * MOST_LAYERS + layer] != NO_INDEX; ++layer)
            result[i].push_back(words[i * MOST_LAYERS + layer]);
    return result;
}

std::vector<u32> RayDevice::visible(const std::vector<TestRay>& rays) const {
    return trace<u32>("trace_visible", rays);
}

std::vector<float> RayDevice::shares(const std::vector<TestRay>& rays) const {
    return trace<float>("trace_share", rays);
}

} // namespace clrt
