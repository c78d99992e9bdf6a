// SPDX-License-Identifier: Apache-2.0
// What the keys of an MTL material mean, said in the renderer's terms. The rules are one table and the
// functions beside it.
#pragma once

#include "scene/material_description.h"
#include "scene/notices.h"
#include "scene/readers/mtl_reader.h"

#include <string>
#include <vector>

namespace clrt {

/// From this Ns on the reflection of illum 3 and 8 is a perfect mirror, as exporters write it.
constexpr double MIRROR_NS = 1000;

/// Up to this roughness `whitted` follows the reflection of a metallic-roughness material as a mirror's.
constexpr double WHITTED_MIRROR_PR = 0.1;

/// A row of the table: a line of MTL that selects it, and what it makes.
struct MaterialRow {
    std::string keys, text;
};
std::vector<MaterialRow> material_rows();

/// Gives a material the meaning that the table has for its keys. `notices` gets what is odd about emission
/// and coverage; what is odd about the surface becomes its remarks.
MaterialDescription describe_mtl(const MtlMaterial& mtl, NoticeList& notices);

} // namespace clrt
