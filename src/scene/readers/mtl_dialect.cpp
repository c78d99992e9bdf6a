// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/mtl_dialect.h"

#include "scene/text_scanner.h"

#include <algorithm>
#include <cctype>

namespace clrt {
namespace {

struct Mark {
    const char* text; ///< lower case; whole words of the header
    const char* name;
};
/// Writers that only the log tells apart.
constexpr Mark MARKS[] = {
    {"3ds max", "3ds Max"},   {"maya", "Maya"},     {"meshlab", "MeshLab"},
    {"sketchup", "SketchUp"}, {"assimp", "assimp"}, {"open asset import library", "assimp"},
};

bool is_word_character(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

/// Whether a text holds these words with no letter or digit at their ends.
bool holds_words(std::string_view text, std::string_view words) {
    for (size_t at = text.find(words); at != std::string_view::npos; at = text.find(words, at + 1)) {
        const size_t end = at + words.size();
        if ((at == 0 || !is_word_character(text[at - 1])) &&
            (end == text.size() || !is_word_character(text[end])))
            return true;
    }
    return false;
}

/// "Blender 5.0.1 MTL File: ..." with its version, "Blender MTL File: ..." or "Blender3D MTL File: ..."
/// without one.
MtlWriter blender_of(std::string_view comment) {
    std::string_view rest = comment;
    const std::string_view program = next_word(rest);
    if (program != "Blender" && program != "Blender3D")
        return {};
    std::string_view word = next_word(rest);
    const std::string version(word == "MTL" ? std::string_view() : word);
    if (!version.empty())
        word = next_word(rest);
    if (word != "MTL" || next_word(rest).substr(0, 4) != "File")
        return {};
    return version.empty() ? MtlWriter{MtlDialect::BLENDER_PYTHON, "Blender before 3.1"}
                           : MtlWriter{MtlDialect::BLENDER, "Blender " + version};
}

MtlWriter writer_of(std::string_view comment) {
    const MtlWriter blender = blender_of(comment);
    if (is_blender(blender.dialect))
        return blender;
    std::string lower(comment);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    for (const Mark& mark : MARKS)
        if (holds_words(lower, mark.text))
            return {MtlDialect::PLAIN, mark.name};
    return {};
}

} // namespace

MtlWriter find_mtl_writer(std::string_view text) {
    text = without_byte_order_mark(text);
    while (!text.empty()) {
        const size_t end = std::min(text.find_first_of("\r\n"), text.size());
        std::string_view line = trim(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.empty())
            continue;
        if (line[0] != '#')
            break;
        line.remove_prefix(std::min(line.find_first_not_of('#'), line.size()));
        const MtlWriter writer = writer_of(trim(line));
        if (!writer.name.empty())
            return writer;
    }
    return {};
}

} // namespace clrt
