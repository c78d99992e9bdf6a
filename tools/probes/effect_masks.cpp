// SPDX-License-Identifier: Apache-2.0
#include "probes/effect_masks.h"

#include "probes/merl_file.h"
#include "probes/meshes.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <set>
#include <utility>

namespace clrt {

bool is_permitted(EffectMask effects) {
    for (const EffectSpec& effect : effect_table())
        if ((effects & effect.bit) && effect.one_of && !(effects & effect.one_of))
            return false;
    return with_implied(effects) == effects;
}

namespace {

/// The set with what it cannot be without; matte where any lobe would do, else the first that does.
EffectMask completed(EffectMask effects) {
    effects = with_implied(effects);
    for (const EffectSpec& effect : effect_table())
        if ((effects & effect.bit) && effect.one_of && !(effects & effect.one_of))
            effects |= effect.one_of & EFFECT_MATTE ? EFFECT_MATTE : effect.one_of & ~(effect.one_of - 1);
    return with_implied(effects);
}

/// Every two bits with their values in a set, as numbers.
std::set<u32> pairs_of(EffectMask effects) {
    std::set<u32> pairs;
    const u32 count = u32(effect_table().size());
    const auto bit = [&](u32 i) { return (effects & effect_table()[i].bit) != 0; };
    for (u32 i = 0; i < count; ++i)
        for (u32 j = i + 1; j < count; ++j)
            pairs.insert((i * count + j) * 4 + 2 * bit(i) + bit(j));
    return pairs;
}

/// A set in which every effect is as likely as not, as far as a scene can call for it.
EffectMask random_effects(std::mt19937& random) {
    for (;;) {
        EffectMask effects = 0;
        for (const EffectSpec& effect : effect_table())
            if (random() & 1)
                effects |= effect.bit;
        // Half of the draws add what is implied, the others take away what implies it.
        effects = random() & 1 ? with_implied(effects) : without_effects(effects, EVERY_EFFECT & ~effects);
        if (is_permitted(effects))
            return effects;
    }
}

const char* const COLOUR = "colour.png";

/// A ball of the floor's material on either side, one of them a mirror image.
void add_two_instances(Scene& scene) {
    const glm::dmat4 left = glm::scale(glm::translate(glm::dmat4(1), {-0.5, 0.3, 0}), glm::dvec3(0.1));
    add_instances(scene, make_ball(6, 5), {left, glm::scale(glm::dmat4(1), {-1, 1, 1}) * left});
    for (Instance& instance : scene.instances)
        instance.object = 0;
}

} // namespace

std::vector<EffectMask> single_effects() {
    std::vector<EffectMask> sets;
    for (const EffectSpec& effect : effect_table())
        sets.push_back(completed(effect.bit));
    return sets;
}

std::vector<EffectMask> all_but_one_effect() {
    std::vector<EffectMask> sets;
    for (const EffectSpec& effect : effect_table())
        sets.push_back(without_effects(EVERY_EFFECT, effect.bit));
    return sets;
}

std::vector<EffectMask> pairwise_effects() {
    constexpr int CANDIDATES = 400, PROBES = 4000;
    std::mt19937 random(1);
    std::set<u32> missing;
    for (int i = 0; i < PROBES; ++i)
        for (const u32 pair : pairs_of(random_effects(random)))
            missing.insert(pair);
    std::vector<EffectMask> sets;
    while (!missing.empty()) {
        EffectMask best = 0;
        size_t most = 0;
        for (int i = 0; i < CANDIDATES || most == 0; ++i) {
            const EffectMask candidate = random_effects(random);
            const std::set<u32> pairs = pairs_of(candidate);
            const size_t covered = size_t(std::count_if(pairs.begin(), pairs.end(),
                                                        [&](u32 pair) { return missing.count(pair) != 0; }));
            if (covered > most)
                most = covered, best = candidate;
        }
        for (const u32 pair : pairs_of(best))
            missing.erase(pair);
        sets.push_back(best);
    }
    return sets;
}

std::vector<EffectMask> all_effect_sets() {
    std::set<EffectMask> sets{0, EVERY_EFFECT};
    for (const auto& family : {single_effects(), all_but_one_effect(), pairwise_effects()})
        sets.insert(family.begin(), family.end());
    return {sets.begin(), sets.end()};
}

void read_by_second_uvs(const std::string& file, Scene& scene) {
    for (size_t i = 0; i < scene.uvs.size(); ++i)
        scene.second_uvs.push_back(scene.uvs[i ^ 1]);
    for (size_t i = 0; i < scene.textures.size(); ++i)
        if (scene.texture_names[i] == file)
            scene.textures[i].channel |= TEXTURE_SECOND_UV;
}

std::string describe_effects(EffectMask effects) {
    return fmt::format("{:#x}: {}", effects, fmt::join(effect_names(effects), ","));
}

SceneOfEffects::SceneOfEffects(EffectMask effects) : effects_(effects) {
    options.film.size = {16, 16};
    options.sampling.spp = 16;
    options.sampling.replicates = 8;
    options.effects.all = false;
    if (!has(EFFECT_INTERREFLECTION))
        options.transport.max_depth = 2;
    if (has(EFFECT_FILTER))
        options.film.filter = Filter::GAUSSIAN;
    if (has(EFFECT_PATH_FILTER))
        options.transport.paths = "L(D|S)?E";
    options.sampling.light_sampler = has(EFFECT_LIGHT_TREE) ? LightSampler::TREE : LightSampler::MIXTURE;
    add_materials();
    add_bodies();
    add_lights();
    look({0.2, 1.6, 3}, {0, 0.5, 0}, 50);
    finish = [effects](Scene& scene) {
        if (effects & EFFECT_INSTANCES)
            add_two_instances(scene);
        if (effects & EFFECT_SECOND_UV)
            read_by_second_uvs(COLOUR, scene);
    };
    if (has(EFFECT_MOTION_BLUR))
        options.camera.end_eye = glm::dvec3(0.3, 1.7, 2.9);
    if (has(EFFECT_DEPTH_OF_FIELD))
        options.camera.aperture = 0.1;
    if (has(EFFECT_TEXTURE_FILTER))
        options.scene.texture_filter = TextureFilter::FOOTPRINT;
}

void SceneOfEffects::add_materials() {
    std::vector<unsigned char> colour;
    std::vector<float> normal;
    for (int i = 0; i < 64; ++i) {
        colour.insert(colour.end(),
                      {(unsigned char)(i * 97), (unsigned char)(i * 31), (unsigned char)(200 - i)});
        normal.insert(normal.end(), {0.5f + 0.1f * float(i % 3), 0.5f - 0.1f * float(i % 2), 0.95f});
    }
    texture8(COLOUR, 8, 8, 3, colour);
    texture("normal.exr", 8, 8, 3, normal);

    const auto map = [&](const char* key) {
        return has(EFFECT_TEXTURES) ? std::string("\n") + key + " " + COLOUR : std::string();
    };
    const std::string black = "Kd 0 0 0";
    const std::string base = has(EFFECT_MATTE) ? "Kd 0.7 0.6 0.5" + map("map_Kd") : black;
    const std::string tint = has(EFFECT_MATTE) ? "Kd 0.2 0.3 0.2\n" : "Kd 0 0 0\n";
    build.material("floor", base + (has(EFFECT_NORMAL_MAP) ? "\nnorm normal.exr" : ""));
    build.material("bumpy", base + (has(EFFECT_NORMAL_MAP) ? std::string("\nbump -bm 0.05 ") + COLOUR : ""));
    build.material("plain", has(EFFECT_MATTE) ? "Kd 0.5 0.5 0.8" : black);
    build.material("gloss", tint + "Ks 0.6 0.6 0.5\nNs 30\nillum 2" + map("map_Ks"));
    build.material("brushed", tint + "Pm 0.8\nPr 0.4\naniso 0.7" + (has(EFFECT_MATTE) ? map("map_Pr") : ""));
    build.material("mirror", tint + "Ks 0.7 0.7 0.6\nillum 3" + map("map_Ks"));
    build.material("copper", "conductor copper");
    build.material("gold", "conductor gold\nPr 0.4");
    build.material("glass", "Ni 1.5\nTf 0.9 1 0.9\nillum 7");
    build.material("frosted", "Ni 1.4\nillum 7\nPr 0.5" + map("map_Pr"));
    const std::string turned = "\nPr 0.4\naniso 0.7\nanisor 0.2";
    build.material("honey", "Ni 1.4\nillum 7\nattenuation 0.3 0.6 0.9");
    build.material("flint", "Ni 1.6\nillum 7\nabbe 15");
    build.material("ice", "Ni 1.3\nillum 7\npriority 1");
    build.material("stained",
                   tint + "Pm 0\nTf 0.6" + (has(EFFECT_MIRROR) ? "\nPr 0\nNi 1.5" : "\nPr 0.4\nNi 1"));
    build.material("lacquer", tint + "Pc 0.9\nPcr 0.2");
    build.material("velvet", tint + "Ps 0.8");
    build.material("pane", "illum 7\nthin_walled 1");
    build.material("turned",
                   has(EFFECT_GLOSSY)
                       ? tint + "Pm 0.8" + turned
                       : "illum 7" + turned + (has(EFFECT_ROUGH_REFRACTION) ? "" : "\nthin_walled 1"));
    build.material("turned_glass", "illum 7" + turned);
    build.material("sample", "merl sample.binary");
    if (has(EFFECT_MEASURED))
        folder.write("sample.binary",
                     merl_file(matte_and_glossy({0.4, 0.2, 0.1}, {0.3, 0.3, 0.2}, 0.3), {12, 8, 8}));
    build.material("screen", base + "\nd 0.6" + map("map_d"));
    std::vector<unsigned char> lamp(64, has(EFFECT_MAPPED_EMISSION) ? 20 : 230);
    lamp[9] = lamp[44] = 230;
    texture8("lamp.png", 8, 8, 1, lamp);
    build.material("lamp",
                   std::string("Kd 0 0 0\nKe 8 7 5") + (has(EFFECT_TEXTURES) ? "\nmap_Ke lamp.png" : ""));
}

void SceneOfEffects::add_bodies() {
    build.use("floor").textured_quad({{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}});
    build.use("bumpy").textured_quad({{-2, 0, -1.5}, {2, 0, -1.5}, {2, 2, -1.6}, {-2, 2, -1.6}});
    build.use("plain").box({-0.2, 0.01, -1.2}, {0.2, 0.5, -0.9});
    if (has(EFFECT_GLOSSY)) {
        build.use("gloss").icosphere({0.6, 0.35, -0.3}, 0.3, 1);
        build.use("brushed").textured_quad(
            {{-1.6, 0.1, -0.8}, {-0.9, 0.1, -1}, {-0.9, 1, -1.1}, {-1.6, 1, -0.9}});
    }
    if (has(EFFECT_MIRROR))
        build.use("mirror").box({0.9, 0.01, -0.9}, {1.5, 0.9, -0.4});
    if (has(EFFECT_CONDUCTOR)) {
        if (has(EFFECT_MIRROR))
            build.use("copper").box({1.5, 0.01, 0.2}, {1.8, 0.6, 0.5});
        if (has(EFFECT_GLOSSY))
            build.use("gold").icosphere({-1.2, 0.3, 0.1}, 0.25, 1);
    }
    if (has(EFFECT_REFRACTION))
        build.use("glass").icosphere({-0.4, 0.4, 0.3}, 0.3, 1);
    if (has(EFFECT_ROUGH_REFRACTION))
        build.use("frosted").textured_quad(
            {{0.3, 0.1, 0.6}, {0.9, 0.1, 0.6}, {0.9, 0.7, 0.5}, {0.3, 0.7, 0.5}});
    add_rare_bodies();
    if (has(EFFECT_SMOOTH_NORMALS))
        build.use(has(EFFECT_REFRACTION) ? "glass" : "plain")
            .icosphere({0.1, 0.9, -0.4}, 0.25, 1, Facing::OUTWARD, Shading::SMOOTH);
    if (has(EFFECT_CUT_OUT))
        build.use("screen").textured_quad({{-1, 0.1, 0.8}, {0, 0.1, 0.8}, {0, 1.2, 0.6}, {-1, 1.2, 0.6}});
}

void SceneOfEffects::add_rare_bodies() {
    if (has(EFFECT_ATTENUATION))
        build.use("honey").icosphere({1.2, 1.3, -0.3}, 0.25, 1);
    if (has(EFFECT_DISPERSION))
        build.use("flint").icosphere({-0.9, 0.9, 0.3}, 0.2, 1);
    if (has(EFFECT_NESTED))
        build.use("ice").icosphere({0.2, 0.7, 0.5}, 0.15, 1);
    if (has(EFFECT_PART_GLASS))
        build.use("stained").icosphere({-1.2, 1.4, -0.3}, 0.25, 1);
    if (has(EFFECT_COAT))
        build.use("lacquer").icosphere({0.5, 1.3, -0.6}, 0.2, 1);
    if (has(EFFECT_SHEEN))
        build.use("velvet").icosphere({-0.5, 1.4, -0.6}, 0.2, 1);
    if (has(EFFECT_MEASURED))
        build.use("sample").icosphere({-0.9, 1.7, 0.1}, 0.2, 1);
    if (has(EFFECT_THIN_WALL))
        build.use("pane").textured_quad(
            {{-1.7, 0.1, 0.4}, {-1.2, 0.1, 0.4}, {-1.2, 0.6, 0.2}, {-1.7, 0.6, 0.2}});
    if (has(EFFECT_ROTATION) && has(EFFECT_ROUGH_REFRACTION))
        build.use("turned_glass").textured_quad({{1, 1, 0}, {1.4, 1, 0}, {1.4, 1.3, 0}, {1, 1.3, 0}});
    if (has(EFFECT_ROTATION))
        build.use("turned").textured_quad({{1.1, 0.1, 0.2}, {1.7, 0.1, 0.2}, {1.7, 0.7, 0}, {1.1, 0.7, 0}});
}

void SceneOfEffects::add_lights() {
    options.light.environment = glm::dvec3(0);
    if (has(EFFECT_AREA_LIGHT))
        build.use("lamp").textured_quad({{-0.6, 2, -0.4}, {0.4, 2, -0.4}, {0.4, 2, 0.4}, {-0.6, 2, 0.4}});
    if (has(EFFECT_AREA_LIGHT) && has(EFFECT_LIGHT_TREE)) // there is another to choose
        build.textured_quad({{1.2, 1.8, -0.4}, {1.4, 1.8, -0.4}, {1.4, 1.8, 0.4}, {1.2, 1.8, 0.4}});
    if (has(EFFECT_DELTA_LIGHT)) {
        options.light.suns.push_back({{1, 2, 1}, {3, 3, 2}, 3});
        options.light.points.push_back({{-1, 2, 1}, {2, 2, 4}});
    }
    if (has(EFFECT_SPOT))
        options.light.points.push_back({{1, 2, 1}, {5, 4, 2}, SpotCone{{-1, -1.5, -1}, 30, 10}, "--spot"});
    if (has(EFFECT_ENVIRONMENT))
        options.light.environment = glm::dvec3(0.4, 0.5, 0.6);
    if (has(EFFECT_ENVIRONMENT_MAP)) {
        std::vector<float> sky;
        for (int i = 0; i < 32; ++i)
            sky.insert(sky.end(), {0.1f + float(i % 7), 0.3f, float(i % 5)});
        texture("sky.exr", 8, 4, 3, sky);
        options.light.environment.reset();
        options.light.environment_file = folder.file("sky.exr");
    }
}

} // namespace clrt
