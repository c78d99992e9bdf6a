// SPDX-License-Identifier: Apache-2.0
// What a run does and how it talks.
#pragma once

#include "options/names.h"
#include "options/toggle.h"
#include <cstdint>
#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

enum class Check { OFF, COUNT, STRICT };

template <>
inline constexpr Named<Check> NAMES<Check>[] = {
    {Check::OFF, "off"}, {Check::COUNT, "count"}, {Check::STRICT, "strict"}};
enum class Explain { NO, TABLE, JSON };
/// What a ledger prices: effects that the picture shows, or the code of those that it does not.
enum class LedgerOf { NOTHING, SHOWN, ABSENT };

struct RunOptions {
    bool list_devices = false;
    Explain explain = Explain::NO;
    LedgerOf ledger = LedgerOf::NOTHING; ///< measure what effects cost and give; no picture
    Check check = Check::COUNT;
    std::optional<glm::ivec2> pixel; ///< replay a sample of it; no picture
    std::uint32_t sample = 0;        ///< which one
    Toggle progress = Toggle::AUTO;
    int verbosity = 0; ///< -1 quiet, 0, 1 verbose
    bool no_sidecar = false;
    std::string sidecar_path; ///< options file that was read; empty: none
    /// The options that were given, by their long names: "file:line" in an options file, empty on the command
    /// line.
    std::map<std::string, std::string> given;
    std::vector<std::string> command; ///< argv as given, for the metadata
    /// The command line that a film file keeps for --resume: without --resume, with what that took from its
    /// film.
    std::vector<std::string> resumable_command;
};

} // namespace clrt
