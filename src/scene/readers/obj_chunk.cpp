// SPDX-License-Identifier: Apache-2.0
// The statements of OBJ text, one function each; a function returns what is wrong, or nothing.
#include "scene/readers/obj_chunk.h"

#include "scene/readers/coordinate.h"
#include "scene/text_scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace clrt {

namespace {

using namespace std::string_view_literals;

constexpr std::string_view CURVE_KEYWORDS[] = {"vp",   "deg",   "bmat", "step", "cstype",
                                               "curv", "curv2", "surf", "parm", "trim",
                                               "hole", "scrv",  "sp",   "end",  "con"};

bool is_end(std::string_view word) {
    return word.empty() || word[0] == '#';
}

/// Takes up to `wanted` numbers off `rest`, `needed` of them at least.
template <typename T>
std::string parse_numbers(std::string_view keyword, std::string_view& rest, int needed, int wanted,
                          T* numbers) {
    for (int i = 0; i < wanted; ++i) {
        const std::string_view word = next_word(rest);
        if (is_end(word)) {
            if (i >= needed)
                return {};
            return "expected " + std::to_string(needed) + (needed == 1 ? " number" : " numbers") + " after " +
                   std::string(keyword) + ", found " + std::to_string(i);
        }
        if (!parse_number(word, numbers[i]))
            return "expected a number after " + std::string(keyword) + ", found " + quoted(word);
    }
    return {};
}

/// Reads an index and moves `at` behind it; beyond 31 bits it saturates (and never looks absent).
bool parse_index(const char*& at, const char* end, i32& index) {
    if (end - at > 1 && at[0] == '+' && at[1] != '-')
        ++at;
    const bool negative = at != end && *at == '-';
    const auto [stop, error] = std::from_chars(at, end, index);
    if (error == std::errc::invalid_argument)
        return false;
    at = stop;
    if (error == std::errc::result_out_of_range || index == ABSENT_INDEX)
        index = negative ? ABSENT_INDEX + 1 : std::numeric_limits<i32>::max();
    return true;
}

/// Reads v, v/t, v//n or v/t/n.
bool parse_corner(std::string_view word, ObjCorner& corner) {
    const char* at = word.data();
    const char* const end = at + word.size();
    if (!parse_index(at, end, corner.v))
        return false;
    for (i32* index : {&corner.t, &corner.n}) {
        if (at == end)
            return true;
        if (*at++ != '/')
            return false;
        const bool empty = at == end || *at == '/';
        if (!empty && !parse_index(at, end, *index))
            return false;
    }
    return at == end;
}

std::string parse_face(std::string_view rest, size_t line, ObjChunk& chunk) {
    const size_t first = chunk.corners.size();
    std::string oversized;
    for (std::string_view word = next_word(rest); !is_end(word); word = next_word(rest)) {
        ObjCorner corner;
        if (!parse_corner(word, corner))
            return "expected a corner v, v/t, v//n or v/t/n with whole numbers after f, found " +
                   quoted(word);
        if (corner.v == std::numeric_limits<i32>::max() || corner.v == ABSENT_INDEX + 1)
            if (oversized.empty())
                oversized = quoted(word.substr(0, word.find('/')));
        chunk.corners.push_back(corner);
    }
    if (chunk.corners.size() - first < 3) {
        chunk.tallies[FEW_CORNERS].add(line);
        return {};
    }
    if (chunk.oversized_index.empty())
        chunk.oversized_index = std::move(oversized);
    chunk.faces.push_back({first, chunk.corners.size(), u32(line), u32(chunk.positions.size()),
                           u32(chunk.uvs.size()), u32(chunk.normals.size())});
    return {};
}

/// Three more numbers behind a position are its colour; one alone is a weight.
bool parse_colour(std::string_view rest, glm::vec3& colour) {
    for (int c = 0; c < 3; ++c)
        if (const std::string_view word = next_word(rest); is_end(word) || !parse_number(word, colour[c]))
            return false;
    return true;
}

std::string parse_position(std::string_view rest, size_t line, ObjChunk& chunk) {
    glm::dvec3 p(0);
    std::string error = parse_numbers("v", rest, 3, 3, &p.x);
    p = {as_coordinate(p.x), as_coordinate(p.y), as_coordinate(p.z)};
    chunk.has_non_finite_position |= !(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    if (glm::vec3 colour; !rest.empty() && parse_colour(rest, colour)) {
        if (chunk.colours.empty())
            chunk.first_colour_line = line;
        chunk.colours.resize(chunk.positions.size(), NO_COLOUR);
        chunk.colours.push_back(colour);
    }
    chunk.positions.push_back(p);
    return error;
}

/// A smoothing group that goes on is not noted again: some writers repeat it before every face.
void parse_smoothing(std::string_view rest, size_t line, ObjChunk& chunk) {
    const std::string_view name = next_word(rest);
    if (chunk.smoothings.empty() || chunk.smoothings.back().name != name)
        chunk.smoothings.push_back({std::string(name), line, chunk.faces.size()});
}

std::string parse_statement(std::string_view text, size_t line, ObjChunk& chunk) {
    std::string_view rest = text;
    const std::string_view keyword = next_word(rest);
    const auto add_name = [&](std::vector<ObjName>& names) {
        names.push_back({std::string(trim(rest)), line, chunk.faces.size()});
    };
    if (keyword == "v"sv)
        return parse_position(rest, line, chunk);
    if (keyword == "f"sv)
        return parse_face(rest, line, chunk);
    if (keyword == "vn"sv)
        return parse_numbers(keyword, rest, 3, 3, &chunk.normals.emplace_back(0.0f).x);
    if (keyword == "vt"sv)
        return parse_numbers(keyword, rest, 1, 2, &chunk.uvs.emplace_back(0.0f).x);
    if (keyword == "usemtl"sv)
        add_name(chunk.materials);
    else if (keyword == "o"sv || keyword == "g"sv)
        add_name(chunk.groups);
    else if (keyword == "mtllib"sv)
        add_name(chunk.libraries);
    else if (keyword == "l"sv)
        chunk.tallies[LINES].add(line);
    else if (keyword == "p"sv)
        chunk.tallies[POINTS].add(line);
    else if (std::find(std::begin(CURVE_KEYWORDS), std::end(CURVE_KEYWORDS), keyword) !=
             std::end(CURVE_KEYWORDS))
        chunk.tallies[CURVES].add(line);
    else if (keyword == "s"sv)
        parse_smoothing(rest, line, chunk);
    else {
        if (chunk.tallies[UNKNOWN_STATEMENTS].count == 0)
            chunk.unknown_keyword = quoted(keyword);
        chunk.tallies[UNKNOWN_STATEMENTS].add(line);
    }
    return {};
}

} // namespace

ObjChunk parse_obj_chunk(std::string_view text) {
    ObjChunk chunk;
    LineReader lines(text, 0);
    while (chunk.error.empty() && lines.next()) {
        chunk.error = parse_statement(lines.text(), lines.number(), chunk);
        chunk.error_line = lines.number();
    }
    chunk.line_ends = lines.line_ends();
    if (!chunk.colours.empty())
        chunk.colours.resize(chunk.positions.size(), NO_COLOUR);
    return chunk;
}

} // namespace clrt
