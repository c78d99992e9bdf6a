// SPDX-License-Identifier: Apache-2.0
#include "stability/cases/ray_builds.h"

#include "naive/naive_kernels.h"
#include "stability/probe_set.h"

#include <fmt/format.h>

namespace clrt {

const KernelVariant& plain_triangles(const ProbeDevice& device) {
    return device.once<KernelVariant>("plain triangles", [&] {
        return KernelVariant{"plain triangles", with_naive(device.kernels(), true, false)};
    });
}

const KernelVariant& plain_boxes(const ProbeDevice& device) {
    return device.once<KernelVariant>("plain boxes", [&] {
        return KernelVariant{"plain boxes", with_naive(device.kernels(), false, true)};
    });
}

const KernelVariant& plain_offsets(const ProbeDevice& device) {
    return device.once<KernelVariant>("plain offsets", [&] {
        return KernelVariant{"plain offsets", with_naive_offset(device.kernels())};
    });
}

RayDeviceOptions ray_options(Build build, const KernelVariant& naive) {
    RayDeviceOptions options;
    options.precision = precision_of(build);
    options.variant = build == Build::NAIVE ? &naive : nullptr;
    return options;
}

void for_each_tree(Build build, const KernelVariant& naive,
                   const std::function<void(const RayDeviceOptions&, const std::string&)>& trace) {
    RayDeviceOptions options = ray_options(build, naive);
    if (build != Build::SINGLE)
        return trace(options, name_of(options.layout));
    for (const BvhLayout layout : ALL_LAYOUTS)
        for (const BvhQuality quality : {BvhQuality::FAST, BvhQuality::HIGH}) {
            options.layout = layout;
            options.quality = quality;
            trace(options, std::string(name_of(layout)) + (quality == BvhQuality::HIGH ? " high" : ""));
        }
}

std::vector<Build> robust_builds(const CaseRun& run) {
    std::vector<Build> builds = run.builds();
    builds.erase(builds.begin());
    return builds;
}

std::string ray_text(const TestRay& ray) {
    const vec4 &o = ray.origin, &d = ray.direction;
    return fmt::format("({:a}, {:a}, {:a}) + t ({:a}, {:a}, {:a})", o.x, o.y, o.z, d.x, d.y, d.z);
}

} // namespace clrt
