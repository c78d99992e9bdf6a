// SPDX-License-Identifier: Apache-2.0
// Light that is sampled from both ends: corners, where a connection may be as short as one likes.
#include "stability/catalogue.h"
#include "stability/probe_set.h"

#include "probes/film_estimate.h"
#include "probes/prepared_render.h"

#include <algorithm>
#include <cmath>

namespace clrt {

namespace {

/// A matte unit square under another of radiance 1, opposite or at an edge; the picture is that square, seen
/// in plan from between the two: every pixel shows the same area, so its mean is the form factor.
struct LitSquare : ScratchScene {
    explicit LitSquare(bool opposite) {
        build.material("matte", "Kd 1 1 1").material("lamp", "Kd 0 0 0\nKe 1 1 1");
        build.use("matte").floor(0.5);
        build.use("lamp");
        if (opposite)
            build.polygon({{-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5}});
        else
            build.polygon({{-0.5, 0, -0.5}, {-0.5, 1, -0.5}, {-0.5, 1, 0.5}, {-0.5, 0, 0.5}});
        look({0, 0.5, 0}, {0, 0, 0}, 90);
        options.effects.all = false;
    }
};

/// Next-event estimation alone: no weights, and paths that hit a light by chance count nothing.
const std::vector<KernelPatch> LIGHT_SAMPLING_ONLY = {
    {"path/connect.h", "light.is_delta ? REAL(1.0) : mis_weight(light.pdf_w, eval.pdf_w)", "REAL(1.0)"},
    {"path/connect.h", "return emitted * mis_weight(pdf_w, light_pdf_w);",
     "return emitted * REAL(0.0) * light_pdf_w;"}};

/// The largest of single samples over their mean.
double largest_sample(const Film& film) {
    const double largest = double(*std::max_element(film.sums.begin(), film.sums.end())) * film.scale.quantum;
    return largest / film_estimate(film).mean;
}

void corners(CaseRun& run) {
    struct Arrangement {
        bool opposite;
        double form_factor;
    };
    const PatchedKernels light_sampling(run.device.kernels(), LIGHT_SAMPLING_ONLY);
    Figure& z = run.figure("standard errors off", LARGEST_Z);
    // Six of them are 1.2 % of the form factor.
    Figure& noise = run.figure("relative standard error", 2e-3);
    Figure& contribution = run.figure("largest sample over the mean", 50);
    for (const Arrangement& arrangement :
         {Arrangement{false, 0.2000437761}, Arrangement{true, 0.1998248957}}) {
        const LitSquare subject(arrangement.opposite);
        const Scene scene = subject.load();
        for (const Build build : run.builds()) {
            const auto describe = [&] {
                return std::string(arrangement.opposite ? "opposite" : "at a right angle");
            };
            Options options = subject.options;
            options.device.precision = precision_of(build);
            options.device.kernels_folder = build == Build::NAIVE ? light_sampling.path() : "";
            options.sampling.spp = std::uint32_t(run.count(1024, 16384, 262144));
            const Estimate mean = film_estimate(PreparedRender(run.device, scene, options).run().film);
            const double miss =
                std::abs(mean.mean - arrangement.form_factor) - RENDER_ROUNDING * arrangement.form_factor;
            z[build].see(std::max(miss, 0.0) / mean.error, describe);
            noise[build].see(mean.error / arrangement.form_factor, describe);
            options.sampling.spp =
                std::uint32_t(options.sampling.replicates); // every sample has sums of its own
            options.film.size = {128, 128};
            contribution[build].see(largest_sample(PreparedRender(run.device, scene, options).run().film),
                                    describe);
        }
    }
}

} // namespace

const std::vector<StabilityCase>& bidirectional_cases() {
    static const std::vector<StabilityCase> cases = {
        {"B01", "Corners", "a unit square lit by another, opposite and at a common edge, by path tracing",
         "form factors 0.1998248957 and 0.2000437761",
         "6 standard errors of 64 replicates; multiple importance sampling "
         "bounds a sample where light sampling alone (naive) has none near the edge",
         corners},
    };
    return cases;
}

} // namespace clrt
