// SPDX-License-Identifier: Apache-2.0
// The measured BRDFs of a scene, each file once, as the kernels read them.
#pragma once

#include "scene/material_description.h"
#include "scene/notices.h"

#include <map>
#include <string>
#include <vector>

namespace clrt {

/// From this albedo on a BRDF is said to reflect more than it gets: what is above 1 by less may be rounding.
constexpr double MEASURED_LARGEST_ALBEDO = 1.01;

class MeasuredStore {
public:
    /// Reads a file (find_file.h) and returns its index; the same file again is not read again. Notes values
    /// that are missing and an albedo above 1, which stay as they were measured. Throws SceneError for a
    /// file that is not there or no measured BRDF, and where all together are too large for their indices.
    u32 add(const MeasuredUse& use, NoticeList& notices);

    /// Moves all of them into the scene, their files' names too.
    void take(Scene& scene);

private:
    u32 store(const MeasuredUse& use, const std::string& path, NoticeList& notices);

    std::vector<MeasuredBrdf> measured_;
    std::vector<u32> words_;
    std::vector<std::string> names_, paths_;
    std::map<std::string, u32> index_; // of a path
};

} // namespace clrt
