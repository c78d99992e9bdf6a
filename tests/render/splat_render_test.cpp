// SPDX-License-Identifier: Apache-2.0
// A splatting integrator in a whole render: a ray caster whose samples are splatted to where their camera
// rays cross the film draws what the ray caster gathers, to the bit.
#include "probes/prepared_render.h"
#include "support/render_scene.h"
#include "support/test_device.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// Splats what raycast_radiance gathers; `position` is the film position of sample k.
const char* const SPLATTING = R"(
static CLRT_NOINLINE void splat_radiance(const Scene* scene, const RenderParams* params, CameraSample* samples,
                                         uint count, PixelRays* rays)
{
    raycast_radiance(scene, params, samples, count, rays);
    for (uint k = 0; k < count; ++k) {
        const real3 radiance = samples[k].radiance;
        samples[k].radiance = (real3)(REAL(0.0));
        pixel_splat(params, &samples[k], 0u, POSITION, radiance);
    }
}

#define INTEGRATOR_RADIANCE splat_radiance)";

/// The kernels with it in place of the ray caster.
PatchedKernels splatting_kernels(bool int64, const std::string& position) {
    const std::string defines = fmt::format(
        "#define FILM_SPLATS 1\n#define FILM_INT64_ATOMICS {}\n#define POSITION {}\n", int(int64), position);
    return PatchedKernels(
        kernels_under_test(),
        {{"integrators/raycast.cl", "#include \"raycast.h\"", defines + "#include \"raycast.h\""},
         {"integrators/raycast.cl", "#define INTEGRATOR_RADIANCE raycast_radiance", SPLATTING}});
}

/// A lamp over a box.
struct LitBox : TestScene {
    LitBox() {
        build.material("grey", "Kd 0.5 0.4 0.3").material("lamp", "Kd 0 0 0\nKe 5 4 3").use("grey");
        build.floor(2, -0.5).box({-0.5, -0.5, -0.5}, {0.3, 0.2, 0.4}, Facing::OUTWARD);
        build.use("lamp").floor(0.3, 1.5);
        look({1, 1, 3}, {0, 0, 0}, 40);
        options.effects.all = false;
        options.transport.integrator = Integrator::RAYCAST;
        options.film.size = {41, 31};
        options.sampling.spp = 16;
        options.sampling.replicates = 8;
    }
};

const char* const OF_THE_RAY = "camera_project(&params->camera, samples[k].ray.origin + "
                               "samples[k].ray.direction, (real2)(REAL(0.5))).film";

} // namespace

TEST(SplatRender, SplatsToTheRaysFilmPositionsAreTheGatheredPicture) {
    LitBox scene;
    for (const bool is_cropped : {false, true}) {
        if (is_cropped)
            scene.options.film.crop = Crop{9, 3, 30, 26};
        const Film gathered = PreparedRender(test_device(), scene.load(), scene.options).run().film;
        for (const bool int64 : {false, true}) {
            if (int64 && !test_device().info.int64_atomics)
                continue;
            const PatchedKernels kernels = splatting_kernels(int64, OF_THE_RAY);
            Options options = scene.options;
            options.device.kernels_folder = kernels.path();
            const Render splatted = PreparedRender(test_device(), scene.load(), options).run();
            EXPECT_TRUE(splatted.film.sums == gathered.sums)
                << "cropped " << is_cropped << ", int64 " << int64;
            EXPECT_EQ(splatted.counts.bad(), 0u);
        }
    }
}

TEST(SplatRender, ASampleWithABadSplatIsABadSampleOfItsPixel) {
    LitBox scene;
    const PatchedKernels kernels = splatting_kernels(
        false, "samples[k].sampler.key == sampler_make(params->seed, 5u * params->width + 7u, 3u, 1u).key && "
               "samples[k].replicate == 3u ? (real2)(REAL_NAN) : (real2)(REAL(0.0))");
    scene.options.device.kernels_folder = kernels.path();
    const Render render = PreparedRender(test_device(), scene.load(), scene.options).run();
    EXPECT_EQ(render.counts.nan, 2u) << "samples 3 and 11";
    EXPECT_EQ(render.counts.bad_pixels, (std::map<u32, std::uint64_t>{{5u * 41u + 7u, 2u}}));
    ASSERT_EQ(render.counts.bad_samples.size(), 2u);
    for (const auto& [pixel, sample] : render.counts.bad_samples) {
        EXPECT_EQ(pixel, 5u * 41u + 7u);
        EXPECT_EQ(sample % 8, 3u);
    }
}

} // namespace clrt
