// SPDX-License-Identifier: Apache-2.0
// The automaton of path expressions against a matcher of another kind (std::regex over all short words), and
// its size.
#include "paths/automaton.h"

#include "error.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>
#include <regex>

namespace clrt {

namespace {

const PathAlphabet EVERYTHING{0xf, KINDS_ALL};
const std::string LETTERS = "DGRT", KINDS = "apde";

Automaton make(const std::string& picture, const std::vector<std::string>& layers = {},
               const PathAlphabet& alphabet = EVERYTHING) {
    std::vector<PathExpression> expressions;
    for (const std::string& layer : layers)
        expressions.push_back(parse_path_expression(layer));
    return make_automaton(parse_path_expression(picture), expressions, alphabet);
}

/// An expression as a regular expression over words such as "aDRE": a letter of KINDS, letters of LETTERS, E.
std::regex oracle(const std::string& text) {
    const bool has_glossy = text.find('G') != std::string::npos;
    std::string pattern;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const bool has_kind = c == 'L' && i + 1 < text.size() && KINDS.find(text[i + 1]) != std::string::npos;
        switch (c) {
        case ' ':
            break;
        case 'L':
            pattern += has_kind ? std::string(1, text[++i]) : "[apde]";
            break;
        case 'D':
            pattern += has_glossy ? "D" : "[DG]";
            break;
        case 'S':
            pattern += "[RT]";
            break;
        case '.':
            pattern += "[DGRT]";
            break;
        case 'C':
            pattern += "E";
            break;
        case '(':
            pattern += "(?:";
            break;
        default:
            pattern += c;
        }
        // Several signs behind each other mean that what is repeated is repeated.
        if (std::string("*+?").find(c) != std::string::npos && i + 1 < text.size() &&
            std::string("*+?").find(text[i + 1]) != std::string::npos)
            throw std::logic_error("the oracle reads one sign behind a symbol");
    }
    return std::regex(pattern);
}

/// All words of up to `longest` letters, from the eye.
std::vector<std::string> words(size_t longest) {
    std::vector<std::string> all{""};
    for (size_t i = 0; all[i].size() < longest; ++i)
        for (const char c : LETTERS)
            all.push_back(all[i] + c);
    return all;
}

int state_behind(const Automaton& automaton, const std::string& word) {
    int state = automaton.is_empty() ? 0 : 1;
    for (const char c : word)
        state = automaton.states[size_t(state)].next[LETTERS.find(c)];
    return state;
}

/// Compares with the oracle on every word: the picture, and each layer of it.
void expect_same_language(const std::string& picture, const std::vector<std::string>& layers,
                          size_t longest) {
    const Automaton automaton = make(picture, layers);
    const bool from_eye = picture.find_first_of("EC") < picture.find('L');
    const auto matches = [&](const std::regex& expression, const std::string& word, char kind) {
        const std::string light_first = kind + std::string(word.rbegin(), word.rend()) + "E";
        const std::string eye_first = "E" + word + kind;
        return std::regex_match(from_eye ? eye_first : light_first, expression);
    };
    const std::regex whole = oracle(picture);
    std::vector<std::regex> parts;
    for (const std::string& layer : layers)
        parts.push_back(oracle(layer));
    for (const std::string& word : words(longest)) {
        const AutomatonState& state = automaton.states[size_t(state_behind(automaton, word))];
        for (size_t k = 0; k < KINDS.size(); ++k) {
            const bool in_picture = matches(whole, word, KINDS[k]);
            ASSERT_EQ((state.kinds >> k & 1u) != 0, in_picture)
                << picture << " on E" << word << "L" << KINDS[k];
            for (size_t i = 0; i < layers.size(); ++i)
                ASSERT_EQ((state.layers[i] >> k & 1u) != 0, in_picture && matches(parts[i], word, KINDS[k]))
                    << layers[i] << " in " << picture << " on E" << word << "L" << KINDS[k];
        }
    }
}

/// Whether two states accept different words or layers: by walking the pairs of states behind both.
bool are_different(const Automaton& automaton, int a, int b) {
    std::vector<std::pair<int, int>> pairs{{a, b}};
    for (size_t i = 0; i < pairs.size(); ++i) {
        const AutomatonState& one = automaton.states[size_t(pairs[i].first)];
        const AutomatonState& other = automaton.states[size_t(pairs[i].second)];
        if (one.kinds != other.kinds || one.layers != other.layers)
            return true;
        for (size_t letter = 0; letter < LETTER_COUNT; ++letter) {
            const std::pair<int, int> next{one.next[letter], other.next[letter]};
            if (std::find(pairs.begin(), pairs.end(), next) == pairs.end())
                pairs.push_back(next);
        }
    }
    return false;
}

void expect_minimal(const Automaton& automaton, const std::string& what) {
    for (int a = 0; a < int(automaton.states.size()); ++a)
        for (int b = a + 1; b < int(automaton.states.size()); ++b)
            EXPECT_TRUE(are_different(automaton, a, b)) << what << ": states " << a << " and " << b;
}

/// A random expression from the light.
std::string random_expression(std::mt19937& random, int depth) {
    const auto pick = [&](const std::vector<std::string>& from) { return from[random() % from.size()]; };
    std::string part;
    const unsigned count = 1 + random() % 3;
    for (unsigned i = 0; i < count; ++i) {
        if (depth > 0 && random() % 3 == 0)
            part +=
                "(" + random_expression(random, depth - 1) + "|" + random_expression(random, depth - 1) + ")";
        else
            part += pick({"D", "G", "S", "R", "T", "."});
        part += pick({"", "", "", "*", "+", "?"});
    }
    return part;
}

} // namespace

TEST(Automaton, AgreesWithRegularExpressionsOnAllShortWords) {
    for (const char* text :
         {"LE", "LDE", "L(D|S)*E", "L.*E", "LD?S*E", "LS+DE", "LS+D(D|S)*E", "LDG*E", "L(D|G|S)*E",
          "LaDE|LpS*E", "(La|Le)(DD)*E", "ED?S*L", "CS*DLa", "L.?.?.?E", "LR*T+D?E", "LpE"})
        expect_same_language(text, {}, 5);
    expect_same_language("L(D|S)*DE", {}, 6);
    expect_same_language("E(SD)*L", {}, 6);
}

TEST(Automaton, AgreesWithRegularExpressionsOnRandomExpressions) {
    std::mt19937 random(3);
    for (int i = 0; i < 60; ++i) {
        const std::string text = "L" + random_expression(random, 2) + "E";
        SCOPED_TRACE(text);
        expect_same_language(text, {}, 4);
        expect_minimal(make(text), text);
    }
}

TEST(Automaton, LayersArePartsOfThePicture) {
    expect_same_language("L(D|G|S)*E", {"LDE", "LS+DE", "LG*E", "LE"}, 4);
    expect_same_language("LD(D|S)*E", {"LD+E", "L.*SE"}, 4);
    EXPECT_EQ(make("LDE", {"LSE"}).states[1].layers[0], 0u);
}

TEST(Automaton, HasTheFewestStates) {
    const std::vector<std::pair<std::string, size_t>> sizes = {
        {"LE", 1},          {"L(D|S)*E", 1},    {"LDE", 2},
        {"LD?S*E", 2},      {"LS+D(D|S)*E", 3}, {"LD(D|S)?(D|S)?E", 6},
        {"L(D|D)E", 2},     {"LDE|LDE", 2},     {"L(D|S)*(D|S)*E", 1},
        {"LDDDDDDDDDE", 10}};
    for (const auto& [text, count] : sizes) {
        const Automaton automaton = make(text);
        EXPECT_EQ(automaton.states.size() - 1, count) << text;
        expect_minimal(automaton, text);
    }
    expect_minimal(make("L(D|G|S)*E", {"LDE", "LS+DE", "LD+E", "L.*DG.*E"}), "four layers");
}

TEST(Automaton, TheScenesLettersAreAllThereAre) {
    const PathAlphabet matte{1u << LETTER_MATTE, KIND_AREA};
    EXPECT_TRUE(make("LS+DE", {}, matte).is_empty());
    EXPECT_TRUE(make("LpDE", {}, matte).is_empty());
    EXPECT_TRUE(accepts_everything(make("L(D|S)*E", {}, matte), matte));
    EXPECT_TRUE(accepts_everything(make("LaD*E", {}, matte), matte));
    EXPECT_FALSE(accepts_everything(make("LD+E", {}, matte), matte));
    EXPECT_FALSE(accepts_everything(make("LaD*E"), EVERYTHING));
    EXPECT_FALSE(
        accepts_everything(make("L(D|S)*E", {}, {1u << LETTER_MATTE, 0}), {1u << LETTER_MATTE, KIND_AREA}));
    EXPECT_EQ(make("LS*D?E", {}, matte).states.size(), 3u) << "the dead state, before and behind D";
    // What leads nowhere is dead: R, because no light is behind it.
    EXPECT_EQ(make("LaDE|LpRE", {}, {0x5, KIND_AREA}).states[1].next[LETTER_MIRROR], 0);
}

TEST(Automaton, KnowsTheLongestAndTheShortestPath) {
    EXPECT_EQ(longest_path(make("LE")), 0);
    EXPECT_EQ(longest_path(make("LD?S?E")), 2);
    EXPECT_EQ(longest_path(make("LS*DE", {}, {1u << LETTER_MATTE, KIND_AREA})), 1);
    EXPECT_EQ(longest_path(make("LDD+E")), std::nullopt);
    EXPECT_EQ(make("LDD+E").states[1].distance, 2);
    EXPECT_EQ(make("LS*E").states[1].distance, 0);
}

TEST(Automaton, KnowsWhatThePictureAloneTellsApart) {
    const Automaton layered = make("L(D|G|S)*E", {"LDG*E"});
    const AutomatonState& start = layered.states[1];
    ASSERT_NE(start.next[LETTER_MATTE], start.next[LETTER_MIRROR]);
    for (size_t s = 1; s < layered.states.size(); ++s)
        EXPECT_EQ(layered.states[s].picture, start.picture) << "the picture takes every path";
    const Automaton split = make("LDG*E", {"LE"});
    EXPECT_NE(split.states[size_t(split.states[1].next[LETTER_MATTE])].picture,
              split.states[size_t(split.states[1].next[LETTER_GLOSSY])].picture);
}

TEST(Automaton, RefusesWhatIsTooLarge) {
    std::string text = "L.*D";
    for (int i = 0; i < 20; ++i)
        text += ".";
    // From the eye the D is at a fixed place; from the light the automaton must remember twenty letters.
    EXPECT_NO_THROW(make(text + "E"));
    std::string turned = "E.*D";
    for (int i = 0; i < 20; ++i)
        turned += ".";
    EXPECT_THROW(make(turned + "L"), UsageError);
    EXPECT_THROW(make("L" + std::string(300, 'D') + "E"), UsageError);
    EXPECT_NO_THROW(make("L" + std::string(254, 'D') + "E"));
}

} // namespace clrt
