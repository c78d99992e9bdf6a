// SPDX-License-Identifier: Apache-2.0
// The MTL reader and the repairs: any bytes give materials inside their ranges or a SceneError.
#include "error.h"
#include "fuzz_target.h"
#include "scene/readers/mtl_repair.h"

#include <cmath>
#include <limits>

namespace clrt {

namespace {

constexpr double UNBOUNDED = std::numeric_limits<double>::max();

void check_range(const std::optional<double>& value, double least, double most) {
    promise(!value || (*value >= least && *value <= most), "values are in their ranges");
}

void check_range(const std::optional<glm::dvec3>& value, double most) {
    for (int c = 0; value && c < 3; ++c)
        check_range((*value)[c], 0, most);
}

void check_map(const std::optional<MtlTexture>& map) {
    if (!map)
        return;
    promise(!map->file.empty(), "a map names a file");
    for (const double value : {map->scale.x, map->scale.y, map->offset.x, map->offset.y, map->base, map->gain,
                               map->bump_multiplier})
        promise(std::isfinite(value), "a map's numbers are finite");
    promise(!map->channel || *map->channel <= 4, "a map's channel is one of five");
}

void check_material(const MtlMaterial& m) {
    for (const auto& colour : {m.ka, m.kd, m.ks, m.tf})
        check_range(colour, 1);
    check_range(m.ke, UNBOUNDED);
    for (const auto& share : {m.d, m.tr, m.pr, m.pm, m.ps, m.pcr, m.aniso, m.dielectric_f0})
        check_range(share, 0, 1);
    for (const auto& number : {m.ns, m.pc, m.anisor})
        check_range(number, 0, UNBOUNDED);
    check_range(m.ni, std::numeric_limits<double>::denorm_min(), UNBOUNDED);
    promise(!m.illum || (*m.illum >= 0 && *m.illum <= 9), "illum is one of ten");
    for (const auto* map : {&m.map_kd, &m.map_ks, &m.map_ke, &m.map_d, &m.map_pr, &m.map_pm, &m.map_ps,
                            &m.map_normal, &m.map_bump, &m.map_ns, &m.map_refl, &m.map_dielectric_f0})
        check_map(*map);
}

/// A repaired material is in the same ranges; the pictures of half the names can be read, or are normal maps.
void check_repairs(const MtlMaterial& mtl, NoticeList& notices) {
    const PictureFacts facts{[](const TextureUse& map, TextureRole) { return map.file.size() % 2 == 0; },
                             [](const TextureUse& map) { return map.file.size() % 4 == 0; }};
    check_material(repair_material(mtl, facts, notices));
}

} // namespace

} // namespace clrt

int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
    using namespace clrt;
    try {
        NoticeList notices;
        for (const MtlMaterial& material : parse_mtl(as_text(data, size), "a.mtl", notices)) {
            check_material(material);
            check_repairs(material, notices);
        }
        notices.lines();
    } catch (const SceneError&) {
    }
    return 0;
}
