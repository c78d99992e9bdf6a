// SPDX-License-Identifier: Apache-2.0
#include "replay/quantities.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>

namespace clrt {

namespace {

constexpr TraceUnit NONE = TraceUnit::NONE, LENGTH = TraceUnit::LENGTH, POSITION = TraceUnit::POSITION;
constexpr TraceSign ANY = TraceSign::ANY, NOT_NEGATIVE = TraceSign::NOT_NEGATIVE;
constexpr bool CARRIED = true;

constexpr Quantity TABLE[] = {
    {TRACE_VERTEX, "vertex", "vertex", 2},
    {TRACE_TRIANGLE, "triangle", "triangle", 1},
    {TRACE_FRONT, "side", "front", 1},
    {TRACE_LOBE, "lobe", "lobe", 1},
    {TRACE_CONTINUES, "goes on", "continues", 1},
    {TRACE_STATE, "path state", "path_state", 1},
    {TRACE_SURVIVES, "roulette", "survives", 1},
    {TRACE_WAITING, "rays waiting", "rays_waiting", 1},
    {TRACE_LIGHT_KIND, "light", "light", 1},
    {TRACE_CONNECTS, "light reflected", "light_reflected", 1},
    {TRACE_VISIBLE, "light visible", "light_visible", 1},
    {TRACE_CUT, "max depth", "cut", 1},
    {TRACE_RAY_ORIGIN, "ray origin", "ray_origin", 3, POSITION, ANY, CARRIED},
    {TRACE_RAY_DIRECTION, "ray direction", "ray_direction", 3, NONE, ANY, CARRIED},
    {TRACE_DISTANCE, "distance", "distance", 1, LENGTH, NOT_NEGATIVE},
    {TRACE_BARYCENTRIC, "barycentric", "barycentric", 2},
    {TRACE_POSITION, "position", "position", 3, POSITION},
    {TRACE_NORMAL_G, "geometric normal", "normal_geometric", 3},
    {TRACE_NORMAL_S, "shading normal", "normal_shading", 3},
    {TRACE_OFFSET, "offset bound", "offset_bound", 1, LENGTH, NOT_NEGATIVE},
    {TRACE_EMITTED, "emitted radiance", "emitted_radiance", 3, NONE, NOT_NEGATIVE},
    {TRACE_SKY, "sky radiance", "sky_radiance", 3, NONE, NOT_NEGATIVE},
    {TRACE_ADDED, "radiance added", "radiance_added", 3, NONE, NOT_NEGATIVE, CARRIED},
    {TRACE_WI, "sampled direction", "sampled_direction", 3},
    {TRACE_WEIGHT, "BSDF weight", "bsdf_weight", 3, NONE, NOT_NEGATIVE},
    {TRACE_PDF, "BSDF pdf", "bsdf_pdf", 1, NONE, NOT_NEGATIVE},
    {TRACE_ETA, "index ratio", "index_ratio", 1, NONE, NOT_NEGATIVE},
    {TRACE_THROUGHPUT, "throughput", "throughput", 3, NONE, NOT_NEGATIVE, CARRIED},
    {TRACE_SURVIVAL, "roulette chance", "roulette_chance", 1, NONE, NOT_NEGATIVE},
    {TRACE_LIGHT_DIRECTION, "light direction", "light_direction", 3},
    {TRACE_LIGHT_RADIANCE, "light radiance", "light_radiance", 3, NONE, NOT_NEGATIVE},
    {TRACE_LIGHT_PDF, "light pdf", "light_pdf", 1, NONE, NOT_NEGATIVE},
    {TRACE_LIGHT_BSDF, "BSDF to light", "light_bsdf", 3, NONE, NOT_NEGATIVE},
    {TRACE_LIGHT_BSDF_PDF, "BSDF pdf to light", "light_bsdf_pdf", 1, NONE, NOT_NEGATIVE},
    {TRACE_LIGHT_WEIGHT, "MIS weight", "mis_weight", 1, NONE, NOT_NEGATIVE},
    {TRACE_CONNECTION, "light arriving", "light_arriving", 3, NONE, NOT_NEGATIVE},
    {TRACE_SHARE, "visible share", "visible_share", 1, NONE, NOT_NEGATIVE},
    {TRACE_RADIANCE, "radiance", "radiance", 3, NONE, NOT_NEGATIVE, CARRIED},
    {TRACE_LAYER, "layer of paths", "path_layer", 3, NONE, NOT_NEGATIVE, CARRIED},
};

} // namespace

const Quantity& quantity(u32 id) {
    const auto* const row =
        std::find_if(std::begin(TABLE), std::end(TABLE), [id](const Quantity& q) { return q.id == id; });
    if (row == std::end(TABLE))
        throw std::out_of_range("no quantity of a record has the number " + std::to_string(id));
    return *row;
}

} // namespace clrt
