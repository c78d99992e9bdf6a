// SPDX-License-Identifier: Apache-2.0
// A piece of an OBJ file -> its statements, with the indices of faces as they were written.
#pragma once

#include "kernels/shared/types.h"

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace clrt {

/// The index of a corner that gives none (0 is an index, if a wrong one).
constexpr i32 ABSENT_INDEX = std::numeric_limits<i32>::min();

/// The colour of a vertex that gives none.
constexpr glm::vec3 NO_COLOUR(std::numeric_limits<float>::quiet_NaN());

/// The indices of a face's corner: from 1, or negative and counting back from the element before the face.
struct ObjCorner {
    i32 v = ABSENT_INDEX, t = ABSENT_INDEX, n = ABSENT_INDEX;
};

/// How many elements of each kind there are.
struct ObjCounts {
    size_t positions = 0, uvs = 0, normals = 0;
};

/// A face with three corners or more.
struct ObjFace {
    size_t first_corner, end_corner; ///< into ObjChunk::corners
    u32 line;                        ///< in the chunk, from 0
    u32 positions, uvs, normals;     ///< elements of the chunk before this face
};

/// A usemtl, o, g, mtllib or s statement: the rest of its line.
struct ObjName {
    std::string name;
    size_t line = 0; ///< in the chunk, from 0
    size_t face = 0; ///< the first face of the chunk that comes after it
};

/// What is left out or put right, and reported in one notice a kind.
enum ObjOddity {
    POINTS,
    LINES,
    CURVES,
    UNKNOWN_STATEMENTS,
    FEW_CORNERS,
    NON_FINITE_FACES,
    UV_OUT_OF_RANGE,
    NORMAL_OUT_OF_RANGE,
    CRUDE_CUTS,
    ODDITY_KINDS
};

/// How often something was met, and where first.
struct Tally {
    size_t count = 0, first_line = 0;

    /// Counts one more; lines must come in ascending order.
    void add(size_t line) {
        if (count++ == 0)
            first_line = line;
    }
};
using Tallies = std::array<Tally, ODDITY_KINDS>;

/// Everything a piece of text says, and the first thing in it that is wrong.
struct ObjChunk {
    std::vector<glm::dvec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> uvs;
    std::vector<glm::vec3> colours; ///< as written, of each position, NaN for none; empty if none has any
    std::vector<ObjCorner> corners;
    std::vector<ObjFace> faces;
    std::vector<ObjName> materials, groups, libraries;
    std::vector<ObjName> smoothings; ///< s statements: their first words
    Tallies tallies;                 ///< lines in the chunk, from 0
    std::string unknown_keyword;     ///< of the first unknown statement
    std::string oversized_index;     ///< the first vertex index beyond 31 bits as written; stored saturated
    bool has_non_finite_position = false;
    size_t first_colour_line = 0; ///< of the first position with a colour
    size_t line_ends = 0;
    std::string error; ///< what is wrong in error_line, where reading stopped; empty if nothing is
    size_t error_line = 0;
};

/// Reads a text that starts and ends between statements. Never throws for what the text says.
ObjChunk parse_obj_chunk(std::string_view text);

} // namespace clrt
