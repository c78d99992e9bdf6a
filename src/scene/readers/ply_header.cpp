// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/ply_header.h"

#include "error.h"
#include "scene/text_scanner.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <utility>

namespace clrt {

namespace {

/// Both sets of names that writers use.
constexpr std::pair<std::string_view, PlyType> TYPES[] = {
    {"char", PlyType::INT8},      {"int8", PlyType::INT8},       {"uchar", PlyType::UINT8},
    {"uint8", PlyType::UINT8},    {"short", PlyType::INT16},     {"int16", PlyType::INT16},
    {"ushort", PlyType::UINT16},  {"uint16", PlyType::UINT16},   {"int", PlyType::INT32},
    {"int32", PlyType::INT32},    {"uint", PlyType::UINT32},     {"uint32", PlyType::UINT32},
    {"float", PlyType::FLOAT32},  {"float32", PlyType::FLOAT32}, {"double", PlyType::FLOAT64},
    {"float64", PlyType::FLOAT64}};

constexpr std::pair<std::string_view, PlyFormat> PLY_FORMATS[] = {{"ascii", PlyFormat::ASCII},
                                                                  {"binary_little_endian", PlyFormat::LITTLE},
                                                                  {"binary_big_endian", PlyFormat::BIG}};

std::vector<std::string_view> ply_words(std::string_view line) {
    std::vector<std::string_view> words;
    while (!(line = trim(line)).empty()) {
        const size_t end = std::min(line.find_first_of(" \t"), line.size());
        words.push_back(line.substr(0, end));
        line.remove_prefix(end);
    }
    return words;
}

/// Reads one statement a line.
class HeaderReader {
public:
    HeaderReader(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}

    PlyHeader read() {
        while (true) {
            const std::vector<std::string_view> words = ply_words(next_line());
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info" || words[0] == "ply")
                continue;
            if (words[0] == "end_header")
                return header_;
            statement(words);
        }
    }

private:
    [[noreturn]] void fail(const std::string& expected, std::string_view found) const {
        throw SceneError(path_, header_.lines,
                         fmt::format("expected {}, found {}", expected, clrt::quoted(found)));
    }

    std::string_view next_line() {
        const size_t end = bytes_.find('\n', header_.bytes);
        ++header_.lines;
        if (end == bytes_.npos)
            fail("end_header", bytes_.substr(header_.bytes));
        const std::string_view line = bytes_.substr(header_.bytes, end - header_.bytes);
        header_.bytes = end + 1;
        return line;
    }

    template <typename T, size_t N>
    T named(const std::pair<std::string_view, T> (&rows)[N], std::string_view name,
            const char* expected) const {
        for (const auto& [known, value] : rows)
            if (known == name)
                return value;
        fail(expected, name);
    }

    PlyType type(std::string_view name) const { return named(TYPES, name, "the type of a number"); }

    size_t count(std::string_view word) const {
        size_t value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size())
            fail("a number of elements", word);
        return value;
    }

    void statement(const std::vector<std::string_view>& words) {
        const bool is_property = words[0] == "property" && !header_.elements.empty();
        if (words[0] == "format" && words.size() == 3)
            header_.format = named(PLY_FORMATS, words[1], "ascii, binary_little_endian or binary_big_endian");
        else if (words[0] == "element" && words.size() == 3)
            header_.elements.push_back({std::string(words[1]), count(words[2]), {}});
        else if (is_property && words.size() == 5 && words[1] == "list")
            header_.elements.back().properties.push_back(
                {std::string(words[4]), type(words[3]), true, type(words[2])});
        else if (is_property && words.size() == 3)
            header_.elements.back().properties.push_back({std::string(words[2]), type(words[1])});
        else
            fail("format, element, property of an element, comment or end_header", words[0]);
    }

    std::string_view bytes_;
    const std::string& path_;
    PlyHeader header_;
};

} // namespace

size_t ply_size(PlyType type) {
    constexpr size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[int(type)];
}

bool is_ply(std::string_view bytes) {
    return bytes.substr(0, 4) == "ply\n" || bytes.substr(0, 5) == "ply\r\n";
}

PlyHeader read_ply_header(std::string_view bytes, const std::string& path) {
    return HeaderReader(bytes, path).read();
}

} // namespace clrt
