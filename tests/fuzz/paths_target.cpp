// SPDX-License-Identifier: Apache-2.0
// The path notation: any text gives an automaton within its limits or a UsageError. The first byte chooses
// what the scene has; lines are the picture's expression and its layers'.
#include "error.h"
#include "fuzz_target.h"
#include "paths/automaton.h"

namespace clrt {

namespace {

void check_state(const Automaton& automaton, const AutomatonState& state) {
    for (const int next : state.next)
        promise(next >= 0 && size_t(next) < automaton.states.size(), "successors are states");
    unsigned layers = 0;
    for (const unsigned layer : state.layers)
        layers |= layer;
    promise((layers & ~state.kinds) == 0, "layers are parts of the picture");
}

void check(const Automaton& automaton) {
    promise(!automaton.states.empty() && automaton.states.size() <= AUTOMATON_STATES_LIMIT + 1,
            "the tables hold the states");
    for (const AutomatonState& state : automaton.states)
        check_state(automaton, state);
    const std::optional<int> longest = longest_path(automaton);
    promise(!longest || automaton.is_empty() || *longest >= automaton.states[1].distance,
            "the longest path is no shorter than the shortest");
}

} // namespace

} // namespace clrt

int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
    using namespace clrt;
    if (size == 0)
        return 0;
    const PathAlphabet alphabet{data[0] & 0xfu, unsigned(data[0]) >> 4};
    std::vector<PathExpression> expressions;
    std::string_view rest = as_text(data + 1, size - 1);
    try {
        while (expressions.size() <= PATH_LAYERS_LIMIT) {
            const size_t end = rest.find('\n');
            expressions.push_back(parse_path_expression(std::string(rest.substr(0, end))));
            if (end == rest.npos)
                break;
            rest.remove_prefix(end + 1);
        }
        const PathExpression picture = expressions.front();
        expressions.erase(expressions.begin());
        const Automaton automaton = make_automaton(picture, expressions, alphabet);
        check(automaton);
        accepts_everything(automaton, alphabet);
    } catch (const UsageError&) {
    }
    return 0;
}
