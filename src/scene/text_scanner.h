// SPDX-License-Identifier: Apache-2.0
// Reading text files of statements (OBJ, MTL): whole files, lines, words and numbers, safe on any bytes.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace clrt {

/// All bytes of a file (or of a pipe, or of the standard input: "-"). Throws SceneError for one that is
/// missing, unreadable or a folder.
std::string read_file(const std::string& path);

/// The text after a UTF-8 byte order mark, or all of it where there is none.
std::string_view without_byte_order_mark(std::string_view text);

/// The text without white space at both ends.
std::string_view trim(std::string_view text);

/// The text before a comment: a '#' that starts the text or follows white space. Not for names: they may hold
/// '#'.
std::string_view without_comment(std::string_view text);

/// Takes the first word off `rest` (words are separated by spaces and tabs). Empty when there is none left.
std::string_view next_word(std::string_view& rest);

/// Reads a decimal number that fills the whole word ("1", "+.5", "-2e-3", "nan", "inf", "1.#IND"); no locale.
/// Beyond the range of T the value is infinite or zero. False, and `value` untouched, for anything else. T is
/// float or double.
template <typename T>
bool parse_number(std::string_view word, T& value);

/// Reads a decimal integer that fills the whole word ("3", "+3", "-1"); beyond the range of long long it
/// saturates. False, and `value` untouched, for anything else.
bool parse_integer(std::string_view word, long long& value);

/// A piece of input for a message: in single quotes, unprintable bytes as \xNN, shortened when long.
std::string quoted(std::string_view text);

/// The first offset after `from` where a line starts that does not continue the one before (LineReader's
/// rules); the size of the text if there is none. For cutting a text into pieces that can be read on their
/// own.
size_t next_line_start(std::string_view text, size_t from);

/// Walks over the lines of a text. LF, CR LF and a lone CR end a line. A backslash at a line's very end joins
/// the next one with a space; a comment is not continued. Empty lines and comment lines are skipped but
/// counted.
class LineReader {
public:
    explicit LineReader(std::string_view text, size_t first_line = 1);

    /// Moves to the next line that has text and is no comment; false at the end of the text.
    bool next();
    /// The line without white space at its ends. Valid until the next call of next().
    std::string_view text() const { return line_; }
    /// The number of the line (of its first part where it was continued).
    size_t number() const { return number_; }
    /// How many line ends were read so far.
    size_t line_ends() const { return line_ends_; }

private:
    std::string_view take_line();
    void join_continued_lines();

    std::string_view rest_, line_;
    std::string joined_; ///< the text of a continued line
    size_t first_line_, number_ = 0, line_ends_ = 0;
    const char* next_lf_ = nullptr; ///< the nearest LF and CR, kept so that each byte is searched once
    const char* next_cr_ = nullptr;
};

} // namespace clrt
