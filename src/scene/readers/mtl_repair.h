// SPDX-License-Identifier: Apache-2.0
// What the writer of a material meant -> the same said in the words of the MTL table (mtl_rules.h). The
// repairs are one table; --mtl plain leaves it out.
#pragma once

#include "scene/notices.h"
#include "scene/readers/mtl_reader.h"

#include <map>
#include <string>

namespace clrt {

/// Applies every repair whose condition holds, each with one notice (file:line) and its name in `repairs`.
MtlMaterial repair_material(const MtlMaterial& mtl, const PictureFacts& maps, NoticeList& notices);

/// Notes which program wrote each library, where its header says so.
void note_writers(const std::map<std::string, MtlMaterial>& library, NoticeList& notices);

} // namespace clrt
