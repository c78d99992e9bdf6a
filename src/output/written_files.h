// SPDX-License-Identifier: Apache-2.0
// Results must not replace what they are made from, nor each other.
#pragma once

#include "output/named_file.h"

#include <string>
#include <vector>

namespace clrt {

/// Whether two names stand for one file: the same file where both are there, symbolic and hard links
/// included, else the same place.
bool is_same_file(const std::string& a, const std::string& b);

/// Throws UsageError that names option and file where one of `written` is one of `read`, or where two of
/// `written` are one file. What is not there was not read.
void check_written_files(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read);

} // namespace clrt
