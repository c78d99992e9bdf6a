// SPDX-License-Identifier: Apache-2.0
// Every option once: its names, its help, and how its value enters Options. The command line, the options
// file and --help are all read from this table.
#pragma once

#include "app/option_values.h"

#include <string>
#include <utility>
#include <vector>

namespace clrt {

enum class Repeat { NO, YES };
enum class InFile { NO, YES };

/// One option. A flag has no value name; a value name in "[=x]" is optional and only given with '='.
struct OptionSpec {
    const char* group;      ///< heading in --help
    const char* short_name; ///< "s", or ""
    const char* long_name;  ///< with its dashes
    const char* value_name; ///< "N", "" for a flag, "[=json]" for a flag with an optional value
    std::string help;       ///< meaning, unit and default; one line, wrapped by --help
    void (*apply)(Options&, const OptionValue&);
    Repeat repeat = Repeat::NO;   ///< several values make a list; otherwise the last one counts
    InFile in_file = InFile::YES; ///< makes sense in an options file
};

/// One occurrence of an option on the command line or in an options file.
struct GivenOption {
    const OptionSpec* spec = nullptr;
    OptionValue value;
};

/// The table in the order of --help.
const std::vector<OptionSpec>& option_table();

/// The option with this long name ("--spp"), or null.
const OptionSpec* find_option(const std::string& long_name);

/// Pairs of long names of which one command line or file can hold only one. On the command line, either of
/// them replaces the other one of the options file.
const std::vector<std::pair<std::string, std::string>>& exclusive_options();

/// Throws UsageError "unknown option ..." that names what other renderers' name for it is here, else the
/// nearest option where there is a near one.
[[noreturn]] void reject_unknown_option(const std::string& origin, const std::string& given);

/// Whether the option takes no value, or one only after '='.
inline bool is_flag(const OptionSpec& spec) {
    return spec.value_name[0] == '\0' || spec.value_name[0] == '[';
}

} // namespace clrt
