// SPDX-License-Identifier: Apache-2.0
// All files that a run reads and writes, so that the one never replaces the other.
#pragma once

#include "options/options.h"
#include "output/named_file.h"

#include <string>
#include <vector>

namespace clrt {

struct Scene;

/// The files that a run writes, by the options that name them. The programs' cache is not among them.
std::vector<NamedFile> files_to_write(const Options& options);

/// The files that a run reads, as far as the options name them. A film that --checkpoint writes again is not
/// among them.
std::vector<NamedFile> files_to_read(const Options& options);

/// Prints what a run has to say in the end: to stdout, or to stderr where a result goes to stdout.
/// A stream that takes no more is no reason to stop: run_program() tells of stdout in the end.
void print_report(const Options& options, const std::string& text);

/// Throws UsageError where a result would replace a file of the options or of the loaded scene, or another
/// result. To be called before anything is written.
void check_run_files(const Options& options, const Scene& scene);

} // namespace clrt
