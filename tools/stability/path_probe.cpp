// SPDX-License-Identifier: Apache-2.0
#include "stability/path_probe.h"

#include "kernels/shared/effects.h"
#include "stability/probe_set.h"

#include <fmt/format.h>
#include <utility>

namespace clrt {

namespace {

const char* const TEXT = R"(
#define PROBE_PATHS(NAME, RADIANCE)                                                                                   \
    CLRT_KERNEL void NAME(const RenderParams params, SCENE_PARAMS, global const float4* restrict rays, const u32 count,    \
                     const u32 samples, global real* restrict out_values)                                             \
    {                                                                                                                 \
        const u32 i = (u32)get_global_id(0);                                                                          \
        if (i >= count)                                                                                               \
            return;                                                                                                   \
        const Scene scene = SCENE_MAKE;                                                                               \
        const u32 pixel = i / samples;                                                                                \
        CameraSample sample;                                                                                          \
        sample.sampler = sampler_make(params.seed, pixel, 0u, i % samples);                                           \
        sample.ray = ray_make(vector_from(rays[2u * pixel]), vector_normalize(vector_from(rays[2u * pixel + 1u])), \
                              REAL(0.0));                                                                               \
        sample.radiance = (real3)(REAL(0.0));                                                                         \
        layers_begin(&sample.layers);                                                                                 \
        PixelRays counted = {0u, 0u, 0u, 0ul, 0u};                                                                    \
        RADIANCE(&scene, &params, &sample, 1u, &counted);                                                             \
        out_values[3u * i] = sample.radiance.x;                                                                       \
        out_values[3u * i + 1u] = sample.radiance.y;                                                                  \
        out_values[3u * i + 2u] = sample.radiance.z;                                                                  \
    }
PROBE_PATHS(probe_path, path_radiance)
PROBE_PATHS(probe_whitted, whitted_radiance)
)";

/// The programs of the probe are compiled for one layout.
std::shared_ptr<PlannedScene> plan_in_probed_layout(Scene scene, Options options) {
    options.bvh.layout = BvhLayout::BVH8;
    return plan_scene(std::move(scene), std::move(options));
}

} // namespace

KernelProbe& path_probe(const ProbeDevice& device, Build build) {
    return device.once<KernelProbe>(std::string("paths: ") + build_name(build), [&] {
        ProbeOptions options;
        options.precision = precision_of(build);
        options.defines = {fmt::format("CLRT_EFFECTS={:#x}u", EFFECT_ALL & ~EFFECT_PATH_FILTER),
                           "SAMPLES_AT_ONCE=1"};
        KernelProbe made(device, {"integrators/path.h", "integrators/whitted.h"}, options);
        made.add_text(TEXT);
        return made;
    });
}

PathProbe::PathProbe(const ProbeDevice& device, Scene scene, Options options)
    : device_(device),
      prepared_(prepare_scene(device, plan_in_probed_layout(std::move(scene), std::move(options)))) {
    params = launch_params(*prepared_.planned);
}

TestRay PathProbe::ray(const glm::dvec3& origin, const glm::dvec3& at) const {
    const Normalisation& frame = scene().normalisation;
    return make_ray_to((origin - frame.centre) * frame.scale, (at - frame.centre) * frame.scale);
}

std::vector<glm::dvec3> PathProbe::radiance(Build build, Integrator integrator,
                                            const std::vector<TestRay>& rays, size_t samples) const {
    KernelProbe& probe = path_probe(device_, build);
    Kernel kernel = probe.kernel(integrator == Integrator::WHITTED ? "probe_whitted" : "probe_path");
    const size_t count = rays.size() * samples;
    std::vector<vec4> words;
    for (const TestRay& ray : rays) {
        words.push_back(ray.origin);
        words.push_back(ray.direction);
    }
    bind_scene(prepared_.buffers, kernel);
    kernel.set("params", params);
    kernel.set("rays", probe.upload(words));
    kernel.set("count", u32(count));
    kernel.set("samples", u32(samples));
    const cl::Buffer out = create_buffer(
        prepared_.device, "radiance", 3 * count * (build == Build::DOUBLE ? sizeof(double) : sizeof(float)));
    kernel.set("out_values", out);
    probe.launch(kernel, count);
    std::vector<glm::dvec3> result(count);
    const auto widen = [&](const auto& values) {
        for (size_t i = 0; i < count; ++i)
            result[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    };
    if (build == Build::DOUBLE)
        widen(probe.read<double>(out, 3 * count));
    else
        widen(probe.read<float>(out, 3 * count));
    return result;
}

std::vector<Build> path_builds(const CaseRun& run) {
    return run.device.info.fp64 ? std::vector<Build>{Build::SINGLE, Build::DOUBLE}
                                : std::vector<Build>{Build::SINGLE};
}

} // namespace clrt
