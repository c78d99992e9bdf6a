// SPDX-License-Identifier: Apache-2.0
#include "support/lit_rooms.h"

#include "probes/film_estimate.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

TileMeans tile_means(const TestScene& scene, Options options, Integrator integrator, const char* paths) {
    options.transport.integrator = integrator;
    options.transport.paths = paths;
    const Render render = render_loaded(scene.load(), options);
    EXPECT_EQ(render.counts.bad(), 0u) << name_of(integrator);
    TileMeans tiles;
    for (int y = 0; y < render.film.height; y += 8)
        for (int x = 0; x < render.film.width; x += 8)
            for (int channel = 0; channel < 3; ++channel) {
                const Estimate tile = film_estimate(render.film, channel, {x, y, x + 8, y + 8});
                tiles.mean.push_back(tile.mean);
                tiles.variance.push_back(tile.error * tile.error);
            }
    return tiles;
}

void expect_equal(const TileMeans& a, const TileMeans& b, double sharpness) {
    double squares = 0, mean = 0, noise = 0;
    for (size_t i = 0; i < a.mean.size(); ++i) {
        mean += b.mean[i] / double(b.mean.size());
        noise += (a.variance[i] + b.variance[i]) / double(b.mean.size());
        if (a.variance[i] + b.variance[i] == 0) {
            EXPECT_NEAR(a.mean[i], b.mean[i], 1e-5 * b.mean[i]) << "tile " << i;
            continue;
        }
        const double z = (a.mean[i] - b.mean[i]) / std::sqrt(a.variance[i] + b.variance[i]);
        EXPECT_LT(std::abs(z), LARGEST_Z) << "tile " << i << ": " << a.mean[i] << ", expected " << b.mean[i];
        squares += z * z;
    }
    // Channels are nearly alike: the squares of 9 tiles have a mean of 1 +- 0.47.
    EXPECT_LT(squares / double(a.mean.size()), 2.8);
    EXPECT_LT(std::sqrt(noise), sharpness * mean) << "too noisy to tell them apart";
}

Room::Room() {
    build.material("matte", "Kd 0.6 0.5 0.4").material("metal", "Kd 0.8 0.8 0.8\nPm 1\nPr 0.4");
    build.material("frosted", "Ni 1.5\nillum 7\nPr 0.4").material("mirror", "Ks 0.9 0.8 0.7\nillum 3");
    build.material("glass", "Ni 1.5\nillum 7").material("lamp", "Kd 0 0 0\nKe 6 5 4");
    build.use("matte").floor(3);
    build.polygon({{-3, 0, -2}, {3, 0, -2}, {3, 3, -2}, {-3, 3, -2}});
    build.use("metal").polygon({{-1.5, 0.05, 0.5}, {-0.5, 0.05, 0.5}, {-0.5, 0.5, -0.5}, {-1.5, 0.5, -0.5}});
    build.use("frosted").box({0.3, 0.01, -0.5}, {1.2, 0.6, 0.3});
    look({0, 1.6, 4}, {0, 0.7, 0}, 50);
    options.film.size = {24, 24};
    options.sampling.spp = 512;
    options.transport.max_depth = 6;
    options.light.environment = glm::dvec3(0);
}

void Room::add_lamp() {
    build.use("lamp").raw("o lamp").polygon({{-0.6, 2, -0.6}, {0.6, 2, -0.6}, {0.6, 2, 0.6}, {-0.6, 2, 0.6}});
}

void Room::add_hidden_mirrors() {
    for (const double x : {-2.6, 2.6})
        build.use("mirror").polygon({{x, 0.01, -1}, {x, 2, -1}, {x, 2, 2}, {x, 0.01, 2}});
}

void Room::add_caustics() {
    build.use("mirror").box({-0.4, 0.01, -1.4}, {0.2, 1.1, -1.1});
    build.use("glass").box({0.1, 0.9, 0.0}, {0.9, 1.2, 0.8});
}

void Room::add_sharp_reflections() {
    build.material("polished", "Kd 0.8 0.8 0.7\nPm 1\nPr 0.3")
        .material("brushed", "Kd 0.2 0.2 0.2\nPm 0.6\nPr 0.25\naniso 0.5")
        .material("lacquer", "Kd 0.5 0.2 0.1\nKs 0.2 0.2 0.2\nNs 250\nillum 2");
    build.use("polished").polygon({{-2.6, 0.01, -1}, {-2.6, 2, -1}, {-2.6, 2, 2}, {-2.6, 0.01, 2}});
    build.use("brushed").textured_quad({{2.6, 0.01, 2}, {2.6, 2, 2}, {2.6, 2, -1}, {2.6, 0.01, -1}});
    build.use("lacquer").box({-0.4, 0.01, -1.4}, {0.2, 1.1, -1.1});
    build.use("polished").icosphere({0.6, 1.1, 0.2}, 0.3, 2, Facing::OUTWARD, Shading::SMOOTH);
}

void Room::add_bent_normals() {
    std::vector<unsigned char> heights;
    for (int i = 0; i < 8 * 8; ++i)
        heights.push_back((i % 8 + i / 8) % 3 == 0 ? 180 : 90);
    texture8("bump.png", 8, 8, 1, heights);
    build.material("bumpy", "Kd 0.7 0.7 0.7\nbump -bm 0.4 bump.png").use("bumpy");
    build.textured_quad({{-1.6, 0.2, -1}, {-0.6, 0.2, -1}, {-0.6, 1.2, -1}, {-1.6, 1.2, -1}});
    build.use("matte").icosphere({-0.7, 0.4, 0.7}, 0.3, 1, Facing::OUTWARD, Shading::SMOOTH);
    build.use("frosted").icosphere({0, 0.4, 1}, 0.3, 1, Facing::OUTWARD, Shading::SMOOTH);
    build.use("glass").icosphere({0.8, 0.4, 1}, 0.3, 1, Facing::OUTWARD, Shading::SMOOTH);
}

void Room::add_steep_normals() {
    std::vector<float> texels;
    for (int i = 0; i < 4 * 4; ++i) {
        const double slope = 0.3 + 0.16 * (i % 5), turn = 2.4 * i;
        for (const double n : {slope * std::cos(turn), slope * std::sin(turn), std::sqrt(1 - slope * slope)})
            texels.push_back(float(0.5 + 0.5 * n));
    }
    texture("steep.exr", 4, 4, 3, texels);
    build.material("steep", "Kd 0.7 0.7 0.7\nnorm steep.exr")
        .material("steep metal", "Kd 0.8 0.8 0.8\nPm 1\nPr 0.5\nnorm steep.exr")
        .material("steep glass", "Ni 1.5\nillum 7\nPr 0.5\nnorm steep.exr");
    build.use("steep").textured_quad({{-2, 0.1, 2}, {2, 0.1, 2}, {2, 0.1, -0.6}, {-2, 0.1, -0.6}});
    build.use("steep metal").textured_quad({{1.5, 0, 1.5}, {1.8, 2, 1.5}, {1.8, 2, -1}, {1.5, 0, -1}});
    build.use("steep glass").textured_quad({{-1, 0.5, 1.5}, {0, 0.5, 1.5}, {0, 0.5, 0.2}, {-1, 0.5, 0.2}});
}

void expect_crop_is_a_part(Integrator integrator, const Crop& crop, Toggle path_reuse) {
    Room room;
    room.add_lamp();
    room.options.film.size = {32, 32};
    room.options.transport.integrator = integrator;
    room.options.transport.path_reuse = path_reuse;
    room.options.sampling.spp = 16;
    room.options.sampling.replicates = 8;
    const Film whole = room.render().film;
    room.options.film.crop = crop;
    const Film window = room.render().film;
    const auto at = [](const Film& film, int replicate, int x, int y) {
        const size_t pixel = size_t(y) * size_t(film.width) + size_t(x);
        return film.sums[size_t(replicate) * film_plane(film) + 3 * pixel];
    };
    for (int replicate = 0; replicate < 8; ++replicate)
        for (int y = 0; y < window.height; ++y)
            for (int x = 0; x < window.width; ++x)
                ASSERT_EQ(at(window, replicate, x, y), at(whole, replicate, x + crop.x0, y + crop.y0))
                    << x << "," << y;
}

const std::vector<Lighting>& lightings() {
    static const std::vector<Lighting> all = {
        {"lamp", [](Room& room) { room.add_lamp(); }},
        {"two-sided",
         [](Room& room) {
             room.options.light.two_sided = true;
             room.build.use("lamp").polygon(
                 {{-1, 1.4, -1.2}, {1, 1.4, -1.2}, {1, 1.8, -0.9}, {-1, 1.8, -0.9}});
         }},
        {"textured",
         [](Room& room) {
             room.texture("lamp.exr", 2, 2, 3, {4, 0, 0, 0, 3, 0, 0, 0, 5, 1, 1, 1});
             room.build.material("slide", "Kd 0 0 0\nKe 2 2 2\nmap_Ke lamp.exr").use("slide");
             room.build.textured_quad({{-0.6, 2, -0.6}, {0.6, 2, -0.6}, {0.6, 2, 0.6}, {-0.6, 2, 0.6}});
         }},
        {"point",
         [](Room& room) {
             room.options.light.points.push_back({{0.5, 1.8, 1}, {4, 5, 6}});
         },
         true},
        {"far point",
         [](Room& room) {
             room.options.light.points.push_back({{9, 18, 20}, {4000, 3000, 2000}});
         },
         true},
        {"spot",
         [](Room& room) {
             room.options.light.points.push_back(
                 {{0.5, 1.8, 1}, {8, 10, 12}, SpotCone{{-0.4, -1, -0.6}, 40, 15}});
         },
         true},
        {"far spot",
         [](Room& room) {
             room.options.light.points.push_back(
                 {{9, 18, 20}, {4000, 3000, 2000}, SpotCone{{-9, -17.5, -20}, 3, 3}});
         },
         true},
        {"wide spot",
         [](Room& room) {
             room.options.light.points.push_back({{0.5, 1.8, 1}, {4, 5, 6}, SpotCone{{-1, -0.5, 0}, 150, 0}});
         },
         true},
        {"sun",
         [](Room& room) {
             room.options.light.suns.push_back({{-1, 2, 1.5}, {3, 2, 1}, 0});
         },
         true},
        {"disc",
         [](Room& room) {
             room.options.light.suns.push_back({{-1, 2, 1.5}, {3, 2, 1}, 20});
         }},
        {"even sky", [](Room& room) { room.options.light.environment = glm::dvec3(1, 2, 3); }},
        {"map",
         [](Room& room) {
             std::vector<float> texels;
             for (int i = 0; i < 8 * 4; ++i)
                 for (int channel = 0; channel < 3; ++channel)
                     texels.push_back(i == 12 ? 40.0f : 0.2f + 0.1f * float((i * 7 + channel) % 5));
             room.texture("sky.exr", 8, 4, 3, texels);
             room.options.light.environment.reset();
             room.options.light.environment_file = room.folder.file("sky.exr");
         }},
        {"all",
         [](Room& room) {
             room.add_lamp();
             room.options.light.points.push_back({{0.5, 1.8, 1}, {1, 1, 2}});
             room.options.light.points.push_back({{-1, 1.8, 1}, {2, 1, 1}, SpotCone{{0.5, -1, -1}, 50, 20}});
             room.options.light.suns.push_back({{-1, 2, 1.5}, {1, 0.5, 0.5}, 10});
             room.options.light.environment = glm::dvec3(0.3, 0.4, 0.5);
         },
         true},
    };
    return all;
}

} // namespace clrt
