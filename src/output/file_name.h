// SPDX-License-Identifier: Apache-2.0
// Names of outputs that say what is in them: "pot-{seed}-{spp}.png" -> "pot-7-64.png".
#pragma once

#include <cstdint>
#include <string>

namespace clrt {

/// What a name can tell about a picture.
struct NameValues {
    std::uint32_t seed = 0;
    std::uint64_t spp = 0; ///< samples a pixel that are in the picture
    int frame = 0;         ///< of --frames, from 1
};

/// The placeholders, as words for messages.
inline constexpr const char* NAME_PLACEHOLDERS =
    "{seed}, {spp} or {frame}, {frame:4} for four digits at least";

/// Puts values in the place of {seed}, {spp} and {frame}; {frame:4} has four digits at least, zeros in front.
/// {{ and }} are braces. Throws UsageError "expected ..., found ..." for another word in braces and for a
/// single brace.
std::string expand_file_name(const std::string& name, const NameValues& values);

/// The name with its braces doubled: expanding gives it back.
std::string literal_file_name(const std::string& name);

/// Whether the name has a {frame}. Throws UsageError as expand_file_name.
bool names_frame(const std::string& name);

/// "-{frame:4}" before the extension, where the name has no {frame} yet.
std::string with_frame_number(const std::string& name);

} // namespace clrt
