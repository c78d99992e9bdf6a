// SPDX-License-Identifier: Apache-2.0
// Every option once. The order is the order of --help.
#include "app/option_table.h"

#include "app/nearest_name.h"
#include "app/option_rows.h"
#include "app/peer_names.h"
#include "error.h"

namespace clrt {

const std::vector<OptionSpec>& option_table() {
    static const std::vector<OptionSpec> table = [] {
        std::vector<OptionSpec> all;
        for (const auto& group : {work_options(), picture_options(), camera_options(), light_options(),
                                  promise_options(), run_options()})
            all.insert(all.end(), group.begin(), group.end());
        return all;
    }();
    return table;
}

const OptionSpec* find_option(const std::string& long_name) {
    for (const OptionSpec& spec : option_table())
        if (long_name == spec.long_name)
            return &spec;
    return nullptr;
}

const std::vector<std::pair<std::string, std::string>>& exclusive_options() {
    static const std::vector<std::pair<std::string, std::string>> pairs = {
        {"--quiet", "--verbose"},
        {"--cache", "--no-cache"},
        {"--error", "--denoised-error"},
        {"--fov", "--focal-length"},
        {"--fov", "--film-width"},
        {"--pixel", "--explain"},
        {"--pixel", "--ledger"},
        {"--eye", "--view"},
        {"--aperture", "--fstop"},
        {"--fov", "--ortho-height"},
        {"--focal-length", "--ortho-height"},
        {"--film-width", "--ortho-height"},
        {"--env", "--sky"},
        {"--env-rotate", "--sky"}, // its azimuth turns it
    };
    return pairs;
}

void reject_unknown_option(const std::string& origin, const std::string& given) {
    const std::string advice = "`clrt --help` lists all";
    const std::string name = given.substr(0, given.find('='));
    const std::string start = origin + "unknown option " + name + "; ";
    if (const std::string here = name_here(name); !here.empty())
        throw UsageError(start + "clrt calls it " + here + ", and " + advice);
    std::vector<std::string> known;
    for (const OptionSpec& spec : option_table())
        known.emplace_back(spec.long_name);
    const std::string nearest = nearest_name(name, known);
    if (!is_misspelling(name, nearest))
        throw UsageError(start + advice);
    throw UsageError(start + "the nearest is " + nearest + ", and " + advice);
}

} // namespace clrt
