// SPDX-License-Identifier: Apache-2.0
// Files, lines, words and numbers of text inputs.
#include "scene/text_scanner.h"

#include "error.h"
#include "output/standard_streams.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <system_error>
#include <unistd.h>

namespace clrt {

namespace {

constexpr size_t READ_BYTES = size_t(1) << 20; ///< read at a time where a file's size is not known (pipes)
constexpr size_t QUOTED_BYTES = 60;            ///< longest piece of input in a message

bool is_blank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/// from_chars takes no plus sign.
std::string_view without_plus(std::string_view word) {
    return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

/// What Microsoft's C library used to print for infinities and NaNs: "1.#INF", "-1.#IND00", "1.#QNAN".
template <typename T>
bool parse_microsoft_special(std::string_view word, T& value) {
    const bool negative = !word.empty() && word[0] == '-';
    word.remove_prefix(negative);
    if (word.substr(0, 3) != "1.#")
        return false;
    const T special =
        word.substr(3, 3) == "INF" ? std::numeric_limits<T>::infinity() : std::numeric_limits<T>::quiet_NaN();
    value = negative ? -special : special;
    return true;
}

/// The power of ten of the first digit that is not zero: tells overflow from underflow.
long long decimal_exponent(std::string_view word) {
    long long exponent = 0;
    const size_t e = std::min(word.find_first_of("eE"), word.size());
    if (e < word.size())
        parse_integer(word.substr(e + 1), exponent);
    const std::string_view mantissa = word.substr(0, e);
    const size_t point = std::min(mantissa.find('.'), mantissa.size());
    const size_t first = std::min(mantissa.find_first_of("123456789"), mantissa.size());
    // Halved, so that the sum cannot overflow: only the sign counts.
    return exponent / 2 + (static_cast<long long>(point) - static_cast<long long>(first)) / 2;
}

/// How many bytes the printable UTF-8 character at the start of `text` takes (Unicode 15, table 3-7); 0 if
/// there is none.
size_t printable_length(std::string_view text) {
    const auto byte = [text](size_t i) -> unsigned { return i < text.size() ? text[i] & 0xffu : 0; };
    const unsigned first = byte(0);
    if (first < 0x80)
        return first >= 0x20 && first != 0x7f;
    if (first < 0xc2 || first > 0xf4)
        return 0;
    const unsigned low = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
    const unsigned high = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
    if (byte(1) < low || byte(1) > high)
        return 0;
    const size_t length = first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    for (size_t i = 2; i < length; ++i)
        if ((byte(i) & 0xc0) != 0x80)
            return 0;
    return length;
}

std::string system_message(int error) {
    return std::generic_category().message(error);
}

} // namespace

std::string read_file(const std::string& path) {
    const bool is_piped = is_standard_input(path);
    const std::string name = input_name(path);
    std::error_code error;
    if (!is_piped) {
        const auto status = std::filesystem::status(path, error);
        if (std::filesystem::is_directory(status))
            throw SceneError(name, 0, "expected a file, found a folder");
        if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
            !std::filesystem::is_fifo(status))
            throw SceneError(name, 0, "expected a file, found a device or a socket");
    }
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
        is_piped ? fdopen(dup(STDIN_FILENO), "rb") : std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file)
        throw SceneError(name, 0, "cannot be opened: " + system_message(errno));

    const auto size = std::filesystem::file_size(path, error);
    const bool knows_size = !is_piped && !error;
    std::string text;
    size_t length = 0;
    // One byte more than the size, so that the first read of a regular file already meets its end.
    for (size_t room = knows_size ? size + 1 : READ_BYTES;; room = READ_BYTES) {
        text.resize(length + room);
        length += std::fread(&text[length], 1, room, file.get());
        if (std::ferror(file.get()))
            throw SceneError(name, 0, "cannot be read: " + system_message(errno));
        if (length < text.size())
            break;
    }
    text.resize(length);
    return text;
}

std::string_view without_byte_order_mark(std::string_view text) {
    return text.substr(0, 3) == "\xef\xbb\xbf" ? text.substr(3) : text;
}

std::string_view trim(std::string_view text) {
    while (!text.empty() && is_blank(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back()))
        text.remove_suffix(1);
    return text;
}

std::string_view without_comment(std::string_view text) {
    for (size_t i = text.find('#'); i != text.npos; i = text.find('#', i + 1))
        if (i == 0 || is_blank(text[i - 1]))
            return text.substr(0, i);
    return text;
}

std::string_view next_word(std::string_view& rest) {
    const char* begin = rest.data();
    const char* const end = begin + rest.size();
    while (begin != end && is_blank(*begin))
        ++begin;
    const char* stop = begin;
    while (stop != end && !is_blank(*stop))
        ++stop;
    rest = {stop, static_cast<size_t>(end - stop)};
    return {begin, static_cast<size_t>(stop - begin)};
}

template <typename T>
bool parse_number(std::string_view word, T& value) {
    word = without_plus(word);
    const char* const end = word.data() + word.size();
    T parsed = 0;
    const auto [stop, error] = std::from_chars(word.data(), end, parsed);
    if (error == std::errc::invalid_argument || stop != end)
        return parse_microsoft_special(word, value);
    if (error == std::errc::result_out_of_range) {
        parsed = decimal_exponent(word) > 0 ? std::numeric_limits<T>::infinity() : T(0);
        if (word[0] == '-')
            parsed = -parsed;
    }
    value = parsed;
    return true;
}

template bool parse_number<float>(std::string_view, float&);
template bool parse_number<double>(std::string_view, double&);

bool parse_integer(std::string_view word, long long& value) {
    word = without_plus(word);
    const char* const end = word.data() + word.size();
    long long parsed = 0;
    const auto [stop, error] = std::from_chars(word.data(), end, parsed);
    if (error == std::errc::invalid_argument || stop != end)
        return false;
    if (error == std::errc::result_out_of_range)
        parsed =
            word[0] == '-' ? std::numeric_limits<long long>::min() : std::numeric_limits<long long>::max();
    value = parsed;
    return true;
}

std::string quoted(std::string_view text) {
    std::string out = "'";
    size_t i = 0;
    while (i < std::min(text.size(), QUOTED_BYTES)) {
        if (const size_t length = printable_length(text.substr(i))) {
            out += text.substr(i, length);
            i += length;
            continue;
        }
        char escaped[5];
        std::snprintf(escaped, sizeof escaped, "\\x%02x",
                      static_cast<unsigned>(static_cast<unsigned char>(text[i++])));
        out += escaped;
    }
    return out + (i < text.size() ? "'..." : "'");
}

size_t next_line_start(std::string_view text, size_t from) {
    for (size_t i = text.find_first_of("\n\r", from); i != text.npos; i = text.find_first_of("\n\r", i + 1)) {
        size_t line_end = i; // where the characters that end the line begin
        if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n')
            ++i;
        else if (text[i] == '\n' && i > 0 && text[i - 1] == '\r')
            --line_end;
        if (line_end == 0 || text[line_end - 1] != '\\')
            return i + 1;
    }
    return text.size();
}

LineReader::LineReader(std::string_view text, size_t first_line) : rest_(text), first_line_(first_line) {}

std::string_view LineReader::take_line() {
    const char* const begin = rest_.data();
    const char* const end = begin + rest_.size();
    // Search LF and CR apart and only when the last one found was passed: linear for every mix of line ends.
    const auto search = [&](const char*& found, char c) {
        if (found && found >= begin)
            return;
        const void* hit = std::memchr(begin, c, static_cast<size_t>(end - begin));
        found = hit ? static_cast<const char*>(hit) : end;
    };
    search(next_lf_, '\n');
    search(next_cr_, '\r');
    const char* const stop = std::min(next_lf_, next_cr_);
    const char* after = stop;
    if (stop != end) {
        ++line_ends_;
        after += *stop == '\r' && stop + 1 != end && stop[1] == '\n' ? 2 : 1;
    }
    rest_ = {after, static_cast<size_t>(end - after)};
    return {begin, static_cast<size_t>(stop - begin)};
}

void LineReader::join_continued_lines() {
    joined_.assign(line_);
    while (!joined_.empty() && joined_.back() == '\\') {
        joined_.back() = ' ';
        if (rest_.empty())
            break;
        joined_ += take_line();
    }
    line_ = joined_;
}

bool LineReader::next() {
    while (!rest_.empty()) {
        number_ = first_line_ + line_ends_;
        line_ = take_line();
        const bool continued = !line_.empty() && line_.back() == '\\';
        if (continued && trim(line_).front() != '#')
            join_continued_lines();
        line_ = trim(line_);
        if (!line_.empty() && line_.front() != '#')
            return true;
    }
    line_ = {};
    return false;
}

} // namespace clrt
