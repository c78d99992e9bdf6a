// SPDX-License-Identifier: Apache-2.0
// The sky: one bright texel, black and broken maps, the poles.
#include "stability/catalogue.h"
#include "stability/mean_figure.h"
#include "stability/path_probe.h"

#include "probes/random_inputs.h"
#include "probes/scene_probe.h"
#include "probes/sphere_cells.h"
#include "scene/environment.h"
#include "scene/sky_table.h"
#include "scene/sky_texels.h"

#include <fmt/format.h>
#include <limits>

namespace clrt {

namespace {

using glm::dvec3;

EnvironmentImage even_image(int width, int height, float value) {
    return {width, height, std::vector<glm::vec3>(size_t(width) * size_t(height), glm::vec3(value))};
}

Environment map_of(const EnvironmentImage& image) {
    NoticeList notices;
    Environment map = map_environment(image, 1, 0, notices);
    tabulate_sky(map, SkySampling::BY_TABLE_AND_BSDF);
    return map;
}

/// A floor of reflectance 1/2 under a map.
PathProbe floor_under(const ProbeDevice& device, const Environment& sky) {
    ScratchScene scene;
    scene.build.material("floor", "Kd 0.5 0.5 0.5").use("floor").floor(1);
    scene.options.transport.max_depth = 2;
    scene.options.light.environment = dvec3(0);
    Scene loaded = scene.load();
    loaded.environment = sky;
    return PathProbe(device, std::move(loaded), scene.options);
}

/// Irradiance of a floor from a texel of radiance 1 in a black map: the bilinear tent times the cosine, by
/// quadrature.
double texel_irradiance(int width, int height, int row) {
    const std::vector<QuadraturePoint> rule = gauss_legendre(16);
    double sum = 0;
    for (const double side : {-1.0, 1.0})
        for (const QuadraturePoint& q : rule) {
            const double theta = PI * (row + 0.5 + side * q.at) / height;
            sum += q.weight * (1 - q.at) * std::sin(theta) * std::cos(theta);
        }
    return sum * PI / height * 2 * PI / width; // the tent over the azimuth has the area of a texel
}

void one_bright_texel(CaseRun& run) {
    // A share of n samples: six standard errors of 15/64.
    const size_t samples = run.count(2e4, 1e6, 1e7);
    Figure& missed = run.figure("|share of samples beside the bilinear tent - 15/64|",
                                6 * std::sqrt(15.0 / 64 * (49.0 / 64) / double(samples)));
    Figure& bad = run.figure("samples that are no finite number >= 0", 0);
    // Six standard errors are 6 %: a sixteenth of the tent that is lost is just seen.
    MeanFigure mean(run, "the irradiance", 1e-2);
    const int height = int(run.count(512, 2048, 4096)), width = 2 * height, row = height / 5;
    for (const double radiance : {1.0, 1e10, 1e30}) {
        EnvironmentImage image = even_image(width, height, 0);
        image.texels[size_t(row * width + width / 3)] = glm::vec3(float(radiance));
        const PathProbe probe = floor_under(run.device, map_of(image));
        const std::vector<TestRay> rays = {probe.ray({0.1, 0.5, 0.2}, {0.1, 0, 0.1})};
        for (const Build build : path_builds(run)) {
            std::vector<double> values;
            double dark = 0;
            for (const dvec3& value : probe.radiance(build, Integrator::PATH, rays, samples)) {
                values.push_back(value.x / radiance);
                dark += value.x == 0;
                bad[build].count(!(value.x >= 0 && std::isfinite(value.x)),
                                 [&] { return fmt::format("radiance {}", radiance); });
            }
            missed[build].see(std::abs(dark / double(values.size()) - 15.0 / 64),
                              [&] { return fmt::format("radiance {}", radiance); });
            mean.see(build, values, 0.5 / PI * texel_irradiance(width, height, row),
                     [&] { return fmt::format("radiance {}: ", radiance); });
        }
    }
}

void black_sky(CaseRun& run) {
    Figure& light = run.figure("paths that see light", 0);
    const PathProbe probe = floor_under(run.device, map_of(even_image(16, 8, 0)));
    const std::vector<TestRay> rays = {probe.ray({0.1, 0.5, 0.2}, {0.1, 0, 0.1}),
                                       probe.ray({0.1, 0.5, 0.2}, {0.1, 1, 0.1})};
    for (const Build build : path_builds(run))
        for (const dvec3& value : probe.radiance(build, Integrator::PATH, rays, 256))
            light[build].count(value != dvec3(0), [&] { return fmt::format("{}", value.x); });
}

void broken_texels(CaseRun& run) {
    Figure& different = run.figure("texels that differ from the map with them zeroed", 0);
    Figure& silent = run.figure("reports that lack number or place", 0);
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    EnvironmentImage broken = even_image(32, 16, 0), clean = broken;
    Random random(1);
    for (glm::vec3& texel : broken.texels)
        texel = {float(random.unit()), float(random.unit()), float(random.unit())};
    clean = broken;
    broken.texels[5 * 32 + 7] = {nan, 1, 1};
    broken.texels[9 * 32 + 1] = {1, inf, 1};
    broken.texels[12 * 32 + 3] = {-2, 1, 1};
    clean.texels[5 * 32 + 7] = clean.texels[9 * 32 + 1] = glm::vec3(0);
    clean.texels[12 * 32 + 3] = {0, 1, 1};
    NoticeList notices;
    clean_environment(broken, "sky.exr", notices);
    const Environment a = map_of(broken), b = map_of(clean);
    for (int i = 0; i < 32 * 16; ++i)
        different[Build::SINGLE].count(sky_texel(a, i % 32, i / 32) != sky_texel(b, i % 32, i / 32) ||
                                           texel_probability(a, i % 32, i / 32) !=
                                               texel_probability(b, i % 32, i / 32),
                                       [&] { return fmt::format("texel {}", i); });
    std::string said;
    for (const std::string& line : notices.lines())
        said += line + "\n";
    for (const char* part : {"2 texels", "7,5", "1 texels", "3,12"})
        silent[Build::SINGLE].count(said.find(part) == std::string::npos,
                                    [&] { return fmt::format("\"{}\" in {}", part, said); });
}

void poles(CaseRun& run) {
    // Of a tile's 16 texels at a pole those of the first row get 3 or 4 shares where 3.75 are due.
    Figure& density = run.figure("|4 pi density - 1| of a map of ones", 0.25);
    Figure& radiance = run.figure("radiances of it that are not 1", 0);
    Figure& bad = run.figure("densities at the poles that are no finite number > 0", 0);
    auto& probe = run.device.once<SceneProbe>("sky", [&] {
        SceneProbe made(run.device, {"lights/environment_sample.h", "numerics/sampler.h"});
        made.add("sample",
                 "const LightSample s = environment_sample(scene, params, vector_make(REAL(0.0), REAL(0.0), "
                 "REAL(1.0)), as_uint(a.x),"
                 "as_uint(a.y), a.z); first = probe_vec4(s.wi, s.pdf_w); second = probe_vec4(s.radiance, "
                 "environment_map_pdf_w(scene, params, s.wi));");
        made.add("at", "first = probe_vec4(environment_eval(scene, params, vector_from(a)), "
                       "environment_map_pdf_w(scene, "
                       "params, vector_from(a)));");
        return made;
    });
    for (const int height : {1, 2, 16, 512}) {
        Scene scene;
        scene.environment = map_of(even_image(2 * height, height, 1));
        RenderParams params{};
        params.environment = {1, 1, 1, 0};
        params.environment_width = u32(2 * height);
        params.environment_height = u32(height);
        params.environment_format = scene.environment.texel_format;
        params.environment_cos = 1;
        Random random(2);
        std::vector<vec4> numbers, directions;
        for (size_t i = 0; i < run.count(2e4, 1e6, 1e7); ++i) {
            const u32 word = random.word(), alias = random.word();
            numbers.push_back({bits_to_float(word), bits_to_float(alias), float(random.unit()), 0});
        }
        for (const double away : {0.0, 1e-30, 1e-20, 1e-10, 1e-8, 1e-6, 1e-4})
            for (const float y : {1.0f, -1.0f})
                for (int turn = 0; turn < 8; ++turn)
                    directions.push_back({float(away * std::cos(turn)), y, float(away * std::sin(turn)), 0});
        const SceneProbe::Outputs got = probe.run("sample", scene, params, numbers);
        const auto describe = [&] { return fmt::format("{} rows", height); };
        for (size_t i = 0; i < numbers.size(); ++i) {
            density[Build::SINGLE].see(std::abs(4 * PI * got.first[i].w - 1), describe);
            density[Build::SINGLE].see(std::abs(4 * PI * got.second[i].w - 1), describe);
            radiance[Build::SINGLE].count(to_dvec3(got.second[i]) != dvec3(1), describe);
        }
        for (const vec4& at : probe.run("at", scene, params, directions).first) {
            bad[Build::SINGLE].count(!(at.w > 0 && std::isfinite(at.w)), describe);
            radiance[Build::SINGLE].count(to_dvec3(at) != dvec3(1), describe);
        }
    }
}

} // namespace

const std::vector<StabilityCase>& environment_cases() {
    static const std::vector<StabilityCase> cases = {
        {"E01", "OneBrightTexel", "one texel of 1, 1e10, 1e30 in a black map of 1024 x 512",
         "the bilinear tent times the cosine, by quadrature",
         "its texel and neighbours are chosen always, by their share of the tent: 15/64 of that is beside "
         "it; noise",
         one_bright_texel},
        {"E02", "BlackSky", "a map of zeros", "0", "a law", black_sky},
        {"E03", "BrokenTexels", "NaN, infinite and negative texels",
         "the map with them zeroed; number and place reported", "a law", broken_texels},
        {"E04", "Poles", "maps of ones from 2 x 1 to 1024 x 512, directions at the poles",
         "density 1 / (4 pi), radiance 1",
         "sines, quotient and the stored probability: eight units in the last place", poles},
    };
    return cases;
}

} // namespace clrt
