// SPDX-License-Identifier: Apache-2.0
// The command line that replays a sample of a picture.
#pragma once

#include "options/options.h"
#include "replay/replay.h"

namespace clrt {

/// Words as one could type them into a shell.
std::string shell_text(const std::vector<std::string>& words);

/// The picture's command without what it writes, and the sample's address.
std::string replay_command(const Options& options, const SampleAddress& address);

} // namespace clrt
