// SPDX-License-Identifier: Apache-2.0
// Subset construction over the positions of all expressions at once, then partition refinement (Moore 1956).
#include "paths/automaton.h"

#include "error.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <numeric>

namespace clrt {

namespace {

/// States before minimising; beyond it an expression asks for more memory and time than it can be worth.
constexpr size_t LARGEST_CONSTRUCTION = 20000;

/// A position of one of the expressions: 0 is the picture's, then the layers'.
using Place = std::pair<int, int>;
using Places = std::vector<Place>;

/// Builds the states as sets of places, in order of discovery; state 0 is the empty set.
class Construction {
public:
    Construction(std::vector<const PathExpression*> expressions, const PathAlphabet& alphabet)
        : expressions_(std::move(expressions)), alphabet_(alphabet) {
        find({});
        Places start;
        for (size_t e = 0; e < expressions_.size(); ++e)
            for (const int eye : expressions_[e]->eyes)
                start.emplace_back(int(e), eye);
        find(start);
        for (size_t s = 0; s < states.size(); ++s)
            expand(s);
    }
    std::vector<AutomatonState> states;

private:
    const PathPosition& at(const Place& place) const {
        return expressions_[size_t(place.first)]->positions[size_t(place.second)];
    }

    int find(const Places& places) {
        const auto [entry, is_new] = numbers_.emplace(places, int(states.size()));
        if (is_new) {
            states.emplace_back();
            sets_.push_back(places);
        }
        if (states.size() > LARGEST_CONSTRUCTION)
            throw UsageError(
                fmt::format("path expressions: expected an automaton of at most {} states, found more; "
                            "write them shorter or render the layers one by one",
                            AUTOMATON_STATES_LIMIT));
        return entry->second;
    }

    void expand(size_t s) {
        std::array<Places, LETTER_COUNT> next;
        std::array<unsigned, PATH_LAYERS_LIMIT + 1> kinds{};
        for (const Place& place : sets_[s])
            for (const int following : at(place).following) {
                const Place target{place.first, following};
                kinds[size_t(place.first)] |= at(target).kinds & alphabet_.kinds;
                for (unsigned letter = 0; letter < LETTER_COUNT; ++letter)
                    if (at(target).letters & alphabet_.letters & (1u << letter))
                        next[letter].push_back(target);
            }
        for (unsigned letter = 0; letter < LETTER_COUNT; ++letter) {
            Places& places = next[letter];
            std::sort(places.begin(), places.end());
            places.erase(std::unique(places.begin(), places.end()), places.end());
            const int number = find(places);
            states[s].next[letter] = number;
        }
        // A layer shows a part of the picture.
        states[s].kinds = kinds[0];
        for (size_t layer = 0; layer < PATH_LAYERS_LIMIT; ++layer)
            states[s].layers[layer] = kinds[layer + 1] & kinds[0];
    }

    std::vector<const PathExpression*> expressions_;
    PathAlphabet alphabet_;
    std::map<Places, int> numbers_;
    std::vector<Places> sets_;
};

/// Fewest letters from each state to one that ends a path; -1 where there is none.
std::vector<int> distances(const std::vector<AutomatonState>& states) {
    std::vector<int> distance(states.size(), -1);
    std::vector<std::vector<int>> before(states.size());
    std::vector<int> queue;
    for (size_t s = 0; s < states.size(); ++s) {
        for (const int next : states[s].next)
            before[size_t(next)].push_back(int(s));
        if (states[s].kinds) {
            distance[s] = 0;
            queue.push_back(int(s));
        }
    }
    for (size_t i = 0; i < queue.size(); ++i)
        for (const int s : before[size_t(queue[i])])
            if (distance[size_t(s)] < 0) {
                distance[size_t(s)] = distance[size_t(queue[i])] + 1;
                queue.push_back(s);
            }
    return distance;
}

/// Replaces states that accept nothing by the dead one.
void trim(std::vector<AutomatonState>& states) {
    const std::vector<int> distance = distances(states);
    for (size_t s = 0; s < states.size(); ++s) {
        states[s].distance = std::max(distance[s], 0);
        for (int& next : states[s].next)
            next = distance[size_t(next)] < 0 ? 0 : next;
    }
    if (distance[1] < 0)
        states.resize(1);
}

/// The class of each state: equal for states from which the same words are accepted, by the picture and, if
/// asked for, by every layer. Classes are numbered by their first state.
std::vector<int> classes(const std::vector<AutomatonState>& states, bool with_layers) {
    std::vector<int> of(states.size(), 0);
    for (size_t count = 0;;) {
        std::map<std::vector<int>, int> numbers;
        std::vector<int> refined;
        for (size_t s = 0; s < states.size(); ++s) {
            std::vector<int> key{of[s], int(states[s].kinds)};
            if (with_layers)
                key.insert(key.end(), states[s].layers.begin(), states[s].layers.end());
            for (const int next : states[s].next)
                key.push_back(of[size_t(next)]);
            refined.push_back(numbers.emplace(std::move(key), int(numbers.size())).first->second);
        }
        of = std::move(refined);
        if (numbers.size() == count)
            return of;
        count = numbers.size();
    }
}

/// Gathers the reachable states of each class in one, in breadth-first order from the start.
std::vector<AutomatonState> merge_classes(const std::vector<AutomatonState>& states,
                                          const std::vector<int>& of, const std::vector<int>& picture) {
    std::vector<AutomatonState> merged(1);
    merged[0].picture = picture[0];
    if (states.size() < 2)
        return merged;
    std::map<int, int> numbers{{of[0], 0}, {of[1], 1}};
    std::vector<size_t> queue{0, 1}; // a state of each class
    for (size_t i = 1; i < queue.size(); ++i) {
        AutomatonState state = states[queue[i]];
        state.picture = picture[queue[i]];
        for (int& next : state.next) {
            const auto [entry, is_new] = numbers.emplace(of[size_t(next)], int(queue.size()));
            if (is_new)
                queue.push_back(size_t(next));
            next = entry->second;
        }
        merged.push_back(state);
    }
    return merged;
}

} // namespace

Automaton make_automaton(const PathExpression& picture, const std::vector<PathExpression>& layers,
                         const PathAlphabet& alphabet) {
    std::vector<const PathExpression*> expressions{&picture};
    for (const PathExpression& layer : layers)
        expressions.push_back(&layer);
    std::vector<AutomatonState> states = Construction(expressions, alphabet).states;
    trim(states);
    Automaton automaton;
    automaton.states = merge_classes(states, classes(states, true), classes(states, false));
    if (automaton.states.size() > AUTOMATON_STATES_LIMIT + 1)
        throw UsageError(
            fmt::format("path expressions: expected an automaton of at most {} states, found {}; write "
                        "them shorter or render the layers one by one",
                        AUTOMATON_STATES_LIMIT, automaton.states.size() - 1));
    return automaton;
}

std::optional<int> longest_path(const Automaton& automaton) {
    // Longest way by states left: one that is longer than there are states meets a state twice.
    const size_t count = automaton.states.size();
    std::vector<int> longest(count, -1);
    for (size_t round = 0; round <= count; ++round) {
        std::vector<int> longer = longest;
        for (size_t s = 1; s < count; ++s) {
            if (automaton.states[s].kinds)
                longer[s] = std::max(longer[s], 0);
            for (const int next : automaton.states[s].next)
                if (next && longest[size_t(next)] >= 0)
                    longer[s] = std::max(longer[s], longest[size_t(next)] + 1);
        }
        if (longer == longest)
            return automaton.is_empty() ? 0 : std::max(longest[1], 0);
        longest = std::move(longer);
    }
    return std::nullopt;
}

bool accepts_everything(const Automaton& automaton, const PathAlphabet& alphabet) {
    if (automaton.states.size() != 2)
        return false;
    const AutomatonState& only = automaton.states[1];
    if (only.kinds != alphabet.kinds)
        return false;
    for (unsigned letter = 0; letter < LETTER_COUNT; ++letter)
        if ((alphabet.letters >> letter & 1u) && only.next[letter] != 1)
            return false;
    return true;
}

} // namespace clrt
