// SPDX-License-Identifier: Apache-2.0
// scattering/bsdf_energy.h: every material that the table of rules makes, in a white furnace. A surface under
// light from everywhere never shines brighter than the light, and as bright where nothing is absorbed.
#include "probes/random_inputs.h"
#include "probes/scene_probe.h"
#include "support/mtl_material.h"
#include "support/test_device.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec3;

namespace {

/// Directions of a lattice for each part of a BSDF; the error of the mean of both is part of the bounds
/// below.
constexpr u32 DIRECTIONS = 2048;
constexpr double LATTICE_ERROR = 5e-4;
/// No light is created: the albedo's bound.
constexpr double MOST = 1 + 1e-3;
/// Nothing is lost where nothing absorbs, but what the tables of glass keep back: they have three dimensions,
/// and are nowhere above the integral.
constexpr double LEAST_LOSSLESS = 0.99, LEAST_GLASS = 0.97;

/// Mixtures are sampled as wholes, which has a larger error.
constexpr double MIXED_ERROR = 4e-3;
/// Below a coat the table is that of a white lobe (bsdf_cover.h), and glass from inside loses what the film
/// sends back. Below a sheen a rough metal loses what is reflected back to it at another angle.
constexpr double LEAST_COATED = 0.98, LEAST_COVERED = 0.93, LEAST_COATED_SHEEN = 0.98;

/// The albedo of a BSDF: the mean weight of its samples, radiance behind glass freed of eta^2. Every part of
/// the mixture gets the same directions (Roberts' generalised golden ratio) and counts by its probability;
/// where the lobe's number decides between reflection and refraction too, it takes STRATA values. What passes
/// a smooth pane is no sample, and added.
const char* const TEXT = R"(
#define STRATA 12u

real3 furnace_part(const Bsdf* bsdf, real low, real high, uint strata, uint k)
{
    real3 sum = (real3)(REAL(0.0));
    if (!(high > low))
        return sum;
    const real2 u = (real2)(sampler_unit(3242174889u * k), sampler_unit(2447445414u * k));
    for (uint j = 0u; j < strata; ++j) {
        const real shift = strata == 1u ? REAL(0.5) : sampler_unit(2654435769u * k);
        const BsdfSample s = bsdf_sample(bsdf, low + (high - low) * ((real)j + shift) / (real)strata, u);
        if (s.is_valid)
            sum += s.weight / (s.eta * s.eta);
    }
    return sum * ((high - low) / (real)strata);
}

/* Where several parts have glass or a cover: all of the mixture at once, by many lobes' numbers. */
#define MIXED_STRATA 48u

real3 furnace_albedo(const Bsdf* bsdf, uint count)
{
    if (bsdf_is_part_glass(bsdf) || bsdf_is_covered(bsdf)) {
        real3 mixed = (real3)(REAL(0.0));
        for (uint k = 1u; k <= count; ++k)
            mixed += furnace_part(bsdf, REAL(0.0), REAL(1.0), MIXED_STRATA, k);
        return mixed / (real)count;
    }
    const bool is_glass = (bsdf->lobes & LOBES_GLASS) != 0u;
    const real multiple = bsdf->choose_multiple;
    const real a = is_glass ? multiple * bsdf->multiple_reflects : bsdf->choose[LOBE_ROW_MATTE];
    const real b = is_glass ? multiple : bsdf->choose[LOBE_ROW_MATTE] + multiple;
    real3 sum = (real3)(REAL(0.0));
    for (uint k = 1u; k <= count; ++k) {
        sum += furnace_part(bsdf, REAL(0.0), a, 1u, k) + furnace_part(bsdf, a, b, 1u, k) +
               furnace_part(bsdf, b, REAL(1.0), is_glass ? STRATA : 1u, k);
    }
    return sum / (real)count;
}
)";

SceneProbe& probe() {
    static SceneProbe instance = [] {
        SceneProbe made(test_device(), {"scattering/material.h"}, TEXT);
        // a: barycentric weights, triangle, number of directions; b: wo
        made.add("albedo",
                 "Hit hit; hit.t = REAL(1.0); hit.b1 = (real)a.x; hit.b2 = (real)a.y; hit_set_triangle(0u, "
                 "as_uint(a.z), &hit);"
                 "const Ray ray_there = ray_make((real3)(REAL(0.0)), -vector_from(b), REAL(0.0));"
                 "const Surface surface = surface_at(scene, &hit, &ray_there);"
                 "const Bsdf bsdf = material_bsdf(scene, &surface, vector_from(b), TRANSPORT_RADIANCE);"
                 "const bool crosses = (bsdf.lobes & LOBE_PANE) && bsdf_pane_is_delta(&bsdf);"
                 "const real3 passes = crosses ? bsdf_pane_passes(&bsdf) : (real3)(REAL(0.0));"
                 "first = probe_vec4(furnace_albedo(&bsdf, as_uint(a.w)) + passes, REAL(0.0));");
        return made;
    }();
    return instance;
}

struct Case {
    std::string keys;
    Material material;
};

/// A scene whose triangle i has material i, and the maps that materials use.
class Materials {
public:
    explicit Materials(float map_value) {
        Texture texture{};
        texture.width = texture.height = 1;
        texture.format = TEXEL_FLOAT;
        texture.scale_u = texture.scale_v = texture.gain = 1;
        scene_.textures.push_back(texture);
        for (const float value : {map_value, map_value, map_value, 1.0f})
            scene_.texel_words.push_back(float_to_bits(value));
        scene_.positions = {{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}};
        scene_.uvs = {0, 0, 1, 0, 0, 1};
    }

    /// Adds what the rules make of the keys, unless it is there already.
    /// `weight`: of transmission.
    void add(const std::string& keys, double weight = 0) {
        NoticeList notices;
        const LoadMap first_texture = [](const TextureUse&, TextureRole) { return 0u; };
        MtlMaterial mtl = parse_mtl("newmtl m\n" + keys, "m.mtl", notices).at(0);
        if (weight > 0)
            mtl.transmission_weight = weight;
        const RuledMaterial ruled = rule_material(mtl, {}, first_texture, notices);
        const Material material = ruled.material;
        for (const Case& old : cases)
            if (std::memcmp(&old.material, &material, sizeof material) == 0 && !ruled.extension.is_needed)
                return;
        Triangle triangle{};
        triangle.v1 = triangle.t1 = 1;
        triangle.v2 = triangle.t2 = 2;
        triangle.n0 = triangle.n1 = triangle.n2 = triangle.emitter = NO_INDEX;
        triangle.material = u32(cases.size());
        scene_.triangles.push_back(triangle);
        scene_.materials.push_back(material);
        append_extension(ruled.extension, scene_);
        cases.push_back({keys, material});
    }

    /// Calls check(case, wo, albedo) for every material and direction.
    template <class Check>
    void for_each(const Check& check) {
        std::vector<vec4> hits, wo;
        std::vector<size_t> which;
        for (size_t i = 0; i < cases.size(); ++i)
            for (const double cosine : {0.004, 0.04, 0.2, 0.6, 1.0})
                for (const int side : {1, -1}) {
                    if (side < 0 && !(cases[i].material.lobes & LOBES_GLASS))
                        continue;
                    // Stretched lobes along and across, and in between.
                    const bool is_round = cases[i].material.alpha_x == cases[i].material.alpha_y;
                    for (const double azimuth : {0.0, 0.8, PI / 2}) {
                        if (is_round && azimuth != 0.8)
                            continue;
                        dvec3 direction = direction_at(cosine, azimuth);
                        direction.z *= side;
                        hits.push_back({0.25f, 0.25f, float_of(u32(i)), float_of(DIRECTIONS)});
                        wo.push_back(to_vec4(direction));
                        which.push_back(i);
                    }
                }
        const SceneProbe::Outputs got = probe().run("albedo", scene_, RenderParams{}, hits, wo);
        for (size_t i = 0; i < hits.size(); ++i)
            check(cases[which[i]], to_dvec3(wo[i]), to_dvec3(got.first[i]));
    }

    std::vector<Case> cases;

private:
    static float float_of(u32 word) {
        float value;
        std::memcpy(&value, &word, sizeof value);
        return value;
    }
    Scene scene_;
};

/// Pr, Ns and aniso in all combinations that matter.
std::vector<std::string> roughnesses() {
    std::vector<std::string> keys = {"", "Ns 0\n", "Ns 30\n", "Ns 999\n"};
    for (const double pr : {0.0, 0.0101, 0.1, 0.2, 0.45, 0.7, 1.0})
        for (const double aniso : {0.0, 0.4, 1.0})
            keys.push_back(fmt::format("Pr {}\naniso {}\n", pr, aniso));
    return keys;
}

/// Every row of the table with these colours and maps.
void add_rules(const std::string& colours, Materials& materials) {
    for (const MaterialRow& row : material_rows())
        for (const std::string& roughness : roughnesses())
            materials.add(row.keys + "\n" + colours + roughness);
}

double least_of(const Material& material) {
    const bool is_covered = (material.lobes & (LOBE_COAT | LOBE_SHEEN)) != 0;
    if (is_covered && (material.lobes & LOBES_ROUGH))
        return material.lobes & LOBE_SHEEN ? LEAST_COVERED : LEAST_COATED;
    if ((material.lobes & LOBE_COAT) && (material.lobes & LOBE_SHEEN))
        return LEAST_COATED_SHEEN;
    return material.lobes & LOBE_DIELECTRIC ? LEAST_GLASS : LEAST_LOSSLESS;
}

double largest(const dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

void expect_no_light_created(Materials& materials) {
    materials.for_each([](const Case& made, const dvec3& wo, const dvec3& albedo) {
        EXPECT_LE(largest(albedo), MOST + LATTICE_ERROR)
            << made.keys << "wo " << wo.x << " " << wo.y << " " << wo.z;
    });
}

} // namespace

TEST(BsdfEnergy, NoRuleMakesMoreLightThanItGets) {
    Materials materials(1);
    for (const char* colours : {"Kd 1 1 1\nKs 1 1 1\nTf 1 1 1\n", "Kd 1 0.9 0.2\nKs 0.04 0.3 0.9\n",
                                "Kd 1 1 1\nKs 0.5 0.5 0.5\nNi 2.4\n"})
        add_rules(colours, materials);
    expect_no_light_created(materials);
}

TEST(BsdfEnergy, NeitherDoMapsWhateverTheySay) {
    for (const float value : {0.0f, 1.0f, 4.0f}) {
        Materials materials(value);
        add_rules("Kd 1 1 1\nmap_Kd a.png\nKs 1 1 1\nmap_Ks a.png\nmap_Pr a.png\n", materials);
        add_rules("Kd 1 1 1\nmap_Kd a.png\nPm 0.5\nmap_Pr a.png\n", materials);
        add_rules("Kd 1 1 1\nPm 1\nmap_Pm a.png\n", materials);
        expect_no_light_created(materials);
    }
}

TEST(BsdfEnergy, NothingIsLostWhereNothingAbsorbs) {
    Materials materials(1);
    for (const std::string& roughness : roughnesses()) {
        materials.add("Pm 1\nKd 1 1 1\n" + roughness);
        materials.add("Pm 0\nKd 1 1 1\n" + roughness);
        materials.add("illum 3\nKd 0 0 0\nKs 1 1 1\n" + roughness);
        materials.add("eta 0.001\nk 5\n" + roughness); // absorbs 2e-4 head-on
        materials.add("illum 5\nKd 1 1 1\nKs 0.3 0.3 0.3\n" + roughness);
        for (const double index : {1.1, 1.5, 2.4})
            materials.add(fmt::format("illum 7\nNi {}\n", index) + roughness);
    }
    materials.for_each([](const Case& made, const dvec3& wo, const dvec3& albedo) {
        if (made.material.alpha_x != made.material.alpha_y)
            return; // said in bsdf_energy.h: their tables are coarser
        const double least = made.material.lobes & LOBE_DIELECTRIC ? LEAST_GLASS : LEAST_LOSSLESS;
        EXPECT_GE(albedo.x, least - LATTICE_ERROR)
            << made.keys << "wo " << wo.x << " " << wo.y << " " << wo.z;
    });
}

TEST(BsdfEnergy, GlassOfAnyIndexMakesNoLight) {
    Materials materials(1);
    for (const double index : {1.001, 1.01, 1.03, 1.05, 1.08, 1.1, 1.3, 1.5, 2.4})
        for (const double roughness : {0.0317, 0.1, 0.2, 0.32, 0.45, 0.58, 0.7, 0.84, 1.0})
            for (const double ni : {index, 1 / index})
                materials.add(fmt::format("illum 7\nNi {:.6f}\nPr {}\n", ni, roughness));
    materials.for_each([&](const Case& made, const dvec3& wo, const dvec3& albedo) {
        EXPECT_LE(albedo.x, MOST + LATTICE_ERROR) << made.keys << "wo " << wo.x << " " << wo.y << " " << wo.z;
    });
}

TEST(BsdfEnergy, PartGlassPanesAndCoversMakeNoLightAndLoseLittle) {
    Materials materials(1);
    for (const double pr : {0.0, 0.1, 0.45, 0.7, 1.0}) {
        const std::string rough = fmt::format("Pr {}\n", pr);
        for (const double weight : {0.3, 0.5, 1.0})
            for (const char* rest : {"Pm 0\n", "Pm 0.5\n", "Pm 0\nthin_walled 1\n"})
                materials.add("Kd 1 1 1\nmap_Kd a.png\n" + (rest + rough), weight);
        materials.add("Kd 1 1 1\nillum 7\nthin_walled 1\n" + rough);
        for (const double pcr : {0.03, 0.3, 0.6}) {
            const std::string coat = fmt::format("Pc 1\nPcr {}\n", pcr);
            materials.add("Kd 1 1 1\nPm 0\n" + rough + coat);
            materials.add("Kd 1 1 1\nPm 1\n" + rough + coat);
            materials.add("Kd 1 1 1\nillum 1\n" + rough + coat + "Ps 1\n");
        }
        materials.add("Kd 1 1 1\nillum 1\nPs 1\n" + rough);
        materials.add("Kd 1 1 1\nPm 1\nPs 0.5\n" + rough);
    }
    materials.for_each([](const Case& made, const dvec3& wo, const dvec3& albedo) {
        EXPECT_LE(largest(albedo), MOST + MIXED_ERROR)
            << made.keys << "wo " << wo.x << " " << wo.y << " " << wo.z;
        if (MATERIAL_METALLIC(made.material) == 0.5f)
            return; // F0 and base of half a metal keep less by themselves
        EXPECT_GE(albedo.x, least_of(made.material) - MIXED_ERROR)
            << made.keys << "wo " << wo.x << " " << wo.y << " " << wo.z;
    });
}
