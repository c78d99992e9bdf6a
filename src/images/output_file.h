// SPDX-License-Identifier: Apache-2.0
// What encoders and writers put their bytes into.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace clrt {

/// Write, then commit; without commit() nothing appears. Errors of writing are kept until commit(), so that
/// image encoders need not cope with them.
class OutputFile {
public:
    virtual ~OutputFile() = default;

    /// Writes at a position, counted from 0.
    virtual void write_at(const void* bytes, size_t size, std::int64_t position) = 0;
    /// Reads back what was written; returns the number of bytes that are there.
    virtual size_t read_at(void* bytes, size_t size, std::int64_t position) const = 0;
    /// The size so far, bytes.
    virtual std::int64_t size() const = 0;
    /// Makes it appear. Throws SceneError that names the file and the system's reason.
    virtual void commit() = 0;

protected:
    OutputFile() = default;
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;
};

} // namespace clrt
