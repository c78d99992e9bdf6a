// SPDX-License-Identifier: Apache-2.0
// Bad samples and bright ones: planted ones are counted, none occurs by itself, no light is clamped away.
#include "stability/catalogue.h"
#include "stability/film_bench.h"
#include "stability/shipped_scenes.h"

#include "output/image.h"
#include "probes/effect_masks.h"
#include "probes/prepared_render.h"
#include "probes/random_inputs.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <OpenImageIO/imageio.h>

namespace clrt {

namespace {

using Address = std::pair<std::uint32_t, std::uint32_t>;

/// Pixel and sample of each planted fault, and what it becomes.
struct Planted {
    Address address;
    const char* radiance;
};
const Planted PLANTED[] = {
    {{5, 3}, "NAN_BITS, 1, 1"},
    {{77, 0}, "1, INFINITE_BITS, 1"},
    {{130, 7}, "1, 1, -INFINITE_BITS"},
    {{200, 1}, "1, -1e-6f, 1"},
    {{255, 2}, "2.0f * params->largest_contribution, 1, 1"},
};

/// Replaces the radiance of planted samples where the film looks at it.
std::vector<KernelPatch> planting_patches() {
    const std::string include = "#include \"path/layers.h\"\n", radiance = "samples[k].radiance";
    std::string text = "#define NAN_BITS as_float(0x7fc00001u)\n#define INFINITE_BITS as_float(0x7f800000u)\n"
                       "static inline real3 plant(const RenderParams* params, real3* radiance, uint pixel, "
                       "uint sample)\n{\n";
    for (const Planted& planted : PLANTED)
        text += fmt::format(
            "    if (pixel == {}u && sample == {}u)\n        *radiance = convert_real3((float3)({}));\n",
            planted.address.first, planted.address.second, planted.radiance);
    return {{"integrators/pixel.h", include, include + text + "    return *radiance;\n}\n"},
            {"integrators/pixel.h", "film_fault(params, " + radiance + ")",
             "film_fault(params, plant(params, (real3*)&" + radiance + ", pixel, counter->sample))"}};
}

/// The inside of a shining box, every sample with sums of its own.
struct FurnaceBox : ScratchScene {
    FurnaceBox() {
        build.material("white", "Kd 0.5 0.5 0.5\nKe 1 1 1")
            .use("white")
            .box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
        look({0, 0, 0}, {0, 0, -1}, 60);
        options.effects.all = false;
        options.sampling.spp = 8;
        options.sampling.replicates = 8;
    }
};

void planted_faults(CaseRun& run) {
    Figure& counted = run.figure("planted samples not counted by kind", 0);
    Figure& listed = run.figure("planted samples not listed, and others", 0);
    Figure& differing = run.figure("sums of other samples that differ", 0);
    const PatchedKernels planting(run.device.kernels(), planting_patches());
    const FurnaceBox subject;
    const Scene scene = subject.load();
    std::vector<Address> addresses;
    for (const Planted& planted : PLANTED)
        addresses.push_back(planted.address);
    for (const Build build : run.builds()) {
        if (build == Build::NAIVE)
            continue;
        Options options = subject.options;
        options.device.precision = precision_of(build);
        const Film clean = render_loaded(run.device, scene, options).film;
        options.device.kernels_folder = planting.path();
        const Render bad = PreparedRender(run.device, scene, options).run();
        const RenderCounts& counts = bad.counts;
        const std::pair<std::uint64_t, std::uint64_t> kinds[] = {
            {counts.nan, 1}, {counts.infinite, 2}, {counts.negative, 1}, {counts.overflow, 1}};
        for (const auto& [found, planted] : kinds)
            counted[build].see(std::abs(double(found) - double(planted)),
                               [] { return std::string("a kind"); });
        for (const Address& address : addresses)
            listed[build].count(
                std::count(counts.bad_samples.begin(), counts.bad_samples.end(), address) != 1,
                [&] { return fmt::format("pixel {}, sample {}", address.first, address.second); });
        listed[build].value += std::abs(double(counts.bad_samples.size()) - double(addresses.size()));
        for (size_t i = 0; i < clean.sums.size(); ++i) {
            const size_t pixel = i / 3 % 256, sample = i / 3 / 256;
            const Address address{std::uint32_t(pixel), std::uint32_t(sample)};
            const bool planted = std::count(addresses.begin(), addresses.end(), address) > 0;
            differing[build].count(bad.film.sums[i] != (planted ? 0 : clean.sums[i]),
                                   [&] { return fmt::format("pixel {}, sample {}", pixel, sample); });
        }
    }
}

/// Counts the bad samples of a render.
void see_counts(Worst& bad, const Render& render, const std::string& what) {
    bad.tried += render.counts.primary;
    if (render.counts.bad() > 0 && bad.value == 0)
        bad.input = fmt::format(
            "{}: {} NaN, {} infinite, {} negative, {} overflow, first at pixel {}, sample {}", what,
            render.counts.nan, render.counts.infinite, render.counts.negative, render.counts.overflow,
            render.counts.bad_samples.at(0).first, render.counts.bad_samples.at(0).second);
    bad.value += double(render.counts.bad());
}

void no_hiding(CaseRun& run) {
    Figure& shipped = run.figure("bad samples of the shipped scenes", 0);
    Figure& made = run.figure("bad samples of scenes of some effects", 0);
    const std::uint32_t spp = std::uint32_t(run.count(16, 256, 65536));
    for (const std::string& name : shipped_scenes()) {
        ShippedScene subject(name);
        subject.options.film.size = {64, 48};
        subject.options.sampling.spp = spp;
        subject.options.effects.all = true; // one program serves all
        const Scene scene = subject.load();
        // The quick tier compiles no integrator but path in double.
        const bool has_double =
            run.tier != Tier::QUICK || subject.options.transport.integrator == Integrator::PATH;
        for (const Build build : run.builds())
            if (build != Build::NAIVE && (build != Build::DOUBLE || has_double)) {
                subject.options.device.precision = precision_of(build);
                see_counts(shipped[build], render_loaded(run.device, scene, subject.options), name);
            }
    }
    for (const EffectMask effects : all_effect_sets()) {
        SceneOfEffects subject(effects & ~EFFECT_PATH_FILTER);
        subject.options.effects.all = true;
        subject.options.sampling.spp = spp;
        see_counts(made[Build::SINGLE], subject.render(run.device), describe_effects(effects));
    }
}

void fireflies(CaseRun& run) {
    Figure& error = run.figure("relative error of the mean", 1.2e-7);
    Figure& booked = run.figure("samples beyond the film not counted", 0);
    // Values from 0 to 2, one in 4096 up to 1e6 times as bright, one in 65536 brighter than the film takes.
    Random random(7);
    const size_t count = run.count(1 << 20, 1 << 20, 1 << 22);
    constexpr double TOO_BRIGHT = 1.0 / 65536, BRIGHT = 1.0 / 4096;
    const float largest = float(FilmBench(run.device, std::vector<float>(512, 1.0f), 1).scale().largest);
    std::vector<float> series(count);
    long double sum = 0, clamped = 0;
    size_t beyond = 0;
    for (float& value : series) {
        const double kind = random.unit();
        value = float(kind < TOO_BRIGHT ? random.between(1.01, 100) * double(largest)
                      : kind < BRIGHT   ? std::exp(random.between(0, std::log(1e6)))
                                        : random.between(0, 2));
        beyond += value > largest;
        sum += value > largest ? 0 : value;
        clamped += std::min(value, 10.0f);
    }
    const double exact = double(sum / (long double)(count)),
                 textbook = double(clamped / (long double)(count));
    error[Build::NAIVE].see(std::abs(textbook / exact - 1),
                            [] { return std::string("clamped at ten times the mean"); });
    FilmBench bench(run.device, series, 1);
    for (const Build build : run.builds()) {
        if (build == Build::NAIVE)
            continue;
        for (const float mean : film_mean(bench.film(build)))
            error[build].see(std::abs(double(mean) / exact - 1), [] { return std::string("a pixel"); });
        booked[build].see(
            std::abs(double(bench.counts().overflow) - double(beyond) * FilmBench::PIXELS),
            [&] { return fmt::format("{} counted of {} a pixel", bench.counts().overflow, beyond); });
        booked[build].tried = count * FilmBench::PIXELS;
    }
}

void exr_range(CaseRun& run) {
    Figure& differing = run.figure("values that the file changes", 0);
    const std::vector<float> values = {7e4f,    1e6f,   65504.0f, 65520.0f, 3.4e38f, 1e-7f,
                                       5.9e-8f, 1e-30f, 1e-40f,   0.1f,     0.0f,    1.0f};
    ScratchFolder folder;
    Picture picture;
    picture.width = picture.full_width = 4;
    picture.height = picture.full_height = 1;
    picture.layers.push_back({"", {"R", "G", "B"}, values, false});
    const std::string path = folder.file("range.exr");
    write_picture(picture, path, 0, Tonemap::NONE);
    const auto input = OIIO::ImageInput::open(path);
    std::vector<float> read(values.size());
    if (!input || !input->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, read.data()))
        throw std::runtime_error("the EXR cannot be read back");
    for (size_t i = 0; i < values.size(); ++i) {
        differing[Build::SINGLE].count(float_to_bits(read[i]) != float_to_bits(values[i]),
                                       [&] { return fmt::format("{:a} became {:a}", values[i], read[i]); });
        // What a file of 16-bit floats, the textbook's choice, would hold.
        const double step = std::ldexp(1.0, std::max(std::ilogb(values[i]), -14) - 10);
        const double half = values[i] >= 65520 ? INFINITY : std::nearbyint(double(values[i]) / step) * step;
        differing[Build::NAIVE].count(half != double(values[i]),
                                      [&] { return fmt::format("{:a} as half", values[i]); });
    }
}

} // namespace

const std::vector<StabilityCase>& sample_cases() {
    static const std::vector<StabilityCase> cases = {
        {"X01", "PlantedFaults",
         "NaN, both infinities, a negative and a too bright sample planted at known addresses",
         "the plan, and the same render without them",
         "counting is exact, and a bad sample may touch no other", planted_faults},
        {"X02", "NoHiding", "every shipped scene, and small scenes of every effect and every two",
         "none is bad", "valid scenes give finite, non-negative light", no_hiding},
        {"X03", "Fireflies", "samples of mean about 20 with peaks to 1e6, some beyond what the film takes",
         "long double sum of all that the film takes",
         "nothing is clamped: two roundings of the mean; what is beyond 2^24 mean levels is left out and "
         "counted",
         fireflies},
        {"X04", "PictureRange", "radiances from 1e-40 to 3.4e38 in an EXR", "the values' bits",
         "the file holds 32-bit floats; clrt writes no 16-bit ones, which end at 65504", exr_range},
    };
    return cases;
}

} // namespace clrt
