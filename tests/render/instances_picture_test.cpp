// SPDX-License-Identifier: Apache-2.0
// Pictures of instances are those of the scene with their triangles written out.
#include "probes/film_estimate.h"
#include "probes/meshes.h"
#include "support/render_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace clrt {
namespace {

glm::dmat4 ball_map(const glm::dvec3& place, const glm::dvec3& scale) {
    return glm::scale(glm::rotate(glm::translate(glm::dmat4(1), place), 0.4, {0, 1, 0}), scale);
}

u32 material_named(const Scene& scene, const std::string& name) {
    const auto found = std::find(scene.material_names.begin(), scene.material_names.end(), name);
    EXPECT_NE(found, scene.material_names.end()) << name;
    return u32(found - scene.material_names.begin());
}

/// A lit floor, and balls of a material above it.
struct Balls : TestScene {
    explicit Balls(const std::string& material, const std::vector<glm::dmat4>& maps, bool write_out = false) {
        build.material("ball", material).material("white", "Kd 0.7 0.6 0.5").material("lamp", "Ke 4 5 6");
        build.use("white").floor(2);
        build.use("lamp").polygon({{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}});
        build.use("ball").polygon({{1.9, 0.01, 1.9}, {1.9, 0.01, 1.8}, {1.8, 0.01, 1.9}});
        look({0, 1, 4}, {0, 0.5, 0}, 40);
        options.light.environment = glm::dvec3(0.3, 0.2, 0.1);
        options.sampling.spp = 8;
        options.sampling.replicates = 1;
        finish = [=](Scene& scene) {
            Scene ball = make_ball(16, 12);
            for (Triangle& triangle : ball.triangles)
                triangle.material = material_named(scene, "ball");
            add_instances(scene, ball, maps);
            for (Instance& instance : scene.instances)
                instance.object = 0;
            if (write_out)
                scene = written_out(scene);
        };
    }
};

const std::vector<glm::dmat4> MAPS = {ball_map({-0.4, 0, 0.2}, glm::dvec3(0.25)),
                                      ball_map({0.4, 0, 0.1}, {-0.2, 0.3, 0.2}),
                                      ball_map({0, -0.2, 0.5}, {0.1, 1e-3, 0.1})};

} // namespace

TEST(InstancesPicture, IsThatOfTheirTrianglesWrittenOut) {
    for (const Integrator integrator : {Integrator::PATH, Integrator::BDPT})
        for (const char* material : {"Kd 0.2 0.3 0.2\nPm 0.8\nPr 0.4", "Kd 0.4 0.5 0.6\nd 0.6"}) {
            Balls shared(material, MAPS), written(material, MAPS, true);
            shared.options.transport.integrator = written.options.transport.integrator = integrator;
            EXPECT_TRUE(shared.render().film.sums == written.render().film.sums)
                << name_of(integrator) << ", " << material;
        }
}

// A ball is its own mirror image, and its inside is inside.
TEST(InstancesPicture, OfGlassHasItsInsideWhereItIsMirroredToo) {
    const std::string glass = "Ni 1.5\nillum 7\nattenuation 2 1 0.5";
    const glm::dvec3 size(0.35);
    const auto mean = [&](const glm::dvec3& scale, bool turn) {
        Balls scene(glass, {ball_map({0, 0, 0.2}, scale)});
        scene.options.sampling.spp = 256;
        if (turn) {
            const auto before = scene.finish;
            scene.finish = [=](Scene& made) {
                before(made);
                made.instances[1].side *= -1;
            };
        }
        return film_pixel(scene.render().film, 8, 8);
    };
    const glm::dvec3 plain = mean(size, false), mirrored = mean(size * glm::dvec3(-1, 1, 1), false),
                     wrong = mean(size * glm::dvec3(-1, 1, 1), true);
    EXPECT_NEAR(mirrored.x / plain.x, 1, 0.1);
    EXPECT_GT(std::fabs(wrong.x / plain.x - 1), 0.3);
}

} // namespace clrt
