// SPDX-License-Identifier: Apache-2.0
// Options by which the picture is seen while it is rendered.
#pragma once

#include "app/option_values.h"

namespace clrt {

/// --display-server HOST:PORT; an IPv6 address stands in brackets. Throws UsageError.
void apply_display_server(Options& options, const OptionValue& value);

/// --serve PORT[,stay]. Throws UsageError.
void apply_serve(Options& options, const OptionValue& value);

extern const char* const DISPLAY_SERVER_HELP;
extern const char* const SERVE_HELP;

} // namespace clrt
