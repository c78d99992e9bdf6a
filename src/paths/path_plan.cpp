// SPDX-License-Identifier: Apache-2.0
#include "paths/path_plan.h"

#include "colour.h"
#include "paths/rounded_facets.h"
#include "scene/casters.h"
#include "scene/lights.h"
#include "scene/lobes.h"
#include "scene/material_table.h"
#include "scene/slabs.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>

namespace clrt {

namespace {

/// Every path there is; with G, so that D means matte alone.
const char* const EVERY_PATH = "L(D|G|S)*E";

/// Longer distances are written as this: the deepest --max-depth lies above, so only a few rays more are
/// traced.
constexpr int LARGEST_DISTANCE = 0xffff;

/// Number of the state in which paths start.
constexpr u32 START_NUMBER = 1;

/// The first material on a triangle that has a property; none: there is no such.
std::optional<size_t> find_used(const Scene& scene, const std::function<bool(const Material&)>& has) {
    std::vector<bool> is_used(scene.materials.size(), false);
    for (const Triangle& triangle : scene.triangles)
        is_used[triangle.material] = true;
    for (size_t i = 0; i < scene.materials.size(); ++i)
        if (is_used[i] && has(scene.materials[i]))
            return i;
    return std::nullopt;
}

/// A letter that the first material on a triangle that has a property writes.
PathLetter find_material(const char* symbol, const Scene& scene,
                         const std::function<bool(const Material&)>& has) {
    if (const std::optional<size_t> i = find_used(scene, has))
        return {symbol, describe_material(scene, *i), scene.material_places[*i]};
    return {symbol, "", {}};
}

/// A map can make any lobe rough that can be a delta function.
bool can_be_rough(const Material& m) {
    return m.alpha_x > 0 || m.map_roughness != NO_INDEX;
}
/// Without a change of index there is nothing to refract at, rough or not.
bool can_be_smooth(const Material& m) {
    return m.alpha_x == 0 || MATERIAL_INDEX(m) == 1.0f;
}

/// Lobes of a GGX alpha up to this are about as narrow as the sun: what they send is met as seldom as what
/// smooth ones do, though connections find it. Coats and what maps make smooth are not looked at.
constexpr float NEARLY_SMOOTH = 0.01f;

/// Letters (bits LETTER_BIT) that a material may write.
unsigned letters_of(const Material& m) {
    unsigned letters = 0;
    for (const LobeSpec& lobe : LOBE_SPECS) {
        if (!(m.lobes & lobe.bit))
            continue;
        const bool has_choice = lobe.letters && lobe.delta_letters;
        letters |= !has_choice || can_be_rough(m) ? lobe.letters : 0u;
        letters |= !has_choice || can_be_smooth(m) ? lobe.delta_letters : 0u;
    }
    return letters;
}

bool is_nearly_smooth(const Material& m) {
    const float alpha = std::max(m.alpha_x, m.alpha_y);
    return alpha > 0 && alpha <= NEARLY_SMOOTH;
}

/// The letters that count for paths that only hits find. What connections cross straight does not
/// (scene/slabs.h): the panes that are left reflect.
unsigned letters_for_hits(const Scene& scene, const PathPlan& plan, Integrator integrator) {
    unsigned letters = plan.alphabet.letters;
    if (plan.is_asked) // a nearly smooth lobe is another letter
        return letters;
    if (find_used(scene, [](const Material& m) { return is_nearly_smooth(m) && (m.lobes & LOBE_GLOSSY); }))
        letters |= LETTER_BIT(LETTER_MIRROR);
    if (find_used(scene, [](const Material& m) { return is_nearly_smooth(m) && (m.lobes & LOBES_GLASS); }))
        letters |= LETTER_BIT(LETTER_MIRROR) | LETTER_BIT(LETTER_REFRACTION);
    const bool crosses = plan.are_lamps_behind_slabs ||
                         (connects_through_slabs(integrator) && has_slabs_before_the_sky(scene));
    if (crosses && !find_used(scene, [](const Material& m) {
            return (letters_of(m) & LETTER_BIT(LETTER_REFRACTION)) && !(m.flags & MATERIAL_SLAB);
        }))
        letters &= ~LETTER_BIT(LETTER_REFRACTION);
    return letters;
}

/// Paths that only hits find, nearly smooth lobes counted as smooth.
HitPaths plan_hit_paths(const Scene& scene, const PathPlan& plan, const PathExpression& picture,
                        Integrator integrator, int max_depth) {
    PathPlan counted = plan;
    counted.alphabet.letters = letters_for_hits(scene, plan, integrator);
    // Splats begin at casters.
    const bool is_aimed = has_casters(scene) && !find_used(scene, [](const Material& m) {
                              return is_nearly_smooth(m) && (m.lobes & LOBES_GLASS) && !is_caster(m);
                          });
    if (integrator == Integrator::PATH_LIGHT && !is_aimed)
        integrator = Integrator::PATH;
    HitPaths hits = find_hit_paths(counted, picture, integrator, max_depth);
    hits.are_smooth = (counted.alphabet.letters & ~plan.alphabet.letters) == 0;
    return hits;
}

PathLetter find_letter(const char* symbol, const Scene& scene, unsigned letter) {
    return find_material(symbol, scene,
                         [letter](const Material& m) { return (letters_of(m) & LETTER_BIT(letter)) != 0; });
}

PathLetter find_light(const char* symbol, const Scene& scene, u32 kind) {
    std::vector<std::string> parts;
    for (const SourceCount& lights : count_lights(scene, kind))
        parts.push_back(fmt::format("{} by {}", lights.count, lights.source));
    return {symbol, fmt::format("{}", fmt::join(parts, ", ")), {}};
}

PathLetter find_lamp(const Scene& scene) {
    if (scene.emitters.empty())
        return {"La", "", {}};
    const size_t first = scene.triangles[scene.emitters[0].triangle].material;
    return {"La", describe_material(scene, first), scene.material_places[first]};
}

std::vector<PathLetter> find_letters(const Scene& scene) {
    const bool is_bright = largest_component(scene.environment.radiance) > 0;
    const bool is_backdrop = scene.background && largest_component(*scene.background) > 0;
    return {
        find_letter("D", scene, LETTER_MATTE),
        find_letter("G", scene, LETTER_GLOSSY),
        find_letter("R", scene, LETTER_MIRROR),
        find_letter("T", scene, LETTER_REFRACTION),
        find_lamp(scene),
        find_light("Lp", scene, LIGHT_POINT),
        find_light("Ld", scene, LIGHT_SUN),
        {"Le",
         is_bright     ? "environment above 0"
         : is_backdrop ? "background above 0"
                       : "",
         {}},
    };
}

PathAlphabet make_alphabet(const std::vector<PathLetter>& letters) {
    PathAlphabet alphabet;
    for (unsigned i = 0; i < letters.size(); ++i)
        if (!letters[i].witness.empty())
            (i < LETTER_COUNT ? alphabet.letters : alphabet.kinds) |=
                1u << (i < LETTER_COUNT ? i : i - LETTER_COUNT);
    return alphabet;
}

unsigned find_found_by_rays(const Scene& scene) {
    const bool has_disc = std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& l) {
        return l.kind == LIGHT_SUN && l.one_minus_cos > 0;
    });
    return KIND_AREA | KIND_SKY | (has_disc ? unsigned(KIND_SUN) : 0u);
}

unsigned find_missed_by_rays(const Scene& scene) {
    unsigned kinds = 0;
    for (const Light& light : scene.lights)
        if (light.kind == LIGHT_POINT)
            kinds |= KIND_POINT;
        else if (light.one_minus_cos == 0)
            kinds |= KIND_SUN;
    return kinds;
}

/// The word of a state by its number, which may be beyond those that there are: then no path leaves it.
u32 state_word(const PathPlan& plan, size_t number) {
    const std::vector<AutomatonState>& states = plan.automaton.states;
    if (number == 0 || number >= states.size())
        return u32(number);
    const AutomatonState& state = states[number];
    const bool goes_on =
        std::any_of(state.next.begin(), state.next.end(), [](int next) { return next != 0; });
    const bool splits =
        states[size_t(state.next[LETTER_MATTE])].picture != states[size_t(state.next[LETTER_GLOSSY])].picture;
    return u32(number) | state.kinds << STATE_KINDS_SHIFT |
           (goes_on || (state.kinds & plan.found_by_rays) ? STATE_CONTINUES : 0u) |
           (splits ? STATE_SPLITS : 0u) |
           u32(std::min(state.distance, LARGEST_DISTANCE)) << STATE_DISTANCE_SHIFT;
}

u32 layer_word(const AutomatonState& state) {
    u32 word = 0;
    for (unsigned layer = 0; layer < PATH_LAYERS_LIMIT; ++layer)
        word |= state.layers[layer] << (LAYER_KINDS_BITS * layer);
    return word;
}

/// A row from which every letter leads to one state.
PathState row_to(u32 state) {
    return {{state, state, state, state}, 0, 0, 0, 0};
}

/// The automaton, and what follows from it.
void plan_automaton(const PathExpression& picture, const Options& options, PathPlan& plan) {
    std::vector<PathExpression> layers;
    for (const PathLayerOption& layer : plan.layers)
        layers.push_back(parse_path_expression(layer.expression));
    plan.automaton = make_automaton(picture, layers, plan.alphabet);

    // A path of n scattering events has n + 1 segments.
    const int depth = effective_max_depth(options.transport);
    plan.is_empty = plan.automaton.is_empty() || plan.automaton.states[1].distance + 1 > depth;
    if (const std::optional<int> longest = longest_path(plan.automaton))
        plan.segments = std::min(*longest + 1, depth);
    plan.is_filter = !layers.empty() || !accepts_everything(plan.automaton, plan.alphabet);
}

} // namespace

PathPlan plan_paths(const Scene& scene, const Options& options) {
    PathPlan plan;
    plan.expression = options.transport.paths;
    plan.layers = options.output.path_layers;
    plan.letters = find_letters(scene);
    plan.alphabet = make_alphabet(plan.letters);
    plan.found_by_rays = find_found_by_rays(scene);
    plan.missed_by_rays = find_missed_by_rays(scene);
    plan.is_asked = !plan.expression.empty() || !plan.layers.empty();
    const PathExpression picture =
        parse_path_expression(plan.expression.empty() ? EVERY_PATH : plan.expression);
    if (plan.is_asked)
        plan_automaton(picture, options, plan);
    const Integrator integrator = options.transport.integrator;
    const int max_depth = effective_max_depth(options.transport);
    plan.are_lamps_behind_slabs = finds_lamps_behind_slabs(scene, options);
    plan.blind_spots = find_blind_spots(plan, picture, integrator, max_depth);
    plan.hit_paths = plan_hit_paths(scene, plan, picture, integrator, max_depth);
    if (auto spot = find_rounded_facets(scene, integrator))
        plan.blind_spots.push_back(std::move(*spot));
    return plan;
}

bool finds_lamps_behind_slabs(const Scene& scene, const Options& options) {
    return options.transport.integrator == Integrator::PATH && options.transport.paths.empty() &&
           options.output.path_layers.empty() && has_slabs_before_lamps(scene);
}

PathTables path_tables(const PathPlan& plan) {
    if (!plan.is_filter) {
        const u32 every = START_NUMBER | KINDS_ALL << STATE_KINDS_SHIFT | STATE_CONTINUES;
        return {{row_to(every), row_to(every)}};
    }
    PathTables tables{{row_to(state_word(plan, START_NUMBER)), row_to(STATE_DEAD)}};
    const std::vector<AutomatonState>& states = plan.automaton.states;
    tables.states.resize(std::max<size_t>(states.size(), START_NUMBER + 1), row_to(STATE_DEAD));
    for (size_t number = START_NUMBER; number < states.size(); ++number) {
        PathState& row = tables.states[number];
        for (unsigned letter = 0; letter < LETTER_COUNT; ++letter)
            row.next[letter] = state_word(plan, size_t(states[number].next[letter]));
        row.layers = layer_word(states[number]);
    }
    return tables;
}

std::vector<std::string> path_defines(const PathPlan& plan) {
    std::vector<std::string> defines;
    if (!plan.layers.empty() && plan.is_filter)
        defines.push_back(fmt::format("PATH_LAYERS={}", plan.layers.size()));
    if (plan.are_lamps_behind_slabs)
        defines.emplace_back("LAMPS_BEHIND_SLABS=1");
    return defines;
}

unsigned accepted_kinds(const PathPlan& plan) {
    if (!plan.is_filter)
        return KINDS_ALL;
    unsigned kinds = 0;
    for (const AutomatonState& state : plan.automaton.states)
        kinds |= state.kinds;
    return kinds;
}

} // namespace clrt
