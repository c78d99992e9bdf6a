// SPDX-License-Identifier: Apache-2.0
// Whole numbers from JSON that anybody may have written.
#pragma once

#include <nlohmann/json.hpp>

namespace clrt {

/// Throws Json::type_error unless every number in it, at any depth, is a whole one. To cast another, such as
/// 9e99, to an integer is undefined in C++.
template <class Json>
void expect_whole(const Json& json) {
    if (json.is_structured())
        for (const Json& element : json)
            expect_whole(element);
    else if (!json.is_number_integer())
        throw Json::type_error::create(302, "expected a whole number", &json);
}

/// A whole number, or an array of them, as T.
template <class T, class Json>
T whole(const Json& json) {
    expect_whole(json);
    return json.template get<T>();
}

} // namespace clrt
