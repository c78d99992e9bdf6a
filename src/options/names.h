// SPDX-License-Identifier: Apache-2.0
// Values of options and their names. Each enum has one table of rows, beside its definition; what reads and
// what writes a name goes through it.
#pragma once

#include <optional>
#include <string_view>

namespace clrt {

/// A value and its name: on the command line, in files and in reports.
template <typename T>
struct Named {
    T value;
    const char* name;
};

/// The rows of an enum: each has a `value` and a `name`, both unique, in the order of the enum. Specialised
/// for every enum that has names.
template <typename T>
inline constexpr int NAMES = 0;

/// The name of a value; every value has one.
template <typename T>
constexpr const char* name_of(T value) {
    const char* name = nullptr;
    for (const auto& row : NAMES<T>)
        if (row.value == value)
            name = row.name;
    return name;
}

/// The value of this name; nothing if there is none.
template <typename T>
std::optional<T> find_named(std::string_view name) {
    for (const auto& row : NAMES<T>)
        if (name == row.name)
            return row.value;
    return std::nullopt;
}

} // namespace clrt
