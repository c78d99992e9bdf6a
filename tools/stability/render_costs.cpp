// SPDX-License-Identifier: Apache-2.0
#include "stability/render_costs.h"

#include "stability/shipped_scenes.h"
#include "support/prepared_render.h"

#include <cmath>
#include <memory>

namespace clrt {

namespace {

constexpr int ROUNDS = 7;
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
RenderCost measure(const Device& device, const RenderVariant& variant, const PreparedRender& own,
                   const ShippedScene& subject, const Scene& scene) {
    Device as_told = device;
    as_told.info.correctly_rounded_division &= variant.rounds_correctly;
    Options options = subject.options;
    options.precision = variant.precision;
    std::unique_ptr<PatchedKernels> patched;
    if (variant.contracts) {
        patched = std::make_unique<PatchedKernels>(std::vector<KernelPatch>{
            {"numerics/real.h", "#pragma OPENCL FP_CONTRACT OFF", "#pragma OPENCL FP_CONTRACT ON"}});
        options.kernels_folder = patched->path();
    }
    const PreparedRender other(scene, options, as_told);
    RenderCost cost;
    cost.choice = variant.choice;
    Film films[2];
    double noise = 0;
    const auto render = [&](const PreparedRender& picture, Film& film) {
        Render rendered = picture.run();
        film = std::move(rendered.film);
        if (&film == &films[0] && rendered.error)
            noise = rendered.error->relative_rmse;
    };
    cost.time = time_in_turns([&] { render(own, films[0]); }, [&] { render(other, films[1]); }, 1, ROUNDS);
    cost.difference = relative_difference(film_mean(films[1]), film_mean(films[0]));
    cost.noise = noise;
    return cost;
}

} // namespace

std::vector<RenderCost> measure_render_costs(const Device& device,
                                             const std::function<void(const std::string&)>& tell) {
    std::vector<RenderCost> costs;
    for (const char* name : {"cornell_box", "every_effect"}) {
        ShippedScene subject(name);
        subject.options.size = SIZE;
        subject.options.spp = SPP;
        const Scene scene = subject.load();
        const PreparedRender own(scene, subject.options, device);
        for (const RenderVariant& variant : VARIANTS) {
            if ((variant.precision == Precision::DOUBLE && !device.info.fp64) ||
                (!variant.rounds_correctly && !device.info.correctly_rounded_division))
                continue;
            tell(std::string(name) + ", " + variant.choice);
            costs.push_back(measure(device, variant, own, subject, scene));
            costs.back().scene = name;
        }
    }
    return costs;
}

} // namespace clrt
