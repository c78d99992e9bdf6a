// SPDX-License-Identifier: Apache-2.0
// The text of --help, from the option table. The man page is made from it.
#pragma once

#include <string>

namespace clrt {

/// Usage, example, every option by groups, the options file and the exit codes, wrapped at so many columns,
/// 80 or more.
std::string help_text(size_t columns);

/// "clrt 0.1.0" and a line end.
std::string version_text();

} // namespace clrt
