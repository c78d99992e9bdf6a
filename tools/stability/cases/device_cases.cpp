// SPDX-License-Identifier: Apache-2.0
// Devices: the same picture whatever computes it.
#include "stability/catalogue.h"
#include "stability/probe_set.h"

#include "probes/effect_masks.h"
#include "probes/film_estimate.h"
#include "probes/prepared_render.h"
#include "probes/random_inputs.h"
#include "probes/ray_device.h"
#include "probes/statistics.h"

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
    EverySample() : SceneOfEffects(EVERY_EFFECT & ~EFFECT_PATH_FILTER) {
        options.effects.all = true;
        options.film.size = {24, 24};
        options.sampling.spp = 64;
        options.sampling.replicates = 64;
    }
};

std::string describe_sum(const Film& film, size_t i) {
    return fmt::format("sample {}, pixel {}, channel {}", i / film_plane(film), i % film_plane(film) / 3,
                       i % 3);
}

/// Shares of samples and standard errors between the films of two devices.
void compare_devices(const ProbeDevice& other, const Scene& scene, const Options& options, const Film& here,
                     CaseRun& run) {
    Figure& far = run.figure("samples off by 1e-4 on another device, %", 0.1);
    Figure& z = run.figure("standard errors between devices", 6);
    const Film there = PreparedRender(other, scene, options).run().film;
    const double mean = film_estimate(here).mean / here.scale.quantum;
    Worst off;
    for (size_t i = 0; i < here.sums.size(); ++i) {
        const double a = double(here.sums[i]), b = double(there.sums[i]);
        off.count(std::abs(a - b) > 1e-4 * std::max(std::max(a, b), mean),
                  [&] { return describe_sum(here, i); });
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
    const std::optional<Device> unit = one_unit_of(run.device);
    const ProbeDevice part(unit ? *unit : run.device, run.device.kernels_folder());
    for (const Build build : run.builds()) {
        if (build == Build::NAIVE)
            continue;
        Options options = subject.options;
        options.device.precision = precision_of(build);
        const Film whole = render_loaded(run.device, scene, options).film;
        const Film other = PreparedRender(part, scene, options).run().film;
        for (size_t i = 0; i < whole.sums.size(); ++i)
            differing[build].count(whole.sums[i] != other.sums[i], [&] { return describe_sum(whole, i); });
        if (build == Build::SINGLE)
            if (const std::optional<Device> second = another_device(run.device))
                compare_devices(ProbeDevice(*second, run.device.kernels_folder()), scene, options, whole,
                                run);
    }
}

/// An operation that the kernels rest on, over random inputs, judged by long double.
struct Operation {
    const char* name; ///< of its figure, ULP
    const char* header;
    const char* code;
    const char* naive; ///< the device's own function; empty: the same as `code`
    double low, high;  ///< of both inputs
    double limit;      ///< ULP; of single
    double (*exact)(double a, double b);
};

double sin_of_turn(double u, double) {
    // The period is exact in u; the rest is small, so that long double resolves the zeros.
    return double(std::sin(2 * std::acos(-1.0L) * ((long double)(u)-std::round((long double)(u)*2) / 2)) *
                  (std::fmod(std::round(u * 2), 2) != 0 ? -1 : 1));
}

const Operation OPERATIONS[] = {
    {"division", "numerics/real.h", "a / b", "", 1e-3, 1e3, 2.5, [](double a, double b) { return a / b; }},
    {"square root", "numerics/real.h", "real_sqrt(a)", "", 1e-6, 1e6, 3,
     [](double a, double) { return std::sqrt(a); }},
    {"sine of a turn", "numerics/real.h", "real_sin_cos_turn(a).x", "sin(a * (REAL(2.0) * REAL_PI))", 1e-4, 1,
     2, sin_of_turn},
    {"a b - b^2", "numerics/real.h", "real_difference_of_products(a, b, b, b)", "a * b - b * b", 1, 1.001,
     1.5,
     [](double a, double b) { return double((long double)(b) * ((long double)(a) - (long double)(b))); }},
    {"exponential", "numerics/real_functions.h", "real_exp(-a)", "exp(-a)", 1e-3, 80, 2,
     [](double a, double) { return std::exp(-a); }},
    {"logarithm", "numerics/real_functions.h", "real_log(a)", "log(a)", 1e-20, 1e20, 2,
     [](double a, double) { return std::log(a); }},
    {"power", "numerics/real_functions.h", "real_pow(a, b)", "pow(a, b)", 0.1, 8, 2,
     [](double a, double b) { return std::pow(a, b); }},
    {"arc tangent", "numerics/real_functions.h", "real_atan2(a, b)", "atan2(a, b)", 1e-3, 1e3, 2,
     [](double a, double b) { return std::atan2(a, b); }},
};

void device_functions(CaseRun& run) {
    const KernelFiles files = run.device.kernels();
    Random random(3);
    for (const Operation& operation : OPERATIONS) {
        if (files.count(operation.header) == 0) // these kernels use no such function
            continue;
        const std::string naive = operation.naive;
        ProbeSet probes(run.device, {operation.header},
                        {{"operation", 2, 1, fmt::format("out[0] = {}; (void)b;", operation.code),
                          naive.empty() ? "" : fmt::format("out[0] = {}; (void)b;", naive)}});
        Figure& ulps = run.figure(fmt::format("ULP of {}", operation.name), operation.limit);
        Columns inputs(2);
        for (size_t i = 0; i < run.count(1 << 16, 1 << 22, 1 << 26); ++i)
            for (std::vector<float>& column : inputs)
                column.push_back(
                    float(std::exp(random.between(std::log(operation.low), std::log(operation.high)))));
        for (const Build build : run.builds()) {
            if (build == Build::DOUBLE ||
                !probes.has(build, "operation")) // the reference is no better than double
                continue;
            const std::vector<double> got = probes.run(build, "operation", inputs)[0];
            for (size_t i = 0; i < got.size(); ++i)
                ulps[build].see(
                    ulp_distance(float(got[i]), operation.exact(double(inputs[0][i]), double(inputs[1][i]))),
                    [&] { return fmt::format("{:a}, {:a}", inputs[0][i], inputs[1][i]); });
        }
    }
}

} // namespace

const std::vector<StabilityCase>& device_cases() {
    static const std::vector<StabilityCase> cases = {
        {"V01", "DeviceFunctions", "the operations that all kernels rest on, at random arguments",
         "long double",
         "what OpenCL promises of division and root; the functions' own bounds; naive is the device's "
         "function or the plain formula",
         device_functions},
        {"V02", "DevicesAgree",
         "a scene of all effects on one compute unit, and on another platform's device where there is one",
         "the same scene on the whole device",
         "sums are integers, so threads may not show; another compiler may round a "
         "function's last bit otherwise and send one path in a thousand another way",
         devices_agree},
    };
    return cases;
}

} // namespace clrt
