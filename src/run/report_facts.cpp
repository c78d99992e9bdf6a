// SPDX-License-Identifier: Apache-2.0
#include "run/report_facts.h"

#include "paths/path_plan.h"
#include "render/render_params.h"
#include "scene/slabs.h"

#include <algorithm>

namespace clrt {

double rays_per_second(const Render& render) {
    return render.seconds > 0 ? double(render.counts.rays()) / render.seconds : 0;
}

std::vector<std::string> names_of_effects(const Effects& effects, bool present) {
    std::vector<std::string> names;
    for (const Effect& effect : effects.list)
        if (effect.present == present && !(effects.left_out & effect.bit))
            names.push_back(effect.name);
    return names;
}

std::vector<std::string> crossed_slabs(const Scene& scene, const Options& options) {
    const Environment& sky = scene.environment;
    const bool is_sky_sampled = !sky.texels.empty() || !sky.portals.empty();
    const bool is_outside_found = crosses_slabs(scene, options) && (is_sky_sampled || has_suns(scene));
    std::vector<std::string> names;
    if (!is_outside_found && !finds_lamps_behind_slabs(scene, options))
        return names;
    for (size_t i = 0; i < scene.materials.size(); ++i)
        if (scene.materials[i].flags & MATERIAL_SLAB)
            names.push_back(scene.material_names[i]);
    return names;
}

TileSpread tile_spread(const Film& film) {
    TileSpread spread;
    for (size_t tile = 0; tile < film_tiles(film); ++tile) {
        const std::uint32_t samples = film.tile_samples[0][tile] + film.tile_samples[1][tile];
        spread.fewest = std::min(spread.fewest, samples);
        spread.most = std::max(spread.most, samples);
    }
    spread.mean = double(film_all_samples(film)) / double(film_plane(film) / 3);
    return spread;
}

} // namespace clrt
