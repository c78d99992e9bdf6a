// SPDX-License-Identifier: Apache-2.0
// The standard input and output by the names of files: "-" is a scene to read or statistics to write,
// "png:-" a picture, whose format must be said.
#pragma once

#include "images/output_file.h"

#include <string>

namespace clrt {

/// Whether a file to read stands for the standard input.
bool is_standard_input(const std::string& path);

/// How messages and results name a file to read: "stdin", or its path.
std::string input_name(const std::string& path);

/// Whether a file to write stands for the standard output: "-", or a word and ":-".
bool is_standard_output(const std::string& path);

/// What is written to the standard output, all at once with commit(): encoders go back and forth.
class StandardOutput : public OutputFile {
public:
    /// `path`: as the user named it.
    explicit StandardOutput(std::string path) : path_(std::move(path)) {}

    void write_at(const void* bytes, size_t size, std::int64_t position) override;
    size_t read_at(void* bytes, size_t size, std::int64_t position) const override;
    std::int64_t size() const override { return std::int64_t(bytes_.size()); }
    void commit() override;

private:
    std::string path_, bytes_;
};

/// What a name stands for: a file, which is whole or not there (AtomicFile), or the standard output. Throws
/// SceneError.
std::unique_ptr<OutputFile> open_output(const std::string& path);

} // namespace clrt
