// SPDX-License-Identifier: Apache-2.0
// The values of options: text -> numbers, vectors, sizes, durations, names, paths. Every function throws
// UsageError that names the option, the value found and what was expected.
#pragma once

#include "options/names.h"
#include "options/options.h"

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace clrt {

/// One value as the user wrote it, and where.
struct OptionValue {
    std::string option;           ///< its long name with dashes
    std::string text;             ///< empty for a flag
    std::string origin;           ///< "scene.clrt:3: ", or empty for the command line
    std::filesystem::path folder; ///< where relative paths start; empty: the current folder
};

/// Throws UsageError "option --spp: expected a whole number ..., found 'x'".
[[noreturn]] void reject_value(const OptionValue& value, const std::string& expected);

/// Tests a number; one of the predicates below or a lambda.
using Accept = bool (*)(double);
inline bool any_number(double) {
    return true;
}
inline bool positive(double x) {
    return x > 0;
}
inline bool not_negative(double x) {
    return x >= 0;
}

/// A finite number that float can hold, in C notation, and that `accept` accepts.
double parse_number(const OptionValue& value, const std::string& expected, Accept accept = any_number);

/// A whole number from `low` to `high`.
std::int64_t parse_whole(const OptionValue& value, std::int64_t low, std::int64_t high);

/// Between `least` and `most` finite numbers separated by commas.
std::vector<double> parse_numbers(const OptionValue& value, size_t least, size_t most,
                                  const std::string& expected);

/// Three numbers separated by commas.
glm::dvec3 parse_vector(const OptionValue& value, const std::string& expected);

/// A picture size "800x600": 1 to 65535 pixels a side.
glm::ivec2 parse_size(const OptionValue& value);

/// A window "x0,y0,x1,y1" in pixels, not empty, no negative corner.
Crop parse_crop(const OptionValue& value);

/// A pixel "x,y" from the top left.
glm::ivec2 parse_pixel(const OptionValue& value);

/// A duration above 0 in seconds: "90", "90s", "5m", "1.5h".
double parse_duration(const OptionValue& value);

/// A number from 0 to 1: "0.02" or "2%".
double parse_fraction(const OptionValue& value);

/// A path, put in front of which is the options file's folder if it is relative. Not empty.
std::string parse_path(const OptionValue& value);

/// The same for a result, which may go to the standard output (standard_streams.h).
std::string parse_result(const OptionValue& value);

/// Whether the text starts with a number and a comma or is a number: then it is meant as numbers, not as a
/// file name.
bool looks_like_numbers(const std::string& text);

/// The text without spaces, tabs and the returns of Windows' lines around it.
std::string trimmed(const std::string& text);

/// The parts of "a,b,c"; blanks around them are dropped. "" has one empty part.
std::vector<std::string> split_list(const std::string& text);

/// "a, b or c".
std::string alternatives(const std::vector<std::string>& texts);

/// A value of an enum by its name (options/names.h).
template <typename T>
T parse_choice(const OptionValue& value) {
    if (const std::optional<T> found = find_named<T>(value.text))
        return *found;
    std::vector<std::string> names;
    for (const auto& row : NAMES<T>)
        names.emplace_back(row.name);
    reject_value(value, alternatives(names));
}

} // namespace clrt
