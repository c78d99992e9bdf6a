// SPDX-License-Identifier: Apache-2.0
// A replayed sample has the bits of the rendered one; a planted fault is found where it was planted, and so
// is a decision that is made differently in double precision.
#include "film/film_buffers.h"
#include "probes/effect_masks.h"
#include "probes/kernel_probe.h"
#include "render/launcher.h"
#include "render/light_outlines.h"
#include "replay/causes.h"
#include "replay/flips.h"
#include "support/drawn.h"
#include "support/render_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <iterator>

namespace clrt {

namespace {

constexpr Integrator INTEGRATORS[] = {Integrator::PATH, Integrator::DISTRIBUTION, Integrator::WHITTED,
                                      Integrator::RAYCAST};

/// A loaded scene on the test device, without programs. Its options may change where their programs do.
struct Stage {
    std::shared_ptr<PlannedScene> planned;
    PreparedScene prepared;
    Options& options = planned->options;

    Stage(Scene scene, Options given)
        : planned(plan_loaded(test_device(), std::move(scene), std::move(given))),
          prepared(prepare_scene(test_device(), planned)) {}

    std::vector<SampleAddress> all_pixels(u32 sample) const {
        std::vector<SampleAddress> addresses;
        for (u32 pixel = 0; pixel < u32(options.film.size.x * options.film.size.y); ++pixel)
            addresses.push_back({pixel, sample});
        return addresses;
    }
    PreparedScene with_programs() const {
        return prepare_render(test_device(), planned, {prepared.tree, {}});
    }
    Render render() const { return render_silently(with_programs()); }
    Replay replay(Precision precision) const { return Replay(prepared, precision); }
};

/// How many of the film's sums are not those of the replayed samples.
size_t count_differences(const Render& render, const std::vector<SampleTrace>& traces) {
    const size_t plane = film_plane(render.film);
    const size_t replicate = render.film.ranges.front().first % u32(render.film.replicates);
    size_t differences = 0;
    for (const SampleTrace& trace : traces)
        for (size_t c = 0; c < 3; ++c)
            differences += trace.film[c] != render.film.sums[replicate * plane + 3 * trace.address.pixel + c];
    return differences;
}

/// A small room that every kind of path runs through.
Stage every_effect(Integrator integrator) {
    SceneOfEffects small(EVERY_EFFECT);
    small.options.transport.integrator = integrator;
    small.options.film.size = {24, 20};
    small.options.sampling.replicates = 4;
    small.options.sampling.spp = 1;
    if (integrator != Integrator::PATH)
        small.options.transport.paths.clear();
    return Stage(small.load(), small.options);
}

/// A copy of the kernels in which texts are replaced.
class PlantedKernels {
public:
    PlantedKernels() {
        const std::string from = test_kernels_folder();
        std::filesystem::copy(from.empty() ? CLRT_KERNELS_FOLDER : from, path(),
                              std::filesystem::copy_options::recursive);
    }
    std::string path() const { return folder_.file("kernels"); }
    void replace(const std::string& file, const std::string& from, const std::string& to) const {
        std::string text = folder_.read("kernels/" + file);
        const size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from << " is not in " << file;
        folder_.write("kernels/" + file, text.replace(at, from.size(), to));
    }

private:
    ScratchFolder folder_;
};

/// A closed room that shines a little everywhere, 16 x 16 pixels.
void make_white_room(TestScene& room) {
    room.build.material("white", "Kd 0.7 0.7 0.7\nKe 0.1 0.1 0.1").use("white");
    room.build.box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
    room.look({0, 0, 0.9}, {0, 0, -1}, 60);
    room.options.effects.all = false;
}

FlipStatistics flips_of(const TestScene& scene) {
    return find_flips(Stage(scene.load(), scene.options).prepared);
}

/// A change to a kernel file that spoils one sample, and what it is to be reported as.
struct Fault {
    const char* name;
    const char* file;
    std::string from, to;
    u32 kind, quantity, bounce;
};

/// Faults in sample 6 of pixel (3, 2): number 1 of replicate 2 of 4.
std::vector<Fault> planted_faults() {
    const std::string planted = "sampler_make(0u, 2u * 16u + 3u, 2u, 1u)";
    const std::string vertex = "    const real3 wo = -path->ray.direction;\n";
    const std::string sampled = "const BsdfSample next = guide_sample(scene, bsdf, path->numbers.lobe, "
                                "path->numbers.direction, guide);";
    const auto spoil_sample = [&](const char* bounce, const char* what) {
        return "const Sampler planted = " + planted + ";\n    " + sampled.substr(6) +
               "\n    if (path->numbers.alias == sampler_partner_words(&planted, " + bounce +
               ", SAMPLE_DIRECTION).y) next." + what;
    };
    const std::string light = "LightSample light = path_light(scene, params, surface, bsdf, path);";
    const char* const walk = "path/walk.h";
    return {
        {"NaN weight at bounce 2", walk, sampled, spoil_sample("2u", "weight.y = as_float(0x7fc00000u);"),
         COUNT_NAN, TRACE_WEIGHT, 2},
        {"infinite weight at bounce 1", walk, sampled,
         spoil_sample("1u", "weight.x = as_float(0x7f800000u);"), COUNT_INFINITE, TRACE_WEIGHT, 1},
        {"negative throughput", walk, "path->throughput *= next->weight;",
         "path->throughput *= next->weight; if (segment == 1u && sampler->word_key == " + planted +
             ".word_key) path->throughput *= REAL(-100.0);",
         COUNT_NEGATIVE, TRACE_THROUGHPUT, 1},
        {"overflow in the sum", "integrators/path.h", vertex,
         vertex + "    if (segment == 1u && sample->sampler.word_key == " + planted +
             ".word_key) sample->radiance.x = REAL(1e30);\n",
         COUNT_OVERFLOW, 0, 0},
        {"NaN density of the light at bounce 2", "path/connect.h", light,
         "const Sampler planted = " + planted + ";\n    " + light +
             "\n    if (path->numbers.alias == sampler_partner_words(&planted, 2u, SAMPLE_DIRECTION).y) "
             "light.pdf_w = "
             "as_float(0x7fc00000u);",
         COUNT_NAN, TRACE_LIGHT_PDF, 2},
    };
}

/// The events of one quantity, in their order.
std::vector<TraceEvent> events_of(const SampleTrace& trace, u32 quantity) {
    std::vector<TraceEvent> found;
    std::copy_if(trace.events.begin(), trace.events.end(), std::back_inserter(found),
                 [&](const TraceEvent& event) { return event.quantity == quantity; });
    return found;
}

} // namespace

TEST(Replay, ASampleAddsToTheFilmWhatTheRenderAdds) {
    std::vector<std::pair<Integrator, Precision>> programs;
    for (const Integrator integrator : INTEGRATORS) {
        programs.push_back({integrator, Precision::SINGLE});
        if (test_device().info.fp64 && integrator != Integrator::WHITTED)
            programs.push_back({integrator, Precision::DOUBLE});
    }
    for (const auto& [integrator, precision] : drawn(programs, 3)) {
        Stage stage = every_effect(integrator);
        stage.options.device.precision = precision;
        Replay replay = stage.replay(precision);
        for (const u32 sample : {0u, 7u}) {
            stage.options.sampling.first_sample = sample;
            const std::vector<SampleTrace> traces = replay.run(stage.all_pixels(sample));
            EXPECT_EQ(count_differences(stage.render(), traces), 0u) << name_of(integrator) << ' ' << sample;
        }
    }
}

TEST(Replay, SimplerScenesHaveTheBitsOfTheirOwnPrograms) {
    const std::vector<EffectMask> sets = single_effects();
    for (size_t i = 0; i < sets.size(); i += 4) {
        SceneOfEffects small(sets[i]);
        small.options.effects.all = false;
        small.options.sampling.spp = 1;
        small.options.sampling.first_sample = 3;
        const Stage stage(small.load(), small.options);
        Replay replay = stage.replay(Precision::SINGLE);
        EXPECT_EQ(count_differences(stage.render(), replay.run(stage.all_pixels(3))), 0u)
            << describe_effects(sets[i]);
    }
}

TEST(Replay, TheRadianceOfTheRecordIsThatOfTheRenderToTheLastBit) {
    // A film of quanta so fine that the sums are the floats themselves.
    constexpr double QUANTUM = 0x1p-44;
    for (const Integrator integrator : {Integrator::PATH, Integrator::RAYCAST}) {
        const Stage stage = every_effect(integrator);
        RenderParams params = launch_params(*stage.planned);
        params.quantum = float(QUANTUM);
        params.inverse_quantum = float(1 / QUANTUM);
        params.largest_contribution = 0x1p18f;
        const PreparedScene prepared = stage.with_programs();
        const FilmBuffers film(test_device(), params, stage.planned->effects.paths.layers.size());
        Launcher launcher(test_device(), prepared.programs->picture, integrator_kernel(integrator), params,
                          prepared.buffers);
        film.write_emission(find_light_outlines(stage.planned->scene, params));
        film.bind(launcher.kernel());
        launcher.run(5, 1, 0, params.tile_count);
        RenderProgress sums;
        sums.film.width = stage.options.film.size.x;
        sums.film.height = stage.options.film.size.y;
        film.read_sums(sums);

        const size_t plane = size_t(3 * stage.options.film.size.x * stage.options.film.size.y);
        size_t lit = 0, different = 0;
        for (const SampleTrace& trace : stage.replay(Precision::SINGLE).run(stage.all_pixels(5))) {
            const auto radiance =
                std::find_if(trace.events.begin(), trace.events.end(),
                             [](const TraceEvent& e) { return e.quantity == TRACE_RADIANCE; });
            ASSERT_NE(radiance, trace.events.end());
            for (int c = 0; c < 3; ++c) {
                const double value = trace_value(trace, *radiance, c);
                const double sum = double(
                    sums.film.sums[plane * (5 % params.replicates) + 3 * trace.address.pixel + size_t(c)]);
                lit += value > 0;
                different +=
                    value > 0x1p-20 ? sum * QUANTUM != value : std::abs(sum * QUANTUM - value) > QUANTUM;
            }
        }
        EXPECT_EQ(different, 0u) << name_of(integrator);
        EXPECT_GT(lit, plane / 4);
    }
}

TEST(Replay, LongPathsAreRecordedWhole) {
    TestScene scene;
    scene.build.material("mirror", "Kd 0 0 0\nKs 1 1 1\nillum 3").use("mirror");
    scene.build.box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
    scene.look({0.1, 0.2, 0.3}, {0, 0, -1}, 60);
    scene.options.film.size = {2, 1};
    scene.options.effects.all = false; // a program that no other test has: the small one is the fast one
    scene.options.transport.max_depth = 3000;
    scene.options.transport.roulette_depth = 4000;
    const Stage stage(scene.load(), scene.options);
    Replay replay = stage.replay(Precision::SINGLE);
    const std::vector<SampleTrace> traces = replay.run({{1, 0}, {0, 9}});
    ASSERT_EQ(traces.size(), 2u);
    for (const SampleTrace& trace : traces) {
        EXPECT_EQ(trace.events.size(), trace.event_count);
        EXPECT_EQ(trace_bounce(trace, trace.events.size() - 1), 3000u);
        EXPECT_EQ(trace.events.back().quantity, TRACE_RADIANCE);
        const bool all_mirrors =
            std::all_of(trace.events.begin(), trace.events.end(), [](const TraceEvent& event) {
                return event.quantity != TRACE_LOBE || event.bits[0] == LOBE_MIRROR;
            });
        EXPECT_TRUE(all_mirrors);
        // Every sampled direction is that of the next ray.
        const std::vector<TraceEvent> rays = events_of(trace, TRACE_RAY_DIRECTION);
        const std::vector<TraceEvent> sampled = events_of(trace, TRACE_WI);
        ASSERT_EQ(rays.size(), 3000u);
        ASSERT_EQ(sampled.size(), 2999u);
        for (size_t i = 0; i < sampled.size(); ++i)
            EXPECT_EQ(sampled[i].bits, rays[i + 1].bits) << i;
    }
    EXPECT_EQ(traces[0].decisions, replay.run({{1, 0}}, TraceEvents::NONE)[0].decisions);
    EXPECT_NE(traces[0].decisions, traces[1].decisions);
}

// X01: faults at a known pixel, sample, bounce and quantity.
TEST(Replay, PlantedFaultsAreFoundWhereTheyArePlanted) {
    for (const Fault& fault : planted_faults()) {
        PlantedKernels kernels;
        kernels.replace(fault.file, fault.from, fault.to);
        TestScene room;
        make_white_room(room);
        room.options.sampling.replicates = 4;
        room.options.sampling.spp = 8;
        room.options.device.kernels_folder = kernels.path();
        const Stage stage(room.load(), room.options);
        const Render render = stage.render();
        const RenderCounts& counts = render.counts;
        EXPECT_EQ(counts.nan, fault.kind == COUNT_NAN) << fault.name;
        EXPECT_EQ(counts.infinite, fault.kind == COUNT_INFINITE) << fault.name;
        EXPECT_EQ(counts.negative, fault.kind == COUNT_NEGATIVE) << fault.name;
        EXPECT_EQ(counts.overflow, fault.kind == COUNT_OVERFLOW) << fault.name;
        ASSERT_EQ(counts.bad_samples.size(), 1u) << fault.name;
        EXPECT_EQ(counts.bad_samples[0], std::pair(2u * 16u + 3u, 6u)) << fault.name;
        EXPECT_EQ(counts.bad_pixels, (std::map<u32, std::uint64_t>{{2u * 16u + 3u, 1u}})) << fault.name;

        const std::vector<CauseCount> causes = find_causes(stage.prepared, counts);
        ASSERT_EQ(causes.size(), 1u) << fault.name;
        EXPECT_EQ(causes[0].cause.kind, fault.kind) << fault.name;
        EXPECT_EQ(causes[0].cause.quantity, fault.quantity) << fault.name;
        EXPECT_EQ(causes[0].cause.bounce, fault.bounce) << fault.name;
        EXPECT_EQ(causes[0].count, 1u) << fault.name;
        EXPECT_EQ(causes[0].cause.material,
                  fault.quantity != 0 ? stage.planned->scene.triangles[0].material : NO_INDEX)
            << fault.name;
    }
}

TEST(Replay, ADecisionThatDoubleMakesDifferentlyIsFound) {
    if (!test_device().info.fp64)
        GTEST_SKIP() << "the device has no fp64";
    PlantedKernels kernels;
    // In double, Russian roulette ends what it would let live at bounce 2 in one pixel of three.
    kernels.replace("path/walk.h",
                    "const bool survives = !(sampler_number(sampler, segment, SAMPLE_ROULETTE) >= survival);",
                    "bool survives = !(sampler_number(sampler, segment, SAMPLE_ROULETTE) >= survival);\n"
                    "#ifdef REAL_IS_DOUBLE\n    if (segment == 2u && sampler->key % 3u == 0u) survives = "
                    "!survives;\n#endif\n");
    TestScene room;
    make_white_room(room);
    room.options.sampling.spp = 4;
    room.options.transport.roulette_depth = 2;
    room.options.device.kernels_folder = test_kernels_folder();
    const FlipStatistics clean = flips_of(room);
    EXPECT_EQ(clean.samples, 16u * 16u * 4u);
    EXPECT_LE(clean.flips.size(), 1u) << "1e-5 of the samples of a matte room flip (flips_test)";
    room.options.device.kernels_folder = kernels.path();
    const FlipStatistics flips = flips_of(room);
    const std::uint64_t planted = flips.counts()[{"roulette", 2u}];
    // A third of 1024 keys that a hash deals out, within three standard errors.
    EXPECT_NEAR(double(planted) / double(flips.samples), 1.0 / 3, 0.045);
    EXPECT_GE(planted + clean.flips.size(), flips.flips.size()) << format_flips(flips);
}

} // namespace clrt
