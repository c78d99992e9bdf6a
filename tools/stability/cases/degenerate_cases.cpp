// SPDX-License-Identifier: Apache-2.0
// Degenerate geometry: no area, garbage, copies, needles, nothing at all, normals that are none.
#include "error.h"
#include "probes/aimed_rays.h"
#include "probes/scratch_scene.h"
#include "stability/cases/ray_builds.h"
#include "stability/catalogue.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>

namespace clrt {

namespace {

void count_different_sums(const Film& a, const Film& b, const std::string& name, Worst& differing) {
    for (size_t i = 0; i < a.sums.size(); ++i)
        differing.count(a.sums[i] != b.sums[i], [&] { return fmt::format("{}, sum {}", name, i); });
}

/// A room with a lamp and a box.
ScratchScene& make_room_scene(ScratchScene& scene) {
    scene.build.material("white", "Kd 0.7 0.7 0.7")
        .material("red", "Kd 0.6 0.1 0.1")
        .material("lamp", "Kd 0 0 0\nKe 8 7 5");
    scene.build.use("white").box({-1, 0, -1}, {1, 2, 1}, Facing::INWARD);
    scene.build.use("lamp").polygon({{-0.4, 1.9, -0.4}, {0.4, 1.9, -0.4}, {0.4, 1.9, 0.4}, {-0.4, 1.9, 0.4}});
    scene.build.use("red").box({-0.5, 0.01, -0.5}, {0.1, 0.8, 0.2});
    scene.look({0.2, 1, 0.9}, {0, 0.7, -1}, 80);
    scene.options.film.size = {32, 24};
    scene.options.sampling.spp = 8;
    scene.options.sampling.replicates = 8;
    return scene;
}

void zero_area(CaseRun& run) {
    const size_t count = run.count(1e3, 1e4, 1e4);
    ScratchScene clean, with;
    const Film expected = make_room_scene(clean).render(run.device).film;
    make_room_scene(with);
    Random random(1);
    std::string faces;
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec3 p = random.in_cube(0.4) + glm::dvec3(0, 1, 0);
        if (i % 2) // on a line: exact, as corners are on a lattice
            faces += fmt::format("v {0} 1 0.5\nv {1} 1 0.5\nv {2} 1 0.5\nf -3 -2 -1\n", p.x, p.x + 0.25,
                                 p.x - 0.5);
        else
            faces += fmt::format("v {0} {1} {2}\nv {0} {1} {2}\nv {2} {1} {0}\nf -3 -2 -1\n", p.x, p.y, p.z);
    }
    with.build.use("lamp").raw(faces);
    const Scene scene = with.load();
    count_different_sums(expected, render_loaded(run.device, scene, with.options).film, "room",
                         run.figure("sums of the film that differ in any bit", 0)[Build::SINGLE]);
    run.figure("triangles that are not counted", 0)[Build::SINGLE].see(
        double(count) - double(std::min(count, scene.statistics.degenerate_triangles)),
        [] { return "room"; });

    const Scene soup = make_soup(2000, 0.3, 1);
    Scene spoiled = soup;
    for (int i = 0; i < 10000; ++i) {
        const u32 a = u32(random.word() % spoiled.positions.size()),
                  b = u32(random.word() % spoiled.positions.size());
        add_triangle(spoiled, a, i % 2 == 0 ? a : b, a);
    }
    const std::vector<TestRay> rays = rays_at(spoiled, run.count(2e4, 1e5, 1e6), 1);
    Figure& hits = run.figure("rays whose hit differs in any bit", 0);
    for (const Build build : robust_builds(run))
        for_each_tree(
            build, plain_boxes(run.device), [&](const RayDeviceOptions& options, const std::string& tree) {
                const std::vector<TestHit> a = RayDevice(run.device, soup, options).closest(rays),
                                           b = RayDevice(run.device, spoiled, options).closest(rays);
                for (size_t i = 0; i < rays.size(); ++i)
                    hits[build].count(a[i] != b[i], [&] { return tree + ": " + ray_text(rays[i]); });
            });
}

/// Text of an OBJ whose numbers are random bits, sometimes words that are no numbers.
std::string garbage_obj(Random& random, bool bad_indices) {
    std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const auto number = [&] {
        const u32 bits = random.word();
        return bits % 4 ? fmt::format("{}", bits_to_float(random.word()))
                        : fmt::format("{}", random.between(-1, 1));
    };
    for (int i = 0; i < 40; ++i)
        text += fmt::format("v {} {} {}\nvn {} {} {}\nvt {} {}\n", number(), number(), number(), number(),
                            number(), number(), number(), number());
    for (int i = 0; i < 40; ++i) {
        const auto corner = [&] {
            return bad_indices && random.word() % 50 == 0 ? std::to_string(int(random.word()))
                                                          : std::to_string(random.word() % 43 + 1);
        };
        const auto vertex = [&] {
            return fmt::format("{}/{}/{}", corner(), random.word() % 40 + 1, random.word() % 40 + 1);
        };
        text += fmt::format("f {} {} {}\n", vertex(), vertex(), vertex());
    }
    return text;
}

void garbage(CaseRun& run) {
    Figure& bad = run.figure("pixels that are not finite, bad samples", 0);
    Figure& unexpected = run.figure("files that end in anything but a picture or a scene error", 0);
    Random random(2);
    size_t rendered = 0;
    const size_t scenes = run.count(60, 1000, 10000);
    for (size_t k = 0; k < scenes; ++k) {
        ScratchScene scene;
        scene.build.raw(garbage_obj(random, k % 2));
        scene.options.light.environment = glm::dvec3(1);
        scene.options.film.size = {8, 8};
        scene.options.sampling.spp = 4;
        scene.options.sampling.replicates = 4;
        const auto describe = [&] { return fmt::format("scene {}", k); };
        try {
            const Render render = scene.render(run.device);
            ++rendered;
            double wrong = double(render.counts.bad());
            for (const float value : film_mean(render.film))
                wrong += !std::isfinite(value);
            bad[Build::SINGLE].see(wrong, describe);
            unexpected[Build::SINGLE].count(false, describe);
        } catch (const SceneError&) {
            unexpected[Build::SINGLE].count(false, describe);
        } catch (const std::exception& error) {
            unexpected[Build::SINGLE].count(true,
                                            [&] { return fmt::format("scene {}: {}", k, error.what()); });
        }
    }
    // About 0.4 of them name no face or are refused; three standard errors of 60 files are 0.19. Were it many
    // more, the figures above would be of nothing.
    run.figure("scenes that did not become a picture, of all", 0.6)[Build::SINGLE].see(
        1 - double(rendered) / double(scenes), [] { return "garbage"; });
}

double seconds_to_build(const Scene& scene) {
    const auto start = std::chrono::steady_clock::now();
    build_bvh(scene.positions, scene.triangles, BvhLayout::BVH8, BvhQuality::FAST);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void duplicates(CaseRun& run) {
    constexpr u32 COPIES = 100000;
    Scene scene = make_empty_scene();
    const u32 first = add_position(scene, {-1, -1, 0});
    add_position(scene, {1, -1, 0.5});
    add_position(scene, {0, 1, -0.5});
    for (u32 i = 0; i < COPIES; ++i)
        add_triangle(scene, first, first + 1, first + 2);
    Random random(3);
    std::vector<TestRay> rays;
    for (int i = 0; i < 64; ++i)
        rays.push_back(
            make_ray_to(random.in_cube(0.5) + glm::dvec3(0, 0, 3), {random.between(-0.2, 0.2), -0.3, 0}));
    Figure& wrong = run.figure("hits of a copy", 0);
    Figure& depth = run.figure("depth of the tree", 64);
    for (const Build build : robust_builds(run))
        for_each_tree(build, plain_boxes(run.device),
                      [&](const RayDeviceOptions& options, const std::string& tree) {
                          if (options.quality != BvhQuality::FAST)
                              return;
                          const RayDevice device(run.device, scene, options);
                          depth[build].see(device.bvh().depth, [&] { return tree; });
                          for (const TestHit& hit : device.closest(rays))
                              wrong[build].count(hit.triangle != 0, [&] { return tree; });
                      });
    Figure& slowness = run.figure("time to build over that of a soup of as many", 3);
    const Scene soup = make_soup(int(COPIES), 0.05, 1);
    double ratio = INFINITY;
    for (int round = 0; round < 3; ++round)
        ratio = std::min(ratio, seconds_to_build(scene) / seconds_to_build(soup));
    slowness[Build::SINGLE].see(ratio, [] { return "bvh8 fast"; });
}

void needles(CaseRun& run) {
    const Scene ball = make_ball(int(run.count(1e4, 5e4, 5e4)), 2);
    Figure& lost = run.figure("rays lost", 0);
    for (const Aim aim : {Aim::VERTEX, Aim::EDGE}) {
        const std::vector<TestRay> rays = aimed_rays(ball, 0.5, aim, run.count(2e4, 1e6, 1e6), 7);
        for (const Build build : run.builds())
            for_each_tree(build, plain_triangles(run.device),
                          [&](const RayDeviceOptions& options, const std::string& tree) {
                              const std::vector<TestHit> hits =
                                  RayDevice(run.device, ball, options).closest(rays);
                              for (size_t i = 0; i < rays.size(); ++i)
                                  lost[build].count(hits[i].triangle == NO_INDEX,
                                                    [&] { return tree + ": " + ray_text(rays[i]); });
                          });
    }
}

void coplanar_twins(CaseRun& run) {
    Scene scene = make_tilted_plane(16);
    const u32 count = u32(scene.triangles.size());
    Random random(4);
    // Each triangle once more, in another order and with its corners in another order, which turns the
    // winding too.
    std::vector<Triangle> twins = scene.triangles;
    for (u32 i = count - 1; i > 0; --i)
        std::swap(twins[i], twins[random.word() % (i + 1)]);
    for (const Triangle& twin : twins)
        add_triangle(scene, twin.v0, twin.v1, twin.v2);
    const std::vector<TestRay> rays = rays_at(scene, run.count(2e4, 2e5, 1e6), 4);
    Figure& wrong = run.figure("hits of the second twin", 0);
    for (const Build build : robust_builds(run))
        for_each_tree(
            build, plain_boxes(run.device), [&](const RayDeviceOptions& options, const std::string& tree) {
                const std::vector<TestHit> hits = RayDevice(run.device, scene, options).closest(rays);
                for (size_t i = 0; i < rays.size(); ++i)
                    wrong[build].count(hits[i].triangle != NO_INDEX && hits[i].triangle >= count,
                                       [&] { return tree + ": " + ray_text(rays[i]); });
            });
}

void nothing(CaseRun& run) {
    Figure& hits = run.figure("hits of nothing", 0);
    for (const bool point : {false, true}) {
        Scene scene = make_empty_scene();
        if (point)
            add_triangle(scene, {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5});
        const std::vector<TestRay> rays = rays_at(scene, 10000, 5);
        for (const Build build : robust_builds(run))
            for_each_tree(build, plain_boxes(run.device),
                          [&](const RayDeviceOptions& options, const std::string& tree) {
                              const RayDevice device(run.device, scene, options);
                              const std::vector<u32> any = device.any(rays);
                              const std::vector<TestHit> found = device.closest(rays);
                              for (size_t i = 0; i < rays.size(); ++i)
                                  hits[build].count(any[i] || found[i].triangle != NO_INDEX,
                                                    [&] { return tree; });
                          });
    }
    Scene triangle = make_empty_scene();
    add_triangle(triangle, {-1, -1, 0.25}, {1, -1, 0.25}, {0, 1, 0.25});
    Figure& one = run.figure("rays whose hit of a single triangle differs", 0);
    const std::vector<TestRay> rays = rays_at(triangle, 10000, 6);
    for (const Build build : robust_builds(run))
        for_each_tree(
            build, plain_boxes(run.device), [&](const RayDeviceOptions& options, const std::string& tree) {
                const RayDevice device(run.device, triangle, options);
                const std::vector<TestHit> found = device.closest(rays), all = device.closest_of_all(rays);
                for (size_t i = 0; i < rays.size(); ++i)
                    one[build].count(found[i] != all[i], [&] { return tree + ": " + ray_text(rays[i]); });
            });
    ScratchScene scene;
    scene.build.raw("v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3");
    scene.options.light.environment = glm::dvec3(0.25, 0.5, 0.75);
    scene.options.sampling.spp = 64;
    const std::vector<float> picture = film_mean(scene.render(run.device).film);
    Figure& background = run.figure("difference from the background", 0);
    for (size_t i = 0; i < picture.size(); ++i)
        background[Build::SINGLE].see(std::abs(picture[i] - 0.25 * double(i % 3 + 1)),
                                      [&] { return fmt::format("value {}", i); });
}

/// A lit quad whose corners have this normal ("" for none).
ScratchScene& make_quad_with_normal(ScratchScene& scene, const std::string& normal) {
    scene.build.material("matte", "Kd 0.5 0.6 0.7\nKs 0.2 0.2 0.2\nNs 10\nillum 2").use("matte");
    const std::string n = normal.empty() ? "" : "//-1";
    scene.build.raw("v -1 0 1\nv 1 0 1\nv 1 0.5 -1\nv -1 0.5 -1\n" +
                    (normal.empty() ? "" : "vn " + normal + "\n") + "f -4" + n + " -3" + n + " -2" + n +
                    " -1" + n);
    scene.options.light.environment = glm::dvec3(0.4);
    scene.options.light.suns.push_back({{0.2, 1, 0.1}, {1, 1, 1}, 0});
    scene.look({0.3, 2, 2}, {0, 0.2, 0}, 40);
    scene.options.film.size = {24, 24};
    scene.options.sampling.spp = 8;
    scene.options.sampling.replicates = 8;
    return scene;
}

void bad_normals(CaseRun& run) {
    ScratchScene flat;
    const Film expected = make_quad_with_normal(flat, "").render(run.device).film;
    Figure& differing = run.figure("sums that differ from the geometric normal's", 0);
    Figure& bad = run.figure("bad samples", 0);
    Figure& silent = run.figure("fallbacks without a notice", 0);
    for (const char* normal :
         {"0 0 0", "nan 0 1", "inf 0 0", "1e-42 0 0", "0 -1e30 1e-30", "0 -0.970142 -0.242536"}) {
        ScratchScene scene;
        make_quad_with_normal(scene, normal);
        const Scene loaded = scene.load();
        const Render render = render_loaded(run.device, loaded, scene.options);
        bad[Build::SINGLE].see(double(render.counts.bad()), [&] { return normal; });
        if (normal[1] == 'a' || normal[0] == 'i' || std::string(normal) == "0 0 0") {
            count_different_sums(expected, render.film, normal, differing[Build::SINGLE]);
            silent[Build::SINGLE].count(std::none_of(loaded.notices.begin(), loaded.notices.end(),
                                                     [](const std::string& line) {
                                                         return line.find("shaded flat") != std::string::npos;
                                                     }),
                                        [&] { return normal; });
        }
    }
}

} // namespace

const std::vector<StabilityCase>& degenerate_cases() {
    static const std::vector<StabilityCase> cases = {
        {"D01", "ZeroArea",
         "triangles with equal corners or corners on a line, added to a room and to a soup",
         "film and hits without them", "they have no area: they change no bit, and the loader counts them",
         zero_area},
        {"D02", "Garbage", "OBJ files of random bits, words that are no numbers, indices out of range",
         "a picture without bad samples, or a scene error", "no input may end in anything else", garbage},
        {"D03", "Duplicates", "1e5 copies of a triangle",
         "the lowest index is hit; a soup of as many triangles",
         "ties are decided by the index; a depth of 64 and three times a soup's time: copies must not spoil "
         "the tree",
         duplicates},
        {"D04", "Needles", "a ball of meridian slivers as long as the ball, aimed at vertices and edges",
         "a closed mesh holds every ray", "edge functions have exact signs whatever a triangle's shape",
         needles},
        {"D05", "CoplanarTwins", "a plane of triangles, and each of them once more", "the lower index is hit",
         "both have the same distance to the last bit: it is computed from the triangle alone",
         coplanar_twins},
        {"D06", "Nothing", "no triangle, a single point, one triangle", "no hit; the background",
         "sums of 64 equal samples are exact", nothing},
        {"D07", "BadShadingNormals", "corner normals that are zero, no numbers, tiny, huge, opposite",
         "the film of the geometric normal", "a normal without a direction gives way, with a notice",
         bad_normals},
    };
    return cases;
}

} // namespace clrt
