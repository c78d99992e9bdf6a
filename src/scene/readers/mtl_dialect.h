// SPDX-License-Identifier: Apache-2.0
// The program that wrote a material library, as the comment at its head says: its habits decide what some
// keys mean (mtl_repair.h).
#pragma once

#include <string>
#include <string_view>

namespace clrt {

/// Whose habits a library follows. Only Blender gives keys another meaning; what other programs do wrong
/// shows in the keys themselves.
enum class MtlDialect {
    PLAIN,
    BLENDER_PYTHON, ///< Blender before 3.1: its header has no version
    BLENDER         ///< Blender from 3.1 on
};

struct MtlWriter {
    MtlDialect dialect = MtlDialect::PLAIN;
    std::string name; ///< "Blender 5.0.1", "3ds Max"; empty: unknown
};

/// The writer that the comment lines before the first statement name.
MtlWriter find_mtl_writer(std::string_view text);

inline bool is_blender(MtlDialect dialect) {
    return dialect != MtlDialect::PLAIN;
}

} // namespace clrt
