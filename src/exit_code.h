// SPDX-License-Identifier: Apache-2.0
// Exit codes of clrt and its tools; the README and the man page list the same table.
#pragma once

namespace clrt {

enum ExitCode : int {
    EXIT_DONE = 0,              ///< the picture was written as asked
    EXIT_SCENE = 1,             ///< scene, input or output file, or host memory
    EXIT_USAGE = 2,             ///< wrong command line or options file
    EXIT_DEVICE = 3,            ///< no such device, its compiler failed, or it lacks memory or fp64
    EXIT_CHECK = 4,             ///< a numeric check failed; the picture was written
    EXIT_ERROR_NOT_REACHED = 5, ///< the error target was not reached; the picture was written
    EXIT_INTERRUPTED = 130,     ///< SIGINT
    EXIT_TERMINATED = 143       ///< SIGTERM
};

} // namespace clrt
