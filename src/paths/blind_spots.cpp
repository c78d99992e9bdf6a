// SPDX-License-Identifier: Apache-2.0
// The product of the automata of all expressions that matter gives the unsampled language; turned round, it
// is read from the light and becomes an expression again.
#include "paths/blind_spots.h"

#include "paths/automaton.h"
#include "paths/expression_text.h"
#include "paths/path_plan.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace clrt {

namespace {

/// The image of a light, straight or by smooth surfaces.
const char* const IMAGE = "LS*E";

/// More states than this make no readable expression: one that holds more paths is given instead.
constexpr size_t READABLE_STATES = 16;

/// States of several automata at once.
using Joint = std::array<int, 5>;
enum { LANGUAGE, PICTURE, RAYS, CONNECTION, IMAGES };

/// Paths of a picture, as told from the others by which techniques find them: none, or hits alone.
enum class Finding { NONE, HITS };

/// Such paths, walked from the eye: state 0 is the start.
struct FoundPaths {
    std::vector<std::array<int, LETTER_COUNT>> next;
    std::vector<unsigned> kinds; ///< KIND_* that end such a path
    std::vector<int> distance;   ///< letters from the start
};

class Product {
public:
    Product(const PathPlan& plan, const PathExpression& picture, Integrator integrator, Finding finding)
        : plan_(plan), finding_(finding) {
        const SimulatedPaths& simulated = integrator_row(integrator).paths;
        const PathExpression expressions[] = {
            parse_path_expression(simulated.all), picture, parse_path_expression(simulated.by_rays),
            parse_path_expression(simulated.by_connection), parse_path_expression(IMAGE)};
        Joint start{};
        for (size_t i = 0; i < automata_.size(); ++i) {
            automata_[i] = make_automaton(expressions[i], {}, plan.alphabet);
            start[i] = automata_[i].is_empty() ? 0 : 1;
        }
        find(start, 0);
        for (size_t s = 0; s < joints_.size(); ++s)
            expand(s);
    }
    FoundPaths result;

private:
    const AutomatonState& state(const Joint& joint, size_t i) const {
        return automata_[i].states[size_t(joint[i])];
    }

    unsigned found_kinds(const Joint& joint) const {
        const auto kinds = [&](size_t i) { return state(joint, i).kinds; };
        if (finding_ == Finding::HITS)
            return kinds(LANGUAGE) & kinds(PICTURE) & plan_.found_by_rays & kinds(RAYS) &
                   ~(kinds(CONNECTION) | kinds(IMAGES));
        const unsigned by_extent = plan_.found_by_rays & ~(kinds(RAYS) | kinds(CONNECTION));
        const unsigned without = plan_.missed_by_rays & ~(kinds(CONNECTION) | kinds(IMAGES));
        return kinds(LANGUAGE) & kinds(PICTURE) & (by_extent | without);
    }

    int find(const Joint& joint, int distance) {
        const auto [entry, is_new] = numbers_.emplace(joint, int(joints_.size()));
        if (is_new) {
            joints_.push_back(joint);
            result.next.emplace_back();
            result.kinds.push_back(found_kinds(joint));
            result.distance.push_back(distance);
        }
        return entry->second;
    }

    void expand(size_t s) {
        const Joint joint = joints_[s];
        for (unsigned letter = 0; letter < LETTER_COUNT; ++letter) {
            Joint next{};
            for (size_t i = 0; i < next.size(); ++i)
                next[i] = state(joint, i).next[letter];
            const bool goes_on = next[LANGUAGE] != 0 && next[PICTURE] != 0;
            result.next[s][letter] = goes_on ? find(next, result.distance[s] + 1) : -1;
        }
    }

    const PathPlan& plan_;
    const Finding finding_;
    std::array<Automaton, 5> automata_;
    std::map<Joint, int> numbers_;
    std::vector<Joint> joints_;
};

/// The paths of such kinds of light, read from the light, whose first letter is one of `first`. Turning a
/// deterministic automaton round and making it deterministic gives the smallest one (Brzozowski 1962).
std::vector<LightState> from_light(const FoundPaths& paths, unsigned kinds, unsigned first) {
    using PlaceSet = std::set<int>;
    std::map<PlaceSet, int> numbers;
    std::vector<PlaceSet> sets;
    const auto find = [&](const PlaceSet& places) {
        const auto [entry, is_new] = numbers.emplace(places, int(sets.size()));
        if (is_new)
            sets.push_back(places);
        return entry->second;
    };
    PlaceSet ends;
    for (size_t s = 0; s < paths.kinds.size(); ++s)
        if (paths.kinds[s] & kinds)
            ends.insert(int(s));
    sets.push_back(ends); // the start has a number of its own: only there the letter is restricted
    std::vector<LightState> states;
    for (size_t i = 0; i < sets.size() && i <= READABLE_STATES; ++i) {
        LightState light;
        light.accepts = i > 0 && sets[i].count(0) > 0;
        for (unsigned letter = 0; letter < LETTER_COUNT; ++letter) {
            PlaceSet before;
            for (size_t s = 0; s < paths.next.size(); ++s)
                if (sets[i].count(paths.next[s][letter]))
                    before.insert(int(s));
            if (!before.empty() && (i > 0 || (first >> letter & 1u)))
                light.next[letter] = find(before);
        }
        states.push_back(light);
    }
    return states;
}

/// Letters that a path of such kinds of light can have next to the light, within so many segments.
unsigned first_letters(const FoundPaths& paths, unsigned kinds, int max_depth) {
    unsigned letters = 0;
    for (const std::array<int, LETTER_COUNT>& next : paths.next)
        for (unsigned letter = 0; letter < LETTER_COUNT; ++letter)
            if (const int s = next[letter];
                s >= 0 && (paths.kinds[size_t(s)] & kinds) && paths.distance[size_t(s)] + 1 <= max_depth)
                letters |= 1u << letter;
    return letters;
}

/// Surfaces of the paths of such kinds of light whose letter next to it is one of `first`.
std::string surfaces_text(const FoundPaths& paths, unsigned kinds, unsigned first) {
    std::vector<LightState> states = from_light(paths, kinds, first);
    if (states.size() > READABLE_STATES) {
        states.assign(2, {});
        states[1].accepts = true;
        for (unsigned letter = 0; letter < LETTER_COUNT; ++letter) {
            states[0].next[letter] = first >> letter & 1u ? 1 : -1;
            states[1].next[letter] = 1;
        }
    }
    return surface_expression(states);
}

std::string light_text(const PathPlan& plan, unsigned bit) {
    const std::string& witness = plan.letters[LETTER_COUNT + bit].witness;
    if (!(plan.missed_by_rays >> bit & 1u))
        return witness;
    return (1u << bit == KIND_POINT ? "point light (" : "sun without a disc (") + witness + ")";
}

/// One spot for the light itself, one for each material next to it.
void add_spots(const PathPlan& plan, const FoundPaths& paths, unsigned bit, int max_depth,
               std::vector<BlindSpot>& spots) {
    if (paths.kinds[0] >> bit & 1u)
        spots.push_back({plan.letters[LETTER_COUNT + bit].symbol + "E", light_text(plan, bit), ""});
    unsigned left = first_letters(paths, 1u << bit, max_depth);
    for (unsigned letter = 0; letter < LETTER_COUNT; ++letter) {
        if (!(left >> letter & 1u))
            continue;
        const PathLetter& material = plan.letters[letter];
        unsigned together = 0;
        for (unsigned other = letter; other < LETTER_COUNT; ++other)
            if ((left >> other & 1u) && plan.letters[other].witness == material.witness)
                together |= 1u << other;
        left &= ~together;
        BlindSpot spot;
        spot.paths =
            plan.letters[LETTER_COUNT + bit].symbol + surfaces_text(paths, 1u << bit, together) + "E";
        spot.cause = light_text(plan, bit) + ", next to it " + material.witness;
        if (plan.missed_by_rays >> bit & 1u)
            spot.seen = "lights that have an extent: emissive triangles, a sun with a diameter";
        if (material.place.line)
            spot.where = fmt::format("{}:{}", material.place.file, material.place.line);
        spots.push_back(std::move(spot));
    }
}

} // namespace

std::vector<BlindSpot> find_blind_spots(const PathPlan& plan, const PathExpression& picture,
                                        Integrator integrator, int max_depth) {
    const FoundPaths paths = Product(plan, picture, integrator, Finding::NONE).result;
    std::vector<BlindSpot> spots;
    for (unsigned bit = 0; LETTER_COUNT + bit < plan.letters.size(); ++bit)
        add_spots(plan, paths, bit, max_depth, spots);
    return spots;
}

HitPaths find_hit_paths(const PathPlan& plan, const PathExpression& picture, Integrator integrator,
                        int max_depth) {
    const FoundPaths paths = Product(plan, picture, integrator, Finding::HITS).result;
    HitPaths hits;
    std::string lights;
    unsigned first = 0;
    for (unsigned bit = 0; LETTER_COUNT + bit < plan.letters.size(); ++bit)
        if (const unsigned letters = first_letters(paths, 1u << bit, max_depth)) {
            hits.kinds |= 1u << bit;
            lights += (lights.empty() ? "" : "|") + plan.letters[LETTER_COUNT + bit].symbol;
            first |= letters;
        }
    if (hits.kinds == plan.alphabet.kinds)
        lights = "L";
    else if (hits.kinds & (hits.kinds - 1))
        lights = "(" + lights + ")";
    if (hits.kinds != 0)
        hits.paths = lights + surfaces_text(paths, hits.kinds, first) + "E";
    return hits;
}

std::string format_blind_spots(const std::vector<BlindSpot>& spots) {
    std::string text;
    for (const BlindSpot& spot : spots)
        text += fmt::format("not seen {}: {}\n", spot.paths, spot.cause);
    return text;
}

nlohmann::ordered_json blind_spots_json(const std::vector<BlindSpot>& spots) {
    using Json = nlohmann::ordered_json;
    Json list = Json::array();
    for (const BlindSpot& spot : spots)
        list.push_back({{"paths", spot.paths},
                        {"cause", spot.cause},
                        {"where", spot.where.empty() ? Json(nullptr) : Json(spot.where)}});
    return list;
}

std::vector<BlindSpot> read_blind_spots(const nlohmann::ordered_json& json) {
    std::vector<BlindSpot> spots;
    for (const auto& spot : json)
        spots.push_back({spot.at("paths"), spot.at("cause"),
                         spot.at("where").is_null() ? "" : spot.at("where").get<std::string>()});
    return spots;
}

} // namespace clrt
