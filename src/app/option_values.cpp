// SPDX-License-Identifier: Apache-2.0
// Values of options: text -> numbers, vectors, sizes, durations, paths. Independent of the locale.
#include "app/option_values.h"

#include "error.h"
#include "output/standard_streams.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

namespace clrt {

namespace {

/// The picture formats' common limit, pixels a side.
constexpr int LARGEST_SIDE = 65535;

/// The whole text as a T, or nothing; a leading '+' is allowed as in C.
template <typename T>
std::optional<T> read_all(const std::string& text) {
    const char* first = text.data();
    const char* const last = first + text.size();
    if (text.size() > 1 && text[0] == '+' && text[1] != '-')
        ++first;
    T result{};
    const auto [end, error] = std::from_chars(first, last, result);
    if (error != std::errc() || end != last)
        return {};
    return result;
}

/// Numbers reach the kernels as float, so what float cannot hold is refused here.
std::optional<double> read_number(const std::string& text) {
    const std::optional<double> x = read_all<double>(text);
    if (!x || !(std::abs(*x) <= std::numeric_limits<float>::max()))
        return {};
    return x;
}

std::optional<int> read_side(const std::string& text) {
    const std::optional<int> side = read_all<int>(text);
    return side && *side >= 1 && *side <= LARGEST_SIDE ? side : std::nullopt;
}

} // namespace

void reject_value(const OptionValue& value, const std::string& expected) {
    throw UsageError(value.origin + "option " + value.option + ": expected " + expected + ", found '" +
                     value.text + "'");
}

double parse_number(const OptionValue& value, const std::string& expected, Accept accept) {
    const std::optional<double> x = read_number(value.text);
    if (!x || !accept(*x))
        reject_value(value, expected);
    return *x;
}

std::int64_t parse_whole(const OptionValue& value, std::int64_t low, std::int64_t high) {
    const std::optional<std::int64_t> n = read_all<std::int64_t>(value.text);
    if (!n || *n < low || *n > high)
        reject_value(value, "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    return *n;
}

std::string trimmed(const std::string& text) {
    const char* const blanks = " \t\r";
    const size_t first = text.find_first_not_of(blanks);
    if (first == std::string::npos)
        return "";
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string> split_list(const std::string& text) {
    std::vector<std::string> parts;
    for (size_t start = 0;;) {
        const size_t comma = text.find(',', start);
        parts.push_back(trimmed(text.substr(start, comma - start)));
        if (comma == std::string::npos)
            return parts;
        start = comma + 1;
    }
}

std::vector<double> parse_numbers(const OptionValue& value, size_t least, size_t most,
                                  const std::string& expected) {
    const std::vector<std::string> parts = split_list(value.text);
    if (parts.size() < least || parts.size() > most)
        reject_value(value, expected);
    std::vector<double> numbers;
    for (const std::string& part : parts) {
        const std::optional<double> x = read_number(part);
        if (!x)
            reject_value(value, expected);
        numbers.push_back(*x);
    }
    return numbers;
}

glm::dvec3 parse_vector(const OptionValue& value, const std::string& expected) {
    const std::vector<double> v = parse_numbers(value, 3, 3, expected);
    return {v[0], v[1], v[2]};
}

glm::ivec2 parse_size(const OptionValue& value) {
    const std::string expected = "a size in pixels such as 800x600, each side from 1 to 65535";
    const size_t cross = value.text.find_first_of("xX");
    if (cross == std::string::npos)
        reject_value(value, expected);
    const std::optional<int> width = read_side(value.text.substr(0, cross));
    const std::optional<int> height = read_side(value.text.substr(cross + 1));
    if (!width || !height)
        reject_value(value, expected);
    return {*width, *height};
}

Crop parse_crop(const OptionValue& value) {
    const std::string expected =
        "a window x0,y0,x1,y1 in whole pixels with 0 <= x0 < x1 and 0 <= y0 < y1 (the "
        "end is excluded)";
    const std::vector<std::string> parts = split_list(value.text);
    if (parts.size() != 4)
        reject_value(value, expected);
    std::array<int, 4> corner{};
    for (size_t i = 0; i < 4; ++i) {
        const std::optional<int> pixel = read_all<int>(parts[i]);
        if (!pixel || *pixel < 0)
            reject_value(value, expected);
        corner[i] = *pixel;
    }
    const Crop crop{corner[0], corner[1], corner[2], corner[3]};
    if (crop.x0 >= crop.x1 || crop.y0 >= crop.y1)
        reject_value(value, expected);
    return crop;
}

glm::ivec2 parse_pixel(const OptionValue& value) {
    const std::vector<std::string> parts = split_list(value.text);
    glm::ivec2 pixel{-1, -1};
    for (size_t i = 0; i < 2 && parts.size() == 2; ++i)
        pixel[int(i)] = read_all<int>(parts[i]).value_or(-1);
    if (pixel.x < 0 || pixel.y < 0)
        reject_value(value, "a pixel x,y in whole numbers from 0, counted from the top left");
    return pixel;
}

double parse_duration(const OptionValue& value) {
    const std::string expected = "a duration above 0 such as 90, 90s, 5m or 1h";
    std::string digits = value.text;
    double unit_seconds = 1;
    if (!digits.empty() && (digits.back() == 's' || digits.back() == 'm' || digits.back() == 'h')) {
        unit_seconds = digits.back() == 's' ? 1 : digits.back() == 'm' ? 60 : 3600;
        digits.pop_back();
    }
    const std::optional<double> x = read_number(digits);
    if (!x || !(*x > 0))
        reject_value(value, expected);
    return *x * unit_seconds;
}

double parse_fraction(const OptionValue& value) {
    const std::string expected = "a fraction from 0 to 1 such as 0.002 or 0.2%";
    std::string digits = value.text;
    const bool percent = !digits.empty() && digits.back() == '%';
    if (percent)
        digits.pop_back();
    const std::optional<double> x = read_number(digits);
    const double fraction = x.value_or(-1) / (percent ? 100 : 1);
    if (!(fraction >= 0 && fraction <= 1))
        reject_value(value, expected);
    return fraction;
}

std::string parse_path(const OptionValue& value) {
    if (value.text.empty())
        reject_value(value, "a path");
    return (value.folder / value.text).string();
}

std::string parse_result(const OptionValue& value) {
    return is_standard_output(value.text) ? value.text : parse_path(value);
}

std::string alternatives(const std::vector<std::string>& texts) {
    std::string list;
    for (size_t i = 0; i < texts.size(); ++i)
        list += (i == 0 ? "" : i + 1 < texts.size() ? ", " : " or ") + texts[i];
    return list;
}

bool looks_like_numbers(const std::string& text) {
    return read_all<double>(split_list(text)[0]).has_value();
}

} // namespace clrt
