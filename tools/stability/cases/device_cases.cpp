// SPDX-License-Identifier: Apache-2.0
// Devices: the same picture whatever computes it.
#include "stability/catalogue.h"
#include "stability/probe_set.h"

#include "support/effect_masks.h"
#include "support/film_estimate.h"
#include "support/prepared_render.h"

#include <cmath>
#include <fmt/format.h>

namespace clrt {

namespace {

/// One compute unit of a device as a device of its own; none where it cannot be divided.
std::optional<Device> one_unit_of(const Device& device) {
    const cl_device_partition_property properties[] = {CL_DEVICE_PARTITION_EQUALLY, 1, 0};
    std::vector<cl::Device> units;
    try {
        cl::Device whole = device.handle;
        if (whole.createSubDevices(properties, &units) != CL_SUCCESS || units.empty())
            return std::nullopt;
        Device unit;
        unit.info = device.info;
        unit.handle = units[0];
        unit.context = cl::Context(unit.handle);
        unit.queue = cl::CommandQueue(unit.context, unit.handle, CL_QUEUE_PROFILING_ENABLE);
        return unit;
    } catch (const cl::Error&) {
        return std::nullopt;
    }
}

/// The first device of another platform.
std::optional<Device> another_device(const Device& device) {
    for (const PlatformInfo& platform : list_platforms())
        if (platform.index != device.info.platform_index && !platform.devices.empty())
            return open_device(platform.devices.front());
    return std::nullopt;
}

/// A small scene of all effects; every sample has sums of its own.
struct EverySample : SceneOfEffects {
    EverySample() : SceneOfEffects(EVERY_EFFECT & ~u32(EFFECT_PATH_FILTER)) {
        options.all_effects = true;
        options.size = {24, 24};
        options.spp = 64;
        options.replicates = 64;
    }
};

std::string describe_sum(const Film& film, size_t i) {
    return fmt::format("sample {}, pixel {}, channel {}", i / film_plane(film), i % film_plane(film) / 3, i % 3);
}

/// Shares of samples and standard errors between the films of two devices.
void compare_devices(const Device& other, const Scene& scene, const Options& options, const Film& here, CaseRun& run) {
    Figure& far = run.figure("samples off by 1e-4 on another device, %", 0.1);
    Figure& z = run.figure("standard errors between devices", 6);
    const Film there = PreparedRender(scene, options, other).run().film;
    const double mean = film_estimate(here).mean / here.scale.quantum;
    Worst off;
    for (size_t i = 0; i < here.sums.size(); ++i) {
        const double a = double(here.sums[i]), b = double(there.sums[i]);
        off.count(std::abs(a - b) > 1e-4 * std::max(std::max(a, b), mean), [&] { return describe_sum(here, i); });
    }
    off.value *= 100 / double(off.tried);
    off.input = fmt::format("{} {}: {}", other.info.platform, other.info.driver, off.input);
    far[Build::SINGLE] = off;
    for (int channel = 0; channel < 3; ++channel) {
        const Estimate a = film_estimate(here, channel), b = film_estimate(there, channel);
        z[Build::SINGLE].see(std::abs(a.mean - b.mean) / std::hypot(a.error, b.error),
                             [&] { return fmt::format("channel {}", channel); });
    }
}

void devices_agree(CaseRun& run) {
    Figure& differing = run.figure("sums that differ on one compute unit", 0);
    const EverySample subject;
    const Scene scene = subject.load();
    // Without units to choose from the device is asked twice.
    static const std::optional<Device> unit = one_unit_of(run.device); // never freed before the driver's own statics
    const Device& part = unit ? *unit : run.device;
    for (const Build build : run.builds()) {
        if (build == Build::NAIVE)
            continue;
        Options options = subject.options;
        options.precision = precision_of(build);
        const Film whole = render_loaded(scene, options).film;
        const Film other = PreparedRender(scene, options, part).run().film;
        for (size_t i = 0; i < whole.sums.size(); ++i)
            differing[build].count(whole.sums[i] != other.sums[i], [&] { return describe_sum(whole, i); });
        if (build == Build::SINGLE)
            if (const std::optional<Device> second = another_device(run.device))
                compare_devices(*second, scene, options, whole, run);
    }
}

} // namespace

const std::vector<StabilityCase>& device_cases() {
    static const std::vector<StabilityCase> cases = {
        {"V02", "DevicesAgree", "a scene of all effects on one compute unit, and on another platform's device where there is one",
         "the same scene on the whole device", "sums are integers, so threads may not show; another compiler may round a "
         "function's last bit otherwise and send one path in a thousand another way", devices_agree},
    };
    return cases;
}

} // namespace clrt
