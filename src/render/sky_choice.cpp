// SPDX-License-Identifier: Apache-2.0
#include "render/sky_choice.h"

#include "console/signals.h"
#include "render/pilot.h"
#include "scene/sky_table.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <spdlog/spdlog.h>
#include <utility>
#include <vector>

namespace clrt {

namespace {

/// Pixels and samples a pixel of a pilot. Smaller frames are not worth one.
constexpr double MOST_PIXELS = 1536, FEWEST_PIXELS = 768;
constexpr std::uint32_t SKY_PILOT_SPP = 8;

/// Squared error that a table must spare for it to be taken, by pilots that are right within a few percent.
constexpr double WORTHWHILE_SKY_GAIN = 1.1;

/// Size of the pilots; none where a plan has no choice.
std::optional<PilotSize> size_of_sky_pilots(const PlannedScene& planned) {
    const Environment& sky = planned.scene.environment;
    const Options& options = planned.options;
    const double pixels = double(options.film.size.x) * double(options.film.size.y);
    const bool is_certain = sky.sampling != SkySampling::BY_TABLE_AND_BSDF || sky.tabulated_share == 1;
    if (is_certain || planned.effects.paths.is_empty || !options.output.path_layers.empty() ||
        pixels < FEWEST_PIXELS)
        return std::nullopt;
    const double scale = std::min(std::sqrt(MOST_PIXELS / pixels), 1.0);
    return PilotSize{std::max(int(options.film.size.x * scale), 1),
                     std::max(int(options.film.size.y * scale), 1), SKY_PILOT_SPP};
}

} // namespace

void choose_sky_table(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                      PreparedParts& parts, Progress& progress) {
    const std::optional<PilotSize> size = size_of_sky_pilots(*planned);
    if (!size)
        return;
    progress.update({"pilot", -1, 0, -1, -1});
    Environment& sky = planned->scene.environment;
    std::vector<SkyTile> tiles = sky.tiles;
    const double share = sky.tabulated_share;
    const std::optional<Crop> crop = std::exchange(planned->options.film.crop, std::nullopt);
    const auto error = [&] {
        const PreparedScene prepared = prepare_render(device, planned, parts);
        parts = {prepared.tree, prepared.programs};
        return path_pilot_error(prepared, *size);
    };
    const double by_excess = error();
    tabulate_sky(sky, SkySampling::BY_TABLE);
    const double by_radiance = error();
    planned->options.film.crop = crop;
    progress.finish();
    spdlog::debug("sky: {:.4g} by what exceeds the mean, {:.4g} by its radiance", by_excess, by_radiance);
    if (by_excess > WORTHWHILE_SKY_GAIN * by_radiance && !stop_signal()) {
        spdlog::info(
            "sky: light samples by its whole radiance have {:.2f} times less squared error than by what "
            "exceeds its mean, by pilots of {} x {} pixels, {} spp",
            by_excess / by_radiance, size->width, size->height, size->spp);
        return;
    }
    sky.tiles = std::move(tiles);
    sky.tabulated_share = share;
    sky.sampling = SkySampling::BY_TABLE_AND_BSDF;
}

} // namespace clrt
