// SPDX-License-Identifier: Apache-2.0
// What an OBJ holds that is left out or put right, in words.
#pragma once

#include "scene/readers/obj_pieces.h"

#include <string>
#include <vector>

namespace clrt {

/// How often a kind of oddity occurred.
size_t count_oddities(const ObjPieces& pieces, ObjOddity kind);

/// Throws SceneError: what there is in place of faces.
[[noreturn]] void throw_no_faces(const std::string& path, const ObjPieces& pieces, const ObjMesh& mesh);

/// One line for each kind of oddity that occurred: the place of the first, and how many more there are.
std::vector<std::string> make_notices(const std::string& path, const ObjPieces& pieces);

} // namespace clrt
