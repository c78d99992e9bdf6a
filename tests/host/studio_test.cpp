// SPDX-License-Identifier: Apache-2.0
// The studio: set up where nothing gives light and nowhere else, for any camera and any up, with a ground and
// a backdrop that belong together; and said as flags that give the same scene.
#include "scene/studio.h"

#include "command_line_support.h"
#include "film/film_identity.h"
#include "render/render_params.h"
#include "scene/ground.h"
#include "support/render_scene.h"

#include <functional>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <sstream>

namespace clrt {

namespace {

constexpr double PI = 3.14159265358979323846;

/// A box on the plane y = 1 that nothing lights; tests add what they are about.
class UnlitBox : public TestScene {
public:
    UnlitBox() {
        options.light.studio = true;
        build.material("grey", "Kd 0.5 0.5 0.5").use("grey").box({-1, 1, -2}, {3, 2, 2});
    }
};

/// The material of the ground, the last one; none without a ground.
const Material* ground_of(const Scene& scene) {
    return scene.material_names.back() == "ground" ? &scene.materials.back() : nullptr;
}

/// The notice that starts with these words; empty if there is none.
std::string notice(const Scene& scene, const std::string& start) {
    for (const std::string& line : scene.notices)
        if (line.compare(0, start.size(), start) == 0)
            return line;
    return "";
}

/// The flags at the end of the studio's notice, as arguments.
std::vector<std::string> studio_flags(const Scene& scene) {
    const std::string line = notice(scene, "no light in the scene");
    std::istringstream words(line.substr(std::min(line.find(" --"), line.size())));
    std::vector<std::string> flags;
    for (std::string word; words >> word;)
        flags.push_back(word);
    return flags;
}

/// Six walls whose fronts look inwards, on the plane y = 0.
class ClosedRoom : public TestScene {
public:
    ClosedRoom() {
        options.light.studio = true;
        build.material("wall", "Kd 0.7 0.7 0.7").use("wall").box({0, 0, 0}, {6, 3, 5}, Facing::INWARD);
    }
};

glm::dvec3 vector(const vec4& v) {
    return {v.x, v.y, v.z};
}

} // namespace

TEST(Studio, HasKeySkyGroundAndBackdrop) {
    const Scene scene = UnlitBox().load();
    EXPECT_TRUE(scene.is_studio);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].kind, u32(LIGHT_SUN));
    EXPECT_GT(scene.lights[0].one_minus_cos, 0.003f) << "a disc of 9 degrees or more";
    EXPECT_GT(scene.environment.radiance.x, 0);
    EXPECT_TRUE(scene.background);
    EXPECT_TRUE(ground_of(scene));
    for (const char* part :
         {"key light", "--sun", "sky", "--env", "ground", "--ground", "backdrop", "--background"})
        EXPECT_NE(notice(scene, "no light in the scene: a studio").find(part), std::string::npos) << part;
}

TEST(Studio, LightOfTheFileOrAnOptionLeavesItOut) {
    const std::function<void(UnlitBox&)> lights[] = {
        [](UnlitBox& s) { s.build.material("lamp", "Ke 1 1 1").use("lamp").floor(0.1, 5); },
        [](UnlitBox& s) { s.options.light.environment = glm::dvec3(1); },
        [](UnlitBox& s) { s.options.light.environment = glm::dvec3(0); },
        [](UnlitBox& s) {
            s.options.light.suns.push_back({{0, 1, 0}, glm::dvec3(1), 0});
        },
        [](UnlitBox& s) {
            s.options.light.points.push_back({{0, 9, 0}, glm::dvec3(1)});
        },
        [](UnlitBox& s) { s.options.light.studio = false; },
    };
    for (const auto& light : lights) {
        UnlitBox box;
        light(box);
        const Scene scene = box.load();
        EXPECT_FALSE(scene.is_studio);
        EXPECT_FALSE(scene.background);
        EXPECT_FALSE(ground_of(scene));
        EXPECT_EQ(notice(scene, "no light in the scene: a studio"), "");
    }
    UnlitBox off;
    off.options.light.studio = false;
    EXPECT_EQ(off.load().environment.radiance, glm::dvec3(1)) << "the white sky";
}

TEST(Studio, ItsFlagsGiveTheSameScene) {
    const std::function<void(TestScene&)> changes[] = {
        [](TestScene&) {},
        [](TestScene& s) { s.options.light.ground = GroundOptions{glm::dvec3(0.7, 0.5, 0.3)}; },
        [](TestScene& s) { s.options.light.ground = GroundOptions{}; },
        [](TestScene& s) {
            s.options.light.background = BackgroundOptions{{0.1, 0.2, 0.3}, false};
        },
        [](TestScene& s) {
            s.options.light.background = BackgroundOptions{{0, 0, 0}, true};
        },
        [](TestScene& s) { s.options.light.environment_scale = 2; },
        [](TestScene& s) { s.options.camera.up = glm::dvec3(0, 0, 1); },
    };
    for (const auto& change : changes)
        for (const bool is_room : {false, true}) {
            UnlitBox box;
            ClosedRoom room;
            TestScene& test = is_room ? static_cast<TestScene&>(room) : box;
            change(test);
            const Scene studio = test.load();
            const std::vector<std::string> flags = studio_flags(studio);
            ASSERT_FALSE(flags.empty());
            const double scale = test.options.light.environment_scale;
            test.options.light = parse(flags).light;
            test.options.light.environment_scale = scale;
            const Scene given = test.load();
            EXPECT_FALSE(given.is_studio);
            const auto identity = [&](const Scene& scene) {
                return film_identity(scene, test.options, make_render_params(scene, test.options, {1, 2}),
                                     {1, 2});
            };
            EXPECT_EQ(identity(studio), identity(given)) << notice(studio, "no light in the scene");
        }
}

TEST(Studio, TheBackdropIsTheRadianceOfAnUnshadedGround) {
    for (const std::optional<glm::dvec3> albedo :
         {std::optional<glm::dvec3>(), std::optional(glm::dvec3(0.9, 0.5, 0.1))}) {
        UnlitBox box;
        if (albedo)
            box.options.light.ground = GroundOptions{albedo};
        const Scene scene = box.load();
        const Light& key = scene.lights[0];
        const double sine = std::sqrt(1 - std::pow(1 - double(key.one_minus_cos), 2));
        const glm::dvec3 irradiance = vector(key.emission) * (PI * sine * sine); // at normal incidence
        const glm::dvec3 expected = vector(ground_of(scene)->matte) *
                                    (irradiance * double(key.vector.y) / PI + scene.environment.radiance);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR((*scene.background)[c], expected[c], 1e-5);
    }
}

TEST(Studio, TheGroundLiesUnderTheLowestCornerWhateverIsUp) {
    for (const glm::dvec3 up :
         {glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 2), glm::dvec3(-1, 0, 0), glm::dvec3(1, 2, 2)}) {
        UnlitBox box, without;
        box.options.camera.up = without.options.camera.up = up;
        box.options.light.ground = GroundOptions{glm::dvec3(0.5)};
        without.options.light.studio = false;
        const Scene scene = box.load(), bare = without.load();
        ASSERT_TRUE(ground_of(scene));
        const glm::dvec3 unit = glm::normalize(up);
        const double lowest = lowest_along(bare, unit);
        size_t triangles = 0;
        for (const Triangle& t : scene.triangles) {
            if (&scene.materials[t.material] != ground_of(scene))
                continue;
            ++triangles;
            const glm::dvec3 a = vector(scene.positions[t.v0]), b = vector(scene.positions[t.v1]),
                             c = vector(scene.positions[t.v2]);
            EXPECT_GT(glm::dot(glm::cross(b - a, c - a), unit), 0) << "its front is above";
            for (const glm::dvec3& corner : {a, b, c}) {
                EXPECT_LT(glm::dot(corner, unit), lowest);
                EXPECT_GT(glm::dot(corner, unit), lowest - 1e-4);
            }
        }
        EXPECT_EQ(triangles, scene.triangles.size() - bare.triangles.size()) << "no others are added";
        EXPECT_GE(scene.ground_extent, 16.0f);
        EXPECT_EQ(scene.camera.eye, bare.camera.eye) << "the camera is fitted to the scene alone";
        EXPECT_EQ(scene.normalisation.scale, bare.normalisation.scale);
        EXPECT_EQ(scene.extent, bare.extent);
    }
}

TEST(Studio, TheKeyComesFromAboveTheLeftOfAnyCamera) {
    for (const glm::dvec3 up : {glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)})
        for (const glm::dvec3 eye : {glm::dvec3(9, 3, 4), glm::dvec3(-9, 3, 4), glm::dvec3(1, -7, 1),
                                     glm::dvec3(1, 30, 0.01), glm::dvec3(1, 1.5, 40)}) {
            UnlitBox box;
            box.options.camera.eye = eye;
            box.options.camera.at = {1, 1.5, 0};
            box.options.camera.up = up;
            const Scene scene = box.load();
            const glm::dvec3 key = vector(scene.lights[0].vector);
            const glm::dvec3 look = glm::normalize(scene.camera.at - scene.camera.eye);
            const glm::dvec3 right = glm::normalize(glm::cross(look, scene.camera.up));
            EXPECT_NEAR(glm::dot(key, up), 0.743, 1e-3);
            EXPECT_LT(glm::dot(key, right), -0.3);
            const glm::dvec3 level = look - glm::dot(look, up) * up;
            if (glm::length(level) > 0.1) {
                EXPECT_LT(glm::dot(key, glm::normalize(level)), -0.3) << "it shines from the camera's side";
            }
        }
}

TEST(Studio, HasNoGroundWhereItWouldHideOrBelieSomething) {
    UnlitBox transparent, below, none;
    transparent.options.light.background = BackgroundOptions{{0, 0, 0}, true};
    below.look({0, -3, 9}, {1, 1.5, 0}, 40);
    none.options.light.ground = GroundOptions{};
    for (UnlitBox* box : {&transparent, &below, &none}) {
        const Scene scene = box->load();
        EXPECT_TRUE(scene.is_studio);
        EXPECT_FALSE(ground_of(scene));
        EXPECT_TRUE(scene.background);
        EXPECT_EQ(scene.ground_extent, 0.0f);
    }
}

TEST(Ground, LiesUnderAnySceneThatAsksForIt) {
    UnlitBox box;
    box.options.light.environment = glm::dvec3(2);
    box.options.light.ground = GroundOptions{glm::dvec3(0.2, 0.3, 0.4)};
    const Scene scene = box.load();
    ASSERT_TRUE(ground_of(scene));
    EXPECT_EQ(ground_of(scene)->matte.z, 0.4f);
    EXPECT_EQ(scene.object_names.back(), "ground");
    EXPECT_FALSE(scene.background) << "the sky is seen";
}

TEST(Ground, IsAsLargeToLargeScenesAsToSmallOnes) {
    UnlitBox box, large;
    large.scale = 1024;
    const Scene one = box.load(), other = large.load();
    ASSERT_EQ(one.positions.size(), other.positions.size());
    for (size_t i = 0; i < one.positions.size(); ++i)
        EXPECT_EQ(vector(one.positions[i]), vector(other.positions[i]));
    EXPECT_EQ(*one.background, *other.background);
}

TEST(Studio, AClosedRoomHasALampInsideAndNoGround) {
    const Scene scene = ClosedRoom().load();
    EXPECT_TRUE(scene.is_studio);
    EXPECT_FALSE(ground_of(scene));
    EXPECT_FALSE(scene.background);
    EXPECT_EQ(scene.environment.radiance, glm::dvec3(1)) << "for its windows";
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].kind, u32(LIGHT_POINT));
    const glm::dvec3 lamp =
        vector(scene.lights[0].vector) / scene.normalisation.scale + scene.normalisation.centre;
    for (int c = 0; c < 3; ++c) {
        EXPECT_GT(lamp[c], 0);
        EXPECT_LT(lamp[c], glm::dvec3(6, 3, 5)[c]);
    }
}

TEST(Studio, TheLampStaysOnTheCamerasSideOfAWall) {
    ClosedRoom room;
    room.build.polygon({{0, 0, 2.6}, {6, 0, 2.6}, {6, 3, 2.6}, {0, 3, 2.6}}); // the camera is just before it
    room.look({3, 1.5, 2.59}, {3.5, 1.5, 2.4}, 40);
    const Scene scene = room.load();
    ASSERT_EQ(scene.lights.size(), 1u);
    const double z =
        double(scene.lights[0].vector.z) / scene.normalisation.scale + scene.normalisation.centre.z;
    EXPECT_LT(z, 2.6);
}

TEST(Studio, ACameraInsideASolidIsIndoorsToo) {
    // A house's walls look outwards: no room by its faces.
    UnlitBox house;
    house.look({0, 1.5, 0}, {2, 1.5, 0}, 60);
    const Scene inside = house.load();
    EXPECT_FALSE(inside.background);
    ASSERT_EQ(inside.lights.size(), 1u);
    EXPECT_EQ(inside.lights[0].kind, u32(LIGHT_POINT));
    // Before an open front there is no lamp.
    TestScene open;
    open.options.light.studio = true;
    open.build.material("wall", "Kd 0.7 0.7 0.7").use("wall").box({0, 0, -3}, {4, 3, 0}, Facing::INWARD);
    open.look({2, 1.5, 9}, {2, 1.5, 0}, 40);
    EXPECT_TRUE(open.load().lights.empty());
    EXPECT_EQ(open.load().environment.radiance, glm::dvec3(1));
}

} // namespace clrt
