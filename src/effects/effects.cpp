// SPDX-License-Identifier: Apache-2.0
#include "effects/effects.h"

#include "kernels/shared/effects.h"
#include "paths/path_report.h"

#include <fmt/format.h>
#include <functional>

namespace clrt {

namespace {

/// True for materials that are on at least one triangle.
std::vector<bool> used_materials(const Scene& scene) {
    std::vector<bool> used(scene.materials.size(), false);
    for (const Triangle& triangle : scene.triangles)
        used[triangle.material] = true;
    return used;
}

std::string describe_material(const Scene& scene, size_t index) {
    const SourcePlace& place = scene.material_places[index];
    const std::string where = place.line ? fmt::format(" ({}:{})", place.file, place.line) : "";
    return fmt::format("material \"{}\"{}", scene.material_names[index], where);
}

/// Collects effects; every question is asked of the used materials or of one fact.
class EffectFinder {
public:
    explicit EffectFinder(const Scene& scene) : scene_(scene), used_(used_materials(scene)) {}

    /// An effect that the first used material with a property calls for.
    void material(u32 bit, const char* name, const char* absent, const std::function<bool(const Material&)>& calls) {
        for (size_t i = 0; i < scene_.materials.size(); ++i)
            if (used_[i] && calls(scene_.materials[i]))
                return fact(bit, name, true, describe_material(scene_, i));
        fact(bit, name, false, absent);
    }

    /// An effect that one fact decides.
    void fact(u32 bit, const char* name, bool present, const std::string& witness) {
        list.push_back({bit, name, present, witness});
    }

    std::vector<Effect> list;

private:
    const Scene& scene_;
    const std::vector<bool> used_;
};

void find_light_effects(const Scene& scene, EffectFinder& finder) {
    const bool area = !scene.emitters.empty();
    finder.fact(EFFECT_AREA_LIGHT, "area lights", area,
                area ? fmt::format("{} emissive triangles, first {}", scene.emitters.size(),
                                   describe_material(scene, scene.triangles[scene.emitters[0].triangle].material))
                     : "no triangle emits");
    const bool delta = !scene.lights.empty();
    finder.fact(EFFECT_DELTA_LIGHT, "point lights and suns", delta,
                delta ? fmt::format("{} by --point or --sun", scene.lights.size()) : "no --point, no --sun");
    const Environment& sky = scene.environment;
    const bool map = !sky.texels.empty();
    const bool bright = sky.radiance.x > 0 || sky.radiance.y > 0 || sky.radiance.z > 0;
    finder.fact(EFFECT_ENVIRONMENT, "environment", bright, bright ? "radiance above 0 outside the scene" : "black");
    finder.fact(EFFECT_ENVIRONMENT_MAP, "environment map", map && bright,
                map ? fmt::format("--env, {} x {} texels", sky.width, sky.height) : "no map");
}

void find_material_effects(EffectFinder& finder) {
    finder.material(EFFECT_MATTE, "matte reflection", "no material has Kd above 0",
                    [](const Material& m) { return (m.lobes & LOBE_MATTE) != 0; });
    finder.material(EFFECT_GLOSSY, "glossy reflection", "no material reflects roughly",
                    [](const Material& m) { return (m.lobes & LOBE_GLOSSY) != 0; });
    finder.material(EFFECT_MIRROR, "mirror reflection", "no material is a mirror",
                    [](const Material& m) { return (m.lobes & LOBE_MIRROR) != 0; });
    finder.material(EFFECT_REFRACTION, "refraction", "no material is a dielectric",
                    [](const Material& m) { return (m.lobes & LOBE_DIELECTRIC) != 0; });
    finder.material(EFFECT_ROUGH_REFRACTION, "rough refraction", "no dielectric is rough",
                    [](const Material& m) { return (m.lobes & LOBE_DIELECTRIC) && m.alpha_x > 0; });
    finder.material(EFFECT_TEXTURES, "textures", "no material has a map", [](const Material& m) {
        for (u32 map : {m.map_matte, m.map_specular, m.map_emission, m.map_coverage, m.map_roughness, m.map_metallic,
                        m.map_normal, m.map_bump})
            if (map != NO_INDEX)
                return true;
        return false;
    });
    finder.material(EFFECT_NORMAL_MAP, "normal and bump maps", "no material has one",
                    [](const Material& m) { return m.map_normal != NO_INDEX || m.map_bump != NO_INDEX; });
}

/// The first triangle with corner normals, or the number of triangles.
size_t first_smooth_triangle(const Scene& scene) {
    size_t i = 0;
    while (i < scene.triangles.size() && scene.triangles[i].n0 == NO_INDEX)
        ++i;
    return i;
}

} // namespace

Effects find_effects(const Scene& scene, const Options& options) {
    EffectFinder finder(scene);
    find_light_effects(scene, finder);
    find_material_effects(finder);
    const size_t smooth = first_smooth_triangle(scene);
    const bool has_smooth = smooth < scene.triangles.size();
    finder.fact(EFFECT_SMOOTH_NORMALS, "smooth normals", has_smooth,
                has_smooth ? fmt::format("vn on triangle {}", smooth) : "no vn");
    finder.material(EFFECT_CUT_OUT, "cut-outs", "no coverage below 1",
                    [](const Material& m) { return (m.flags & MATERIAL_CUT_OUT) != 0; });
    const bool filtered = options.filter != Filter::BOX;
    finder.fact(EFFECT_FILTER, "pixel filter", filtered, filtered ? "--filter" : "box filter");

    Effects effects;
    effects.paths = plan_paths(scene, options);
    finder.fact(EFFECT_PATH_FILTER, "path filter", effects.paths.is_filter, path_summary(effects.paths));
    effects.list = std::move(finder.list);
    for (const Effect& effect : effects.list)
        if (effect.present || options.all_effects)
            effects.mask |= effect.bit;
    return effects;
}

std::string format_effects(const Effects& effects) {
    std::string text;
    for (const Effect& effect : effects.list)
        text += fmt::format("  {:<7} {:<22} {}\n", effect.present ? "present" : "absent", effect.name, effect.witness);
    return text;
}

} // namespace clrt
