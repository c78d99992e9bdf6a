// SPDX-License-Identifier: Apache-2.0
#include "replay/replay_command.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace clrt {

namespace {

/// Options that say what is written and when; a replay writes none of it.
constexpr const char* WRITTEN[] = {"--output=", "--stats=", "--checkpoint=", "--save-every=", "--check="};

bool is_written(const std::string& word) {
    return std::any_of(std::begin(WRITTEN), std::end(WRITTEN), [&](const char* option) {
        return word.compare(0, std::string(option).size(), option) == 0;
    });
}

} // namespace

std::string shell_text(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) {
        std::string quoted;
        for (const char c : word)
            quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
        const bool plain =
            !word.empty() && word.find_first_of(" \t\n'\"\\$&|;<>()*?[]{}!`~#") == std::string::npos;
        text += (text.empty() ? "" : " ") + (plain ? word : "'" + quoted + "'");
    }
    return text;
}

std::string replay_command(const Options& options, const SampleAddress& address) {
    const u32 width = u32(options.film.size.x);
    std::vector<std::string> words{"clrt",
                                   fmt::format("--pixel={},{}", address.pixel % width, address.pixel / width),
                                   fmt::format("--sample={}", address.sample)};
    for (size_t i = 1; i < options.run.resumable_command.size(); ++i)
        if (options.run.resumable_command[i] != "--" && !is_written(options.run.resumable_command[i]))
            words.push_back(options.run.resumable_command[i]);
    // What pilots have chosen.
    if (options.transport.light_samples > 1 && options.run.given.count("--light-samples") == 0)
        words.insert(words.begin() + 3, fmt::format("--light-samples={}", options.transport.light_samples));
    // A scene may start with a dash.
    if (!options.scene.path.empty() && options.scene.path[0] == '-')
        words.insert(words.end() - 1, "--");
    return shell_text(words);
}

} // namespace clrt
