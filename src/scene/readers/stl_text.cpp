// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/stl_text.h"

#include "error.h"
#include "scene/readers/coordinate.h"
#include "scene/text_scanner.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace clrt {

namespace {

/// The words of a text, one after the other, and their lines.
class Words {
public:
    explicit Words(std::string_view text) : lines_(text) {}

    /// The next word; empty at the end of the text.
    std::string_view next() {
        std::string_view word = next_word(rest_);
        while (word.empty() && lines_.next()) {
            rest_ = lines_.text();
            word = next_word(rest_);
        }
        return word;
    }
    /// What is left of the line.
    std::string_view take_line() { return trim(std::exchange(rest_, {})); }
    size_t line() const { return lines_.number(); }

private:
    LineReader lines_;
    std::string_view rest_;
};

bool is_word(std::string_view word, std::string_view lower_case) {
    return std::equal(word.begin(), word.end(), lower_case.begin(), lower_case.end(),
                      [](char a, char b) { return (a >= 'A' && a <= 'Z' ? char(a - 'A' + 'a') : a) == b; });
}

/// Walks over the facets of one text.
class StlText {
public:
    StlText(std::string_view text, const std::string& path, StlMesh& mesh)
        : words_(text), path_(path), mesh_(mesh) {}

    void parse() {
        for (std::string_view word = words_.next(); !word.empty(); word = words_.next())
            if (is_word(word, "solid"))
                parse_solid();
            else
                fail("solid", word);
    }

private:
    [[noreturn]] void fail(std::string_view expected, std::string_view found) const {
        throw SceneError(path_, words_.line(),
                         fmt::format("expected {}, found {}", expected,
                                     found.empty() ? "the end of the file" : clrt::quoted(found)));
    }

    void expect(std::string_view lower_case) {
        if (const std::string_view word = words_.next(); !is_word(word, lower_case))
            fail(lower_case, word);
    }

    double take_number() {
        const std::string_view word = words_.next();
        double value = 0;
        if (!parse_number(word, value))
            fail("a number", word);
        return value;
    }

    glm::dvec3 take_vector() {
        glm::dvec3 v;
        for (int c = 0; c < 3; ++c)
            v[c] = take_number();
        return v;
    }

    /// From behind "solid" to its "endsolid"; names may have blanks.
    void parse_solid() {
        mesh_.begin_object(std::string(words_.take_line()));
        for (;;) {
            const std::string_view word = words_.next();
            if (is_word(word, "endsolid")) {
                words_.take_line();
                return;
            }
            if (!is_word(word, "facet"))
                fail("facet or endsolid", word);
            parse_facet();
        }
    }

    void parse_facet() {
        const size_t line = words_.line();
        expect("normal");
        take_vector();
        expect("outer");
        expect("loop");
        vertices_.clear();
        std::string_view word = words_.next();
        for (; is_word(word, "vertex"); word = words_.next()) {
            const glm::dvec3 p = take_vector();
            vertices_.push_back({as_coordinate(p.x), as_coordinate(p.y), as_coordinate(p.z)});
        }
        if (!is_word(word, "endloop"))
            fail("vertex or endloop", word);
        expect("endfacet");
        mesh_.add_facet(vertices_, {path_, line});
    }

    Words words_;
    const std::string& path_;
    StlMesh& mesh_;
    std::vector<glm::dvec3> vertices_;
};

} // namespace

void parse_stl_text(std::string_view text, const std::string& path, StlMesh& mesh) {
    StlText(text, path, mesh).parse();
}

} // namespace clrt
