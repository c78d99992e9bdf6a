// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_json.h"

#include "error.h"
#include "scene/text_scanner.h"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

/// The largest whole number up to which doubles have all.
constexpr double LARGEST_WHOLE = 9007199254740992;

/// Strings in messages are cut off behind this.
constexpr size_t LONGEST_FOUND = 40;

std::string found_json(const nlohmann::json& value) {
    if (value.is_array())
        return fmt::format("an array of {} values", value.size());
    if (value.is_object())
        return "an object";
    if (value.is_string())
        return clrt::quoted(value.get_ref<const std::string&>().substr(0, LONGEST_FOUND));
    return value.dump();
}

std::string without_key(const char* key) {
    return fmt::format("no {}", key);
}

} // namespace

void JsonValue::fail(const std::string& expected, const std::string& found) const {
    throw SceneError(
        *file_, 0,
        fmt::format("{}{}expected {}, found {}", path_, path_.empty() ? "" : ": ", expected, found));
}

void JsonValue::fail(const std::string& expected) const {
    fail(expected, found_json(*value_));
}

std::optional<JsonValue> JsonValue::find(const char* key) const {
    if (!value_->is_object())
        fail("an object");
    const auto found = value_->find(key);
    if (found == value_->end())
        return std::nullopt;
    return JsonValue(*found, *file_, path_.empty() ? key : path_ + "." + key);
}

JsonValue JsonValue::at(const char* key) const {
    const std::optional<JsonValue> member = find(key);
    if (!member)
        fail(fmt::format("an object with {}", key), without_key(key));
    return *member;
}

double JsonValue::number(const char* key, double otherwise) const {
    const std::optional<JsonValue> member = find(key);
    return member ? member->number() : otherwise;
}

size_t JsonValue::whole(const char* key, size_t otherwise) const {
    const std::optional<JsonValue> member = find(key);
    return member ? member->whole() : otherwise;
}

bool JsonValue::boolean(const char* key, bool otherwise) const {
    const std::optional<JsonValue> member = find(key);
    return member ? member->boolean() : otherwise;
}

std::string JsonValue::text(const char* key, const std::string& otherwise) const {
    const std::optional<JsonValue> member = find(key);
    return member ? member->text() : otherwise;
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::members() const {
    if (!value_->is_object())
        fail("an object");
    std::vector<std::pair<std::string, JsonValue>> result;
    for (const auto& [key, value] : value_->items())
        result.emplace_back(key, JsonValue(value, *file_, path_.empty() ? key : path_ + "." + key));
    return result;
}

std::vector<JsonValue> JsonValue::elements() const {
    if (!value_->is_array())
        fail("an array");
    std::vector<JsonValue> result;
    for (size_t i = 0; i < value_->size(); ++i)
        result.emplace_back((*value_)[i], *file_, fmt::format("{}[{}]", path_, i));
    return result;
}

std::vector<double> JsonValue::all_numbers() const {
    std::vector<double> result;
    for (const JsonValue& element : elements())
        result.push_back(element.number());
    return result;
}

double JsonValue::number() const {
    if (!value_->is_number())
        fail("a number");
    const double number = value_->get<double>();
    if (!std::isfinite(number))
        fail("a finite number");
    return number;
}

size_t JsonValue::whole() const {
    // 3.0 is a whole number in JSON.
    const double value = value_->is_number() ? value_->get<double>() : -1;
    if (!(value >= 0 && value <= LARGEST_WHOLE && value == std::floor(value)))
        fail("a whole number from 0");
    return size_t(value);
}

bool JsonValue::boolean() const {
    if (!value_->is_boolean())
        fail("true or false");
    return value_->get<bool>();
}

std::string JsonValue::text() const {
    if (!value_->is_string())
        fail("a string");
    return value_->get<std::string>();
}

void JsonValue::read_numbers(double* to, size_t count) const {
    const std::vector<JsonValue> values = elements();
    if (values.size() != count)
        fail(fmt::format("{} numbers", count));
    for (size_t i = 0; i < count; ++i)
        to[i] = values[i].number();
}

JsonDocument::JsonDocument(std::string_view text, const std::string& file) : file_(file) {
    try {
        json_ = std::make_unique<const nlohmann::json>(nlohmann::json::parse(text.begin(), text.end()));
    } catch (const nlohmann::json::parse_error& error) {
        throw SceneError(file, 0,
                         fmt::format("byte {} of its JSON: expected a JSON document, found a fault: {}",
                                     error.byte, error.what()));
    } catch (const nlohmann::json::exception& error) {
        throw SceneError(file, 0, fmt::format("expected a JSON document, found a fault: {}", error.what()));
    }
    if (!json_->is_object())
        root().fail("a JSON object");
}

JsonDocument::~JsonDocument() = default;

JsonValue JsonDocument::root() const {
    return JsonValue(*json_, file_, "");
}

JsonValue JsonDocument::element(const char* array, const JsonValue& index) const {
    const size_t i = index.whole();
    const auto found = json_->find(array);
    const size_t count = found != json_->end() && found->is_array() ? found->size() : 0;
    if (i >= count)
        index.fail(fmt::format("an index into {}, which has {} elements", array, count));
    return JsonValue((*found)[i], file_, fmt::format("{}[{}]", array, i));
}

std::vector<JsonValue> JsonDocument::elements(const char* array) const {
    const std::optional<JsonValue> found = root().find(array);
    return found ? found->elements() : std::vector<JsonValue>();
}

} // namespace clrt
