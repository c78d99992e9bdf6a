// SPDX-License-Identifier: Apache-2.0
#include "render/light_samples_choice.h"

#include "console/signals.h"
#include "film/film_file.h"
#include "film/film_identity.h"

#include <algorithm>
#include <cmath>
#include <spdlog/spdlog.h>
#include <utility>

namespace clrt {

namespace {

/// Light samples of the pilot that has several.
constexpr int PILOT_LIGHT_SAMPLES = 4;

/// What light samples cost a ray that they bring, over the mean of all rays and of what is computed where
/// they end: choosing a light takes longer than most, and some bring none. 1.0 to 2.2 in four scenes of many
/// lamps, by seconds of two cores.
constexpr double LIGHT_SAMPLE_COST = 1.5;

/// Whether pilots are to decide.
bool pilots_decide(const PlannedScene& planned) {
    return !planned.scene.light_tree.nodes.empty() &&
           takes_option(planned.options.transport.integrator, TAKES_LIGHT_SAMPLES) &&
           size_of_path_pilots(planned);
}

/// What pilots with one light sample and with several tell, by the measure that the render is judged by.
LightSamplesGain gain_by(const PathPilot& one, const PathPilot& many, const Options& options) {
    return best_light_samples(deciding_error(one.errors, options), one.rays,
                              deciding_error(many.errors, options), many.rays, PILOT_LIGHT_SAMPLES);
}

/// Pilots of a plan whose programs are there.
class LightPilots {
public:
    LightPilots(const PreparedScene& prepared, PlannedScene& planned)
        : prepared_(prepared), planned_(planned), size_(*size_of_path_pilots(planned)) {}
    PathPilot run(const std::shared_ptr<const RenderPrograms>& programs, bool reuses, int samples) {
        int& planned_samples = planned_.options.transport.light_samples;
        const int before = std::exchange(planned_samples, samples);
        prepared_.programs = programs;
        const PathPilot pilot = run_path_pilot(prepared_, size_, reuses);
        planned_samples = before;
        return pilot;
    }
    const PilotSize& size() const { return size_; }

private:
    PreparedScene prepared_;
    PlannedScene& planned_;
    const PilotSize size_;
};

/// What pilots tell of a plan; `single` as choose_light_samples has it, and reuse may be decided once more.
LightSamplesGain run_light_pilots(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                                  PreparedParts& parts, const std::optional<ReusePilots>& single) {
    const Options& options = planned->options;
    Toggle& reuse = planned->options.transport.path_reuse;
    const bool reuses = reuse == Toggle::ON;
    const PreparedScene prepared = prepare_render(device, planned, parts);
    parts.tree = prepared.tree;
    parts.programs = prepared.programs;
    LightPilots pilots(prepared, *planned);
    const PathPilot one = !single  ? pilots.run(parts.programs, reuses, 1)
                          : reuses ? single->reusing
                                   : single->alone;
    LightSamplesGain best = gain_by(one, pilots.run(parts.programs, reuses, PILOT_LIGHT_SAMPLES), options);
    if (stop_signal())
        return {};
    if (best.samples > 1 && single && !reuses) {
        LightSamplesGain with =
            gain_by(single->reusing, pilots.run(parts.reusing, true, PILOT_LIGHT_SAMPLES), options);
        if (stop_signal())
            return {};
        with.gain *= single->gain;
        if (with.gain >= WORTHWHILE_REUSE_GAIN * best.gain) {
            best = with;
            reuse = Toggle::ON;
            parts.programs = parts.reusing;
        }
    }
    if (best.samples > 1)
        spdlog::info(
            "light samples: {} at the first vertex{}, {:.2f} times the efficiency, by pilots of {} x {} "
            "pixels, {} spp",
            best.samples, reuse == Toggle::ON && !reuses ? " and path reuse" : "", best.gain,
            pilots.size().width, pilots.size().height, pilots.size().spp);
    return best;
}

} // namespace

LightSamplesGain best_light_samples(double error_of_one, double rays_of_one, double error_of_many,
                                    double rays_of_many, int many) {
    // The error is a constant part and one over the number of samples; so is the work and its multiple.
    const double of_lights =
        std::clamp((error_of_one - error_of_many) * many / (many - 1), 0.0, error_of_one);
    const double rays = (rays_of_many - rays_of_one) / (rays_of_one * (many - 1));
    LightSamplesGain best;
    if (!std::isfinite(of_lights) || !std::isfinite(rays))
        return best;
    for (int samples = 2; samples <= MOST_LIGHT_SAMPLES; samples *= 2) {
        const double error = error_of_one - of_lights + of_lights / samples;
        const double gain = error_of_one / (error * (1 + LIGHT_SAMPLE_COST * rays * (samples - 1)));
        if (gain >= WORTHWHILE_LIGHT_SAMPLES_GAIN && gain > best.gain)
            best = {samples, gain};
    }
    return best;
}

void choose_light_samples(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                          PreparedParts& parts, const std::optional<ReusePilots>& single,
                          Progress& progress) {
    Options& options = planned->options;
    int& samples = options.transport.light_samples;
    if (samples != 0)
        return;
    if (!options.film_file.resume_path.empty()) {
        samples = film_light_samples(read_film_content(options.film_file.resume_path).identity);
        return;
    }
    samples = 1;
    if (!pilots_decide(*planned))
        return;
    progress.update({"pilot", -1, 0, -1, -1});
    samples = run_light_pilots(device, planned, parts, single).samples;
    progress.finish();
}

} // namespace clrt
