// SPDX-License-Identifier: Apache-2.0
// The measured BRDFs of a scene, each file once, as the kernels read them.
#pragma once

#include "kernels/shared/measured_types.h"
#include "scene/material_description.h"
#include "scene/notices.h"

#include <map>
#include <string>
#include <vector>

namespace clrt {

/// From this albedo on a BRDF is said to reflect more than it gets: what is above 1 by less may be rounding.
constexpr double MEASURED_LARGEST_ALBEDO = 1.01;

/// The BRDF that begins with a word of Scene::measured, without its values.
MeasuredBrdf measured_at(const std::vector<u32>& words, u32 first_word);

class MeasuredStore {
public:
    /// Reads a file (find_file.h) and returns the BRDF's first word; the same file again is not read again.
    /// Notes values that are missing and an albedo above 1, which stay as they were measured. Throws
    /// SceneError for a file that is not there or no measured BRDF, and where all together are too large for
    /// their words to be counted.
    u32 add(const MeasuredUse& use, NoticeList& notices);

    /// Moves all of them into the scene, their files' names too.
    void take(Scene& scene);

private:
    u32 store(const MeasuredUse& use, const std::string& path, NoticeList& notices);

    std::vector<u32> words_;
    std::map<u32, std::string> names_;
    std::map<std::string, u32> first_words_; // of a path
};

} // namespace clrt
