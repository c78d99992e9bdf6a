// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/mtl_texture.h"

#include "error.h"
#include "scene/find_file.h"
#include "scene/text_scanner.h"

#include <cctype>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

namespace clrt {
namespace {

/// What follows an option.
enum class Argument { VECTOR, NUMBERS_2, NUMBER, WORD };

struct Option {
    const char* name;
    Argument argument;
};
constexpr Option OPTIONS[] = {
    {"-s", Argument::VECTOR},     {"-o", Argument::VECTOR},        {"-t", Argument::VECTOR},
    {"-mm", Argument::NUMBERS_2}, {"-bm", Argument::NUMBER},       {"-boost", Argument::NUMBER},
    {"-texres", Argument::WORD},  {"-clamp", Argument::WORD},      {"-imfchan", Argument::WORD},
    {"-blendu", Argument::WORD},  {"-blendv", Argument::WORD},     {"-cc", Argument::WORD},
    {"-type", Argument::WORD},    {"-colorspace", Argument::WORD},
};

const Option* find_option(std::string_view word) {
    for (const Option& option : OPTIONS)
        if (word == option.name)
            return &option;
    return nullptr;
}

/// Whether a word has the form of an option, as "-foo" and not "-1.png" has.
bool looks_like_option(std::string_view word) {
    return word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1]));
}

/// All options, for messages.
std::string option_names() {
    std::string names;
    for (const Option& option : OPTIONS)
        names += (names.empty() ? "" : " ") + std::string(option.name);
    return names;
}

/// The offset of the first option that follows white space; the size of the text if there is none.
size_t find_trailing_options(std::string_view text) {
    std::string_view rest = text;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
        const size_t at = size_t(word.data() - text.data());
        if (at > 0 && find_option(word))
            return at;
    }
    return text.size();
}

/// Reads the options of one statement into its texture.
class OptionReader {
public:
    OptionReader(std::string_view key, const SourcePlace& place, MtlTexture& texture, NoticeList& notices)
        : key_(key), place_(place), texture_(texture), notices_(notices) {}

    /// Takes what stands before the name off the front of the text: options, and words that have the form of
    /// one, with their values, unless a file has such a name. How many values follow is not known: it goes on
    /// where a file's name or another option begins, or with the last word.
    void take_leading(std::string_view& rest) {
        for (take_options(rest); is_unknown(rest) && !names_file(rest, false); take_options(rest))
            drop_unknown(rest, [&] { return is_last_word(rest) || names_file(rest, true); });
    }

    /// Takes what follows the name: nothing else but options.
    void take_trailing(std::string_view rest) {
        for (take_options(rest); !rest.empty(); take_options(rest))
            drop_unknown(rest, [&] { return rest.empty(); });
    }

    /// The offset of a word that has the form of an option behind the name of a file that is there; the size
    /// of the text where there is none, or where the whole names a file.
    size_t find_unknown_behind(std::string_view text) const {
        if (names_file(text, false))
            return text.size();
        std::string_view rest = text;
        for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
            const size_t at = size_t(word.data() - text.data());
            if (at > 0 && looks_like_option(word) && names_file(text.substr(0, at), true))
                return at;
        }
        return text.size();
    }

private:
    /// Takes options off the front of the text until a word that is none.
    void take_options(std::string_view& rest) {
        for (;;) {
            std::string_view after = rest;
            const Option* option = find_option(next_word(after));
            if (!option)
                return;
            rest = after;
            take_argument(*option, rest);
        }
    }

    /// Drops a word that is no option, with a notice, and what follows it up to an option or until is_end().
    template <class IsEnd>
    void drop_unknown(std::string_view& rest, const IsEnd& is_end) {
        std::string text =
            fmt::format("{}: unknown option {}, which is left out", key_, clrt::quoted(next_word(rest)));
        notices_.add(text + "; expected one of " + option_names(), place_);
        for (rest = trim(rest); !is_end(); rest = trim(rest)) {
            std::string_view after = rest;
            if (looks_like_option(next_word(after)))
                return;
            rest = after;
        }
    }

    /// Whether the text begins with a word of the form of an option, and goes on.
    static bool is_unknown(std::string_view rest) {
        return !is_last_word(rest) && looks_like_option(next_word(rest));
    }

    static bool is_last_word(std::string_view rest) {
        next_word(rest);
        return trim(rest).empty();
    }

    /// Whether the text up to options behind it names a file that is there.
    bool names_file(std::string_view text, bool by_base_name) const {
        const std::string_view name = trim(text.substr(0, find_trailing_options(text)));
        return find_file(name, place_.file, by_base_name).has_value();
    }

    [[noreturn]] void fail(const Option& option, std::string_view expected, std::string_view found) const {
        throw SceneError(place_.file, place_.line,
                         fmt::format("{} {}: expected {}, found {}", key_, option.name, expected,
                                     found.empty() ? "the end of the line" : clrt::quoted(found)));
    }

    double take_number(const Option& option, std::string_view& rest) const {
        const std::string_view word = next_word(rest);
        double value = 0;
        if (!parse_number(word, value) || !std::isfinite(value))
            fail(option, "a finite number", word);
        return value;
    }

    /// One to three numbers: a second and third are taken if they are numbers and something follows them,
    /// because a file name may look like a number.
    int take_vector(const Option& option, std::string_view& rest, double (&values)[3]) const {
        values[0] = take_number(option, rest);
        for (int count = 1; count < 3; ++count) {
            std::string_view after = rest;
            double value = 0;
            if (!parse_number(next_word(after), value) || !std::isfinite(value) || trim(after).empty())
                return count;
            values[count] = value;
            rest = after;
        }
        return 3;
    }

    void take_argument(const Option& option, std::string_view& rest) {
        switch (option.argument) {
        case Argument::VECTOR: {
            double values[3] = {0, 0, 0};
            const int count = take_vector(option, rest, values);
            set_vector(option, values, count);
            break;
        }
        case Argument::NUMBERS_2:
            texture_.base = take_number(option, rest);
            texture_.gain = take_number(option, rest);
            break;
        case Argument::NUMBER: {
            const double value = take_number(option, rest);
            if (std::strcmp(option.name, "-bm") == 0)
                texture_.bump_multiplier = value;
            else
                note_ignored(option);
            break;
        }
        case Argument::WORD:
            set_word(option, next_word(rest));
            break;
        }
    }

    void set_vector(const Option& option, const double (&values)[3], int count) {
        const char kind = option.name[1];
        if (kind == 's')
            texture_.scale = {values[0], count > 1 ? values[1] : 1};
        else if (kind == 'o')
            texture_.offset = {values[0], values[1]};
        else if (values[0] != 0 || values[1] != 0 || values[2] != 0)
            note_ignored(option);
    }

    void set_word(const Option& option, std::string_view word) {
        const std::string_view name = option.name;
        const bool on = word == "on";
        if (word.empty() ||
            ((name == "-clamp" || name == "-cc" || name.substr(0, 6) == "-blend") && !on && word != "off"))
            fail(option, name == "-imfchan" ? "one of r g b m l z" : "on or off", word);
        if (name == "-clamp")
            texture_.wrap_u = texture_.wrap_v = on ? TextureWrap::BLACK : TextureWrap::REPEAT;
        else if (name == "-imfchan")
            set_channel(option, word);
        else if (name.substr(0, 6) == "-blend" ? !on : name == "-cc" ? on : true)
            note_ignored(option);
    }

    /// m is the matte channel, alpha; z is a depth that pictures do not hold.
    void set_channel(const Option& option, std::string_view word) {
        const size_t index = word.size() == 1 ? std::string_view("rgbml").find(word) : std::string_view::npos;
        if (index != std::string_view::npos)
            texture_.channel = u32(index);
        else if (word == "z")
            note_ignored(option);
        else
            fail(option, "one of r g b m l z", word);
    }

    void note_ignored(const Option& option) {
        notices_.add(fmt::format("the texture option {} is ignored", option.name), place_);
    }

    std::string_view key_;
    const SourcePlace& place_;
    MtlTexture& texture_;
    NoticeList& notices_;
};

} // namespace

std::optional<MtlTexture> parse_mtl_texture(std::string_view key, std::string_view value,
                                            const SourcePlace& place, NoticeList& notices) {
    MtlTexture texture;
    texture.place = place;
    OptionReader reader(key, place, texture, notices);
    std::string_view rest = trim(without_comment(value));
    reader.take_leading(rest);
    const std::string_view name = rest.substr(0, find_trailing_options(rest));
    const size_t end = reader.find_unknown_behind(name);
    texture.file = std::string(trim(rest.substr(0, end)));
    reader.take_trailing(rest.substr(end));
    if (texture.file.empty()) {
        notices.add(fmt::format("{} names no file and is ignored", key), place);
        return std::nullopt;
    }
    return texture;
}

} // namespace clrt
