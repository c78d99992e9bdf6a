// SPDX-License-Identifier: Apache-2.0
// The options of the group "Work".
#include "app/integrator_help.h"
#include "app/option_rows.h"
#include "film/film.h"
#include "kernels/shared/render_types.h"

#include <fmt/format.h>

namespace clrt {

namespace {

constexpr int LARGEST_REPLICATES = 64;
constexpr int LARGEST_THREADS = 4096;

void apply_text(std::string& target, const OptionValue& v) {
    if (v.text.empty())
        reject_value(v, "a name");
    target = v.text;
}

/// Above 0, which no number of samples reaches.
double parse_error_target(const OptionValue& v) {
    const double error = parse_fraction(v);
    if (!(error > 0))
        reject_value(v, "an error above 0 such as 0.02 or 2%");
    return error;
}

int parse_branch(const OptionValue& v) {
    return static_cast<int>(parse_whole(v, 1, LARGEST_BRANCH));
}

/// 0: auto.
int parse_light_samples(const OptionValue& v) {
    if (v.text == "auto")
        return 0;
    const int samples = static_cast<int>(parse_whole(v, 1, MOST_LIGHT_SAMPLES));
    if ((samples & (samples - 1)) != 0)
        reject_value(v, "a power of two");
    return samples;
}

std::string layouts_and_qualities() {
    std::vector<std::string> names;
    for (const auto& row : NAMES<BvhLayout>)
        names.emplace_back(row.name);
    for (const auto& row : NAMES<BvhQuality>)
        names.emplace_back(row.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

void apply_integrator(Options& o, const OptionValue& v) {
    const std::optional<Integrator> named = find_named<Integrator>(v.text);
    o.transport.choose = v.text == CHOSEN_INTEGRATOR ? Toggle::ON : Toggle::OFF;
    if (!named && o.transport.choose == Toggle::OFF) {
        std::vector<std::string> names;
        for (const IntegratorRow& row : INTEGRATOR_ROWS)
            names.emplace_back(row.name);
        names.emplace_back(CHOSEN_INTEGRATOR);
        reject_value(v, alternatives(names));
    }
    o.transport.integrator = named.value_or(TransportOptions{}.integrator);
}

// A layout, a quality or one of each; what is not named is chosen.
void apply_bvh(Options& o, const OptionValue& v) {
    o.bvh = {};
    if (v.text == "auto")
        return;
    for (const std::string& name : split_list(v.text)) {
        const auto layout = find_named<BvhLayout>(name);
        const auto quality = find_named<BvhQuality>(name);
        if (layout && !o.bvh.layout)
            o.bvh.layout = layout;
        else if (quality && !o.bvh.quality)
            o.bvh.quality = quality;
        else
            reject_value(v,
                         "auto, " + layouts_and_qualities() + ", or a layout and a quality as in bvh8,high");
    }
}

} // namespace

std::vector<OptionSpec> work_options() {
    const char* const group = "Work";
    const TransportOptions defaults;
    return {
        {group, "d", "--device", "NAME",
         "platform, else device, by a part of its name; cpu, gpu; or P:D as listed; several with commas "
         "between them share the samples (default: variable CLRT_DEVICE, else the first GPU, else the CPU)",
         [](Options& o, const OptionValue& v) { apply_text(o.device.name, v); }},
        {group, "l", "--list-devices", "", "list platforms and devices, with -v how they compute, then exit",
         [](Options& o, const OptionValue&) { o.run.list_devices = true; }, Repeat::NO, COMMAND_LINE_ONLY},
        {group, "i", "--integrator", "NAME", integrator_choices(), apply_integrator},
        {group, "s", "--spp", "N",
         "samples a pixel, those of --resume included (default 64; no limit with --time, 65536 with --error "
         "or "
         "--denoised-error)",
         [](Options& o, const OptionValue& v) {
             o.sampling.spp = static_cast<std::uint32_t>(parse_whole(v, 1, LARGEST_U32));
         }},
        {group, "t", "--time", "DURATION",
         "render for 90, 90s, 5m or 1h: the first pass (a sample a pixel) is always finished, a later one "
         "that is not done in time is dropped (default: no limit)",
         [](Options& o, const OptionValue& v) { o.sampling.time_seconds = parse_duration(v); }},
        {group, "e", "--error", "X",
         "render until the picture's error, root of mean squared over mean, both over the pixels that show "
         "the scene, is at most 0.02 or 2% (with --adaptive=relative the error relative to every pixel's "
         "brightness), looked at where samples are even: --replicates times 2^k or "
         "3/2 2^k; whichever of -s, -t and -e comes first ends the render (default: no target)",
         [](Options& o, const OptionValue& v) { o.sampling.error = parse_error_target(v); }},
        {group, "", "--denoised-error", "X",
         "render until the denoised picture's error, by the same measure as --error, is at most 0.05 or 5% "
         "with 95 % confidence, and the noise can be trusted to be seen; looked at where samples are even, "
         "as rarely as keeps denoising in between below a tenth of the render; brings --denoise (not with "
         "--error; default: no target)",
         [](Options& o, const OptionValue& v) {
             o.sampling.denoised_error = parse_error_target(v);
             if (!o.denoise.denoiser)
                 o.denoise.denoiser = Denoiser::AUTO;
         }},
        {group, "", "--max-depth", "N",
         fmt::format("longest path in segments; 1 sees emitters, 2 adds direct light ({}); what it cuts is "
                     "reported",
                     depth_defaults()),
         [](Options& o, const OptionValue& v) {
             o.transport.max_depth = static_cast<int>(parse_whole(v, 1, LARGEST_DEPTH));
         }},
        {group, "", "--guide", "auto|on|off",
         takers(TAKES_GUIDE) +
             fmt::format(
                 "sample directions where paths have found light before: off, on, or auto: where a "
                 "pilot is noisy, or the picture after {:.0f} million rays, if the guided samples "
                 "then tell that it lowers noise times rays, for bdpt where mirrors or glass and a "
                 "bright light call for a pilot, and that tells so; not with --first-sample, --adaptive, "
                 "--ledger, --pixel or fewer than 4 replicates (default auto)",
                 defaults.guide_after_rays * 1e-6),
         [](Options& o, const OptionValue& v) { o.transport.guide = parse_choice<Toggle>(v); }},
        {group, "", "--path-reuse", "auto|on|off",
         takers(TAKES_PATH_REUSE) +
             fmt::format("give what a path finds behind its second vertex to {} pixels: off, on, or auto: "
                         "where pilots tell that it lowers noise times rays; not with --ledger, "
                         "--pixel, a --crop across tiles of {} pixels, or a roulette from the first segment "
                         "on (default auto)",
                         REUSE_PIXELS, TILE_SIZE),
         [](Options& o, const OptionValue& v) { o.transport.path_reuse = parse_choice<Toggle>(v); }},
        {group, "", "--emission-rays", "N",
         fmt::format("{}camera rays a sample from which a pixel takes the emission of lights, if the outline "
                     "of one crosses it, seen by itself or, where few pixels see such, in mirrors and glass; "
                     "1: paths "
                     "find it there as everywhere (default {})",
                     takers(TAKES_EMISSION_RAYS), defaults.emission_rays),
         [](Options& o, const OptionValue& v) { o.transport.emission_rays = parse_branch(v); }},
        {group, "", "--light-samples", "auto|N",
         fmt::format("{}samples of lights, up to {} and a power of two, at a path's first vertex that is no "
                     "mirror or glass; auto: more than one where there are many lights and pilots tell that "
                     "it lowers noise times rays, but one with --first-sample, --ledger and --pixel (default "
                     "auto)",
                     takers(TAKES_LIGHT_SAMPLES), MOST_LIGHT_SAMPLES),
         [](Options& o, const OptionValue& v) { o.transport.light_samples = parse_light_samples(v); }},
        {group, "", "--roulette-depth", "N",
         fmt::format("{}first segment that Russian roulette may end (default {})",
                     takers(TAKES_ROULETTE_DEPTH), defaults.roulette_depth),
         [](Options& o, const OptionValue& v) {
             o.transport.roulette_depth = static_cast<int>(parse_whole(v, 1, LARGEST_DEPTH));
         }},
        {group, "", "--min-contribution", "X",
         fmt::format("{}smallest weight worth a ray, also in %; whitted leaves smaller ones out, "
                     "distribution most, by chance, and without bias (default {})",
                     takers(TAKES_MIN_CONTRIBUTION), defaults.min_contribution),
         [](Options& o, const OptionValue& v) { o.transport.min_contribution = parse_fraction(v); }},
        {group, "", "--shadow-rays", "N",
         fmt::format("{}shadow rays of a surface point to all lamps together, to the sky, and to every sun "
                     "with a disc (default {}); of these and the next two, fewer where the sample has "
                     "branched before",
                     takers(TAKES_SHADOW_RAYS), defaults.shadow_rays),
         [](Options& o, const OptionValue& v) { o.transport.shadow_rays = parse_branch(v); }},
        {group, "", "--gloss-rays", "N",
         fmt::format("{}rays by which a rough reflection goes on (default {})", takers(TAKES_GLOSS_RAYS),
                     defaults.gloss_rays),
         [](Options& o, const OptionValue& v) { o.transport.gloss_rays = parse_branch(v); }},
        {group, "", "--translucent-rays", "N",
         fmt::format("{}rays by which rough glass goes on, reflected and refracted together (default {})",
                     takers(TAKES_TRANSLUCENT_RAYS), defaults.translucent_rays),
         [](Options& o, const OptionValue& v) { o.transport.translucent_rays = parse_branch(v); }},
        {group, "", "--seed", "N", "chooses the noise; same seed, same picture (default 0)",
         [](Options& o, const OptionValue& v) {
             o.sampling.seed = static_cast<std::uint32_t>(parse_whole(v, 0, LARGEST_U32));
         }},
        {group, "", "--first-sample", "N", "index of the first sample, to continue a run (default 0)",
         [](Options& o, const OptionValue& v) {
             o.sampling.first_sample = static_cast<std::uint32_t>(parse_whole(v, 0, LARGEST_U32));
         }},
        {group, "", "--replicates", "N",
         "independent sample sequences; their spread is the error (default 4; 1 with --spp 1 alone)",
         [](Options& o, const OptionValue& v) {
             o.sampling.replicates = static_cast<int>(parse_whole(v, 1, LARGEST_REPLICATES));
         }},
        {group, "", "--adaptive", "[=mse|relative]",
         fmt::format("take more samples where the picture is noisy, by tiles of {0} x {0} pixels, as soon as "
                     "that is expected to pay; mse makes the mean squared error least, relative that of "
                     "pixels relative to their own brightness, by which --error then judges too (alone: "
                     "mse). --spp is the mean, at least 2 for each of the --replicates (default: the same "
                     "everywhere)",
                     ADAPTIVE_TILE_SIZE),
         [](Options& o, const OptionValue& v) {
             o.sampling.adaptive = v.text.empty() ? ErrorMeasure::MSE : parse_choice<ErrorMeasure>(v);
         }},
        {group, "", "--sampler", "NAME",
         "sobol (scrambled points, even over the samples of a pixel) or independent (white noise, to compare "
         "with) (default sobol)",
         [](Options& o, const OptionValue& v) { o.sampling.sampler = parse_choice<SamplerChoice>(v); }},
        {group, "", "--light-sampler", "NAME",
         "how a light is chosen: tree (by what it may send to the surface; `path`, and `distribution` for "
         "lamps), mixture (half by "
         "power, half evenly over kinds of light and the objects that shine) or power (default tree)",
         [](Options& o, const OptionValue& v) { o.sampling.light_sampler = parse_choice<LightSampler>(v); }},
        {group, "", "--precision", "NAME",
         "single, double (needs fp64) or fast (relaxed maths) (default single)",
         [](Options& o, const OptionValue& v) { o.device.precision = parse_choice<Precision>(v); }},
        {group, "j", "--threads", "N", "CPU threads, 0 for all (default 0)",
         [](Options& o, const OptionValue& v) {
             o.device.threads = static_cast<int>(parse_whole(v, 0, LARGEST_THREADS));
         }},
        {group, "", "--bvh", "NAME",
         "tree of boxes: layout bvh8, bvh2 or cwbvh, quality fast or high, or both as in bvh8,high; auto "
         "chooses "
         "the layout by device and high where a long render pays for it (default auto)",
         apply_bvh},
        {group, "", "--mtl", "MODE",
         "material libraries: auto (as Blender, Maya, scan tools and others mean what they write; every "
         "repair "
         "is said) or plain (word by word) (default auto)",
         [](Options& o, const OptionValue& v) { o.scene.mtl = parse_choice<MtlReading>(v); }},
        {group, "", "--texture-filter", "NAME",
         takers(TAKES_TEXTURE_FILTER) +
             "colours, metal and roughness of textures are read at a point (none) or averaged over what the "
             "ray's cone covers (footprint): less noise in few samples, biased by a blur that narrows with "
             "their number; a third more memory (default none)",
         [](Options& o, const OptionValue& v) { o.scene.texture_filter = parse_choice<TextureFilter>(v); }},
        {group, "", "--instances", "auto|on|off",
         fmt::format(
             "meshes that a glTF file uses several times: kept once and shared (on), copied (off), or "
             "auto: shared where the copies would be {} triangles or more; what shines or moves is "
             "copied (default auto)",
             LEAST_COPIED_TRIANGLES),
         [](Options& o, const OptionValue& v) { o.scene.instances = parse_choice<Toggle>(v); }},
        {group, "", "--gltf-lights", "UNITS",
         "lights of glTF files: blender (candela and lux over 683, as Blender writes them; emission as it "
         "is) or raw (watts as they are) (default blender)",
         [](Options& o, const OptionValue& v) { o.scene.gltf.lights = parse_choice<GltfLights>(v); }},
        {group, "", "--gltf-solid-glass", "",
         "transmission without a volume in glTF files refracts, as in Blender (default: a thin wall, as "
         "the standard says)",
         [](Options& o, const OptionValue&) { o.scene.gltf.solid_glass = true; }},
        {group, "", "--material", "NAME",
         "what everything is made of: none (as the libraries say) or clay (matte grey, to show shape and "
         "light "
         "alone; lights and cut-outs stay) (default none)",
         [](Options& o, const OptionValue& v) {
             o.scene.material_override = parse_choice<MaterialOverride>(v);
         }},
    };
}

} // namespace clrt
