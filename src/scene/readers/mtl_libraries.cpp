// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/mtl_libraries.h"

#include "scene/find_file.h"
#include "scene/text_scanner.h"

#include <algorithm>
#include <fmt/format.h>

namespace clrt {
namespace {

/// Some writers put a backslash before each blank of a name.
std::string without_escaped_blanks(std::string_view text) {
    std::string result;
    for (size_t i = 0; i < text.size(); ++i)
        if (text[i] != '\\' || i + 1 == text.size() || text[i + 1] != ' ')
            result += text[i];
    return result;
}

std::optional<std::string> find_library(std::string_view name, const std::string& obj_path,
                                        bool by_base_name) {
    if (const auto path = find_file(name, obj_path, by_base_name))
        return path;
    return find_file(without_escaped_blanks(name), obj_path, by_base_name);
}

/// Where each word of a text begins and ends.
std::vector<std::string_view> words_of(std::string_view text) {
    std::vector<std::string_view> words;
    for (std::string_view word = next_word(text); !word.empty(); word = next_word(text))
        words.push_back(word);
    return words;
}

/// The text from the first to the last of some words, with the blanks between them.
std::string_view span_of(const std::string_view& first, const std::string_view& last) {
    return {first.data(), size_t(last.data() + last.size() - first.data())};
}

} // namespace

std::vector<std::string> find_libraries(const std::string& obj_path, const ObjLibrary& library,
                                        NoticeList& notices) {
    const std::vector<std::string_view> words = words_of(library.names);
    std::vector<std::string> paths;
    std::string missing;
    for (size_t i = 0; i < words.size();) {
        size_t end = words.size();
        std::optional<std::string> path;
        // The longest run of words that is a file. Only a single word may stand for a file beside the OBJ:
        // the last part of a run would hide the names before it.
        for (; end > i && !path; --end)
            path = find_library(span_of(words[i], words[end - 1]), obj_path, end == i + 1);
        if (path) {
            paths.push_back(*path);
            i = end + 1;
        } else {
            missing += (missing.empty() ? "" : " ") + std::string(words[i++]);
        }
    }
    if (paths.empty() && words.size() > 1)
        if (const auto path = find_library(library.names, obj_path, true)) {
            paths.push_back(*path);
            missing.clear();
        }
    if (!missing.empty() || words.empty())
        notices.add_line(
            fmt::format("{}:{}: mtllib: no file {} found", obj_path, library.line, clrt::quoted(missing)));
    return paths;
}

std::map<std::string, MtlMaterial> read_mtl_libraries(const std::string& obj_path,
                                                      const std::vector<ObjLibrary>& libraries,
                                                      NoticeList& notices, std::vector<NamedFile>& files) {
    std::map<std::string, MtlMaterial> by_name;
    std::vector<std::string> seen;
    for (const ObjLibrary& library : libraries)
        for (const std::string& path : find_libraries(obj_path, library, notices)) {
            if (std::find(seen.begin(), seen.end(), path) != seen.end())
                continue; // the same library again, as exporters write it for every object
            seen.push_back(path);
            files.push_back({"the material library", path});
            for (MtlMaterial& material : read_mtl(path, notices)) {
                const SourcePlace place = material.place;
                std::string name = material.name;
                if (!by_name.emplace(name, std::move(material)).second)
                    notices.add(fmt::format("newmtl {}: defined before, the first definition is taken",
                                            clrt::quoted(name)),
                                place);
            }
        }
    return by_name;
}

} // namespace clrt
