// SPDX-License-Identifier: Apache-2.0
#include "effects/effects.h"

#include "colour.h"
#include "paths/path_report.h"
#include "scene/light_leaves.h"
#include "scene/lights.h"
#include "scene/lobes.h"
#include "scene/material_override.h"
#include "scene/material_table.h"
#include "scene/split_emitters.h"

#include <algorithm>
#include <cassert>
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

std::string quoted_place(const SourcePlace& place) {
    return place.line ? fmt::format(" ({}:{})", place.file, place.line) : "";
}

/// Where an option was given: a line of the options file, or the command line.
SourcePlace place_of(const Options& options, const std::string& name) {
    const auto given = options.run.given.find(name);
    if (given == options.run.given.end())
        return {};
    const size_t colon = given->second.rfind(':');
    if (colon == std::string::npos)
        return {};
    return {given->second.substr(0, colon), std::stoul(given->second.substr(colon + 1))};
}

/// An option as a witness: its name and its line in the options file.
std::string describe_option(const Options& options, const std::string& name) {
    return name + quoted_place(place_of(options, name));
}

/// An option of the group "Light" as a witness; the studio's where it sets that light.
std::string describe_light(const Scene& scene, const Options& options, const std::string& name) {
    return scene.is_studio ? name + " of the studio" : describe_option(options, name);
}

/// Collects effects; every question is asked of the used materials or of one fact.
class EffectFinder {
public:
    explicit EffectFinder(const Scene& scene) : scene_(scene), used_(used_materials(scene)) {}

    /// The first used material with a property, or the number of materials.
    size_t first_material(const std::function<bool(const Material&)>& calls) const {
        size_t i = 0;
        while (i < used_.size() && !(used_[i] && calls(scene_.materials[i])))
            ++i;
        return i;
    }

    /// An effect that the first used material with a property calls for.
    void material(EffectMask bit, const std::string& absent,
                  const std::function<bool(const Material&)>& calls) {
        const size_t i = first_material(calls);
        if (i == used_.size())
            return fact(bit, false, absent);
        fact(bit, true, describe_material(scene_, i), scene_.material_places[i]);
    }

    /// An effect that a map of the first used material with one of these maps calls for.
    void map(EffectMask bit, const std::string& absent,
             const std::function<std::vector<u32>(size_t)>& maps_of) {
        for (size_t i = 0; i < used_.size(); ++i)
            for (const u32 map : used_[i] ? maps_of(i) : std::vector<u32>())
                if (map != NO_INDEX)
                    return fact(bit, true,
                                fmt::format("{}, map \"{}\"{}", describe_material(scene_, i),
                                            scene_.texture_names[map],
                                            quoted_place(scene_.texture_places[map])),
                                scene_.texture_places[map]);
        fact(bit, false, absent);
    }

    /// An effect that one fact decides.
    void fact(EffectMask bit, bool present, const std::string& witness, const SourcePlace& place = {}) {
        list_.push_back({bit, row_of(bit).name, present, witness, place});
    }

    /// All that were asked for, in the order of the table.
    std::vector<Effect> take() {
        std::sort(list_.begin(), list_.end(),
                  [](const Effect& a, const Effect& b) { return &row_of(a.bit) < &row_of(b.bit); });
        assert(list_.size() == effect_table().size());
        return std::move(list_);
    }

private:
    static const EffectSpec& row_of(EffectMask bit) {
        return *std::find_if(effect_table().begin(), effect_table().end(),
                             [bit](const EffectSpec& row) { return row.bit == bit; });
    }

    std::vector<Effect> list_;
    const Scene& scene_;
    const std::vector<bool> used_;
};

void find_delta_lights(const Scene& scene, const Options& options, EffectFinder& finder) {
    std::vector<std::string> parts;
    std::string first = "--point";
    for (const u32 kind : {LIGHT_POINT, LIGHT_SUN})
        for (const SourceCount& lights : count_lights(scene, kind)) {
            if (parts.empty())
                first = lights.source;
            parts.push_back(
                fmt::format("{} by {}", lights.count, describe_light(scene, options, lights.source)));
        }
    const bool given = !options.light.points.empty() || !options.light.suns.empty();
    if (parts.empty())
        parts.push_back(given ? "no --point, no --spot, no --sun with power"
                              : "no --point, no --spot, no --sun");
    finder.fact(EFFECT_DELTA_LIGHT, !scene.lights.empty(), fmt::format("{}", fmt::join(parts, ", ")),
                place_of(options, first));
}

void find_mapped_emission(const Scene& scene, EffectFinder& finder) {
    const EmissiveTriangles triangles = count_emissive_triangles(scene);
    finder.fact(EFFECT_MAPPED_EMISSION, triangles.split > 0,
                triangles.split > 0
                    ? fmt::format("{} emissive triangles in {} parts, by what their maps send from each",
                                  triangles.split, triangles.parts)
                    : "no map makes an emissive triangle shine unevenly");
}

void find_spots(const Scene& scene, EffectFinder& finder) {
    const auto is_spot = [](const Light& light) { return LIGHT_SHARPNESS(light) > 0; };
    const auto count = std::count_if(scene.lights.begin(), scene.lights.end(), is_spot);
    finder.fact(EFFECT_SPOT, count > 0,
                count > 0 ? fmt::format("{} shine within a cone", count) : "no light shines within a cone");
}

void find_environment(const Scene& scene, const Options& options, EffectFinder& finder) {
    const Environment& sky = scene.environment;
    const bool map = !sky.texels.empty();
    const bool bright = largest_component(sky.radiance) > 0;
    const bool is_backdrop = !bright && scene.background && largest_component(*scene.background) > 0;
    const bool given = scene.is_studio || !options.light.environment_file.empty() ||
                       options.light.environment || options.light.sky;
    const char* const name = options.light.sky ? "--sky" : "--env";
    const std::string option = describe_light(scene, options, name);
    const SourcePlace place = place_of(options, name);
    finder.fact(EFFECT_ENVIRONMENT, bright || is_backdrop,
                is_backdrop
                    ? describe_option(options, "--background") + ": radiance above 0, to the camera alone"
                : !bright ? (given ? option + ": black" : "no --env, and other light is there")
                : given   ? option + ": radiance above 0"
                          : "white sky: radiance above 0 where nothing else gives light",
                is_backdrop ? place_of(options, "--background") : place);
    finder.fact(
        EFFECT_ENVIRONMENT_MAP, map && bright,
        !map ? "no map"
             : fmt::format("{}, {} x {} texels{}", option, sky.width, sky.height, bright ? "" : ", black"),
        map ? place : SourcePlace{});
}

void find_light_effects(const Scene& scene, const Options& options, EffectFinder& finder) {
    const bool area = !scene.emitters.empty();
    const size_t first = area ? scene.triangles[scene.emitters[0].triangle].material : 0;
    finder.fact(EFFECT_AREA_LIGHT, area,
                area ? fmt::format("{} emissive triangles, first {}", count_emissive_triangles(scene).count,
                                   describe_material(scene, first))
                     : "no triangle emits",
                area ? scene.material_places[first] : SourcePlace{});
    find_mapped_emission(scene, finder);
    find_delta_lights(scene, options, finder);
    find_environment(scene, options, finder);
}

/// All maps of a material, NO_INDEX among them.
std::vector<u32> maps_of(const Scene& scene, size_t i) {
    const Material& m = scene.materials[i];
    std::vector<u32> maps = {m.map_matte,     m.map_specular, m.map_emission, m.map_coverage,
                             m.map_roughness, m.map_metallic, m.map_normal,   m.map_bump};
    if (scene.extensions.empty())
        return maps;
    const MaterialExtension& e = scene.extensions[i];
    for (const u32 map : {e.map_transmission, e.map_coat, e.map_sheen, e.map_coat_roughness,
                          e.map_sheen_roughness, e.map_anisotropy})
        maps.push_back(map);
    return maps;
}

/// --material may be the reason why effects of materials are absent.
void find_material_effects(const Scene& scene, const Options& options, EffectFinder& finder) {
    const MaterialReplacement* replacement = find_replacement(options.scene.material_override);
    const std::string by = replacement ? fmt::format(", by {} {}", describe_option(options, "--material"),
                                                     name_of(replacement->which))
                                       : "";
    for (const LobeSpec& lobe : LOBE_SPECS)
        finder.material(lobe.effect, lobe.absent + by, [&](const Material& m) {
            const bool is_mixed = lobe.bit == LOBE_DIELECTRIC && (m.flags & MATERIAL_PART_GLASS);
            return (m.lobes & lobe.bit) || is_mixed; // part glass implies refraction
        });
    const auto flagged = [&](EffectMask effect, u32 flag, const char* absent) {
        finder.material(effect, absent + by, [flag](const Material& m) { return (m.flags & flag) != 0; });
    };
    flagged(EFFECT_PART_GLASS, MATERIAL_PART_GLASS, "no material is partly glass");
    flagged(EFFECT_ATTENUATION, MATERIAL_ATTENUATES, "no solid absorbs on the way through it");
    flagged(EFFECT_DISPERSION, MATERIAL_DISPERSES, "no glass has an Abbe number");
    flagged(EFFECT_NESTED, MATERIAL_NESTED, "no solid has a priority");
    flagged(EFFECT_ROTATION, MATERIAL_TURNED, "no stretched highlight is turned");
    finder.material(EFFECT_ROUGH_REFRACTION, "no dielectric is rough" + by, [](const Material& m) {
        return (m.lobes & LOBE_DIELECTRIC) && m.alpha_x > 0 && MATERIAL_INDEX(m) != 1.0f;
    });
    finder.map(EFFECT_TEXTURES, "no material has a map" + by, [&](size_t i) { return maps_of(scene, i); });
    finder.map(EFFECT_NORMAL_MAP, "no material has one" + by, [&](size_t i) {
        return std::vector<u32>{scene.materials[i].map_normal, scene.materials[i].map_bump};
    });
}

/// One set of texture coordinates is the first, whatever its number in the file.
void find_second_uvs(const Scene& scene, EffectFinder& finder) {
    finder.map(EFFECT_SECOND_UV, "no material reads two sets of texture coordinates", [&](size_t i) {
        std::vector<u32> maps;
        for (const u32 map : maps_of(scene, i))
            if (map != NO_INDEX && (scene.textures[map].channel & TEXTURE_SECOND_UV))
                maps.push_back(map);
        return maps;
    });
}

/// Pictures alone have levels; what lies between vertices is as smooth as it looks.
void find_texture_filter(const Scene& scene, const Options& options, EffectFinder& finder) {
    const char* const option = "--texture-filter";
    const Integrator integrator = options.transport.integrator;
    const bool wanted = options.scene.texture_filter == TextureFilter::FOOTPRINT;
    const bool taken = takes_option(integrator, TAKES_TEXTURE_FILTER);
    const bool has_picture =
        std::any_of(scene.textures.begin(), scene.textures.end(),
                    [](const Texture& texture) { return texture.format != TEXEL_VERTEX; });
    finder.fact(EFFECT_TEXTURE_FILTER, wanted && taken && has_picture,
                !wanted        ? "no --texture-filter footprint"
                : !taken       ? fmt::format("{} reads textures at a point", name_of(integrator))
                : !has_picture ? "no material has a picture"
                               : describe_option(options, option) + " footprint",
                wanted ? place_of(options, option) : SourcePlace{});
}

void find_smooth_normals(const Scene& scene, EffectFinder& finder) {
    size_t first = 0;
    while (first < scene.triangles.size() && scene.triangles[first].n0 == NO_INDEX)
        ++first;
    const bool has = first < scene.triangles.size();
    finder.fact(
        EFFECT_SMOOTH_NORMALS, has,
        has ? fmt::format("normals at the corners of triangle {}{}", first, quoted_place(scene.first_smooth))
            : "no vn and no smoothing group",
        scene.first_smooth);
}

void find_cut_outs(EffectFinder& finder) {
    finder.material(EFFECT_CUT_OUT, "no coverage below 1",
                    [](const Material& m) { return (m.flags & MATERIAL_CUT_OUT) != 0; });
}

bool is_conductor(const Material& m) {
    return m.fresnel == FRESNEL_CONDUCTOR && (m.lobes & (LOBE_GLOSSY | LOBE_MIRROR));
}

void find_conductors(EffectFinder& finder) {
    finder.material(EFFECT_CONDUCTOR, "no material has a complex index of refraction", is_conductor);
}

void find_instances(const Scene& scene, const Options& options, EffectFinder& finder) {
    const char* const option = "--instances";
    const bool has = !scene.prototypes.empty();
    finder.fact(
        EFFECT_INSTANCES, has,
        has ? fmt::format("{} instances of {} meshes", scene.instances.size() - 1, scene.prototypes.size())
        : options.scene.instances == Toggle::OFF ? describe_option(options, option) + " off"
                                                 : "no mesh is shared",
        has ? SourcePlace{} : place_of(options, option));
}

void find_filter(const Options& options, EffectFinder& finder) {
    const bool filtered = options.film.filter != Filter::BOX;
    finder.fact(EFFECT_FILTER, filtered, filtered ? describe_option(options, "--filter") : "box filter",
                place_of(options, "--filter"));
}

void find_light_tree(const Scene& scene, const Options& options, unsigned kinds, EffectFinder& finder) {
    const char* const option = "--light-sampler";
    const Integrator integrator = options.transport.integrator;
    kinds &= light_tree_kinds(integrator);
    if (light_tree_kinds(integrator) == 0)
        finder.fact(
            EFFECT_LIGHT_TREE, false,
            fmt::format("{} connects to {} light", name_of(integrator),
                        integrator_row(integrator).connections == Connections::NO_LIGHT ? "no" : "every"));
    else if (options.sampling.light_sampler != LightSampler::TREE)
        finder.fact(
            EFFECT_LIGHT_TREE, false,
            fmt::format("{} {}", describe_option(options, option), name_of(options.sampling.light_sampler)),
            place_of(options, option));
    else if (is_glowing_dome(scene, kinds))
        finder.fact(EFFECT_LIGHT_TREE, false, "one lamp all around, whose parts lie alike to every point");
    else if (has_several_leaves(scene, kinds))
        finder.fact(EFFECT_LIGHT_TREE, true, "several lights, chosen for each surface point");
    else
        finder.fact(EFFECT_LIGHT_TREE, false, "no two lights to choose between");
}

void find_motion_blur(const Scene& scene, const Options& options, EffectFinder& finder) {
    const CameraOptions& camera = options.camera;
    const char* const scene_option = end_option(options.scene);
    const bool camera_given = camera.end_eye || camera.end_at || camera.end_up;
    const char* const camera_option = !camera_given && scene_option ? scene_option
                                      : camera.end_eye              ? "--end-eye"
                                      : camera.end_at               ? "--end-at"
                                                                    : "--end-up";
    const char* const option = scene.position_moves.empty() ? camera_option : scene_option;
    std::vector<std::string> parts;
    if (!scene.position_moves.empty())
        parts.push_back("triangles move by " + describe_option(options, scene_option));
    if (scene.camera.end)
        parts.push_back("the camera moves by " + describe_option(options, camera_option));
    const bool has_motion = !parts.empty();
    if (!has_motion)
        parts.emplace_back(camera_given || scene_option
                               ? "nothing moves while the shutter is open"
                               : "no --end, --animation-time T,T2, --end-eye, --end-at or --end-up");
    finder.fact(EFFECT_MOTION_BLUR, has_motion, fmt::format("{}", fmt::join(parts, ", ")),
                has_motion ? place_of(options, option) : SourcePlace{});
}

void find_depth_of_field(const Scene& scene, const Options& options, EffectFinder& finder) {
    const char* const option = options.camera.fstop ? "--fstop" : "--aperture";
    const bool given = options.camera.fstop || options.camera.aperture;
    finder.fact(EFFECT_DEPTH_OF_FIELD, scene.camera.aperture > 0,
                scene.camera.aperture > 0
                    ? fmt::format("{}: a lens of diameter {:.6g}", describe_option(options, option),
                                  scene.camera.aperture)
                : given ? describe_option(options, option) + " 0"
                        : "a pinhole: no --aperture, no --fstop",
                given ? place_of(options, option) : SourcePlace{});
}

/// A path of three segments scatters twice.
void find_interreflection(const Scene& scene, const Options& options, EffectFinder& finder) {
    const int depth = effective_max_depth(options.transport);
    const size_t reflecting = finder.first_material([](const Material& m) { return m.lobes != 0; });
    const std::string limit =
        options.transport.max_depth && takes_option(options.transport.integrator, TAKES_MAX_DEPTH)
            ? fmt::format("{} {}", describe_option(options, "--max-depth"), depth)
            : fmt::format("paths of at most {} segments", depth);
    if (reflecting == scene.materials.size())
        finder.fact(EFFECT_INTERREFLECTION, false, "no material reflects");
    else if (depth <= 2)
        finder.fact(EFFECT_INTERREFLECTION, false, limit, place_of(options, "--max-depth"));
    else
        finder.fact(EFFECT_INTERREFLECTION, true, limit + ", " + describe_material(scene, reflecting),
                    scene.material_places[reflecting]);
}

/// What --effects asks for, of all effects.
EffectMask chosen_effects(const Options& options, EffectMask needed) {
    const EffectMask start = options.effects.list  ? with_implied(*options.effects.list)
                             : options.effects.all ? EVERY_EFFECT
                                                   : needed;
    return without_effects(start, options.effects.off);
}

} // namespace

Effects find_effects(const Scene& scene, const Options& options) {
    EffectFinder finder(scene);
    find_light_effects(scene, options, finder);
    find_material_effects(scene, options, finder);
    find_smooth_normals(scene, finder);
    find_cut_outs(finder);
    find_filter(options, finder);
    Effects effects;
    effects.paths = plan_paths(scene, options);
    finder.fact(EFFECT_PATH_FILTER, effects.paths.is_filter, path_summary(effects.paths),
                place_of(options, "--paths"));
    find_light_tree(scene, options, accepted_kinds(effects.paths), finder);
    find_motion_blur(scene, options, finder);
    find_depth_of_field(scene, options, finder);
    find_spots(scene, finder);
    find_conductors(finder);
    find_instances(scene, options, finder);
    find_interreflection(scene, options, finder);
    find_second_uvs(scene, finder);
    find_texture_filter(scene, options, finder);

    effects.list = finder.take();
    for (const Effect& effect : effects.list)
        if (effect.present)
            effects.needed |= effect.bit;
    const EffectMask chosen = chosen_effects(options, effects.needed);
    effects.mask = chosen & EFFECT_ALL;
    effects.left_out = effects.needed & ~chosen;
    return effects;
}

std::string format_effects(const Effects& effects) {
    std::string text;
    for (const Effect& effect : effects.list)
        text += fmt::format("  {:<8} {:<22} {}\n",
                            !effect.present                 ? "absent"
                            : effects.left_out & effect.bit ? "left out"
                                                            : "present",
                            effect.name, effect.witness);
    return text;
}

std::vector<std::string> describe_left_out(const Effects& effects) {
    std::vector<std::string> lines;
    for (const EffectSpec& effect : effect_table())
        if (effects.left_out & effect.bit)
            lines.push_back(fmt::format("--effects leaves out {}: {}", effect.name, effect.without));
    return lines;
}

} // namespace clrt
