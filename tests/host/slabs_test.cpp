// SPDX-License-Identifier: Apache-2.0
// Which glass makes slabs, and when connections cross them.
#include "scene/slabs.h"

#include "paths/path_plan.h"
#include "probes/scratch_scene.h"
#include "render/render_params.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

const char* const CLEAR = "Ni 1.5\nillum 7";

/// A thing of glass under a sky, loaded.
template <typename Add>
Scene glass(const std::string& keys, const Add& add) {
    ScratchScene scratch;
    scratch.build.material("glass", keys).use("glass");
    add(scratch.build);
    scratch.options.light.environment = glm::dvec3(1);
    Scene scene = scratch.load();
    mark_slabs(scene);
    return scene;
}

void pane(SceneBuilder& build) {
    build.box({-1, 0, -1}, {1, 0.02, 1});
}

bool is_slab(const Scene& scene) {
    return (scene.materials[0].flags & MATERIAL_SLAB) != 0;
}

} // namespace

TEST(Slabs, AreOfParallelFacets) {
    EXPECT_TRUE(is_slab(glass(CLEAR, pane)));
    EXPECT_TRUE(is_slab(glass(CLEAR, [](SceneBuilder& build) { build.box({0, 0, 0}, {1, 1, 1}); })));
    const auto prism = [](SceneBuilder& build) {
        build.polygon({{0, 0, 0}, {4, 0, 0}, {4, 0, 4}, {0, 0, 4}});
        build.polygon({{0, 0, 4}, {4, 0, 4}, {4, 1, 4}, {0, 1, 4}});
        build.polygon({{0, 0, 0}, {0, 1, 4}, {4, 1, 4}, {4, 0, 0}});
    };
    EXPECT_FALSE(is_slab(glass(CLEAR, prism)));
    const auto gem = [](SceneBuilder& build) { build.icosphere({0, 0, 0}, 1, 1); };
    EXPECT_FALSE(is_slab(glass(CLEAR, gem))) << "too many directions";
    const auto ball = [](SceneBuilder& build) {
        build.icosphere({0, 0, 0}, 1, 0, Facing::OUTWARD, Shading::SMOOTH);
    };
    EXPECT_FALSE(is_slab(glass(CLEAR, ball))) << "bent normals";
}

TEST(Slabs, AreOfClearGlassAlone) {
    for (const char* more : {"Pr 0.3", "d 0.5", "abbe 30", "Ke 1 1 1", "thin_walled 1"})
        EXPECT_FALSE(is_slab(glass(std::string(CLEAR) + "\n" + more, pane))) << more;
    EXPECT_FALSE(is_slab(glass("Kd 1 1 1", pane)));
    EXPECT_TRUE(is_slab(glass(std::string(CLEAR) + "\nTf 0.2 0.5 0.9", pane)));
}

TEST(Slabs, AreCrossedTowardsLightFromOutside) {
    Scene scene = glass(CLEAR, pane);
    Options options;
    options.transport.integrator = Integrator::PATH;
    EXPECT_TRUE(crosses_slabs(scene, options));
    for (const Integrator integrator : {Integrator::LIGHT, Integrator::MLT, Integrator::WHITTED}) {
        options.transport.integrator = integrator;
        EXPECT_FALSE(crosses_slabs(scene, options)) << name_of(integrator);
    }
    options.transport.integrator = Integrator::BDPT;
    EXPECT_TRUE(crosses_slabs(scene, options));
    options.transport.paths = "LDE";
    EXPECT_FALSE(crosses_slabs(scene, options));
    options.transport.paths.clear();
    scene.environment = {};
    EXPECT_FALSE(crosses_slabs(scene, options));
    scene.lights.push_back({});
    scene.lights.back().kind = LIGHT_SUN;
    EXPECT_TRUE(crosses_slabs(scene, options));
    scene.materials[0].flags |= MATERIAL_NESTED;
    EXPECT_FALSE(crosses_slabs(scene, options));
}

TEST(Slabs, AreCrossedTowardsLamps) {
    Scene scene = glass(CLEAR, pane);
    Options options;
    options.transport.integrator = Integrator::PATH;
    EXPECT_FALSE(finds_lamps_behind_slabs(scene, options)) << "there are none";
    scene.emitters.push_back({});
    EXPECT_TRUE(finds_lamps_behind_slabs(scene, options));
    for (const Integrator integrator : {Integrator::PATH_LIGHT, Integrator::BDPT, Integrator::WHITTED}) {
        options.transport.integrator = integrator;
        EXPECT_FALSE(finds_lamps_behind_slabs(scene, options)) << name_of(integrator);
    }
    options.transport.integrator = Integrator::PATH;
    options.transport.paths = "LDE";
    EXPECT_FALSE(finds_lamps_behind_slabs(scene, options));
    options.transport.paths.clear();
    scene.materials[scene.triangles[scene.emitters[0].triangle].material].lobes |= LOBE_COAT;
    EXPECT_FALSE(finds_lamps_behind_slabs(scene, options)) << "a coat dims them by direction";
}

} // namespace clrt
