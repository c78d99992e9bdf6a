// SPDX-License-Identifier: Apache-2.0
// Everything a user can ask for, with defaults and units. Filled by command_line.h, read by every stage.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

enum class Integrator { RAYCAST, WHITTED, PATH };
enum class Precision { SINGLE, DOUBLE, FAST };
enum class SamplerChoice { SOBOL, INDEPENDENT };
enum class Toggle { AUTO, ON, OFF };
enum class BvhChoice { AUTO, BVH8, BVH2, CWBVH };
enum class QualityChoice { AUTO, FAST, HIGH };
enum class Filter { BOX, TENT, GAUSSIAN };
enum class Tonemap { NONE, REINHARD, ACES, FILMIC, AGX };
enum class Check { OFF, COUNT, STRICT };
enum class MtlReading { AUTO, PLAIN };
/// CLAY: matte grey in the place of every material (scene/material_override.h).
enum class MaterialOverride { NONE, CLAY };
enum class Explain { NO, TABLE, JSON };
/// From where a scene is seen, in a frame whose up is the camera's and whose front is towards the eye of
/// FRONT.
enum class View { FRONT, BACK, LEFT, RIGHT, TOP, BOTTOM, ISO };

/// Camera parts as given; absent ones are fitted to the scene, each on its own.
struct CameraOptions {
    std::optional<glm::dvec3> eye, at, up;          ///< scene units
    std::optional<View> view;                       ///< direction of a fitted eye; none: three quarters
    std::optional<double> fov_degrees;              ///< vertical angle of view
    std::optional<double> focal_length, film_width; ///< any common unit; fov = 2 atan(width H / (2 W focal))
};

/// The sun: a disc at infinity.
struct SunOptions {
    glm::dvec3 towards{0, 1, 0}; ///< direction to the sun, any length but 0
    glm::dvec3 irradiance{0};    ///< at normal incidence, linear RGB
    double diameter_degrees = 0; ///< angular diameter; 0 is a delta light
};

/// A point light.
struct PointOptions {
    glm::dvec3 position{0};  ///< scene units
    glm::dvec3 intensity{0}; ///< W/sr per channel, lengths in scene units
};

/// What camera rays that hit nothing show, in place of the environment and the discs of suns. It lights
/// nothing: rays that have left a surface see the sky.
struct BackgroundOptions {
    glm::dvec3 radiance{0};
    bool is_transparent = false; ///< radiance 0, and pictures get an alpha channel
};

/// A matte plane under the scene.
struct GroundOptions {
    std::optional<glm::dvec3> albedo; ///< 0..1; absent: no ground, where the studio would have one
};

struct LightOptions {
    bool studio = true; ///< light by a studio (scene/studio.h) where nothing gives light, else by a white sky
    std::string environment_file;          ///< lat-long map; empty: none
    std::optional<glm::dvec3> environment; ///< constant radiance
    double environment_scale = 1;
    double environment_rotation_degrees = 0; ///< about +Y
    std::vector<SunOptions> suns;
    std::vector<PointOptions> points;
    bool two_sided = false; ///< emissive faces shine on both sides
    std::optional<GroundOptions> ground;
    std::optional<BackgroundOptions> background;
};

/// A window of the picture in pixels; x1, y1 excluded.
struct Crop {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// An EXR layer with the light of some paths.
struct PathLayerOption {
    std::string name;
    std::string expression; ///< path notation (paths/path_expression.h)
};

/// Samples a pixel when none of --spp, --time and --error is given.
constexpr std::uint32_t DEFAULT_SPP = 64;
/// Samples a pixel at most when --error is given without --spp.
constexpr std::uint32_t DEFAULT_SPP_WITH_ERROR = 65536;

/// Between two film files of one run.
constexpr double DEFAULT_CHECKPOINT_SECONDS = 300;

struct Options {
    // Work
    std::string scene_path;
    std::string device; ///< as given to --device; empty: CLRT_DEVICE, else the first GPU, else the CPU
    bool list_devices = false;
    Integrator integrator = Integrator::PATH;
    std::optional<std::uint32_t> spp; ///< 64 if none of spp, time and error is given; 65536 with error alone
    std::optional<double> time_seconds; ///< bounds the render stage of this run
    std::optional<double> error;        ///< target of the relative error
    std::optional<int> max_depth;       ///< path segments; 4096, whitted 10, raycast always 2
    int roulette_depth = 5;             ///< path: first segment that Russian roulette may end
    double min_contribution = 0.002;    ///< whitted: smallest weight worth a ray
    std::uint32_t seed = 0;
    std::uint32_t first_sample = 0;
    int replicates = 8;
    bool adaptive = false; ///< samples go where the picture is noisy
    SamplerChoice sampler = SamplerChoice::SOBOL;
    Precision precision = Precision::SINGLE;
    int threads = 0; ///< 0: all
    BvhChoice bvh = BvhChoice::AUTO;
    QualityChoice bvh_quality = QualityChoice::AUTO; ///< work put into the tree
    MtlReading mtl = MtlReading::AUTO;               ///< auto: as the writers of libraries mean them
    MaterialOverride material_override = MaterialOverride::NONE;

    // Picture
    glm::ivec2 size{800, 600};
    std::vector<std::string> outputs; ///< default STEM.png in the current folder; may hold {seed} and others
    std::optional<int> frames;        ///< pictures of a turn around what the camera looks at
    int frame = 0;                    ///< which of them this is, from 1; 0: none of them
    std::optional<Crop> crop;
    Filter filter = Filter::BOX;
    std::optional<double> filter_radius; ///< pixels; box 0.5, tent 1, gaussian 1.5
    double exposure_ev = 0;              ///< stops, PNG and other 8-bit files only
    bool auto_exposure = false;          ///< exposure_ev is added to what the picture asks for
    Tonemap tonemap = Tonemap::NONE;
    std::optional<std::vector<std::string>> aovs; ///< EXR layers; absent: all, empty: none
    std::vector<PathLayerOption> path_layers;     ///< further EXR layers, made from the picture's light

    CameraOptions camera;
    LightOptions light;

    // The promises
    Explain explain = Explain::NO;
    bool ledger = false;                       ///< measure what every effect costs and gives; no picture
    bool all_effects = false;                  ///< --effects all: the full kernel
    std::optional<std::uint32_t> effects_list; ///< --effects LIST: these and no others
    std::uint32_t effects_off = 0;             ///< --effects -NAME: taken away
    std::string paths;                         ///< path notation (paths/path_expression.h); empty: every path
    std::string stats_path;                    ///< JSON; empty: none
    Check check = Check::COUNT;
    std::optional<glm::ivec2> pixel; ///< replay a sample of it; no picture
    std::uint32_t sample = 0;        ///< which one

    // Runs
    std::string checkpoint_path;                            ///< film file to write; empty: none
    double checkpoint_seconds = DEFAULT_CHECKPOINT_SECONDS; ///< between two of them
    std::string resume_path;                                ///< film file to go on from; empty: none
    bool force = false; ///< --checkpoint may replace films that hold more, and what is no film
    std::optional<double> save_every_seconds; ///< between two pictures so far
    std::string kernels_folder;               ///< replaces the embedded kernels
    std::string dump_folder;                  ///< writes exactly what was compiled
    Toggle cache = Toggle::AUTO;
    std::string cache_folder; ///< default: the user's cache folder
    Toggle progress = Toggle::AUTO;
    int verbosity = 0; ///< -1 quiet, 0, 1 verbose
    bool no_sidecar = false;
    std::string sidecar_path; ///< options file that was read; empty: none
    /// The options that were given, by their long names: "file:line" in an options file, empty on the command
    /// line.
    std::map<std::string, std::string> given;
    std::vector<std::string> command; ///< argv as given, for the metadata
    /// The command line that a film file keeps for --resume: without --resume, with what that took from its
    /// film.
    std::vector<std::string> resumable_command;
};

/// Segments of the longest path when --max-depth does not say: Russian roulette ends paths long before, and
/// where nothing ends them, because surfaces reflect all light, this does within milliseconds.
constexpr int DEFAULT_PATH_DEPTH = 4096;
/// The same for whitted, whose trees can double with every segment.
constexpr int DEFAULT_WHITTED_DEPTH = 10;

/// The largest path length in segments for these options; raycast has always 2.
int effective_max_depth(const Options& options);

/// Whether pictures have an alpha channel: --background transparent.
bool has_transparent_background(const Options& options);

} // namespace clrt
