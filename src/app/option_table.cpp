// SPDX-License-Identifier: Apache-2.0
// Every option once. The order is the order of --help.
#include "app/option_table.h"

#include "app/effect_option.h"
#include "app/layer_option.h"
#include "app/nearest_name.h"
#include "error.h"
#include "output/image.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>

namespace clrt {

namespace {

/// Segments; no scene needs more, and a pixel's loop stays bounded.
constexpr int LARGEST_DEPTH = 65535;
constexpr int LARGEST_REPLICATES = 64;
constexpr int LARGEST_THREADS = 4096;
/// Stops: 2^100 times any float radiance still is a double.
constexpr double LARGEST_EXPOSURE = 100;
/// Pixels; a wider filter is a blurred picture.
constexpr double LARGEST_FILTER_RADIUS = 100;
constexpr std::int64_t LARGEST_U32 = std::numeric_limits<std::uint32_t>::max();

constexpr Repeat REPEATABLE = Repeat::YES;
constexpr InFile COMMAND_LINE_ONLY = InFile::NO;

void no_effect(Options&, const OptionValue&) {}

glm::dvec3 direction(const OptionValue& v) {
    const std::string expected = "a direction x,y,z other than 0,0,0";
    const glm::dvec3 d = parse_vector(v, expected);
    if (d == glm::dvec3(0))
        reject_value(v, expected);
    return d;
}

bool is_colour(const glm::dvec3& c) {
    return c.x >= 0 && c.y >= 0 && c.z >= 0;
}

void apply_environment(Options& o, const OptionValue& v) {
    o.light.environment_file.clear();
    o.light.environment.reset();
    if (!looks_like_numbers(v.text)) {
        o.light.environment_file = parse_path(v);
        return;
    }
    const std::string expected = "an image file or a radiance r,g,b of numbers from 0";
    const glm::dvec3 radiance = parse_vector(v, expected);
    if (!is_colour(radiance))
        reject_value(v, expected);
    o.light.environment = radiance;
}

void apply_sun(Options& o, const OptionValue& v) {
    const std::string expected =
        "x,y,z,r,g,b[,deg]: a direction other than 0,0,0, an irradiance of numbers from 0, "
        "and a diameter from 0 to 90 degrees";
    const std::vector<double> n = parse_numbers(v, 6, 7, expected);
    const SunOptions sun{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, n.size() == 7 ? n[6] : 0};
    const bool diameter_fits = sun.diameter_degrees >= 0 && sun.diameter_degrees <= 90;
    if (sun.towards == glm::dvec3(0) || !is_colour(sun.irradiance) || !diameter_fits)
        reject_value(v, expected);
    o.light.suns.push_back(sun);
}

void apply_point(Options& o, const OptionValue& v) {
    const std::string expected = "x,y,z,r,g,b: a position and an intensity of numbers from 0";
    const std::vector<double> n = parse_numbers(v, 6, 6, expected);
    const PointOptions point{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    if (!is_colour(point.intensity))
        reject_value(v, expected);
    o.light.points.push_back(point);
}

void apply_filter(Options& o, const OptionValue& v) {
    const size_t colon = v.text.find(':');
    OptionValue name = v, radius = v;
    name.text = v.text.substr(0, colon);
    o.filter = parse_choice<Filter>(
        name, {{"box", Filter::BOX}, {"tent", Filter::TENT}, {"gaussian", Filter::GAUSSIAN}});
    o.filter_radius.reset();
    if (colon == std::string::npos)
        return;
    radius.text = v.text.substr(colon + 1);
    o.filter_radius = parse_number(radius, "a radius in pixels above 0 and up to 100 after the ':'",
                                   [](double r) { return r > 0 && r <= LARGEST_FILTER_RADIUS; });
}

void apply_output(Options& o, const OptionValue& v) {
    const std::string path = parse_path(v);
    if (!is_output_path(path))
        reject_value(v, std::string("a file name that ends in ") + OUTPUT_EXTENSIONS);
    o.outputs.push_back(path);
}

/// FILE or FILE,DURATION: a comma in the name counts where no digit follows it.
void apply_checkpoint(Options& o, const OptionValue& v) {
    const size_t comma = v.text.rfind(',');
    const bool has_interval = comma != std::string::npos && comma + 1 < v.text.size() &&
                              std::isdigit(static_cast<unsigned char>(v.text[comma + 1]));
    OptionValue path = v, interval = v;
    path.text = has_interval ? v.text.substr(0, comma) : v.text;
    o.checkpoint_path = parse_path(path);
    o.checkpoint_seconds = DEFAULT_CHECKPOINT_SECONDS;
    if (!has_interval)
        return;
    interval.text = v.text.substr(comma + 1);
    o.checkpoint_seconds = parse_duration(interval);
}

void apply_text(std::string& target, const OptionValue& v) {
    if (v.text.empty())
        reject_value(v, "a name");
    target = v.text;
}

Toggle parse_toggle(const OptionValue& v) {
    return parse_choice<Toggle>(v, {{"auto", Toggle::AUTO}, {"on", Toggle::ON}, {"off", Toggle::OFF}});
}

// A layout, a quality or one of each; what is not named is chosen.
void apply_bvh(Options& o, const OptionValue& v) {
    o.bvh = BvhChoice::AUTO;
    o.bvh_quality = QualityChoice::AUTO;
    if (v.text == "auto")
        return;
    const std::map<std::string, BvhChoice> layouts = {
        {"bvh8", BvhChoice::BVH8}, {"bvh2", BvhChoice::BVH2}, {"cwbvh", BvhChoice::CWBVH}};
    const std::map<std::string, QualityChoice> qualities = {{"fast", QualityChoice::FAST},
                                                            {"high", QualityChoice::HIGH}};
    for (const std::string& name : split_list(v.text)) {
        const auto layout = layouts.find(name);
        const auto quality = qualities.find(name);
        if (o.bvh == BvhChoice::AUTO && layout != layouts.end())
            o.bvh = layout->second;
        else if (o.bvh_quality == QualityChoice::AUTO && quality != qualities.end())
            o.bvh_quality = quality->second;
        else
            reject_value(v, "auto, bvh8, bvh2, cwbvh, fast, high, or a layout and a quality as in bvh8,high");
    }
}

std::vector<OptionSpec> work_options() {
    const char* const group = "Work";
    return {
        {group, "d", "--device", "NAME",
         "platform, else device, by a part of its name; cpu, gpu; or P:D as listed (default: variable "
         "CLRT_DEVICE, else the first GPU, else the CPU)",
         [](Options& o, const OptionValue& v) { apply_text(o.device, v); }},
        {group, "l", "--list-devices", "", "list platforms and devices, with -v how they compute, then exit",
         [](Options& o, const OptionValue&) { o.list_devices = true; }, Repeat::NO, COMMAND_LINE_ONLY},
        {group, "i", "--integrator", "NAME",
         "path (global illumination), whitted (mirrors, glass, shadows) or raycast (first hit, shadows) "
         "(default path)",
         [](Options& o, const OptionValue& v) {
             o.integrator = parse_choice<Integrator>(v, {{"raycast", Integrator::RAYCAST},
                                                         {"whitted", Integrator::WHITTED},
                                                         {"path", Integrator::PATH}});
         }},
        {group, "s", "--spp", "N",
         "samples a pixel, those of --resume included (default 64; no limit with --time, 65536 with --error)",
         [](Options& o, const OptionValue& v) {
             o.spp = static_cast<std::uint32_t>(parse_whole(v, 1, LARGEST_U32));
         }},
        {group, "t", "--time", "DURATION",
         "render for 90, 90s, 5m or 1h, up to a whole pass (default: no limit)",
         [](Options& o, const OptionValue& v) { o.time_seconds = parse_duration(v); }},
        {group, "e", "--error", "X",
         "render until the picture's relative error, root of mean squared over mean, is at most 0.02 or 2%; "
         "whichever of -s, -t and -e comes first ends the render (default: no target)",
         [](Options& o, const OptionValue& v) { o.error = parse_fraction(v); }},
        {group, "", "--max-depth", "N",
         "longest path in segments; 1 sees emitters, 2 adds direct light (default 4096, whitted 10, raycast "
         "always 2); what it cuts is reported",
         [](Options& o, const OptionValue& v) {
             o.max_depth = static_cast<int>(parse_whole(v, 1, LARGEST_DEPTH));
         }},
        {group, "", "--roulette-depth", "N", "path: first segment that Russian roulette may end (default 5)",
         [](Options& o, const OptionValue& v) {
             o.roulette_depth = static_cast<int>(parse_whole(v, 1, LARGEST_DEPTH));
         }},
        {group, "", "--min-contribution", "X",
         "whitted: smallest weight worth a ray, also in % (default 0.002)",
         [](Options& o, const OptionValue& v) { o.min_contribution = parse_fraction(v); }},
        {group, "", "--seed", "N", "chooses the noise; same seed, same picture (default 0)",
         [](Options& o, const OptionValue& v) {
             o.seed = static_cast<std::uint32_t>(parse_whole(v, 0, LARGEST_U32));
         }},
        {group, "", "--first-sample", "N", "index of the first sample, to continue a run (default 0)",
         [](Options& o, const OptionValue& v) {
             o.first_sample = static_cast<std::uint32_t>(parse_whole(v, 0, LARGEST_U32));
         }},
        {group, "", "--replicates", "N",
         "independent sample sequences; their spread is the error (default 8)",
         [](Options& o, const OptionValue& v) {
             o.replicates = static_cast<int>(parse_whole(v, 1, LARGEST_REPLICATES));
         }},
        {group, "", "--adaptive", "",
         "take more samples where the picture is noisy, by tiles of 16 x 16 pixels; --spp is their mean, at "
         "least 2 for each "
         "of the --replicates (default: the same everywhere)",
         [](Options& o, const OptionValue&) { o.adaptive = true; }},
        {group, "", "--sampler", "NAME",
         "sobol (scrambled points, even over the samples of a pixel) or independent (white noise, to compare "
         "with) (default sobol)",
         [](Options& o, const OptionValue& v) {
             o.sampler = parse_choice<SamplerChoice>(
                 v, {{"sobol", SamplerChoice::SOBOL}, {"independent", SamplerChoice::INDEPENDENT}});
         }},
        {group, "", "--precision", "NAME",
         "single, double (needs fp64) or fast (relaxed maths) (default single)",
         [](Options& o, const OptionValue& v) {
             o.precision = parse_choice<Precision>(
                 v,
                 {{"single", Precision::SINGLE}, {"double", Precision::DOUBLE}, {"fast", Precision::FAST}});
         }},
        {group, "j", "--threads", "N", "CPU threads, 0 for all (default 0)",
         [](Options& o, const OptionValue& v) {
             o.threads = static_cast<int>(parse_whole(v, 0, LARGEST_THREADS));
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
             o.mtl = parse_choice<MtlReading>(v, {{"auto", MtlReading::AUTO}, {"plain", MtlReading::PLAIN}});
         }},
    };
}

std::vector<OptionSpec> picture_options() {
    const char* const group = "Picture";
    return {
        {group, "r", "--size", "WxH", "width and height in pixels (default 800x600)",
         [](Options& o, const OptionValue& v) { o.size = parse_size(v); }},
        {group, "o", "--output", "FILE",
         ".png .jpg .bmp .tga .ppm (8-bit sRGB), .exr .hdr .pfm .tif (linear); repeatable (default SCENE.png "
         "in the current folder)",
         apply_output, REPEATABLE},
        {group, "", "--crop", "X0,Y0,X1,Y1",
         "render this window only; pixels from the top left, end excluded",
         [](Options& o, const OptionValue& v) { o.crop = parse_crop(v); }},
        {group, "", "--filter", "NAME[:RADIUS]",
         "box, tent or gaussian; radius in pixels (default box; radius 0.5, 1 or 1.5)", apply_filter},
        {group, "", "--exposure", "EV", "brighten 8-bit pictures by 2^EV (default 0)",
         [](Options& o, const OptionValue& v) {
             o.exposure_ev = parse_number(v, "stops from -100 to 100", [](double ev) {
                 return ev >= -LARGEST_EXPOSURE && ev <= LARGEST_EXPOSURE;
             });
         }},
        {group, "", "--tonemap", "NAME", "curve of 8-bit pictures: none, reinhard or aces (default none)",
         [](Options& o, const OptionValue& v) {
             o.tonemap = parse_choice<Tonemap>(
                 v, {{"none", Tonemap::NONE}, {"reinhard", Tonemap::REINHARD}, {"aces", Tonemap::ACES}});
         }},
        {group, "", "--aov", "LIST",
         "layers of EXR files, such as albedo,N or none: albedo N Z P objectId materialId variance samples "
         "badSamples alpha, and NAME=EXPR for the light of some paths, such as 'caustics=LS+DE'; repeatable "
         "(default: all but alpha, badSamples where there are any)",
         apply_aov, REPEATABLE},
    };
}

std::vector<OptionSpec> camera_options() {
    const char* const group = "Camera";
    return {
        {group, "", "--eye", "X,Y,Z", "position, scene units (default: fitted to the scene)",
         [](Options& o, const OptionValue& v) { o.camera.eye = parse_vector(v, "a position x,y,z"); }},
        {group, "", "--at", "X,Y,Z", "point to look at, scene units (default: fitted to the scene)",
         [](Options& o, const OptionValue& v) { o.camera.at = parse_vector(v, "a position x,y,z"); }},
        {group, "", "--up", "X,Y,Z", "direction that is up in the picture (default 0,1,0)",
         [](Options& o, const OptionValue& v) { o.camera.up = direction(v); }},
        {group, "", "--fov", "DEG", "vertical angle of view, degrees (default 40)",
         [](Options& o, const OptionValue& v) {
             o.camera.fov_degrees = parse_number(v, "an angle in degrees above 0 and below 180",
                                                 [](double degrees) { return degrees > 0 && degrees < 180; });
         }},
        {group, "", "--focal-length", "X", "of the lens, instead of --fov; any unit",
         [](Options& o, const OptionValue& v) {
             o.camera.focal_length = parse_number(v, "a length above 0", positive);
         }},
        {group, "", "--film-width", "X", "goes with --focal-length, in the same unit",
         [](Options& o, const OptionValue& v) {
             o.camera.film_width = parse_number(v, "a length above 0", positive);
         }},
    };
}

std::vector<OptionSpec> light_options() {
    const char* const group = "Light";
    return {
        {group, "", "--env", "FILE|R,G,B",
         "environment: a latitude-longitude picture or one radiance (default 1,1,1 where nothing else gives "
         "light)",
         apply_environment},
        {group, "", "--env-scale", "X", "factor on the environment's radiance (default 1)",
         [](Options& o, const OptionValue& v) {
             o.light.environment_scale = parse_number(v, "a factor from 0", not_negative);
         }},
        {group, "", "--env-rotate", "DEG", "turn of the environment about +Y, degrees (default 0)",
         [](Options& o, const OptionValue& v) {
             o.light.environment_rotation_degrees = parse_number(v, "an angle in degrees");
         }},
        {group, "", "--sun", "X,Y,Z,R,G,B[,DEG]",
         "direction to the sun, irradiance, angular diameter in degrees; repeatable", apply_sun, REPEATABLE},
        {group, "", "--point", "X,Y,Z,R,G,B", "point light: position, intensity in W/sr; repeatable",
         apply_point, REPEATABLE},
        {group, "", "--two-sided-lights", "", "emissive faces shine on both sides (default: on their front)",
         [](Options& o, const OptionValue&) { o.light.two_sided = true; }},
    };
}

std::vector<OptionSpec> promise_options() {
    const char* const group = "The promises";
    return {
        {group, "", "--explain", "[=json]", "say what would be simulated and why; no rendering",
         [](Options& o, const OptionValue& v) {
             if (!v.text.empty() && v.text != "json")
                 reject_value(v, "--explain or --explain=json");
             o.explain = v.text.empty() ? Explain::TABLE : Explain::JSON;
         }},
        {group, "", "--effects", "auto|all|LIST",
         "simulate what the scene needs (auto), with everything compiled in (all; same picture), or only the "
         "effects "
         "listed, such as matte,area-lights; -NAME takes one away: --effects=-refraction (default auto)",
         apply_effects},
        {group, "", "--paths", "EXPR",
         "path: simulate only these paths, light to eye: L light (La area, Lp point, Ld sun, Le sky), D "
         "matte, G "
         "glossy, S specular (R mirror, T refraction), . any surface, E eye, and | * + ? ( ), such as "
         "'L(D|S)*E' (default: all)",
         [](Options& o, const OptionValue& v) {
             check_paths(v, v.text);
             o.paths = v.text;
         }},
        {group, "", "--ledger", "",
         "measure what every effect costs in time and gives in light, by rendering without it; --time bounds "
         "it "
         "(default 60 s); writes no picture",
         [](Options& o, const OptionValue&) { o.ledger = true; }, Repeat::NO, COMMAND_LINE_ONLY},
        {group, "", "--stats", "FILE", "write statistics of the run as JSON, in SI units",
         [](Options& o, const OptionValue& v) { o.stats_path = parse_path(v); }},
        {group, "", "--check", "MODE", "non-finite samples: off, count, strict (exit 4) (default count)",
         [](Options& o, const OptionValue& v) {
             o.check = parse_choice<Check>(
                 v, {{"off", Check::OFF}, {"count", Check::COUNT}, {"strict", Check::STRICT}});
         }},
        {group, "", "--pixel", "X,Y",
         "replay one sample of this pixel and print its path, in single and double precision side by side; "
         "-v adds "
         "hexadecimal numbers, --stats writes JSON; no picture",
         [](Options& o, const OptionValue& v) { o.pixel = parse_pixel(v); }, Repeat::NO, COMMAND_LINE_ONLY},
        {group, "", "--sample", "N", "which sample of --pixel (default 0)",
         [](Options& o, const OptionValue& v) {
             o.sample = static_cast<std::uint32_t>(parse_whole(v, 0, LARGEST_U32 - 1));
         },
         Repeat::NO, COMMAND_LINE_ONLY},
    };
}

std::vector<OptionSpec> run_options() {
    const char* const group = "Runs";
    return {
        {group, "", "--checkpoint", "FILE[,TIME]",
         "write a film file, from which --resume goes on and which clrt-merge merges, at the end and so "
         "often "
         "(default: none; every 5m)",
         apply_checkpoint},
        {group, "", "--resume", "FILE",
         "go on from a film file: with the same command, or alone with another --spp, --time or --error",
         [](Options& o, const OptionValue& v) { o.resume_path = parse_path(v); }, Repeat::NO,
         COMMAND_LINE_ONLY},
        {group, "", "--save-every", "DURATION",
         "write the pictures so far so often (default: at the end only)",
         [](Options& o, const OptionValue& v) { o.save_every_seconds = parse_duration(v); }},
        {group, "", "--kernels", "DIR", "take the kernels from here (default: those inside clrt)",
         [](Options& o, const OptionValue& v) { o.kernels_folder = parse_path(v); }},
        {group, "", "--dump-kernels", "DIR", "write here exactly what is compiled",
         [](Options& o, const OptionValue& v) { o.dump_folder = parse_path(v); }},
        {group, "", "--cache", "MODE",
         "keep compiled kernels: on; auto: unless the driver does; off: neither (default auto)",
         [](Options& o, const OptionValue& v) { o.cache = parse_toggle(v); }},
        {group, "", "--no-cache", "", "same as --cache off",
         [](Options& o, const OptionValue&) { o.cache = Toggle::OFF; }},
        {group, "", "--cache-dir", "DIR", "where to keep them (default: clrt in the user's cache folder)",
         [](Options& o, const OptionValue& v) { o.cache_folder = parse_path(v); }},
        {group, "", "--progress", "MODE",
         "auto (a line on a terminal, else one now and then), on, off (default auto)",
         [](Options& o, const OptionValue& v) { o.progress = parse_toggle(v); }},
        {group, "q", "--quiet", "", "errors only, no progress",
         [](Options& o, const OptionValue&) { o.verbosity = -1; }},
        {group, "v", "--verbose", "", "say everything",
         [](Options& o, const OptionValue&) { o.verbosity = 1; }},
        {group, "", "--no-sidecar", "", "leave the options file SCENE.clrt unread",
         [](Options& o, const OptionValue&) { o.no_sidecar = true; }, Repeat::NO, COMMAND_LINE_ONLY},
        {group, "h", "--help", "", "print this page and exit", no_effect, Repeat::NO, COMMAND_LINE_ONLY},
        {group, "", "--version", "", "print the version and exit", no_effect, Repeat::NO, COMMAND_LINE_ONLY},
    };
}

} // namespace

const std::vector<OptionSpec>& option_table() {
    static const std::vector<OptionSpec> table = [] {
        std::vector<OptionSpec> all;
        for (const auto& group : {work_options(), picture_options(), camera_options(), light_options(),
                                  promise_options(), run_options()})
            all.insert(all.end(), group.begin(), group.end());
        return all;
    }();
    return table;
}

const OptionSpec* find_option(const std::string& long_name) {
    for (const OptionSpec& spec : option_table())
        if (long_name == spec.long_name)
            return &spec;
    return nullptr;
}

const std::vector<std::pair<std::string, std::string>>& exclusive_options() {
    static const std::vector<std::pair<std::string, std::string>> pairs = {
        {"--quiet", "--verbose"},  {"--cache", "--no-cache"}, {"--fov", "--focal-length"},
        {"--fov", "--film-width"}, {"--pixel", "--explain"},  {"--pixel", "--ledger"},
    };
    return pairs;
}

void reject_unknown_option(const std::string& origin, const std::string& given) {
    const std::string advice = "`clrt --help` lists all";
    const std::string name = given.substr(0, given.find('='));
    if (name.size() <= 2) // one letter is near to everything
        throw UsageError(origin + "unknown option " + name + "; " + advice);
    std::vector<std::string> known;
    for (const OptionSpec& spec : option_table())
        known.emplace_back(spec.long_name);
    throw UsageError(origin + "unknown option " + name + "; the nearest is " + nearest_name(name, known) +
                     ", and " + advice);
}

} // namespace clrt
