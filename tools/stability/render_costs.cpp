// SPDX-License-Identifier: Apache-2.0
#include "stability/render_costs.h"

#include "probes/prepared_render.h"
#include "stability/shipped_scenes.h"

#include <cmath>
#include <fmt/format.h>
#include <memory>

namespace clrt {

namespace {

constexpr glm::ivec2 SIZE{96, 72};
constexpr std::uint32_t SPP = 32;

/// Another way to build the kernels.
struct RenderVariant {
    const char* choice;
    Precision precision;
    bool contracts;        ///< without the pragma that forbids it
    bool rounds_correctly; ///< asks for correctly rounded division and root where the device has them
};

const RenderVariant VARIANTS[] = {
    {"a b + c may be contracted", Precision::SINGLE, true, true},
    {"division as the device likes", Precision::SINGLE, false, false},
    {"relaxed maths (fast)", Precision::FAST, false, true},
    {"everything in double", Precision::DOUBLE, false, true},
};

/// RMS difference over the mean of `b`.
double relative_difference(const std::vector<float>& a, const std::vector<float>& b) {
    double squares = 0, sum = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        squares += (double(a[i]) - double(b[i])) * (double(a[i]) - double(b[i]));
        sum += double(b[i]);
    }
    return std::sqrt(squares * double(a.size())) / sum;
}

/// Renders by a variant and by clrt's own kernels in turns.
void measure(const ProbeDevice& device, const RenderVariant& variant, const PreparedRender& own,
             const ShippedScene& subject, const Scene& scene, int rounds, RenderCost& cost) {
    Device as_told = device;
    as_told.info.correctly_rounded_division &= variant.rounds_correctly;
    Options options = subject.options;
    options.device.precision = variant.precision;
    std::unique_ptr<PatchedKernels> patched;
    if (variant.contracts) {
        patched = std::make_unique<PatchedKernels>(
            device.kernels(), std::vector<KernelPatch>{{"numerics/real.h", "#pragma OPENCL FP_CONTRACT OFF",
                                                        "#pragma OPENCL FP_CONTRACT ON"}});
        options.device.kernels_folder = patched->path();
    }
    const ProbeDevice other_device(as_told, device.kernels_folder());
    const PreparedRender other(other_device, scene, options);
    Film films[2];
    double noise = 0;
    const auto render = [&](const PreparedRender& picture, Film& film) {
        Render rendered = picture.run();
        film = std::move(rendered.film);
        if (&film == &films[0] && rendered.error)
            noise = rendered.error->relative_rmse;
    };
    cost.time = time_in_turns(
        device, [&] { render(own, films[0]); }, [&] { render(other, films[1]); }, 1, rounds);
    cost.difference = relative_difference(film_mean(films[1]), film_mean(films[0]));
    cost.noise = noise;
}

/// What can be measured of a variant on this device.
bool is_known(const RenderVariant& variant, const DeviceInfo& device) {
    return (variant.precision != Precision::DOUBLE || device.fp64) &&
           (variant.rounds_correctly || device.correctly_rounded_division);
}

/// Measures all variants on a scene. What one throws becomes the error of its row, so that it does not cost
/// the report.
void measure_scene(const ProbeDevice& device, const char* name, int rounds,
                   const std::function<void(const std::string&)>& tell, std::vector<RenderCost>& costs) {
    const auto attempt = [&](const char* choice, const auto& work) {
        tell(fmt::format("{}, {}", name, choice));
        RenderCost cost;
        cost.choice = choice;
        cost.scene = name;
        try {
            work(cost);
        } catch (const std::exception& error) {
            cost.error = error.what();
        }
        return cost;
    };
    std::unique_ptr<ShippedScene> subject;
    Scene scene;
    std::unique_ptr<PreparedRender> own;
    const RenderCost prepared = attempt("clrt's own", [&](RenderCost&) {
        subject = std::make_unique<ShippedScene>(name);
        subject->options.film.size = SIZE;
        subject->options.sampling.spp = SPP;
        scene = subject->load();
        own = std::make_unique<PreparedRender>(device, scene, subject->options);
    });
    if (!own) {
        costs.push_back(prepared);
        return;
    }
    for (const RenderVariant& variant : VARIANTS)
        if (is_known(variant, device.info))
            costs.push_back(attempt(variant.choice, [&](RenderCost& cost) {
                measure(device, variant, *own, *subject, scene, rounds, cost);
            }));
}

} // namespace

std::vector<RenderCost> measure_render_costs(const ProbeDevice& device, int rounds,
                                             const std::function<void(const std::string&)>& tell) {
    std::vector<RenderCost> costs;
    for (const char* name : {"cornell_box", "every_effect"})
        measure_scene(device, name, rounds, tell, costs);
    return costs;
}

} // namespace clrt
