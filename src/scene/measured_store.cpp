// SPDX-License-Identifier: Apache-2.0
#include "scene/measured_store.h"

#include "error.h"
#include "half_float.h"
#include "scene/find_file.h"
#include "scene/measured_sampling.h"
#include "scene/readers/merl_reader.h"
#include "scene/text_scanner.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

/// A power of two above which no value is 2^15 or more, so that all are finite halves.
float scale_of(const MeasuredValues& table) {
    float largest = 0;
    for (const glm::vec3& value : table.values)
        largest = std::max({largest, value.x, value.y, value.z});
    return largest > 0 ? std::ldexp(1.f, std::ilogb(largest) - 14) : 1;
}

/// Of the BRDF and its values, a multiple of four words.
std::vector<u32> words_of(const MeasuredBrdf& measured, const MeasuredValues& table) {
    constexpr size_t FIRST = sizeof measured / sizeof(u32);
    const size_t halves = 3 * table.values.size();
    std::vector<u32> words((FIRST + (halves + 1) / 2 + 3) / 4 * 4, 0);
    std::memcpy(words.data(), &measured, sizeof measured);
    for (size_t i = 0; i < halves; ++i)
        words[FIRST + i / 2] |= to_half(table.values[i / 3][int(i % 3)] / measured.scale) << (i % 2 * 16);
    return words;
}

double largest_view_albedo(const MeasuredBrdf& measured) {
    double largest = 0;
    for (const MeasuredView& view : measured.views)
        largest = std::max({largest, double(view.albedo.x), double(view.albedo.y), double(view.albedo.z)});
    return largest;
}

} // namespace

u32 MeasuredStore::add(const MeasuredUse& use, NoticeList& notices) {
    const auto path = find_file(use.file, use.place.file);
    if (!path)
        throw SceneError(use.place.file, use.place.line,
                         fmt::format("merl: expected the file of a measured BRDF, found none called {}",
                                     clrt::quoted(use.file)));
    const auto known = first_words_.find(*path);
    return known != first_words_.end() ? known->second : store(use, *path, notices);
}

u32 MeasuredStore::store(const MeasuredUse& use, const std::string& path, NoticeList& notices) {
    const MeasuredValues table = parse_merl(read_file(path), path);
    if (table.missing > 0)
        notices.add(fmt::format("measured BRDF {}: {} of {} values are missing and taken as 0",
                                clrt::quoted(use.file), table.missing, table.values.size()),
                    use.place);
    MeasuredBrdf measured{};
    measured.half_count = table.half_count;
    measured.difference_count = table.difference_count;
    measured.azimuth_count = table.azimuth_count;
    measured.scale = scale_of(table);
    tbb::parallel_for(0u, MEASURED_VIEWS, [&](u32 i) { measured.views[i] = sample_measured(table, i); });
    if (const double albedo = largest_view_albedo(measured); albedo > MEASURED_LARGEST_ALBEDO)
        notices.add(fmt::format("measured BRDF {}: reflects up to {:.3g} times the light that it gets, as "
                                "measured; closed rooms of it may grow too bright",
                                clrt::quoted(use.file), albedo),
                    use.place);
    const std::vector<u32> words = words_of(measured, table);
    if (words_.size() + words.size() > std::numeric_limits<u32>::max())
        throw SceneError(use.place.file, use.place.line,
                         fmt::format("merl: expected measured BRDFs of less than 16 GiB in all, found more "
                                     "with {}",
                                     clrt::quoted(use.file)));
    const u32 first_word = u32(words_.size());
    words_.insert(words_.end(), words.begin(), words.end());
    names_[first_word] = use.file;
    return first_words_[path] = first_word;
}

void MeasuredStore::take(Scene& scene) {
    for (const auto& [path, first_word] : first_words_)
        scene.files.push_back({"the measured BRDF", path});
    scene.measured = std::move(words_);
    scene.measured_names = std::move(names_);
}

MeasuredBrdf measured_at(const std::vector<u32>& words, u32 first_word) {
    MeasuredBrdf measured;
    std::memcpy(static_cast<void*>(&measured), &words[first_word], sizeof measured);
    return measured;
}

} // namespace clrt
