// SPDX-License-Identifier: Apache-2.0
// STEM.clrt -> given options, with their file and line.
#include "app/options_file.h"

#include "app/option_values.h"
#include "error.h"

#include <filesystem>
#include <fstream>

namespace clrt {

namespace {

GivenOption read_line(const std::string& line, const std::string& origin,
                      const std::filesystem::path& folder) {
    if (line.compare(0, 2, "--") != 0)
        throw UsageError(origin + "expected a long option with its dashes such as --spp 64, found '" + line +
                         "'");

    // The name ends at the first blank or '='; the rest, without blanks around it, is the value.
    const size_t end = line.find_first_of(" \t=");
    GivenOption given;
    given.value = {line.substr(0, end), end == std::string::npos ? "" : trimmed(line.substr(end + 1)), origin,
                   folder};
    const std::string& name = given.value.option;
    const bool has_value = !given.value.text.empty();

    given.spec = find_option(name);
    if (!given.spec)
        reject_unknown_option(origin, name);
    if (given.spec->in_file == InFile::NO)
        throw UsageError(origin + "option " + name +
                         " makes sense on the command line only; take the line out");
    if (!is_flag(*given.spec) && !has_value)
        throw UsageError(origin + "option " + name + ": expected a value " + given.spec->value_name +
                         " on the same line, found none");
    if (given.spec->value_name[0] == '\0' && has_value)
        throw UsageError(origin + "option " + name + " takes no value, found '" + given.value.text + "'");
    return given;
}

} // namespace

std::string find_options_file(const std::string& scene_path) {
    std::filesystem::path path(scene_path);
    path.replace_extension(".clrt");
    std::error_code error; // what cannot be looked at counts as absent
    return std::filesystem::is_regular_file(path, error) ? path.string() : "";
}

std::vector<GivenOption> read_options_file(const std::string& path) {
    std::ifstream file(path);
    if (!file)
        throw SceneError(path, 0, "expected a readable options file; --no-sidecar does without it");
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::vector<GivenOption> options;
    std::string text;
    for (size_t number = 1; std::getline(file, text); ++number) {
        if (number == 1 && text.compare(0, 3, "\xEF\xBB\xBF") == 0) // UTF-8 byte order mark of some editors
            text.erase(0, 3);
        const std::string line = trimmed(text);
        if (!line.empty() && line[0] != '#')
            options.push_back(read_line(line, path + ":" + std::to_string(number) + ": ", folder));
    }
    if (file.bad())
        throw SceneError(path, 0, "reading the options file failed");
    return options;
}

} // namespace clrt
