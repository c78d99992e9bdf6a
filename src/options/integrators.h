// SPDX-License-Identifier: Apache-2.0
// The integrators, a row each. Command line, help, checks, blind spots, sky table, programs and reports read
// the rows, so an integrator is added here and in kernels/integrators/NAME.cl.
#pragma once

#include "kernels/shared/chain_types.h"
#include "kernels/shared/render_types.h"
#include "options/names.h"

#include <string>
#include <vector>

namespace clrt {

enum class Integrator { RAYCAST, WHITTED, DISTRIBUTION, LIGHT, PATH, PATH_LIGHT, BDPT, MLT };

/// Options that only some integrators read; bits.
enum IntegratorOption : unsigned {
    TAKES_MAX_DEPTH = 1,
    TAKES_ROULETTE_DEPTH = 2,
    TAKES_MIN_CONTRIBUTION = 4,
    TAKES_PATHS = 8, ///< tells paths apart by their automaton: --paths, --aov NAME=EXPR
    TAKES_SHADOW_RAYS = 16,
    TAKES_GLOSS_RAYS = 32,
    TAKES_TRANSLUCENT_RAYS = 64,
    TAKES_GUIDE = 128,
    TAKES_TEXTURE_FILTER = 256,
    TAKES_PATH_REUSE = 512,
    TAKES_EMISSION_RAYS = 1024,
    TAKES_LIGHT_SAMPLES = 2048,
};

template <>
inline constexpr Named<IntegratorOption> NAMES<IntegratorOption>[] = {
    {TAKES_MAX_DEPTH, "--max-depth"},
    {TAKES_ROULETTE_DEPTH, "--roulette-depth"},
    {TAKES_MIN_CONTRIBUTION, "--min-contribution"},
    {TAKES_PATHS, "--paths"},
    {TAKES_SHADOW_RAYS, "--shadow-rays"},
    {TAKES_GLOSS_RAYS, "--gloss-rays"},
    {TAKES_TRANSLUCENT_RAYS, "--translucent-rays"},
    {TAKES_GUIDE, "--guide"},
    {TAKES_TEXTURE_FILTER, "--texture-filter"},
    {TAKES_PATH_REUSE, "--path-reuse"},
    {TAKES_EMISSION_RAYS, "--emission-rays"},
    {TAKES_LIGHT_SAMPLES, "--light-samples"}};

/// Paths in path notation (paths/path_expression.h): those that an integrator simulates, and those that its
/// techniques find. What is simulated and not found is a blind spot (paths/blind_spots.h).
struct SimulatedPaths {
    const char* all;
    const char* by_rays;       ///< found where a ray meets a light, which has an extent
    const char* by_connection; ///< found by a connection to any light
};

/// Lengths of paths in segments.
struct PathDepths {
    int usual;   ///< without --max-depth
    int longest; ///< that --max-depth may ask for
};

/// Which techniques find the sky: the table is all that does, or directions sampled by the BSDF do too, and
/// multiple importance sampling weighs the two. The brightest alone may be left to the table.
enum class SkySampling { BY_TABLE, BY_TABLE_AND_BSDF, BRIGHTEST_BY_TABLE };

/// Lights that a vertex is connected to: none, every one, every one where all emissive triangles together are
/// one light, of which a table or (--light-sampler) the tree chooses a triangle, or one that is chosen of
/// all.
enum class Connections { NO_LIGHT, EVERY_LIGHT, EVERY_LIGHT_BY_TREE, ONE_LIGHT };

/// Pixels that a work-item adds light to: its own, or any, by atomics.
enum class FilmAccess { GATHER, SPLAT };

/// An integrator. Its kernel is render_STEM in kernels/integrators/STEM.cl (integrator_stem).
struct IntegratorRow {
    Integrator value;
    const char* name;    ///< as in --integrator NAME
    const char* help;    ///< what it simulates, for --help
    const char* omitted; ///< light that it never simulates, for the report; null: none
    SimulatedPaths paths;
    PathDepths depth;
    SkySampling sky;
    Connections connections;
    FilmAccess film;
    unsigned takes; ///< IntegratorOption
};

/// No scene needs longer paths, and a pixel's loop stays bounded.
constexpr int LARGEST_DEPTH = 65535;
/// Russian roulette ends paths long before, and where nothing ends them, because surfaces reflect all light,
/// this does within milliseconds.
constexpr int USUAL_PATH_DEPTH = 4096;
/// Trees can double with every segment.
constexpr int USUAL_TREE_DEPTH = 10;
/// Their rays wait in private memory.
constexpr int LARGEST_TREE_DEPTH = WHITTED_MAX_DEPTH;
/// As that of a chain, so that both are compared at equal depth.
constexpr int USUAL_BDPT_DEPTH = 16;
/// A chain has one length for ever, and every length needs chains.
constexpr int USUAL_CHAIN_DEPTH = 16;
/// Rays of a branch at most: several levels have few, because they share those of the first.
constexpr int LARGEST_BRANCH = 64;
/// The first hit and its connection to a light.
constexpr int DIRECT_LIGHT_DEPTH = 2;

/// From the fewest paths to all of them.
inline constexpr IntegratorRow INTEGRATOR_ROWS[] = {
    {Integrator::RAYCAST,
     "raycast",
     "first hit, shadows",
     "all light but the direct one",
     {"LD?E", "LE", "LDE"},
     {DIRECT_LIGHT_DEPTH, DIRECT_LIGHT_DEPTH},
     SkySampling::BY_TABLE,
     Connections::EVERY_LIGHT,
     FilmAccess::GATHER,
     TAKES_TEXTURE_FILTER},
    {Integrator::WHITTED,
     "whitted",
     "mirrors, glass, shadows",
     "all indirect light but that of mirrors and smooth glass",
     {"LD?S*E", "LS*E", "LDS*E"},
     {USUAL_TREE_DEPTH, LARGEST_TREE_DEPTH},
     SkySampling::BY_TABLE,
     Connections::EVERY_LIGHT,
     FilmAccess::GATHER,
     TAKES_MAX_DEPTH | TAKES_MIN_CONTRIBUTION | TAKES_TEXTURE_FILTER},
    {Integrator::DISTRIBUTION,
     "distribution",
     "soft shadows, gloss, translucency",
     "light that other surfaces send to matte ones",
     {"LD?(G|S)*E", "L(G|S)*E", "L(D|G)(G|S)*E"},
     {USUAL_TREE_DEPTH, LARGEST_TREE_DEPTH},
     SkySampling::BY_TABLE,
     Connections::EVERY_LIGHT_BY_TREE,
     FilmAccess::GATHER,
     TAKES_MAX_DEPTH | TAKES_MIN_CONTRIBUTION | TAKES_PATHS | TAKES_SHADOW_RAYS | TAKES_GLOSS_RAYS |
         TAKES_TRANSLUCENT_RAYS | TAKES_TEXTURE_FILTER},
    {Integrator::LIGHT,
     "light",
     "light paths splatted on the film",
     "all light that the eye sees by mirrors and smooth glass",
     {"L((D|S)*D)?E", "L((D|S)*D)?E", "L(D|S)*DE"},
     {USUAL_PATH_DEPTH, LARGEST_DEPTH},
     SkySampling::BY_TABLE,
     Connections::NO_LIGHT,
     FilmAccess::SPLAT,
     TAKES_MAX_DEPTH | TAKES_ROULETTE_DEPTH | TAKES_EMISSION_RAYS},
    {Integrator::PATH,
     "path",
     "global illumination",
     nullptr,
     {"L(D|S)*E", "L(D|S)*E", "LD(D|S)*E"},
     {USUAL_PATH_DEPTH, LARGEST_DEPTH},
     SkySampling::BY_TABLE_AND_BSDF,
     Connections::ONE_LIGHT,
     FilmAccess::GATHER,
     TAKES_MAX_DEPTH | TAKES_ROULETTE_DEPTH | TAKES_PATHS | TAKES_GUIDE | TAKES_TEXTURE_FILTER |
         TAKES_PATH_REUSE | TAKES_EMISSION_RAYS | TAKES_LIGHT_SAMPLES},
    {Integrator::PATH_LIGHT,
     "path+light",
     "global illumination, caustics by light paths",
     nullptr,
     {"L(D|S)*E", "L(D|S)*E", "LD(D|S)*E|L(D|S)*DE"},
     {USUAL_PATH_DEPTH, LARGEST_DEPTH},
     SkySampling::BY_TABLE,
     Connections::ONE_LIGHT,
     FilmAccess::SPLAT,
     TAKES_MAX_DEPTH | TAKES_ROULETTE_DEPTH | TAKES_GUIDE | TAKES_PATH_REUSE | TAKES_EMISSION_RAYS},
    {Integrator::BDPT,
     "bdpt",
     "global illumination, paths from both ends",
     nullptr,
     {"L(D|S)*E", "L(D|S)*E", "LD(D|S)*E|L(D|S)*D(D(D|S)*)?E"},
     {USUAL_BDPT_DEPTH, LARGEST_DEPTH},
     SkySampling::BY_TABLE,
     Connections::ONE_LIGHT,
     FilmAccess::SPLAT,
     TAKES_MAX_DEPTH | TAKES_ROULETTE_DEPTH | TAKES_GUIDE | TAKES_EMISSION_RAYS},
    {Integrator::MLT,
     "mlt",
     "global illumination by Markov chains",
     nullptr,
     {"L(D|S)*E", "L(D|S)*E", "LD(D|S)*E|L(D|S)*DE"},
     {USUAL_CHAIN_DEPTH, CHAIN_MAX_DEPTH},
     SkySampling::BY_TABLE,
     Connections::ONE_LIGHT,
     FilmAccess::SPLAT,
     TAKES_MAX_DEPTH},
};

template <>
inline constexpr auto& NAMES<Integrator> = INTEGRATOR_ROWS;

/// The row of an integrator.
const IntegratorRow& integrator_row(Integrator integrator);

/// Whether the integrator reads the option.
bool takes_option(Integrator integrator, IntegratorOption option);

/// Kinds of light (KIND_*) among which the light tree chooses; 0: there is none.
unsigned light_tree_kinds(Integrator integrator);

/// Whether its connections to light at infinity cross panes of glass (scene/slabs.h).
bool connects_through_slabs(Integrator integrator);

/// Whether it walks Markov chains (render/metropolis.h): a sample then follows from those before it.
bool walks_chains(Integrator integrator);

/// Names of the integrators that read the option.
std::vector<std::string> integrators_with(IntegratorOption option);

/// The integrator's name as part of other names: with underscores for what is no letter.
std::string integrator_stem(Integrator integrator);

/// The integrator's kernel file below kernels/, "integrators/path.cl", and the name of its kernel in it.
std::string integrator_file(Integrator integrator);
std::string integrator_kernel(Integrator integrator);

} // namespace clrt
