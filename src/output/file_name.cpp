// SPDX-License-Identifier: Apache-2.0
#include "output/file_name.h"

#include "error.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fmt/format.h>

namespace clrt {
namespace {

/// Digits that {word:digits} can ask for; file names end at 255 bytes.
constexpr size_t MOST_DIGITS = 20;

[[noreturn]] void reject(const std::string& found) {
    throw UsageError(
        fmt::format("expected {} in braces, {{{{ and }}}} for braces, found '{}'", NAME_PLACEHOLDERS, found));
}

/// A word in braces, and how many digits it shall have.
struct Placeholder {
    std::string word;
    size_t digits = 1;
};

/// From what stands between the braces.
Placeholder read_placeholder(const std::string& text) {
    const size_t colon = text.find(':');
    Placeholder placeholder{text.substr(0, colon)};
    if (colon == std::string::npos)
        return placeholder;
    const std::string digits = text.substr(colon + 1);
    const bool is_number =
        !digits.empty() && digits.size() <= 2 &&
        std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c); });
    placeholder.digits = is_number ? std::stoul(digits) : 0;
    if (placeholder.digits < 1 || placeholder.digits > MOST_DIGITS)
        reject("{" + text + "}");
    return placeholder;
}

/// The name with value_of(word) in the place of each placeholder.
template <class ValueOf>
std::string expand(const std::string& name, const ValueOf& value_of) {
    std::string result;
    for (size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        if (c != '{' && c != '}') {
            result += c;
            continue;
        }
        if (i + 1 < name.size() && name[i + 1] == c) { // doubled: itself
            result += c;
            ++i;
            continue;
        }
        const size_t end = c == '{' ? name.find('}', i) : std::string::npos;
        if (end == std::string::npos)
            reject(name.substr(i));
        const Placeholder placeholder = read_placeholder(name.substr(i + 1, end - i - 1));
        const std::string number = fmt::format("{}", value_of(placeholder.word));
        result += std::string(placeholder.digits - std::min(placeholder.digits, number.size()), '0') + number;
        i = end;
    }
    return result;
}

} // namespace

std::string expand_file_name(const std::string& name, const NameValues& values) {
    return expand(name, [&](const std::string& word) -> std::uint64_t {
        if (word == "seed")
            return values.seed;
        if (word == "spp")
            return values.spp;
        if (word == "frame")
            return std::uint64_t(values.frame);
        reject("{" + word + "}");
    });
}

std::string literal_file_name(const std::string& name) {
    std::string result;
    for (const char c : name)
        result.append(c == '{' || c == '}' ? 2 : 1, c);
    return result;
}

bool names_frame(const std::string& name) {
    return expand_file_name(name, {0, 0, 1}) != expand_file_name(name, {0, 0, 2});
}

std::string with_frame_number(const std::string& name) {
    if (names_frame(name))
        return name;
    const std::string extension = std::filesystem::path(name).extension().string();
    return name.substr(0, name.size() - extension.size()) + "-{frame:4}" + extension;
}

} // namespace clrt
