// SPDX-License-Identifier: Apache-2.0
// Meshes that are used several times: what is shared, what is copied, where instances are, and their trees.
#include "bvh/instance_bounds.h"
#include "bvh/instanced_bvh.h"
#include "gltf_support.h"
#include "scene/load_scene.h"
#include "scene/place_instances.h"
#include "scene/placed_box.h"
#include "scene/vectors.h"
#include "scene_support.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <map>
#include <random>

namespace clrt {
namespace {

/// A closed solid of four triangles.
const std::vector<float> TETRAHEDRON = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1,
                                        0, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0};

/// Nodes with these texts, all with mesh 0.
GltfBuilder file_of(const std::vector<const char*>& nodes) {
    GltfBuilder file;
    file.add_mesh(TETRAHEDRON);
    file.json["nodes"] = Json::array();
    file.json["scenes"][0]["nodes"] = Json::array();
    for (const char* node : nodes) {
        Json json = Json::parse(node);
        json["mesh"] = 0;
        file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size());
        file.json["nodes"].push_back(json);
    }
    return file;
}

const std::vector<const char*> THREE_NODES = {
    R"({"name": "a", "translation": [2, 0, 0]})",
    R"({"name": "b", "translation": [0, 3, 0], "scale": [-1, 2, 1]})",
    R"({"name": "c", "rotation": [0, 0.6, 0, 0.8], "scale": [0.001, 0.001, 0.001]})"};

ReadGltf read_shared(GltfBuilder file, Toggle instances = Toggle::ON) {
    return ReadGltf(file.glb(), {}, "a.glb", instances);
}

Scene load(const std::string& path, Toggle instances) {
    Options options;
    options.scene.path = path;
    options.scene.instances = instances;
    Progress silent(Toggle::OFF, true);
    return load_scene(options, silent);
}

} // namespace

TEST(Instances, AreSharedWhereThatIsAskedFor) {
    const ReadGltf shared = read_shared(file_of(THREE_NODES));
    EXPECT_TRUE(shared.mesh().triangles.empty());
    ASSERT_EQ(shared.scene.prototypes.size(), 1u);
    EXPECT_EQ(shared.scene.prototypes[0].triangles.size(), 4u);
    ASSERT_EQ(shared.scene.instances.size(), 3u);
    for (u32 i = 0; i < 3; ++i)
        EXPECT_EQ(shared.mesh().object_names.at(shared.scene.instances[i].object),
                  std::string(1, char('a' + i)));
    EXPECT_TRUE(shared.notes("3 instances share 1 meshes of 4 triangles"));
    for (const Toggle copies : {Toggle::OFF, Toggle::AUTO}) { // few: copies take less
        const ReadGltf copied = read_shared(file_of(THREE_NODES), copies);
        EXPECT_EQ(copied.mesh().triangles.size(), 12u);
        EXPECT_TRUE(copied.scene.prototypes.empty());
    }
    EXPECT_EQ(read_shared(file_of({"{}"})).mesh().triangles.size(), 4u) << "used once";
}

TEST(Instances, ThatVanishAreLeftOutAndThoseThatAreFlatAreCopied) {
    std::vector<const char*> nodes = THREE_NODES;
    nodes.push_back(R"({"name": "nothing", "scale": [0, 0, 0]})");
    nodes.push_back(R"({"name": "line", "scale": [0, 1, 0]})");
    nodes.push_back(R"({"name": "decal", "scale": [1, 0, 1]})");
    const ReadGltf read = read_shared(file_of(nodes));
    EXPECT_EQ(read.scene.instances.size(), 3u);
    EXPECT_EQ(read.mesh().triangles.size(), 4u);
    EXPECT_TRUE(read.notes("2 instances are scaled to nothing"));
}

TEST(Instances, MapsAreTriedByShapeNotBySize) {
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1), 1.0, glm::normalize(glm::dvec3(1, 2, 3)));
    for (const double size : {1e-12, 1.0, 1e12})
        EXPECT_EQ(kind_of_map(glm::scale(turn, glm::dvec3(size, -size, 1e-3 * size))), MapKind::PLACES);
    EXPECT_EQ(kind_of_map(glm::scale(turn, {1, 1, 1e-7})), MapKind::FLATTENS);
    EXPECT_EQ(kind_of_map(glm::scale(turn, {1, 0, 1})), MapKind::FLATTENS);
    glm::dmat4 sheared = turn;
    sheared[1] = sheared[0] + 1e-7 * sheared[1];
    EXPECT_EQ(kind_of_map(sheared), MapKind::FLATTENS);
    sheared[1] = sheared[2] = sheared[0];
    EXPECT_EQ(kind_of_map(sheared), MapKind::VANISHES);
    EXPECT_EQ(kind_of_map(glm::dmat4(0)), MapKind::VANISHES);
    for (const double bad : {std::nan(""), HUGE_VAL}) {
        glm::dmat4 map = turn;
        map[3][1] = bad;
        EXPECT_EQ(kind_of_map(map), MapKind::VANISHES);
    }
}

TEST(Instances, WhatShinesIsCopied) {
    GltfBuilder file = file_of(THREE_NODES);
    Json lamp = file.json["meshes"][0]["primitives"][0];
    file.json["materials"] = Json::parse(R"([{"name": "lamp", "emissiveFactor": [1, 1, 0]}])");
    lamp["material"] = 0;
    file.json["meshes"][0]["primitives"].push_back(lamp);
    const ReadGltf read = read_shared(file);
    EXPECT_EQ(read.scene.instances.size(), 3u);
    EXPECT_EQ(read.scene.prototypes.at(0).triangles.size(), 4u);
    EXPECT_EQ(read.mesh().triangles.size(), 12u);
    for (const MeshTriangle& triangle : read.mesh().triangles)
        EXPECT_EQ(read.scene.materials.at(triangle.material).name, "lamp");
}

// Every corner is where the copy has it, and all that is fitted to the scene is the same.
TEST(Instances, StandWhereTheirCopiesWouldStand) {
    const TemporaryFolder folder;
    const std::string path = folder.write("a.glb", file_of(THREE_NODES).glb());
    const Scene shared = load(path, Toggle::ON), copied = load(path, Toggle::OFF);
    ASSERT_EQ(shared.instances.size(), 4u);
    EXPECT_EQ(shared.normalisation.centre, copied.normalisation.centre);
    EXPECT_EQ(shared.camera.eye, copied.camera.eye);
    EXPECT_EQ(shared.camera.at, copied.camera.at);
    EXPECT_EQ(shared.emitted_power, copied.emitted_power);
    EXPECT_EQ(shared.lights.size(), copied.lights.size());
    const size_t own = own_triangle_count(shared.triangles, shared.prototypes);
    EXPECT_EQ(own + 12, copied.triangles.size()) << "the rest is the studio's ground";
    double farthest = 0;
    for (u32 i = 0; i < 3; ++i) {
        const Instance& instance = shared.instances[i + 1];
        EXPECT_EQ(instance.object, i);
        EXPECT_EQ(instance.side, i == 1 ? -1.0f : 1.0f);
        for (u32 k = 0; k < 4; ++k) {
            const Triangle& a = shared.triangles[shared.prototypes[0].first_triangle + k];
            const Triangle& b = copied.triangles[4 * i + k];
            const u32 mirrored[3] = {b.v0, i == 1 ? b.v2 : b.v1, i == 1 ? b.v1 : b.v2};
            const u32 from[3] = {a.v0, a.v1, a.v2};
            for (int c = 0; c < 3; ++c)
                farthest =
                    std::max(farthest, glm::distance(placed(instance, to_dvec3(shared.positions[from[c]])),
                                                     to_dvec3(copied.positions[mirrored[c]])));
        }
    }
    EXPECT_LT(farthest, 2e-7);
}

TEST(Instances, BoxesEncloseEveryCornerAndAreTight) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<vec4> positions;
    std::vector<Triangle> triangles;
    for (u32 i = 0; i < 300; ++i) {
        positions.push_back(
            {float(uniform(random)), float(uniform(random)), 0.1f * float(uniform(random)), 0});
        if (i % 3 == 2) {
            Triangle triangle{};
            triangle.v0 = i - 2, triangle.v1 = i - 1, triangle.v2 = i;
            triangles.push_back(triangle);
        }
    }
    const PrototypeHull hull(positions, triangles);
    for (int round = 0; round < 100; ++round) {
        glm::dmat4 map(1);
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 3; ++r)
                map[c][r] = uniform(random) * std::exp(5 * uniform(random));
        const Instance instance = make_instance(map, glm::dvec3(1));
        const Box box = hull.placed(instance);
        Box exact;
        for (const vec4& p : positions) {
            Float4 q{0, 0, 0, 0};
            for (int r = 0; r < 3; ++r) {
                const vec4& row = instance.to_world[r];
                q[r] = std::fma(row.x, p.x, std::fma(row.y, p.y, std::fma(row.z, p.z, row.w)));
                EXPECT_GE(q[r], box.lower[r]);
                EXPECT_LE(q[r], box.upper[r]);
            }
            exact.extend(q);
        }
        for (int r = 0; r < 3; ++r)
            EXPECT_LT(box.upper[r] - box.lower[r], 1.7f * (exact.upper[r] - exact.lower[r]));
    }
}

namespace {

/// Counts what is below a node: triangles, and instances, which must be alone in their leaf.
void count_below(const Bvh& bvh, u32 root, std::map<u32, int>& triangles, std::map<u32, int>& instances) {
    std::vector<u32> nodes{root};
    while (!nodes.empty()) {
        const u32* node = &bvh.nodes[size_t(nodes.back()) * BVH8_NODE_WORDS];
        nodes.pop_back();
        for (int lane = 0; lane < BVH8_WIDTH; ++lane) {
            const u32 child = node[BVH8_CHILD_WORD + lane];
            float lower, upper;
            std::memcpy(&lower, node + lane, sizeof lower);
            std::memcpy(&upper, node + BVH8_WIDTH + lane, sizeof upper);
            if (lower > upper)
                continue;
            if (!(child & BVH_LEAF_BIT))
                nodes.push_back(child);
            else if (child & BVH_INSTANCE_BIT)
                ++instances[child & ~(BVH_LEAF_BIT | BVH_INSTANCE_BIT)];
            else
                for (int k = 0; k < BVH8_WIDTH; ++k)
                    ++triangles[bvh.leaves[size_t(child & ~BVH_LEAF_BIT) * BVH8_BLOCK_WORDS +
                                           BVH8_BLOCK_ID_WORD + size_t(k)]];
        }
    }
    triangles.erase(NO_INDEX);
}

} // namespace

TEST(Instances, TreesHoldEachTriangleAndEachInstanceOnce) {
    const TemporaryFolder folder;
    GltfBuilder file = file_of(THREE_NODES);
    Json ground = file.json["meshes"][0];
    file.json["meshes"].push_back(ground);
    file.json["nodes"].push_back(Json::parse(R"({"mesh": 1, "translation": [1, 1, 1]})"));
    file.json["scenes"][0]["nodes"].push_back(3);
    const Scene scene = load(folder.write("a.glb", file.glb()), Toggle::ON);
    const Bvh bvh = build_instanced_bvh(scene.positions, scene.triangles, scene.prototypes, scene.instances,
                                        BvhLayout::BVH8);
    std::map<u32, int> own, shared, instances, none;
    count_below(bvh, 0, own, instances);
    ASSERT_EQ(bvh.roots.size(), 1u);
    count_below(bvh, bvh.roots[0], shared, none);
    EXPECT_EQ(instances, (std::map<u32, int>{{1, 1}, {2, 1}, {3, 1}}));
    EXPECT_TRUE(none.empty());
    EXPECT_EQ(own.size(), own_triangle_count(scene.triangles, scene.prototypes));
    EXPECT_EQ(shared.size(), 4u);
    for (const auto& [triangle, count] : shared) {
        EXPECT_GE(triangle, scene.prototypes[0].first_triangle);
        EXPECT_EQ(count, 1);
    }
    for (const auto& [triangle, count] : own)
        EXPECT_EQ(count, 1) << triangle;
}

} // namespace clrt
