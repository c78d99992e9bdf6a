// SPDX-License-Identifier: Apache-2.0
// Pictures of instances are those of the scene with their triangles written out.
#include "probes/film_estimate.h"
#include "probes/meshes.h"
#include "scene/vectors.h"
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

/// Maps to the world as maps to the scene's normalised frame.
std::vector<glm::dmat4> in_frame_of(const Scene& scene, std::vector<glm::dmat4> maps) {
    const glm::dmat4 frame = glm::translate(glm::scale(glm::dmat4(1), glm::dvec3(scene.normalisation.scale)),
                                            -scene.normalisation.centre);
    for (glm::dmat4& map : maps)
        map = frame * map;
    return maps;
}

/// Gives a prototype that is a ball its normals.
void add_ball_normals(Scene& scene) {
    for (u32 k = 0; k < scene.prototypes[0].triangle_count; ++k) {
        Triangle& triangle = scene.triangles[scene.prototypes[0].first_triangle + k];
        const u32 first = u32(scene.normals.size());
        for (int corner = 0; corner < 3; ++corner)
            scene.normals.push_back(to_vec4(glm::normalize(corner_position(scene, triangle, corner))));
        triangle.n0 = first, triangle.n1 = first + 1, triangle.n2 = first + 2;
    }
}

/// A lit floor, and balls of a material above it.
struct Balls : TestScene {
    explicit Balls(const std::string& material, const std::vector<glm::dmat4>& maps, bool write_out = false,
                   bool is_smooth = false) {
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
            add_instances(scene, ball, in_frame_of(scene, maps));
            for (Instance& instance : scene.instances)
                instance.object = 0;
            if (is_smooth)
                add_ball_normals(scene);
            if (write_out)
                scene = written_out(scene);
        };
    }
};

const std::vector<glm::dmat4> MAPS = {ball_map({-0.6, 0.7, 0.2}, glm::dvec3(0.5)),
                                      ball_map({0.6, 0.6, 0.1}, {-0.4, 0.5, 0.4}),
                                      ball_map({0, 0.3, 0.9}, {0.2, 2e-3, 0.2})};

} // namespace

TEST(InstancesPicture, IsThatOfTheirTrianglesWrittenOut) {
    for (const Integrator integrator : {Integrator::PATH, Integrator::BDPT})
        for (const char* material : {"Kd 0.2 0.3 0.2\nPm 0.8\nPr 0.4", "Kd 0.4 0.5 0.6\nd 0.6"}) {
            Balls shared(material, MAPS), written(material, MAPS, true);
            shared.options.transport.integrator = written.options.transport.integrator = integrator;
            const auto sums = shared.render().film.sums;
            EXPECT_TRUE(sums == written.render().film.sums) << name_of(integrator) << ", " << material;
            Balls empty(material, {});
            empty.options.transport.integrator = integrator;
            EXPECT_FALSE(sums == empty.render().film.sums);
        }
}

// Normals round in another way: the picture is the same but for that.
TEST(InstancesPicture, ShadesByNormalsThatTurnWithTheInstance) {
    Balls shared("Kd 0.5 0.5 0.5", MAPS, false, true), written("Kd 0.5 0.5 0.5", MAPS, true, true),
        flat("Kd 0.5 0.5 0.5", MAPS);
    for (Balls* scene : {&shared, &written, &flat})
        scene->options.transport.integrator = Integrator::RAYCAST;
    const std::vector<float> a = film_mean(shared.render().film), b = film_mean(written.render().film),
                             c = film_mean(flat.render().film);
    double difference = 0, of_flat = 0, sum = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        difference += std::fabs(double(a[i]) - double(b[i]));
        of_flat += std::fabs(double(c[i]) - double(b[i]));
        sum += double(b[i]);
    }
    EXPECT_LT(difference, 1e-5 * sum);
    EXPECT_GT(of_flat, 1e-3 * sum);
}

} // namespace clrt
