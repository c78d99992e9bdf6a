// SPDX-License-Identifier: Apache-2.0
// Scenes of many lights, made by hand.
#pragma once

#include "probes/random_inputs.h"
#include "scene/environment.h"
#include "scene/lights.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace clrt {

/// Lights of all kinds. Quads are two triangles and an object each.
struct Lamps {
    Scene scene;

    Lamps() { scene.extent = 1; }

    /// A parallelogram around a centre whose winding's normal is u x v.
    void quad(const glm::dvec3& centre, const glm::dvec3& u, const glm::dvec3& v, const glm::dvec3& radiance,
              u32 flags = 0) {
        const u32 first = u32(scene.positions.size()), material = u32(scene.materials.size());
        for (const glm::dvec3& p : {-u - v, u - v, u + v, v - u})
            scene.positions.push_back(to_vec4(centre + p));
        for (const u32 second : {1u, 2u}) {
            Triangle t{};
            t.v0 = first, t.v1 = first + second, t.v2 = first + second + 1;
            t.n0 = t.n1 = t.n2 = t.t0 = t.t1 = t.t2 = NO_INDEX;
            t.material = t.object = material;
            scene.triangles.push_back(t);
        }
        Material m{};
        m.matte = {0, 0, 0, 1};
        m.emission = to_vec4(radiance);
        m.flags = flags;
        m.map_matte = m.map_specular = m.map_emission = m.map_coverage = NO_INDEX;
        m.map_roughness = m.map_metallic = m.map_normal = m.map_bump = NO_INDEX;
        scene.materials.push_back(m);
        scene.emitted.push_back({radiance, radiance});
    }
    void point(const glm::dvec3& position, const glm::dvec3& intensity) {
        Light light{};
        light.kind = LIGHT_POINT;
        light.vector = to_vec4(position);
        light.emission = to_vec4(intensity);
        scene.lights.push_back(light);
    }
    /// An even cone.
    void spot(const glm::dvec3& position, const glm::dvec3& direction, double degrees) {
        point(position, glm::dvec3(1));
        Light& light = scene.lights.back();
        light.axis_x = float(direction.x), light.axis_y = float(direction.y),
        light.axis_z = float(direction.z);
        light.one_minus_cos = float(1 - std::cos(degrees * 3.14159265358979323846 / 180));
        LIGHT_SHARPNESS(light) = 1e6f;
    }
    void sun(const glm::dvec3& towards, const glm::dvec3& emission, double radius) {
        Light light{};
        light.kind = LIGHT_SUN;
        light.vector = to_vec4(glm::normalize(towards));
        light.emission = to_vec4(emission);
        light.one_minus_cos = float(2 * std::pow(std::sin(radius / 2), 2));
        scene.lights.push_back(light);
    }
    void sky() {
        NoticeList notices;
        EnvironmentImage image{8, 4, std::vector<glm::vec3>(32, glm::vec3(0.1f))};
        image.texels[5] = glm::vec3(9);
        scene.environment = map_environment(image, 1, 0, notices);
    }
    /// Lists the emitters.
    void finish() {
        std::vector<double> exitance;
        for (size_t i = 0; i < scene.materials.size(); ++i)
            exitance.push_back(luminance_of(i) *
                               (scene.materials[i].flags & MATERIAL_EMITS_BOTH_SIDES ? 2 : 1));
        scene.emitters = build_emitters(scene.positions, scene.triangles, exitance).emitters;
    }
    double luminance_of(size_t material) const {
        const glm::dvec3& e = scene.emitted[material].mean;
        return 0.2126 * e.x + 0.7152 * e.y + 0.0722 * e.z;
    }
};

/// Quads of all sizes, places and directions, some of which shine on both sides.
inline Lamps random_lamps(u32 count, u32 seed) {
    Lamps lamps;
    Random random(seed);
    for (u32 i = 0; i < count; ++i) {
        const double size = std::abs(random.signed_log(1e-3, 0.3));
        const glm::dvec3 centre(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
        const glm::dvec3 u = random.direction(), v = glm::normalize(glm::cross(u, random.direction()));
        const glm::dvec3 radiance(std::abs(random.signed_log(1e-3, 1e3)));
        lamps.quad(centre, size * u, size * v, radiance, i % 5 == 0 ? MATERIAL_EMITS_BOTH_SIDES : 0);
    }
    lamps.finish();
    return lamps;
}

} // namespace clrt
