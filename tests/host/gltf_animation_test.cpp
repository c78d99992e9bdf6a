// SPDX-License-Identifier: Apache-2.0
// Animations of glTF files: values at a moment, which of them are played, and motion between two moments.
#include "scene/readers/gltf_animation.h"

#include "gltf_support.h"
#include "scene/load_scene.h"
#include "scene_support.h"

#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <string>

namespace clrt {

namespace {

const double HALF_ROOT = std::sqrt(0.5);

void expect_near(const glm::dvec3& found, const glm::dvec3& expected) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], 1e-6) << c;
}

/// A triangle under node 0 and an animation of it.
struct AnimatedFile : GltfBuilder {
    AnimatedFile() { add_mesh(TRIANGLE_POSITIONS); }

    /// Moves a property of a node in an animation of this name; the last with it is taken.
    void animate(const char* path, const std::vector<float>& times, const std::vector<float>& values,
                 const char* interpolation = "LINEAR", const std::string& name = "", size_t node = 0) {
        Json& all = json["animations"];
        if (all.empty() || all.back()["name"] != name)
            all.push_back({{"name", name}, {"samplers", Json::array()}, {"channels", Json::array()}});
        Json& animation = all.back();
        const bool turns = std::string(path) == "rotation";
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
        animation["samplers"].push_back({{"input", add(times, "SCALAR", 1)},
                                         {"output", add(values, turns ? "VEC4" : "VEC3", turns ? 4 : 3)},
                                         {"interpolation", interpolation}});
    }

    ReadGltf read(double time, const std::string& animation = "") {
        GltfReading reading;
        reading.time = time;
        reading.animation = animation;
        return ReadGltf(glb(), reading);
    }
    /// The scene between two moments, or at one.
    Scene load(double time, std::optional<double> end_time, const CameraOptions& camera = {}) {
        const TemporaryFolder folder;
        Options options;
        options.scene.path = folder.write("a.glb", glb());
        options.scene.gltf.time = time;
        options.scene.end_time = end_time;
        options.camera = camera;
        Progress silent(Toggle::OFF, true);
        return load_scene(options, silent);
    }
    glm::dvec3 corner(double time, int c = 0) { return read(time).corner(0, c); }

    std::string error(const std::string& animation = "") {
        try {
            read(0, animation);
        } catch (const SceneError& fault) {
            return fault.what();
        }
        return "";
    }
};

void expect_fault(AnimatedFile file, const std::string& text) {
    const std::string found = file.error();
    EXPECT_NE(found.find(text), std::string::npos) << found;
}

} // namespace

TEST(GltfAnimation, ValuesGoStraightBetweenKeyFramesAndStandStillOutside) {
    AnimatedFile file;
    file.animate("translation", {1, 2, 4}, {0, 0, 0, 4, 0, 0, 4, 8, 0});
    expect_near(file.corner(-1), {0, 0, 0});
    expect_near(file.corner(1), {0, 0, 0});
    expect_near(file.corner(1.25), {1, 0, 0});
    expect_near(file.corner(2), {4, 0, 0});
    expect_near(file.corner(3.5), {4, 6, 0});
    expect_near(file.corner(9), {4, 8, 0});
}

TEST(GltfAnimation, StepsHoldTheirValue) {
    AnimatedFile file;
    file.animate("translation", {1, 2}, {1, 0, 0, 5, 0, 0}, "STEP");
    expect_near(file.corner(1.999), {1, 0, 0});
    expect_near(file.corner(2), {5, 0, 0});
}

TEST(GltfAnimation, SplinesAreHermites) {
    // In tangent, value, out tangent: of a frame pair two seconds apart, h00 v0 + 2 h10 b0 + h01 v1 + 2 h11
    // a1.
    AnimatedFile file;
    file.animate("translation", {0, 2}, {9, 9, 9, 1, 0, 0, 0, 3, 0, 0, 0, 5, 2, 0, 0, 9, 9, 9},
                 "CUBICSPLINE");
    expect_near(file.corner(0), {1, 0, 0});
    expect_near(file.corner(2), {2, 0, 0});
    const double t = 0.25, t2 = t * t, t3 = t2 * t;
    expect_near(file.corner(0.5),
                {2 * t3 - 3 * t2 + 1 + 2 * (3 * t2 - 2 * t3), 2 * 3 * (t3 - 2 * t2 + t), 2 * 5 * (t3 - t2)});
}

TEST(GltfAnimation, RotationsGoAroundByTheShorterSide) {
    const float half = float(HALF_ROOT);
    for (const float sign : {1.f, -1.f}) { // a quaternion and its negative are one rotation
        AnimatedFile file;
        file.animate("rotation", {0, 1}, {0, 0, 0, 1, 0, 0, sign * half, sign * half});
        const double third = std::atan(1.) * 4 / 6;
        expect_near(file.corner(1. / 3, 1), {std::cos(third), std::sin(third), 0});
        expect_near(file.corner(1, 1), {0, 1, 0});
    }
    AnimatedFile spline; // between two that are the same; tangents of 0: the mean, made one of length 1
    spline.animate("rotation", {0, 1},
                   {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, half, half, 0, 0, 0, 0},
                   "CUBICSPLINE");
    expect_near(spline.corner(0.5, 1), {HALF_ROOT, HALF_ROOT, 0});
    AnimatedFile whole; // 16 bits, normalised
    whole.animate("rotation", {0}, {0, 0, 0, 1});
    const size_t turned = whole.add<std::int16_t>({0, 0, 23170, 23170}, "VEC4", 4, true);
    whole.json["animations"][0]["samplers"][0]["output"] = turned;
    expect_near(whole.corner(0, 1), {0, 1, 0});
}

TEST(GltfAnimation, WhatIsNotMovedStaysAndChildrenFollow) {
    AnimatedFile file;
    file.json["nodes"] = Json::parse(R"([{"children": [1], "translation": [0, 0, 7], "scale": [2, 2, 2]},
                                         {"mesh": 0, "translation": [1, 0, 0]}])");
    file.animate("scale", {0, 1}, {1, 1, 1, 3, 5, 1});
    expect_near(file.corner(1, 0), {3, 0, 7});
    expect_near(file.corner(1, 2), {3, 5, 7});
}

TEST(GltfAnimation, AllArePlayedUnlessOneIsNamed) {
    AnimatedFile file;
    file.json["scenes"][0]["nodes"] = {0, 1};
    file.json["nodes"].push_back({{"mesh", 0}});
    file.animate("translation", {0}, {1, 0, 0}, "LINEAR", "walk");
    file.animate("translation", {0}, {0, 2, 0}, "LINEAR", "run", 1);
    file.animate("translation", {0}, {9, 9, 9}, "LINEAR", "fly", 1);
    ReadGltf all = file.read(0);
    expect_near(all.corner(0, 0), {1, 0, 0});
    expect_near(all.corner(1, 0), {0, 2, 0});
    EXPECT_TRUE(all.notes("two animations move the same node")) << "the third";
    for (const char* name : {"fly", "3"}) {
        ReadGltf fly = file.read(0, name);
        expect_near(fly.corner(0, 0), {0, 0, 0});
        expect_near(fly.corner(1, 0), {9, 9, 9});
        EXPECT_FALSE(fly.notes("two animations"));
    }
    EXPECT_NE(
        file.error("swim").find("--animation: expected one of 1 'walk', 2 'run', 3 'fly', found 'swim'"),
        std::string::npos);
}

TEST(GltfAnimation, WhatIsLeftOutIsSaid) {
    AnimatedFile file;
    EXPECT_NE(file.error().find("--animation-time: expected a file with animations, found none"),
              std::string::npos);
    const TemporaryFolder folder;
    Options options;
    options.scene.path = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    options.scene.gltf.time = 0;
    Progress silent(Toggle::OFF, true);
    try {
        load_scene(options, silent);
        ADD_FAILURE();
    } catch (const SceneError& fault) {
        EXPECT_NE(
            std::string(fault.what()).find("expected a glTF file with animations, found a Wavefront OBJ"),
            std::string::npos)
            << fault.what();
    }
    file.animate("translation", {0}, {1, 0, 0});
    const ReadGltf still(file.glb());
    expect_near(still.corner(0, 0), {0, 0, 0});
    EXPECT_TRUE(still.notes("animations are not played"));
    file.json["animations"][0]["channels"][0]["target"] = Json::parse(R"({"path": "pointer"})");
    EXPECT_TRUE(file.read(0).notes("an animation of what is no node's is left out"));
}

TEST(GltfAnimation, FaultsNameTheirPlace) {
    AnimatedFile good;
    good.animate("rotation", {0, 1}, {0, 0, 0, 1, 0, 0, 0, 1});
    EXPECT_EQ(good.error(), "");
    const auto with = [&](const char* pointer, const Json& value) {
        AnimatedFile file = good;
        file.json[Json::json_pointer(pointer)] = value;
        return file;
    };
    const std::string sampler = "animations[0].samplers[0]";
    expect_fault(with("/nodes/0/matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
                 "nodes[0].matrix: expected translation, rotation and scale");
    expect_fault(with("/animations/0/samplers/0/interpolation", "SPLINE"),
                 sampler + ".interpolation: expected STEP, LINEAR or CUBICSPLINE, found 'SPLINE'");
    expect_fault(with("/animations/0/samplers/0/interpolation", "CUBICSPLINE"),
                 sampler + ".output: expected 6 values for 2 times, found 2");
    expect_fault(with("/animations/0/channels/0/sampler", 1),
                 "channels[0].sampler: expected an index of one of 1 samplers");
    expect_fault(with("/animations/0/channels/0/target/node", 7), "target.node: expected");
    AnimatedFile file = good;
    file.json["animations"][0]["samplers"][0]["input"] = file.add<float>({1, 1}, "SCALAR", 1);
    expect_fault(file, sampler + ".input: expected finite times that increase");
    file = good;
    file.json["animations"][0]["samplers"][0]["output"] =
        file.add<float>({0, 0, 0, 1, 0, 0, 0, 0}, "VEC4", 4);
    expect_fault(file, sampler + ".output: expected quaternions other than 0");
}

TEST(GltfAnimation, BetweenTwoMomentsMeshAndCameraMove) {
    AnimatedFile file;
    file.json["cameras"] = Json::parse(R"([{"type": "perspective", "perspective": {"yfov": 0.5}}])");
    file.json["scenes"][0]["nodes"] = {0, 1};
    file.json["nodes"].push_back(Json::parse(R"({"camera": 0, "translation": [0.25, 0.25, 3]})"));
    file.animate("translation", {0, 2}, {0, 0, 0, 2, 0, 0});
    file.animate("translation", {0, 2}, {0.25f, 0.25f, 3, 0.25f, 2.25f, 3}, "LINEAR", "", 1);
    const Scene scene = file.load(0.5, 1.5);
    ASSERT_GE(scene.position_moves.size(), 3u);
    const double scale = scene.normalisation.scale;
    EXPECT_NEAR(double(scene.position_moves[1].x) / scale, 1, 1e-6) << "half of two seconds' way of 2";
    EXPECT_EQ(scene.position_moves[1].y, 0);
    expect_near(scene.camera.eye, {0.25, 0.75, 3});
    ASSERT_TRUE(scene.camera.end);
    expect_near(scene.camera.end->eye, {0.25, 1.75, 3});
    expect_near(scene.camera.end->at - scene.camera.end->eye, scene.camera.at - scene.camera.eye);
    CameraOptions camera;
    camera.end_eye = glm::dvec3(0, 0, 5);
    expect_near(file.load(0.5, 1.5, camera).camera.end->eye, {0, 0, 5});
    const Scene still = file.load(0.5, 0.5);
    EXPECT_TRUE(still.position_moves.empty());
    EXPECT_FALSE(still.camera.end);
}

TEST(GltfAnimation, WhatVanishesOrHasNoAreaMovesAsWell) {
    AnimatedFile file;
    file.json["meshes"][0]["primitives"][0]["indices"] =
        file.add<std::uint16_t>({0, 1, 2, 1, 1, 2, 0, 0, 0}, "SCALAR", 1);
    file.json["scenes"][0]["nodes"] = {0, 1};
    file.json["nodes"].push_back({{"mesh", 0}});
    file.animate("scale", {0, 1}, {1, 1, 1, 0, 0, 0}, "LINEAR", "", 1);
    EXPECT_FALSE(file.load(0, 1).position_moves.empty());
}

TEST(GltfAnimation, ACameraThatStandsStillIsSaidToStandStill) {
    AnimatedFile file;
    file.json["cameras"] = Json::parse(R"([{"type": "perspective", "perspective": {"yfov": 0.5}}])");
    file.json["scenes"][0]["nodes"] = {0, 1};
    file.json["nodes"].push_back({{"camera", 0}, {"translation", {0.1, 0.2, 3.3}}});
    file.animate("translation", {0, 2}, {0, 0, 0, 2, 0, 0});
    for (int i = 0; i < 20; ++i) {
        file.json["nodes"][1]["rotation"] = {0.01 * i, 0.03 * i, 0.02 * i, 1};
        EXPECT_FALSE(file.load(0, 1).camera.end) << i;
    }
}

TEST(GltfAnimation, LightsThatMoveAreSaidToStandStill) {
    AnimatedFile file;
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([{"type": "point"}])");
    file.json["scenes"][0]["nodes"] = {0, 1};
    file.json["nodes"].push_back(Json::parse(R"({"extensions": {"KHR_lights_punctual": {"light": 0}}})"));
    file.animate("translation", {0, 1}, {0, 0, 1, 0, 0, 2}, "LINEAR", "", 1);
    EXPECT_EQ(count_notices(file.load(0, {}).notices, "that move are shown"), 0);
    EXPECT_EQ(count_notices(file.load(0, 1).notices, "that move are shown where they are at T"), 1);
}

} // namespace clrt
