// SPDX-License-Identifier: Apache-2.0
// G01: where a ray that grazes a plane meets it.
#include "stability/cases/grazing_plane_case.h"

#include "probes/aimed_rays.h"
#include "stability/cases/ray_builds.h"

#include <cmath>
#include <fmt/format.h>

namespace clrt {

void grazed_plane(CaseRun& run) {
    Scene scene = make_empty_scene();
    const u32 first = add_position(scene, {-1, 0, -1});
    for (const glm::dvec3& p : {glm::dvec3(1, 0, -1), {1, 0, 1}, {-1, 0, 1}})
        add_position(scene, p);
    add_triangle(scene, first, first + 2, first + 1);
    add_triangle(scene, first, first + 3, first + 2);
    Figure& error = run.figure("|dx| / x times the angle over u", 4);
    for (int decade = 1; decade <= 6; ++decade) {
        Random random{u32(decade)};
        std::vector<TestRay> rays;
        std::vector<double> angles;
        for (size_t i = 0; i < run.count(1e4, 1e5, 1e6); ++i) {
            const double angle = std::pow(10.0, -decade) * random.between(0.5, 1),
                         x = random.between(0.1, 0.9);
            rays.push_back(make_ray({0, x * std::tan(angle), random.between(-0.5, 0.5)},
                                    {std::cos(angle), -std::sin(angle), 0}));
            angles.push_back(angle);
        }
        for (const Build build : run.builds()) {
            const RayDevice device(run.device, scene, ray_options(build, plain_triangles(run.device)));
            const std::vector<TestHit> hits = device.closest(rays);
            for (size_t i = 0; i < rays.size(); ++i) {
                const vec4 &o = rays[i].origin, &d = rays[i].direction;
                const double x = double(d.x) * (-double(o.y) / double(d.y));
                double found = NAN; // a miss
                if (hits[i].triangle == 0)
                    found = -1 + 2 * (hits[i].b1 + hits[i].b2);
                else if (hits[i].triangle == 1)
                    found = -1 + 2 * hits[i].b2;
                error[build].see(std::abs(found - x) / x * angles[i] / FLOAT_U,
                                 [&] { return ray_text(rays[i]); });
            }
        }
    }
}

} // namespace clrt
