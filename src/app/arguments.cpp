// SPDX-License-Identifier: Apache-2.0
// argv -> options with their values, and the rest, by CLI11.
#include "app/arguments.h"

#include "error.h"

#include <algorithm>
#include <CLI/CLI.hpp>

namespace clrt {

namespace {

/// CLI11 takes the next argument where "--name=" has nothing behind the '='.
void reject_empty_values(int argc, const char* const* argv) {
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--")
            return;
        if (argument.size() > 3 && argument.compare(0, 2, "--") == 0 &&
            argument.find('=') == argument.size() - 1)
            throw UsageError("option " + argument.substr(0, argument.size() - 1) +
                             ": expected a value after '=', found none");
    }
}

/// CLI11 reads "-spp" as "-s pp", and the next argument as a scene.
void reject_long_names_with_one_dash(int argc, const char* const* argv) {
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument == "--")
            return;
        const std::string name = "-" + argument.substr(0, argument.find('='));
        if (name.size() > 3 && find_option(name))
            throw UsageError("option " + name.substr(1) + ": expected two dashes before a long name, " +
                             name);
    }
}

/// An option's name in the place of a value means that the value was forgotten.
void reject_names_as_values(const GivenOption& given) {
    for (const OptionSpec& spec : option_table()) {
        const std::string short_name = std::string("-") + spec.short_name;
        if (given.value.text == spec.long_name || (spec.short_name[0] && given.value.text == short_name))
            throw UsageError("option " + given.value.option + ": expected a value " + given.spec->value_name +
                             ", found the option " + given.value.text);
    }
}

/// CLI11 hands a flag "true" when it stands alone and its text after '=' otherwise.
void check_flag(GivenOption& given) {
    if (given.value.text == "true")
        given.value.text.clear();
    if (given.spec->value_name[0] == '\0' && !given.value.text.empty())
        throw UsageError("option " + given.value.option + " takes no value, found '" + given.value.text +
                         "'");
}

std::string names_for_cli11(const OptionSpec& spec) {
    const std::string short_part = spec.short_name[0] ? "-" + std::string(spec.short_name) + "," : "";
    return short_part + spec.long_name;
}

} // namespace

Arguments split_arguments(int argc, const char* const* argv) {
    // Declare every option; CLI11 only collects texts.
    CLI::App app;
    app.set_help_flag();
    app.allow_extras();
    const std::vector<OptionSpec>& table = option_table();
    std::vector<std::vector<std::string>> texts(table.size());
    for (size_t i = 0; i < table.size(); ++i)
        if (is_flag(table[i]))
            app.add_flag(names_for_cli11(table[i]), texts[i]);
        else
            app.add_option(names_for_cli11(table[i]), texts[i])
                ->expected(1)
                ->allow_extra_args(false)
                ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    Arguments arguments;
    app.add_option("scene", arguments.scenes);

    reject_empty_values(argc, argv);
    reject_long_names_with_one_dash(argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError&) { // the only one left: the last option lacks its value
        throw UsageError("option " + std::string(argv[argc - 1]) +
                         ": expected a value, found the end of the command "
                         "line");
    }

    for (size_t i = 0; i < table.size(); ++i)
        for (const std::string& text : texts[i])
            arguments.options.push_back({&table[i], {table[i].long_name, text, "", ""}});
    const auto asks_for_text = [](const GivenOption& given) {
        return given.value.option == "--help" || given.value.option == "--version";
    };
    if (std::any_of(arguments.options.begin(), arguments.options.end(), asks_for_text))
        return arguments;

    for (const std::string& rest : app.remaining())
        if (rest != "--")
            reject_unknown_option("", rest);
    for (GivenOption& given : arguments.options)
        if (is_flag(*given.spec))
            check_flag(given);
        else
            reject_names_as_values(given);
    return arguments;
}

} // namespace clrt
