// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM: the first asks the render to stop and save, the second ends at once.
#pragma once

namespace clrt {

/// Installs handlers for SIGINT and SIGTERM. The first is answered by a line on stderr unless `is_quiet`:
/// while a scene is loaded or a program compiled, nothing else shows that it came. A second signal ends the
/// process with 128 + its number.
void catch_stop_signals(bool is_quiet = false);

/// From now on a pipe whose reader has gone (SIGPIPE) and a file that grows beyond the limit of `ulimit -f`
/// (SIGXFSZ) are errors of writing, with their messages, and end no process.
void report_failed_writes();

/// 0, or the number of the signal that came.
int stop_signal();

/// Asks to stop and save as a first SIGINT does; nothing where a signal has come already. Any thread may.
void request_stop();

} // namespace clrt
