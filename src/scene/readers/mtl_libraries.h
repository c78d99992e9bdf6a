// SPDX-License-Identifier: Apache-2.0
// The mtllib statements of an OBJ -> its materials by name.
#pragma once

#include "scene/readers/mtl_reader.h"
#include "scene/readers/obj_reader.h"

#include <map>
#include <string>
#include <vector>

namespace clrt {

/// Reads all libraries. The text after mtllib is one name with spaces or several names: the longest run of
/// words that names a file is taken first. A name defined twice keeps its first definition, as in the MTL
/// specification's search order and in tinyobjloader. What is missing or defined twice is a notice. The
/// libraries that are read are added to `files`.
std::map<std::string, MtlMaterial> read_mtl_libraries(const std::string& obj_path,
                                                      const std::vector<ObjLibrary>& libraries,
                                                      NoticeList& notices, std::vector<NamedFile>& files);

/// The library files of one mtllib statement that exist, in order; what is missing is one notice.
std::vector<std::string> find_libraries(const std::string& obj_path, const ObjLibrary& library,
                                        NoticeList& notices);

} // namespace clrt
