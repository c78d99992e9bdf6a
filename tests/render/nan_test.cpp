// SPDX-License-Identifier: Apache-2.0
// A NaN anywhere inside a sample is counted, also where the comparison that meets it first would take it for
// black, for a light behind the surface or for an end by roulette. NaNs are planted into a copy of the
// kernels, by the seed.
#include "probes/prepared_render.h"
#include "support/render_scene.h"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// Which samples come by a place of the kernels.
enum class Reached { BY_ALL, IF_LIT, IF_CONTINUED };

/// What may become NaN, and the floors whose picture depends on it.
struct Value {
    const char* name;
    std::vector<std::string> floors = {"matte", "glossy", "mirror", "glass", "rough glass"};
};

/// A statement of the kernels and the values that may become NaN right behind it.
struct Place {
    const char* file;
    const char* statement;
    std::vector<Value> values;
    Reached reached = Reached::BY_ALL;
};

std::vector<Value> surface_values() {
    return {{"surface.position.y"}, {"surface.normal_g.x"}, {"surface.normal_s.z"}};
}

std::vector<Value> light_values() {
    return {{"light.wi.y"}, {"light.radiance.z"}, {"light.pdf_w"}, {"light.target.x"}};
}

std::vector<Place> path_places() {
    const char* const file = "integrators/path.h";
    return {
        {file, "const Surface surface = visible_surface(scene, params, &path->ray, &path->hit);",
         surface_values()},
        {file,
         "Bsdf bsdf = vertex_bsdf(scene, &surface, wo);",
         {{"bsdf.wo.z", {"glossy", "mirror", "glass", "rough glass"}},
          {"bsdf.frame.z.y"},
          {"bsdf.matte.x", {"matte", "glossy"}},
          {"bsdf.specular.y", {"glossy", "mirror"}},
          {"bsdf.alpha_x", {"glossy", "rough glass"}},
          {"bsdf.eta", {"glass", "rough glass"}}}},
        {file,
         "const real3 wo = -path->ray.direction;",
         {{"path->numbers.direction.x", {"matte", "glossy", "rough glass"}}}},
        {file,
         "const BsdfSample next = path_sample(scene, &surface, &bsdf, continues, &guide, path);",
         {{"next.wi.x"}},
         Reached::IF_CONTINUED},
        {"path/walk.h", "path->throughput *= next->weight;", {{"path->throughput.y"}}, Reached::IF_CONTINUED},
        {"path/walk.h",
         "path->ray = surface_ray(surface, next->reflects, next->wi);",
         {{"path->ray.origin.x"}, {"path->ray.direction.y"}},
         Reached::IF_CONTINUED},
        {"path/connect.h", "LightSample light = path_light(scene, params, surface, bsdf, path);",
         light_values(), Reached::IF_LIT},
    };
}

/// Those of the integrators that light locally; `file` has the rest of the vertex, from the statement `first`
/// on.
std::vector<Place> direct_places(const char* file, const char* first) {
    return {{"integrators/direct.h", "light_choose_side(scene, surface, &light);", light_values(),
             Reached::IF_LIT},
            {file, first, surface_values()},
            {file,
             "const Bsdf bsdf = vertex_bsdf(scene, &surface, wo);",
             {{"bsdf.wo.z"},
              {"bsdf.frame.z.y", {"matte", "glossy"}},
              {"bsdf.matte.x", {"matte", "glossy"}},
              {"bsdf.specular.y", {"glossy"}}}}};
}

std::vector<Place> light_places() {
    const char* const file = "path/light_path.h";
    return {
        {file,
         "path->emission = emission_sample(scene, params, &numbers);",
         {{"path->emission.power.y"}, {"path->emission.ray.direction.x"}, {"path->emission.pdf"}}},
        {"path/light_vertex.h",
         "vertex->surface = visible_surface(scene, params, ray, hit);",
         {{"vertex->surface.position.y"}, {"vertex->surface.normal_g.x"}, {"vertex->surface.normal_s.z"}}},
        {"path/light_vertex.h",
         "light_vertex_complete(scene, -ray->direction, vertex);",
         {{"vertex->bsdf.wo.z"}, {"vertex->bsdf.frame.z.y"}, {"vertex->bsdf.matte.x"}}},
        {file,
         "const CameraConnection camera =\n"
         "        camera_project_at(params, surface->position, lens, surface_time(surface));",
         {{"camera.pdf_a"}, {"camera.film.x"}, {"camera.lens.y"}}},
        {file, "const BsdfValue eval = light_bent_eval(scene, vertex, hit, wi);", {{"eval.value.z"}}},
        {file,
         "const BsdfSample next = light_bent_sample(scene, vertex, hit, sampler_unit(choices.x), direction);",
         {{"next.wi.x"}, {"next.weight.x"}}},
        {file, "path->throughput *= next.weight;", {{"path->throughput.y"}}}};
}

std::vector<Place> whitted_places() {
    std::vector<Place> places =
        direct_places("integrators/whitted.h",
                      "const Surface surface = visible_surface(scene, params, &current->ray, &hit);");
    places.push_back(
        {"integrators/whitted.h",
         "uint whitted_push(const RenderParams* params, WhittedRay child, WhittedRay* stack, uint top)\n{",
         {{"child.weight.y"}, {"child.weight.yz = 0.0f; child.weight.x"}, {"child.ray.direction.z"}},
         Reached::IF_CONTINUED});
    return places;
}

std::vector<Place> distribution_places() {
    const char* const file = "integrators/distribution.h";
    const char* const lights = "integrators/distribution_light.h";
    return {
        {file, "const Surface surface = visible_surface(scene, params, &path->ray, &hit);", surface_values()},
        {file,
         "Bsdf bsdf = vertex_bsdf(scene, surface, -path->ray.direction);",
         {{"bsdf.wo.z"},
          {"bsdf.frame.z.y"},
          {"bsdf.matte.x", {"matte", "glossy"}},
          {"bsdf.specular.y", {"glossy"}},
          {"bsdf.alpha_x", {"glossy", "rough glass"}}}},
        {lights,
         "LightSample light =\n            each_light_emitter(scene, params, vertex->surface, normal, "
         "words, alias_word);",
         light_values(), Reached::IF_LIT},
        {"integrators/distribution_ray.h",
         "TreeRay child, TreeRay* stack, uint top)\n{",
         {{"child.weight.y"}, {"child.weight.yz = 0.0f; child.weight.x"}, {"child.ray.direction.z"}},
         Reached::IF_CONTINUED},
    };
}

/// Puts text behind a statement of a file; a constant that it declares can be changed there.
KernelPatch insertion(const char* file, const std::string& statement, const std::string& text) {
    const std::string constant = "const ";
    const bool is_constant = statement.compare(0, constant.size(), constant) == 0;
    return {file, statement, statement.substr(is_constant ? constant.size() : 0) + text};
}

/// Kernels that make value k of the places NaN where the seed is k + 1.
PatchedKernels spoiled_kernels(const std::vector<Place>& places) {
    std::vector<KernelPatch> patches;
    int seed = 0;
    for (const Place& place : places) {
        std::string text;
        for (const Value& value : place.values)
            text += fmt::format("\n if (params->seed == {}u) {{ {} = REAL_NAN; }}\n", ++seed, value.name);
        patches.push_back(insertion(place.file, place.statement, text));
    }
    return PatchedKernels(kernels_under_test(), patches);
}

/// Kernels that make what a statement declares NaN.
PatchedKernels spoiled_kernels(const char* file, const char* statement, const char* value) {
    return PatchedKernels(kernels_under_test(),
                          {insertion(file, statement, fmt::format(" {} = REAL_NAN;", value))});
}

/// A floor under a lamp, with nothing else to see; every sample sees the floor.
class FloorUnderALamp : public TestScene {
public:
    explicit FloorUnderALamp(const std::string& keys) {
        build.material("floor", keys).material("lamp", "Kd 0 0 0\nKe 1 1 1");
        build.use("floor").textured_quad({{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}});
        build.use("lamp").polygon({{-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}});
        look_at_point({1, 1, 0}, {0, 0, 0});
        options.transport.max_depth = 2;
        options.sampling.spp = 8;
        options.sampling.replicates = 8;
    }
    std::uint64_t samples() const {
        return std::uint64_t(options.film.size.x) * std::uint64_t(options.film.size.y) *
               *options.sampling.spp;
    }
};

/// Floors: name and keys of the material.
constexpr std::pair<const char*, const char*> FLOORS[] = {
    {"matte", "Kd 0.5 0.5 0.5"},
    {"glossy", "Kd 0.3 0.3 0.3\nKs 0.4 0.4 0.4\nNs 50\nillum 2"},
    {"mirror", "Kd 0 0 0\nKs 0.9 0.9 0.9\nillum 3"},
    {"glass", "Ni 1.5\nillum 7"},
    {"rough glass", "Ni 1.5\nillum 7\nPr 0.4"},
};

/// Samples of a render that came by a place of their first vertex; `good` are the counts without NaNs.
std::uint64_t samples_at(Reached place, const FloorUnderALamp& scene, const RenderCounts& counts,
                         const RenderCounts& good) {
    if (place == Reached::IF_LIT && good.shadow == 0)
        return 0;
    const bool is_path = scene.options.transport.integrator == Integrator::PATH;
    if (place == Reached::IF_CONTINUED && (is_path || good.secondary == 0))
        return counts.secondary;
    return scene.samples();
}

void expect_all_counted(Integrator integrator, const std::vector<Place>& places) {
    const PatchedKernels kernels = spoiled_kernels(places);
    for (const auto& [name, keys] : FLOORS) {
        FloorUnderALamp scene(keys);
        scene.options.transport.integrator = integrator;
        scene.options.device.kernels_folder = kernels.path();
        const RenderCounts good = scene.render().counts;
        EXPECT_EQ(good.nan, 0u) << name;
        std::uint32_t seed = 0;
        for (const Place& place : places)
            for (const Value& value : place.values) {
                scene.options.sampling.seed = ++seed;
                if (std::find(value.floors.begin(), value.floors.end(), name) == value.floors.end())
                    continue;
                const RenderCounts counts = scene.render().counts;
                const std::uint64_t expected = samples_at(place.reached, scene, counts, good);
                if (expected > 0) {
                    EXPECT_EQ(counts.nan, expected) << name << ": " << value.name << " in " << place.file;
                }
            }
    }
}

/// Expects that a render with these kernels counts every sample as NaN.
void expect_counted(const PatchedKernels& kernels, FloorUnderALamp& scene, Integrator integrator,
                    const std::string& what = "") {
    scene.options.transport.integrator = integrator;
    scene.options.device.kernels_folder = kernels.path();
    EXPECT_EQ(scene.render().counts.nan, scene.samples()) << what;
}

} // namespace

TEST(Nan, PathTracingCountsItWhereverItArises) {
    expect_all_counted(Integrator::PATH, path_places());
}

// Most light paths meet the floor where the picture shows it, but not all: more than half of the samples.
TEST(Nan, LightPathsCountItWhereverItArises) {
    const std::vector<Place> places = light_places();
    const PatchedKernels kernels = spoiled_kernels(places);
    FloorUnderALamp scene("Kd 0.5 0.5 0.5");
    scene.options.transport.integrator = Integrator::LIGHT;
    scene.options.transport.max_depth = 3;
    scene.options.device.kernels_folder = kernels.path();
    scene.look({0, 2.5, 6}, {0, 0, 0}, 90);
    EXPECT_EQ(scene.render().counts.nan, 0u);
    std::uint32_t seed = 0;
    for (const Place& place : places)
        for (const Value& value : place.values) {
            scene.options.sampling.seed = ++seed;
            EXPECT_GT(scene.render().counts.nan, scene.samples() / 2) << value.name << " in " << place.file;
        }
}

TEST(Nan, TheTreeOfRaysCountsItWhereverItArises) {
    expect_all_counted(Integrator::WHITTED, whitted_places());
}

TEST(Nan, DistributionCountsItWhereverItArises) {
    expect_all_counted(Integrator::DISTRIBUTION, distribution_places());
}

TEST(Nan, RayCastingCountsItWhereverItArises) {
    expect_all_counted(Integrator::RAYCAST,
                       direct_places("integrators/raycast.h",
                                     "const Surface surface = visible_surface(scene, params, &ray, &hit);"));
}

TEST(Nan, TheSideOfALampDoesNotHideIt) {
    const PatchedKernels kernels =
        spoiled_kernels("lights/emitter.h", "const real facing = -vector_dot(way, normal);", "facing");
    FloorUnderALamp scene("Kd 0.5 0.5 0.5");
    expect_counted(kernels, scene, Integrator::RAYCAST);
}

TEST(Nan, TheDistanceOfAPointLightDoesNotHideIt) {
    const PatchedKernels kernels = spoiled_kernels(
        "lights/delta_light.h", "const real distance_squared = vector_dot(way, way);", "distance_squared");
    FloorUnderALamp scene("Kd 0.5 0.5 0.5");
    scene.options.light.points.push_back({{0, 2, 1}, glm::dvec3(1)});
    expect_counted(kernels, scene, Integrator::RAYCAST);
}

TEST(Nan, AnInterpolatedNormalDoesNotHideIt) {
    const PatchedKernels kernels = spoiled_kernels(
        "geometry/surface.h", "const real length_squared = vector_dot(sum, sum);", "length_squared");
    FloorUnderALamp scene("Kd 0.5 0.5 0.5");
    scene.build.use("floor").icosphere({0, 0, 0}, 0.2, 1, Facing::OUTWARD, Shading::SMOOTH);
    expect_counted(kernels, scene, Integrator::RAYCAST);
}

TEST(Nan, NoMapHidesIt) {
    const PatchedKernels kernels =
        spoiled_kernels("geometry/texture.h", "const float4 upper = a + fx * (b - a);", "upper");
    for (const char* keys :
         {"Kd 1 1 1\nmap_Kd grey.png", "Kd 0.3 0.3 0.3\nKs 0.5 0.5 0.5\nmap_Ks grey.png\nillum 3",
          "Kd 0.5 0.5 0.5\nPm 0.5\nPr 0.5\nmap_Pr grey.png", "Kd 0.5 0.5 0.5\nPr 0.5\nPm 1\nmap_Pm grey.png",
          "Kd 0.5 0.5 0.5\nmap_bump grey.png", "Kd 0.5 0.5 0.5\nnorm grey.png",
          "Kd 0.5 0.5 0.5\nmap_d grey.png"}) {
        FloorUnderALamp scene(keys);
        scene.texture8("grey.png", 2, 2, 1, {100, 120, 140, 160});
        expect_counted(kernels, scene, Integrator::PATH, keys);
    }
}

} // namespace clrt
