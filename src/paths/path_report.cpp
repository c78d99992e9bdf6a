// SPDX-License-Identifier: Apache-2.0
#include "paths/path_report.h"

#include <fmt/format.h>

namespace clrt {

namespace {

std::string symbols(const PathPlan& plan, bool in_scene, bool lights) {
    std::vector<std::string> list;
    for (size_t i = lights ? LETTER_COUNT : 0; i < (lights ? plan.letters.size() : LETTER_COUNT); ++i)
        if (plan.letters[i].witness.empty() != in_scene)
            list.push_back(plan.letters[i].symbol);
    return list.empty() ? "none" : fmt::format("{}", fmt::join(list, " "));
}

/// The lights of a bit mask, such as "La Le".
std::string kind_symbols(const PathPlan& plan, unsigned kinds) {
    std::vector<std::string> list;
    for (unsigned i = 0; i + LETTER_COUNT < plan.letters.size(); ++i)
        if (kinds >> i & 1u)
            list.push_back(plan.letters[LETTER_COUNT + i].symbol);
    return list.empty() ? "-" : fmt::format("{}", fmt::join(list, " "));
}

std::string format_states(const PathPlan& plan) {
    std::string text = "  state  light       D    G    R    T\n";
    for (size_t s = 1; s < plan.automaton.states.size(); ++s) {
        const AutomatonState& state = plan.automaton.states[s];
        text += fmt::format("  {:>5}  {:<11}", s, kind_symbols(plan, state.kinds));
        for (const int next : state.next)
            text += next ? fmt::format("{:<5}", next) : "-    ";
        for (size_t layer = 0; layer < plan.layers.size(); ++layer)
            if (state.layers[layer])
                text +=
                    fmt::format(" {}: {}", plan.layers[layer].name, kind_symbols(plan, state.layers[layer]));
        text.erase(text.find_last_not_of(' ') + 1);
        text += "\n";
    }
    return text;
}

} // namespace

std::string path_summary(const PathPlan& plan) {
    if (!plan.is_asked)
        return "every path";
    const std::string name = plan.expression.empty() ? "every path" : "'" + plan.expression + "'";
    if (plan.is_empty && !plan.automaton.is_empty())
        return fmt::format(
            "{}: its shortest path has {} segments, more than --max-depth allows; the picture is black", name,
            plan.automaton.states[1].distance + 1);
    if (plan.is_empty)
        return fmt::format(
            "{}: no path of this scene matches (surfaces: {}; lights: {}); the picture is black", name,
            symbols(plan, true, false), symbols(plan, true, true));
    if (!plan.is_filter)
        return fmt::format("{}: that is every path of this scene", name);
    const size_t states = plan.automaton.states.size() - 1;
    return fmt::format(
        "{}: {} state{}, {}", name, states, states == 1 ? "" : "s",
        plan.segments ? fmt::format("at most {} segment{}", *plan.segments, *plan.segments == 1 ? "" : "s")
                      : "no bound on the length");
}

std::string format_paths(const PathPlan& plan) {
    std::string text = "  " + path_summary(plan) + "\n";
    for (const PathLayerOption& layer : plan.layers)
        text += fmt::format("  layer {}: {}\n", layer.name, layer.expression);
    for (const PathLetter& letter : plan.letters)
        text += fmt::format("  {:<7} {:<22} {}\n", letter.witness.empty() ? "absent" : "present",
                            letter.symbol, letter.witness.empty() ? "nothing in this scene" : letter.witness);
    if (plan.is_filter && !plan.is_empty)
        text +=
            "the states, from the eye: the lights that end a path there, and the state behind each letter\n" +
            format_states(plan);
    return text;
}

nlohmann::ordered_json paths_json(const PathPlan& plan) {
    using Json = nlohmann::ordered_json;
    Json layers = Json::array(), letters = Json::array();
    for (const PathLayerOption& layer : plan.layers)
        layers.push_back({{"name", layer.name}, {"expression", layer.expression}});
    for (const PathLetter& letter : plan.letters)
        if (!letter.witness.empty())
            letters.push_back(letter.symbol);
    return {{"expression", plan.expression.empty() ? Json(nullptr) : Json(plan.expression)},
            {"layers", layers},
            {"scene", letters},
            {"empty", plan.is_empty},
            {"states", plan.is_filter ? Json(plan.automaton.states.size() - 1) : Json(nullptr)},
            {"segments", plan.segments ? Json(*plan.segments) : Json(nullptr)}};
}

} // namespace clrt
