// SPDX-License-Identifier: Apache-2.0
// The options of the group "Work".
#include "app/option_rows.h"

#include <map>

namespace clrt {

namespace {

/// Segments; no scene needs more, and a pixel's loop stays bounded.
constexpr int LARGEST_DEPTH = 65535;
constexpr int LARGEST_REPLICATES = 64;
constexpr int LARGEST_THREADS = 4096;

void apply_text(std::string& target, const OptionValue& v) {
    if (v.text.empty())
        reject_value(v, "a name");
    target = v.text;
}

// A layout, a quality or one of each; what is not named is chosen.
void apply_bvh(Options& o, const OptionValue& v) {
    o.bvh.layout = BvhChoice::AUTO;
    o.bvh.quality = QualityChoice::AUTO;
    if (v.text == "auto")
        return;
    const std::map<std::string, BvhChoice> layouts = {
        {"bvh8", BvhChoice::BVH8}, {"bvh2", BvhChoice::BVH2}, {"cwbvh", BvhChoice::CWBVH}};
    const std::map<std::string, QualityChoice> qualities = {{"fast", QualityChoice::FAST},
                                                            {"high", QualityChoice::HIGH}};
    for (const std::string& name : split_list(v.text)) {
        const auto layout = layouts.find(name);
        const auto quality = qualities.find(name);
        if (o.bvh.layout == BvhChoice::AUTO && layout != layouts.end())
            o.bvh.layout = layout->second;
        else if (o.bvh.quality == QualityChoice::AUTO && quality != qualities.end())
            o.bvh.quality = quality->second;
        else
            reject_value(v, "auto, bvh8, bvh2, cwbvh, fast, high, or a layout and a quality as in bvh8,high");
    }
}

} // namespace

std::vector<OptionSpec> work_options() {
    const char* const group = "Work";
    return {
        {group, "d", "--device", "NAME",
         "platform, else device, by a part of its name; cpu, gpu; or P:D as listed (default: variable "
         "CLRT_DEVICE, else the first GPU, else the CPU)",
         [](Options& o, const OptionValue& v) { apply_text(o.device.name, v); }},
        {group, "l", "--list-devices", "", "list platforms and devices, with -v how they compute, then exit",
         [](Options& o, const OptionValue&) { o.run.list_devices = true; }, Repeat::NO, COMMAND_LINE_ONLY},
        {group, "i", "--integrator", "NAME",
         "path (global illumination), whitted (mirrors, glass, shadows) or raycast (first hit, shadows) "
         "(default path)",
         [](Options& o, const OptionValue& v) {
             o.transport.integrator = parse_choice<Integrator>(v, {{"raycast", Integrator::RAYCAST},
                                                                   {"whitted", Integrator::WHITTED},
                                                                   {"path", Integrator::PATH}});
         }},
        {group, "s", "--spp", "N",
         "samples a pixel, those of --resume included (default 64; no limit with --time, 65536 with --error)",
         [](Options& o, const OptionValue& v) {
             o.sampling.spp = static_cast<std::uint32_t>(parse_whole(v, 1, LARGEST_U32));
         }},
        {group, "t", "--time", "DURATION",
         "render for 90, 90s, 5m or 1h: the first pass (a sample a pixel) is always finished, a later one "
         "that is not done in time is dropped (default: no limit)",
         [](Options& o, const OptionValue& v) { o.sampling.time_seconds = parse_duration(v); }},
        {group, "e", "--error", "X",
         "render until the picture's relative error, root of mean squared over mean, both over the pixels "
         "that "
         "show the scene, is at most 0.02 or 2%, looked at where samples are even: --replicates times 2^k or "
         "3/2 2^k; whichever of -s, -t and -e comes first ends the render (default: no target)",
         [](Options& o, const OptionValue& v) {
             o.sampling.error = parse_fraction(v);
             if (!(*o.sampling.error > 0)) // which no number of samples reaches
                 reject_value(v, "an error above 0 such as 0.02 or 2%");
         }},
        {group, "", "--max-depth", "N",
         "longest path in segments; 1 sees emitters, 2 adds direct light (default 4096, whitted 10, raycast "
         "always 2); what it cuts is reported",
         [](Options& o, const OptionValue& v) {
             o.transport.max_depth = static_cast<int>(parse_whole(v, 1, LARGEST_DEPTH));
         }},
        {group, "", "--roulette-depth", "N", "path: first segment that Russian roulette may end (default 5)",
         [](Options& o, const OptionValue& v) {
             o.transport.roulette_depth = static_cast<int>(parse_whole(v, 1, LARGEST_DEPTH));
         }},
        {group, "", "--min-contribution", "X",
         "whitted: smallest weight worth a ray, also in % (default 0.002)",
         [](Options& o, const OptionValue& v) { o.transport.min_contribution = parse_fraction(v); }},
        {group, "", "--seed", "N", "chooses the noise; same seed, same picture (default 0)",
         [](Options& o, const OptionValue& v) {
             o.sampling.seed = static_cast<std::uint32_t>(parse_whole(v, 0, LARGEST_U32));
         }},
        {group, "", "--first-sample", "N", "index of the first sample, to continue a run (default 0)",
         [](Options& o, const OptionValue& v) {
             o.sampling.first_sample = static_cast<std::uint32_t>(parse_whole(v, 0, LARGEST_U32));
         }},
        {group, "", "--replicates", "N",
         "independent sample sequences; their spread is the error (default 8)",
         [](Options& o, const OptionValue& v) {
             o.sampling.replicates = static_cast<int>(parse_whole(v, 1, LARGEST_REPLICATES));
         }},
        {group, "", "--adaptive", "",
         "take more samples where the picture is noisy, by tiles of 16 x 16 pixels; --spp is their mean, at "
         "least 2 for each "
         "of the --replicates (default: the same everywhere)",
         [](Options& o, const OptionValue&) { o.sampling.adaptive = true; }},
        {group, "", "--sampler", "NAME",
         "sobol (scrambled points, even over the samples of a pixel) or independent (white noise, to compare "
         "with) (default sobol)",
         [](Options& o, const OptionValue& v) {
             o.sampling.sampler = parse_choice<SamplerChoice>(
                 v, {{"sobol", SamplerChoice::SOBOL}, {"independent", SamplerChoice::INDEPENDENT}});
         }},
        {group, "", "--precision", "NAME",
         "single, double (needs fp64) or fast (relaxed maths) (default single)",
         [](Options& o, const OptionValue& v) {
             o.device.precision = parse_choice<Precision>(
                 v,
                 {{"single", Precision::SINGLE}, {"double", Precision::DOUBLE}, {"fast", Precision::FAST}});
         }},
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
         [](Options& o, const OptionValue& v) {
             o.scene.mtl =
                 parse_choice<MtlReading>(v, {{"auto", MtlReading::AUTO}, {"plain", MtlReading::PLAIN}});
         }},
        {group, "", "--material", "NAME",
         "what everything is made of: none (as the libraries say) or clay (matte grey, to show shape and "
         "light "
         "alone; lights and cut-outs stay) (default none)",
         [](Options& o, const OptionValue& v) {
             o.scene.material_override = parse_choice<MaterialOverride>(
                 v, {{"none", MaterialOverride::NONE}, {"clay", MaterialOverride::CLAY}});
         }},
    };
}

} // namespace clrt
