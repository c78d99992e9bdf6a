// SPDX-License-Identifier: Apache-2.0
#include "paths/expression_text.h"

#include <algorithm>
#include <map>

namespace clrt {

namespace {

/// A text and what an operator may do with it.
struct Term {
    enum Shape { CHOICE, SEQUENCE, SINGLE } shape = SINGLE;
    std::string text; ///< empty: the empty word
    bool is_empty_word() const { return text.empty(); }
    std::string grouped(Shape least) const { return shape < least ? "(" + text + ")" : text; }
    char last() const { return text.empty() ? '\0' : text.back(); }
};

/// The text without its closing operator.
Term without_operator(const Term& term) {
    return {Term::SINGLE, term.text.substr(0, term.text.size() - 1)};
}

bool is_repeated(const Term& term) {
    return term.shape == Term::SINGLE && (term.last() == '*' || term.last() == '+' || term.last() == '?');
}

Term optional_term(const Term& term) {
    if (term.is_empty_word() || (is_repeated(term) && term.last() != '+'))
        return term;
    if (is_repeated(term))
        return {Term::SINGLE, without_operator(term).text + "*"};
    return {Term::SINGLE, term.grouped(Term::SINGLE) + "?"};
}

Term choice(const Term& a, const Term& b) {
    if (a.text == b.text)
        return a;
    if (a.is_empty_word() || b.is_empty_word())
        return optional_term(a.is_empty_word() ? b : a);
    return {Term::CHOICE, a.text + "|" + b.text};
}

Term repeated(const Term& term) {
    if (term.is_empty_word())
        return term;
    const std::string once = is_repeated(term) ? without_operator(term).text : term.grouped(Term::SINGLE);
    return {Term::SINGLE, once + "*"};
}

Term sequence(const Term& a, const Term& b) {
    if (a.is_empty_word() || b.is_empty_word())
        return a.is_empty_word() ? b : a;
    const std::string x = a.grouped(Term::SINGLE), y = b.grouped(Term::SINGLE);
    if (x + "*" == y || y + "*" == x)
        return {Term::SINGLE, (x.size() < y.size() ? x : y) + "+"};
    return {Term::SEQUENCE, a.grouped(Term::SEQUENCE) + b.grouped(Term::SEQUENCE)};
}

/// Letters as one symbol. Without G anywhere, D means both.
Term symbol(unsigned letters, bool with_glossy) {
    if (!with_glossy && letters == (MATTE | GLOSSY | MIRROR | REFRACTION))
        return {Term::SINGLE, "."};
    std::string text;
    const auto add = [&](unsigned which, const char* name) {
        if ((letters & which) == which)
            text += (text.empty() ? "" : "|") + std::string(name);
    };
    if (!with_glossy && (letters & GLOSSY))
        add(MATTE | GLOSSY, "D");
    else {
        add(MATTE, "D");
        add(GLOSSY, "G");
    }
    if ((letters & MIRROR) && (letters & REFRACTION))
        add(MIRROR | REFRACTION, "S");
    else {
        add(MIRROR, "R");
        add(REFRACTION, "T");
    }
    return {text.size() > 1 ? Term::CHOICE : Term::SINGLE, text};
}

/// Edges between states by the letters that they read.
using Edges = std::map<std::pair<int, int>, unsigned>;

/// The automaton while its states are eliminated; -1 is the light, -2 the eye.
class Elimination {
public:
    Elimination(const std::vector<LightState>& states, const Edges& edges, bool with_glossy) {
        for (const auto& [ends, letters] : edges)
            ways_[ends] = symbol(letters, with_glossy);
        ways_[{LIGHT, 0}] = {};
        for (size_t s = 0; s < states.size(); ++s)
            if (states[s].accepts)
                ways_[{int(s), EYE}] = {};
    }

    Term run(int states) {
        std::vector<int> left;
        for (int s = 0; s < states; ++s)
            left.push_back(s);
        while (!left.empty()) {
            const auto cheapest =
                std::min_element(left.begin(), left.end(), [&](int a, int b) { return cost(a) < cost(b); });
            eliminate(*cheapest);
            left.erase(cheapest);
        }
        return ways_[{LIGHT, EYE}];
    }

private:
    static constexpr int LIGHT = -1, EYE = -2;

    /// Ways that go through a state.
    size_t cost(int state) const {
        size_t in = 0, out = 0;
        for (const auto& [ends, way] : ways_) {
            in += ends.second == state && ends.first != state;
            out += ends.first == state && ends.second != state;
        }
        return in * out;
    }

    void eliminate(int state) {
        const auto loop = ways_.find({state, state});
        const Term around = loop == ways_.end() ? Term() : repeated(loop->second);
        std::vector<std::pair<int, Term>> in, out;
        for (const auto& [ends, way] : ways_) {
            if (ends.second == state && ends.first != state)
                in.emplace_back(ends.first, sequence(way, around));
            if (ends.first == state && ends.second != state)
                out.emplace_back(ends.second, way);
        }
        for (auto way = ways_.begin(); way != ways_.end();)
            way = way->first.first == state || way->first.second == state ? ways_.erase(way) : std::next(way);
        for (const auto& [from, first] : in)
            for (const auto& [to, second] : out) {
                const Term through = sequence(first, second);
                const auto direct = ways_.find({from, to});
                ways_[{from, to}] = direct == ways_.end() ? through : choice(direct->second, through);
            }
    }

    std::map<std::pair<int, int>, Term> ways_;
};

} // namespace

std::string surface_expression(const std::vector<LightState>& states) {
    Edges edges;
    for (size_t s = 0; s < states.size(); ++s)
        for (unsigned letter = 0; letter < LETTER_COUNT; ++letter)
            if (states[s].next[letter] >= 0)
                edges[{int(s), states[s].next[letter]}] |= 1u << letter;
    // Matte and glossy go together on every edge, or G must be written.
    bool together = true;
    for (const auto& [ends, letters] : edges)
        together = together && !(letters & MATTE) == !(letters & GLOSSY);
    const bool any_glossy =
        std::any_of(edges.begin(), edges.end(), [](const auto& edge) { return (edge.second & GLOSSY) != 0; });
    return Elimination(states, edges, any_glossy && !together)
        .run(int(states.size()))
        .grouped(Term::SEQUENCE);
}

} // namespace clrt
