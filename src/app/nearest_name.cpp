// SPDX-License-Identifier: Apache-2.0
// "Did you mean": edit distance between a mistyped name and the known ones.
#include "app/nearest_name.h"

#include <algorithm>
#include <cassert>

namespace clrt {

namespace {

bool starts_with(const std::string& name, const std::string& start) {
    return name.compare(0, start.size(), start) == 0;
}

} // namespace

int edit_distance(const std::string& a, const std::string& b) {
    // distance[i][j] turns the first i letters of a into the first j letters of b.
    std::vector<std::vector<int>> distance(a.size() + 1, std::vector<int>(b.size() + 1));
    for (size_t i = 0; i <= a.size(); ++i)
        distance[i][0] = static_cast<int>(i);
    for (size_t j = 0; j <= b.size(); ++j)
        distance[0][j] = static_cast<int>(j);
    for (size_t i = 1; i <= a.size(); ++i)
        for (size_t j = 1; j <= b.size(); ++j) {
            const int replaced = distance[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            distance[i][j] = std::min({distance[i - 1][j] + 1, distance[i][j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                distance[i][j] = std::min(distance[i][j], distance[i - 2][j - 2] + 1);
        }
    return distance[a.size()][b.size()];
}

std::string nearest_name(const std::string& typed, const std::vector<std::string>& known) {
    assert(!known.empty());
    const auto distance = [&](const std::string& name) {
        return starts_with(name, typed) ? -1 : edit_distance(typed, name);
    };
    return *std::min_element(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
        return distance(a) < distance(b);
    });
}

bool is_misspelling(const std::string& typed, const std::string& name) {
    const size_t dashes = std::min(typed.find_first_not_of('-'), typed.size());
    const size_t letters = typed.size() - dashes;
    if (letters < 2) // one letter is near to everything
        return false;
    return starts_with(name, typed) || size_t(edit_distance(typed, name)) <= (letters + 2) / 3;
}

} // namespace clrt
