// SPDX-License-Identifier: Apache-2.0
#include "render/sky_choice.h"

#include "console/signals.h"
#include "render/pilot.h"
#include "render/reuse_choice.h"
#include "scene/sky_table.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <spdlog/spdlog.h>
#include <string>
#include <utility>
#include <vector>

namespace clrt {

namespace {

/// Squared error that a table must spare for it to be taken, by pilots whose ratios scatter by a few
/// percent.
constexpr double WORTHWHILE_SKY_GAIN = 1.1;

/// Size of the pilots; none where a plan has no choice.
std::optional<PilotSize> size_of_sky_pilots(const PlannedScene& planned) {
    const Environment& sky = planned.scene.environment;
    const bool is_certain = sky.sampling != SkySampling::BY_TABLE_AND_BSDF || sky.tabulated_share == 1;
    if (is_certain || planned.effects.paths.is_empty || !planned.options.output.path_layers.empty())
        return std::nullopt;
    return sky_pilot_size(planned.options);
}

/// A map's table, kept while another is tried.
class Table {
public:
    explicit Table(const Environment& sky)
        : tiles_(sky.tiles), share_(sky.tabulated_share), sampling_(sky.sampling) {}
    void put_into(Environment& sky) {
        sky.tiles = std::move(tiles_);
        sky.tabulated_share = share_;
        sky.sampling = sampling_;
    }

private:
    std::vector<SkyTile> tiles_;
    double share_;
    std::optional<SkySampling> sampling_;
};

/// What a table spares of the usual one's squared error, in words; infinite: the usual one found no light.
std::string comparison(double gain) {
    return std::isfinite(gain)
               ? fmt::format("have {:.2f} times less squared error than by what exceeds its mean", gain)
               : "find light that those by what exceeds its mean do not";
}

} // namespace

bool choose_sky_table(const Device& device, const std::shared_ptr<PlannedScene>& planned,
                      PreparedParts& parts, Progress& progress) {
    const std::optional<PilotSize> size = size_of_sky_pilots(*planned);
    if (!size)
        return false;
    progress.update({"pilot", -1, 0, -1, -1});
    Environment& sky = planned->scene.environment;
    const std::optional<Crop> crop = std::exchange(planned->options.film.crop, std::nullopt);
    const auto error_by = [&](SkySampling sampling) {
        tabulate_sky(sky, sampling);
        return path_pilot_error(prepare_path_pilot(device, planned, parts), *size);
    };
    const double usual = error_by(SkySampling::BY_TABLE_AND_BSDF);
    Table best(sky);
    double error = usual / WORTHWHILE_SKY_GAIN;
    for (const SkySampling sampling : {SkySampling::BY_TABLE, SkySampling::BRIGHTEST_BY_TABLE})
        if (const double other = error_by(sampling); other < error && !stop_signal()) {
            best = Table(sky);
            error = other;
        }
    best.put_into(sky);
    planned->options.film.crop = crop;
    progress.finish();
    const bool is_other = sky.sampling != SkySampling::BY_TABLE_AND_BSDF;
    if (is_other)
        spdlog::info("sky: light samples by {} {}, by pilots of {} x {} pixels, {} spp",
                     sky.sampling == SkySampling::BY_TABLE ? "its whole radiance"
                                                           : "what exceeds four times its mean",
                     comparison(usual / error), size->width, size->height, size->spp);
    return is_other;
}

} // namespace clrt
