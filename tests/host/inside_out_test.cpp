// SPDX-License-Identifier: Apache-2.0
// Closed glass whose corners run the wrong way round is noted; bubbles, panes and solids are not.
#include "scene/inside_out.h"

#include "kernels/shared/lobes.h"
#include "probes/meshes.h"
#include "probes/scene_builder.h"
#include "scene/place_instances.h"

#include <gtest/gtest.h>

namespace clrt {
namespace {

class InsideOut : public testing::Test {
protected:
    InsideOut() {
        scene.materials.resize(2);
        scene.materials[1].lobes = LOBE_DIELECTRIC;
        scene.material_names = {"wall", "glass"};
        scene.material_places = {{"a.mtl", 1}, {"a.mtl", 7}};
    }

    void add_ball(const glm::dvec3& centre, double radius, bool is_inward, u32 material = 1) {
        for (const TestTriangle& t : icosphere_triangles(centre, radius, 1)) {
            if (is_inward)
                add_triangle(scene, t.corners[0], t.corners[2], t.corners[1]);
            else
                add_triangle(scene, t.corners[0], t.corners[1], t.corners[2]);
            scene.triangles.back().material = material;
            scene.triangles.back().object = objects;
        }
        ++objects;
    }

    std::vector<std::string> lines() const {
        NoticeList notices;
        note_inside_out_glass(scene, notices);
        return notices.lines();
    }

    Scene scene = make_empty_scene();
    u32 objects = 0;
};

} // namespace

TEST_F(InsideOut, AClosedBodyIsNotedWithItsMaterial) {
    add_ball({5, 1, -3}, 0.5, true);
    add_ball({-5, 1, -3}, 2, false);
    ASSERT_EQ(lines().size(), 1u);
    EXPECT_NE(lines()[0].find("a.mtl:7: glass 'glass' is closed and inside out"), std::string::npos)
        << lines()[0];
}

TEST_F(InsideOut, BubblesSolidsAndOtherMaterialsAreNot) {
    add_ball({0, 0, 0}, 2, false);
    add_ball({0.3, 0, 0}, 0.5, true);
    add_ball({9, 0, 0}, 1, true, 0);
    EXPECT_TRUE(lines().empty());
}

TEST_F(InsideOut, InstancesHaveTheirMeshsFrontsWhereTheyAre) {
    add_ball({0, 0, 0}, 2, false); // the scene's own
    const auto share = [&](bool is_inward) {
        const u32 first = u32(scene.triangles.size());
        add_ball({0, 0, 0}, 1, is_inward);
        scene.prototypes.push_back({first, u32(scene.triangles.size()) - first});
    };
    const auto add_instance = [&](u32 prototype, double x, double size, bool is_mirrored) {
        glm::dmat4 map(1);
        map[0][0] = is_mirrored ? -size : size;
        map[1][1] = map[2][2] = size;
        map[3][0] = x;
        Instance instance = make_instance(map, glm::dvec3(1));
        instance.prototype = prototype;
        scene.instances.push_back(instance);
    };
    share(false);
    scene.instances.emplace_back();
    add_instance(0, 8, 1, false);
    add_instance(0, -8, 1, true);
    EXPECT_TRUE(lines().empty()) << "a mirrored solid is one";
    share(true);
    EXPECT_TRUE(lines().empty()) << "it is nowhere";
    const std::vector<Instance> before = scene.instances;
    for (const double holder : {0.0, 8.0, -8.0}) { // within the scene's own solid, and within instances
        scene.instances = before;
        add_instance(1, holder, 0.5, false);
        EXPECT_TRUE(lines().empty()) << holder;
    }
    for (const bool is_mirrored : {false, true}) {
        scene.instances = before;
        add_instance(1, 4, 0.5, is_mirrored);
        add_instance(1, 5, 0.5, is_mirrored);
        ASSERT_EQ(lines().size(), 1u) << is_mirrored;
        EXPECT_NE(lines()[0].find("a.mtl:7: glass 'glass' is closed and inside out"), std::string::npos);
        EXPECT_EQ(lines()[0].find("more"), std::string::npos) << "once for a material: " << lines()[0];
    }
}

TEST_F(InsideOut, OpenSurfacesHaveNoInside) {
    add_ball({0, 0, 0}, 1, true);
    scene.triangles.resize(scene.triangles.size() * 3 / 4);
    EXPECT_TRUE(lines().empty());
}

} // namespace clrt
