// SPDX-License-Identifier: Apache-2.0
#include "probes/ray_device.h"

#include "probes/meshes.h"
#include "probes/random_inputs.h"

#include <cassert>
#include <cstring>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace clrt {

namespace {

constexpr size_t MOST_LAYERS = 16;

const char* const FUNCTIONS = R"(
typedef struct {
    real t, b1, b2;
    u32 triangle, instance;
} TracedHit;

typedef struct {
    real x, y, z, offset;
} TracedPoint;

static Ray load_ray(global const float4* rays, size_t i)
{
    Ray ray = ray_make(vector_from(rays[2 * i]), vector_from(rays[2 * i + 1]), REAL(0.0));
    ray.t_max = rays[2 * i].w;
    return ray;
}

static TracedHit traced_hit(const Hit* hit)
{
    const u32 instance = hit->triangle == NO_INDEX ? 0u : hit_instance(hit);
    const TracedHit traced = {hit->t, hit->b1, hit->b2, hit->triangle, instance};
    return traced;
}

static Hit closest_of_all(const Scene* scene, const RenderParams* params, const Ray* ray)
{
    Hit hit = hit_none(ray->t_max);
    if (!ray_is_valid(ray))
        return hit;
    const RayShear shear = ray_shear_make(ray);
    for (u32 k = 0; k < params->width; ++k) {
        real3 p[3];
        surface_corners(scene, &scene->triangles[k], &p[0], &p[1], &p[2]);
        real x[3], y[3], z[3], u, v, w, det, t_det;
        for (int corner = 0; corner < 3; ++corner) {
            const real3 permuted = ray_permuted(p[corner], shear.kz);
            x[corner] = permuted.x;
            y[corner] = permuted.y;
            z[corner] = permuted.z;
        }
        triangle_edges(&shear, x, y, z, &u, &v, &w, &det, &t_det);
        const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
        if (!inside || det == 0)
            continue;
        const real t = t_det / det;
        if (t > 0 && hit_comes_before(t, 0u, k, &hit)) {
            hit.t = t;
            hit.b1 = v / det;
            hit.b2 = w / det;
            hit_set_triangle(0u, k, &hit);
        }
    }
    return hit;
}

static Surface load_surface(const Scene* scene, const Ray* ray, const TracedHit* traced)
{
    Hit hit = hit_none(traced->t);
    hit.b1 = traced->b1;
    hit.b2 = traced->b2;
    hit_set_triangle(traced->instance, traced->triangle, &hit);
    return surface_at(scene, &hit, ray);
}
)";

/// An entry point that takes one ray a work-item: `out` is an array of its results of type `out_type`.
struct EntryPoint {
    const char* name;
    const char* out_type;
    const char* more_parameters; ///< between the number of rays and `out`
    const char* body;            ///< reads scene, params, ray and i, writes out
};

const char* const SURFACE_PARAMETERS =
    "global const TracedHit* restrict hits, global const float4* restrict in, ";

const EntryPoint ENTRY_POINTS[] = {
    {"trace_closest", "TracedHit", "", R"(
    const Hit after = hit_none(REAL(0.0));
    const Hit hit = scene_closest_hit(&scene, &params, &ray, &after);
    out[i] = traced_hit(&hit);)"},
    {"trace_all", "TracedHit", "", R"(
    const Hit hit = closest_of_all(&scene, &params, &ray);
    out[i] = traced_hit(&hit);)"},
    {"trace_any", "u32", "", R"(
    out[i] = scene_any_hit(&scene, &params, &ray) ? 1u : 0u;)"},
    {"trace_layers", "u32", "", R"(
    Hit hit = hit_none(REAL(0.0));
    for (u32 layer = 0; layer < MOST_LAYERS; ++layer) {
        const Hit after = hit;
        hit = scene_closest_hit(&scene, &params, &ray, &after);
        out[i * MOST_LAYERS + layer] = hit.triangle;
        if (hit.triangle == NO_INDEX)
            break;
    })"},
    {"trace_visible", "u32", "", R"(
    const Sampler sampler = sampler_make(1u, (u32)i, 0u, 0u);
    out[i] = visible_hit(&scene, &params, &sampler, 0u, &ray, 0).triangle;)"},
    {"trace_share", "float", "", R"(
    out[i] = (float)visible_share(&scene, &params, &ray).x;)"},
    {"surface_leave", "float4", SURFACE_PARAMETERS, R"(
    const TracedHit traced = hits[i];
    const Surface surface = load_surface(&scene, &ray, &traced);
    const real3 w = vector_from(in[i]);
    const real3 origin = surface_origin(&surface, surface_reflects(&surface, w), w);
    out[i] = (float4)((float)origin.x, (float)origin.y, (float)origin.z, 0.0f);)"},
    {"surface_normal", "float4", SURFACE_PARAMETERS, R"(
    const TracedHit traced = hits[i];
    const Surface surface = load_surface(&scene, &ray, &traced);
    const real3 n = surface.normal_g;
    out[i] = (float4)((float)n.x, (float)n.y, (float)n.z, (float)surface.offset);)"},
    {"surface_front", "u32", SURFACE_PARAMETERS, R"(
    const TracedHit traced = hits[i];
    out[i] = load_surface(&scene, &ray, &traced).front ? 1u : 0u;)"},
    {"surface_light", "u32", SURFACE_PARAMETERS, R"(
    const TracedHit traced = hits[i];
    const Surface surface = load_surface(&scene, &ray, &traced);
    const u32 word = (u32)(in[i].x * 16777216.0f) << 8;
    const LightSample light = emitter_sample(&scene, &params, surface.position, word, 0u, (real)in[i].y);
    const Ray shadow = light_shadow_ray(&surface, &light);
    out[i] = light.pdf_w == REAL(0.0) ? 0u : scene_any_hit(&scene, &params, &shadow) ? 2u : 1u;)"},
    {"surface_point", "TracedPoint", SURFACE_PARAMETERS, R"(
    const TracedHit traced = hits[i];
    const Surface surface = load_surface(&scene, &ray, &traced);
    const TracedPoint point = {surface.position.x, surface.position.y, surface.position.z, surface.offset};
    out[i] = point;)"},
};

/// The functions, and all entry points between the same beginning and end.
std::string kernel_text() {
    std::string text = FUNCTIONS;
    for (const EntryPoint& entry : ENTRY_POINTS)
        text += fmt::format(R"(
CLRT_KERNEL void {}(const RenderParams params, SCENE_PARAMS, global const float4* restrict rays, const u32 count,
               {}global {}* restrict out)
{{
    const size_t i = get_global_id(0);
    if (i >= count)
        return;
    const Scene scene = SCENE_MAKE;
    Ray ray = load_ray(rays, i);{}
}}
)",
                            entry.name, entry.more_parameters, entry.out_type, entry.body);
    return text;
}

/// TracedHit as the host lays it out.
template <class Number>
struct NumberHit {
    Number t, b1, b2;
    u32 triangle, instance;
};
template <class Number>
struct NumberPoint {
    Number x, y, z, offset;
};

} // namespace

KernelProbe& ray_probe(const ProbeDevice& device, const RayDeviceOptions& chosen) {
    const std::string key =
        fmt::format("rays: {} {} {:#x} {} {}", int(chosen.layout), int(chosen.precision), chosen.effects,
                    fmt::join(chosen.defines, " "), chosen.variant ? chosen.variant->name : "");
    return device.once<KernelProbe>(key, [&] {
        ProbeOptions options;
        options.precision = chosen.precision;
        options.defines = chosen.defines;
        options.defines.push_back(fmt::format("BVH_LAYOUT={}", int(chosen.layout)));
        options.defines.push_back(fmt::format("CLRT_EFFECTS={:#x}u", chosen.effects));
        options.defines.push_back(fmt::format("MOST_LAYERS={}u", MOST_LAYERS));
        KernelProbe probe(device, {"path/visibility.h", "lights/emitter.h"}, options,
                          chosen.variant ? chosen.variant->files : device.kernels());
        probe.add_text(kernel_text());
        return probe;
    });
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
           std::memcmp(&a.b2, &b.b2, sizeof a.b2) == 0 && a.triangle == b.triangle &&
           a.instance == b.instance;
}

RayDevice::RayDevice(const ProbeDevice& device, const Scene& scene, BvhLayout layout, Precision precision,
                     EffectMask effects)
    : RayDevice(device, scene,
                RayDeviceOptions{layout, BvhQuality::FAST, precision, effects, {}, {}, nullptr}) {}

RayDevice::RayDevice(const ProbeDevice& device, const Scene& scene, const RayDeviceOptions& options)
    : device_(device), probe_(ray_probe(device, options)), precision_(options.precision),
      bvh_(build_instanced_bvh(scene.positions, scene.triangles, scene.prototypes, scene.instances,
                               options.layout, options.quality)),
      buffers_(upload_scene(device_, scene, bvh_)) {
    params_.scene_extent = options.extent ? *options.extent : extent_of(scene);
    params_.emitter_count = static_cast<u32>(scene.emitters.size());
    // How many trace_all tests.
    params_.width = static_cast<u32>(own_triangle_count(scene.triangles, scene.prototypes));
}

Kernel RayDevice::make_kernel(const std::string& name, const std::vector<TestRay>& rays,
                              const cl::Buffer& out) const {
    Kernel kernel = probe_.kernel(name);
    bind_scene(buffers_, kernel);
    kernel.set("params", params_);
    kernel.set("rays", probe_.upload(rays));
    kernel.set("count", static_cast<u32>(rays.size()));
    kernel.set("out", out);
    return kernel;
}

template <class Out>
std::vector<Out> RayDevice::trace(const std::string& name, const std::vector<TestRay>& rays,
                                  size_t per_ray) const {
    const size_t count = rays.size() * per_ray;
    const cl::Buffer out = create_buffer(device_, "traced", count * sizeof(Out));
    probe_.launch(make_kernel(name, rays, out), rays.size());
    return probe_.read<Out>(out, count);
}

std::vector<TestHit> RayDevice::trace_hits(const std::string& name, const std::vector<TestRay>& rays) const {
    std::vector<TestHit> hits;
    hits.reserve(rays.size());
    if (precision_ == Precision::DOUBLE)
        for (const auto& hit : trace<NumberHit<double>>(name, rays))
            hits.push_back({hit.t, hit.b1, hit.b2, hit.triangle, hit.instance});
    else
        for (const auto& hit : trace<NumberHit<float>>(name, rays))
            hits.push_back({hit.t, hit.b1, hit.b2, hit.triangle, hit.instance});
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

Kernel RayDevice::make_surface_kernel(const std::string& name, const std::vector<TestRay>& rays,
                                      const std::vector<TestHit>& hits, const std::vector<vec4>& in,
                                      const cl::Buffer& out) const {
    assert(hits.size() == rays.size() && in.size() == rays.size());
    std::vector<NumberHit<float>> float_hits;
    std::vector<NumberHit<double>> double_hits;
    for (const TestHit& hit : hits) {
        assert(hit.triangle != NO_INDEX);
        if (precision_ == Precision::DOUBLE)
            double_hits.push_back({hit.t, hit.b1, hit.b2, hit.triangle, hit.instance});
        else
            float_hits.push_back({float(hit.t), float(hit.b1), float(hit.b2), hit.triangle, hit.instance});
    }
    Kernel kernel = make_kernel(name, rays, out);
    kernel.set("hits",
               precision_ == Precision::DOUBLE ? probe_.upload(double_hits) : probe_.upload(float_hits));
    kernel.set("in", probe_.upload(in));
    return kernel;
}

template <class Out>
std::vector<Out> RayDevice::at_surfaces(const std::string& name, const std::vector<TestRay>& rays,
                                        const std::vector<TestHit>& hits, const std::vector<vec4>& in) const {
    const cl::Buffer out = create_buffer(device_, "surfaces", in.size() * sizeof(Out));
    probe_.launch(make_surface_kernel(name, rays, hits, in, out), rays.size());
    return probe_.read<Out>(out, in.size());
}

std::vector<TestRay> RayDevice::leaving(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits,
                                        const std::vector<glm::dvec3>& directions) const {
    std::vector<vec4> wanted;
    wanted.reserve(directions.size());
    for (const glm::dvec3& direction : directions)
        wanted.push_back(make_ray(glm::dvec3(0), direction).direction);
    const std::vector<vec4> origins = at_surfaces<vec4>("surface_leave", rays, hits, wanted);
    std::vector<TestRay> result(rays.size());
    for (size_t i = 0; i < result.size(); ++i)
        result[i] = {{origins[i].x, origins[i].y, origins[i].z, FAR_AWAY}, wanted[i]};
    return result;
}

std::vector<vec4> RayDevice::normals(const std::vector<TestRay>& rays,
                                     const std::vector<TestHit>& hits) const {
    return at_surfaces<vec4>("surface_normal", rays, hits, std::vector<vec4>(rays.size()));
}

std::vector<u32> RayDevice::fronts(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits) const {
    return at_surfaces<u32>("surface_front", rays, hits, std::vector<vec4>(rays.size()));
}
std::vector<TestPoint> RayDevice::points(const std::vector<TestRay>& rays,
                                         const std::vector<TestHit>& hits) const {
    std::vector<TestPoint> points;
    const auto keep = [&](const auto& found) {
        for (const auto& p : found)
            points.push_back({{p.x, p.y, p.z}, p.offset});
    };
    const std::vector<vec4> unused(rays.size());
    if (precision_ == Precision::DOUBLE)
        keep(at_surfaces<NumberPoint<double>>("surface_point", rays, hits, unused));
    else
        keep(at_surfaces<NumberPoint<float>>("surface_point", rays, hits, unused));
    return points;
}

std::vector<u32> RayDevice::lights_seen(const std::vector<TestRay>& rays, const std::vector<TestHit>& hits,
                                        const std::vector<vec4>& numbers) const {
    return at_surfaces<u32>("surface_light", rays, hits, numbers);
}

std::function<void()> RayDevice::leaver(const std::vector<TestRay>& rays,
                                        const std::vector<TestHit>& hits) const {
    std::vector<vec4> back;
    for (const TestRay& ray : rays)
        back.push_back({-ray.direction.x, -ray.direction.y, -ray.direction.z, 0});
    const cl::Buffer out = create_buffer(device_, "left", rays.size() * sizeof(vec4));
    return [this, count = rays.size(), kernel = make_surface_kernel("surface_leave", rays, hits, back, out)] {
        probe_.launch(kernel, count);
    };
}

std::function<void()> RayDevice::tracer(const std::vector<TestRay>& rays) const {
    const cl::Buffer out = create_buffer(device_, "traced", rays.size() * sizeof(NumberHit<double>));
    return [this, count = rays.size(), kernel = make_kernel("trace_closest", rays, out)] {
        probe_.launch(kernel, count);
    };
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
