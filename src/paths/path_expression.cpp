// SPDX-License-Identifier: Apache-2.0
// Recursive descent; every rule gives the positions that its part can start and end with, and adds who
// follows whom.
#include "paths/path_expression.h"

#include "error.h"
#include "kernels/shared/path_types.h"
#include "paths/expression_text.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace clrt {

namespace {

/// Parentheses inside each other; the reader calls itself as deep.
constexpr int DEEPEST_NESTING = 100;

const char* const SYMBOLS =
    "a letter of the path notation (light L La Lp Ld Le, surface D G S R T ., eye E) or (";

/// The expression and a caret, each on its own line; what no terminal shows as one column becomes '?'.
std::string with_caret(const std::string& text, size_t column) {
    std::string shown = text;
    for (char& c : shown)
        if (c < ' ' || c > '~')
            c = '?';
    return "\n  " + shown + "\n  " + std::string(column, ' ') + "^";
}

[[noreturn]] void fail(const std::string& text, size_t column, const std::string& expected,
                       const std::string& found) {
    throw UsageError("expected " + expected + ", found " + found + with_caret(text, column));
}

/// The character there is what was found.
[[noreturn]] void fail_at(const std::string& text, size_t column, const std::string& expected) {
    const bool printable = column < text.size() && text[column] >= ' ' && text[column] <= '~';
    const std::string found = column >= text.size() ? "its end"
                              : printable           ? fmt::format("'{}'", text[column])
                                          : fmt::format("the byte {:#04x}", (unsigned char)text[column]);
    fail(text, column, expected, found);
}

void merge(std::vector<int>& into, const std::vector<int>& more) {
    std::vector<int> both;
    std::set_union(into.begin(), into.end(), more.begin(), more.end(), std::back_inserter(both));
    into = std::move(both);
}

/// What a part of an expression can match.
struct Part {
    bool can_be_empty = false;
    std::vector<int> first, last; ///< sorted
};

/// Reads the text from the left; `following` of the positions runs the way it is written.
class Reader {
public:
    explicit Reader(const std::string& text) : text_(text) {}

    Part read() {
        const Part whole = choice(0);
        if (at_ < text_.size()) // only ')' stops a choice early
            fail_at(text_, at_, "an expression without a ')' that nothing opens");
        return whole;
    }
    std::vector<PathPosition> positions;

private:
    char peek() {
        at_ = std::min(text_.find_first_not_of(' ', at_), text_.size());
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    bool at_end() { return peek() == '\0' && at_ == text_.size(); }

    Part choice(int depth) {
        Part all = sequence(depth);
        while (peek() == '|') {
            ++at_;
            const Part other = sequence(depth);
            all.can_be_empty = all.can_be_empty || other.can_be_empty;
            merge(all.first, other.first);
            merge(all.last, other.last);
        }
        return all;
    }

    Part sequence(int depth) {
        Part all = repeated(depth);
        while (!at_end() && peek() != '|' && peek() != ')') {
            const Part next = repeated(depth);
            connect(all.last, next.first);
            if (all.can_be_empty)
                merge(all.first, next.first);
            std::vector<int> last = next.last;
            if (next.can_be_empty)
                merge(last, all.last);
            all.last = std::move(last);
            all.can_be_empty = all.can_be_empty && next.can_be_empty;
        }
        return all;
    }

    Part repeated(int depth) {
        Part part = single(depth);
        for (char c = peek(); c == '*' || c == '+' || c == '?'; c = peek()) {
            if (c != '?')
                connect(part.last, part.first);
            part.can_be_empty = part.can_be_empty || c != '+';
            ++at_;
        }
        return part;
    }

    Part single(int depth) {
        if (peek() != '(')
            return symbol();
        const size_t opened = at_++;
        if (depth == DEEPEST_NESTING)
            fail_at(text_, opened, fmt::format("at most {} parentheses inside each other", DEEPEST_NESTING));
        const Part inside = choice(depth + 1);
        if (peek() != ')')
            fail_at(text_, at_, fmt::format("a ')' for the '(' in column {}", opened + 1));
        ++at_;
        return inside;
    }

    Part symbol() {
        PathPosition position;
        const char c = peek();
        position.column = at_;
        switch (c) {
        case 'D':
            position.letters = MATTE;
            break;
        case 'G':
            position.letters = GLOSSY;
            break;
        case 'R':
            position.letters = MIRROR;
            break;
        case 'T':
            position.letters = REFRACTION;
            break;
        case 'S':
            position.letters = MIRROR | REFRACTION;
            break;
        case '.':
            position.letters = MATTE | GLOSSY | MIRROR | REFRACTION;
            break;
        case 'E':
        case 'C':
            position.is_eye = true;
            break;
        case 'L':
            position.kinds = light_kind();
            break;
        default:
            fail_at(text_, at_, SYMBOLS);
        }
        ++at_;
        positions.push_back(position);
        const int index = int(positions.size()) - 1;
        return {false, {index}, {index}};
    }

    /// The kind after an L; moves to its letter if it has one.
    unsigned light_kind() {
        const char kind = at_ + 1 < text_.size() ? text_[at_ + 1] : '\0';
        if (kind < 'a' || kind > 'z')
            return KINDS_ALL;
        ++at_;
        switch (kind) {
        case 'a':
            return KIND_AREA;
        case 'p':
            return KIND_POINT;
        case 'd':
            return KIND_SUN;
        case 'e':
            return KIND_SKY;
        default:
            fail_at(text_, at_,
                    "a (area), p (point), d (sun) or e (environment) for the kind of light after L");
        }
    }

    void connect(const std::vector<int>& from, const std::vector<int>& to) {
        for (const int p : from)
            merge(positions[size_t(p)].following, to);
    }

    const std::string& text_;
    size_t at_ = 0;
};

/// Turns "who comes next" round.
void reverse(std::vector<PathPosition>& positions) {
    std::vector<std::vector<int>> before(positions.size());
    for (size_t p = 0; p < positions.size(); ++p)
        for (const int next : positions[p].following)
            before[size_t(next)].push_back(int(p));
    for (size_t p = 0; p < positions.size(); ++p)
        positions[p].following = std::move(before[p]);
}

const char* const LIGHTS = "a light (L, La, Lp, Ld, Le)";

/// Every path has the eye at one end, a light at the other, and neither in between.
void check_ends(const Part& whole, const PathExpression& expression, bool from_eye) {
    const std::string& text = expression.text;
    if (whole.can_be_empty)
        fail(text, 0, "paths from a light to the eye such as L(D|S)*E",
             "an expression that also matches nothing");
    for (const PathPosition& position : expression.positions)
        for (const int next : position.following) {
            if (expression.positions[size_t(next)].is_eye)
                fail_at(text, expression.positions[size_t(next)].column,
                        "the eye only once, at one end of a path");
            if (position.kinds)
                fail_at(text, position.column, "a light only once, at one end of a path");
        }
    const auto check = [&](const std::vector<int>& ends, bool at_eye, const char* verb) {
        for (auto p = ends.rbegin(); p != ends.rend(); ++p) {
            const PathPosition& position = expression.positions[size_t(*p)];
            if (at_eye ? !position.is_eye : !position.kinds)
                fail(text, position.column,
                     fmt::format("every path to {} with {}", verb, at_eye ? "the eye (E)" : LIGHTS),
                     fmt::format("one that {}s with '{}'", verb, text[position.column]));
        }
    };
    check(whole.first, from_eye, "start");
    check(whole.last, !from_eye, "end");
}

} // namespace

PathExpression parse_path_expression(const std::string& text) {
    if (text.size() > LONGEST_PATH_EXPRESSION)
        throw UsageError(fmt::format("expected an expression of at most {} characters, found {}",
                                     LONGEST_PATH_EXPRESSION, text.size()));
    Reader reader(text);
    const Part whole = reader.read();
    PathExpression expression{text, std::move(reader.positions), {}};

    // Read it from the eye, whichever way it is written: the first letter tells.
    const bool from_eye = expression.positions.front().is_eye;
    if (!from_eye)
        reverse(expression.positions);
    check_ends(whole, expression, from_eye);
    expression.eyes = from_eye ? whole.first : whole.last;

    // Without G, matte stands for all that is not specular.
    const bool has_glossy = std::any_of(expression.positions.begin(), expression.positions.end(),
                                        [](const PathPosition& p) { return p.letters == GLOSSY; });
    for (PathPosition& position : expression.positions)
        if (!has_glossy && position.letters == MATTE)
            position.letters |= GLOSSY;
    return expression;
}

} // namespace clrt
