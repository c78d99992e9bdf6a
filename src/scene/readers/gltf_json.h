// SPDX-License-Identifier: Apache-2.0
// Values of a JSON document that know where they stand: what is not as expected is an error that names the
// file, the value's path, what was expected and what was found.
#pragma once

#include "scene/scene.h"

#include <array>
#include <cstddef>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace clrt {

class JsonValue {
public:
    /// `value` and `file` outlive this. `path` such as "nodes[3].scale"; empty: the document.
    JsonValue(const nlohmann::json& value, const std::string& file, std::string path)
        : value_(&value), file_(&file), path_(std::move(path)) {}

    const std::string& path() const { return path_; }
    const std::string& file() const { return *file_; }
    SourcePlace place() const { return {*file_ + ": " + path_, 0}; } ///< for notices

    // Of an object. All but find() throw where this is none.
    std::optional<JsonValue> find(const char* key) const; ///< absent: no such member
    JsonValue at(const char* key) const;                  ///< throws where there is none
    double number(const char* key, double otherwise) const;
    size_t whole(const char* key, size_t otherwise) const;
    bool boolean(const char* key, bool otherwise) const;
    std::string text(const char* key, const std::string& otherwise = "") const;
    std::vector<std::pair<std::string, JsonValue>> members() const;

    // Of an array.
    std::vector<JsonValue> elements() const;
    std::vector<double> all_numbers() const;

    // Of a scalar; numbers are finite.
    double number() const;
    size_t whole() const; ///< a whole number from 0 to 2^53
    bool boolean() const;
    std::string text() const;
    template <size_t N>
    std::array<double, N> numbers() const {
        std::array<double, N> result{};
        read_numbers(result.data(), N);
        return result;
    }

    /// "file: path: expected ..., found ...". The second form says what is here.
    [[noreturn]] void fail(const std::string& expected, const std::string& found) const;
    [[noreturn]] void fail(const std::string& expected) const;

private:
    void read_numbers(double* to, size_t count) const;

    const nlohmann::json* value_;
    const std::string* file_;
    std::string path_;
};

/// A parsed document.
class JsonDocument {
public:
    /// Throws SceneError (file: byte) for what is no JSON object. `file` outlives this.
    JsonDocument(std::string_view text, const std::string& file);
    JsonDocument(const JsonDocument&) = delete;
    JsonDocument& operator=(const JsonDocument&) = delete;
    ~JsonDocument();

    JsonValue root() const;

    /// The element of one of the root's arrays that a value names by its index. Throws where there is none.
    JsonValue element(const char* array, const JsonValue& index) const;

    /// All elements of one of the root's arrays; none where it is absent.
    std::vector<JsonValue> elements(const char* array) const;

private:
    std::unique_ptr<const nlohmann::json> json_;
    const std::string& file_;
};

} // namespace clrt
