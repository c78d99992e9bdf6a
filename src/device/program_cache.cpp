// SPDX-License-Identifier: Apache-2.0
// An entry is a file: magic, key, arguments, binary, and a checksum of all before it. Numbers are 64-bit in
// the machine's byte order, strings are a length and bytes.
#include "device/program_cache.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <spdlog/spdlog.h>
#include <sstream>
#include <unistd.h>
#include <vector>
#include <xxhash.h>

namespace fs = std::filesystem;

namespace clrt {

namespace {

/// Counts changes of the entries' layout; part of the key and of the magic.
const std::string LAYOUT_VERSION = "1";
const std::string MAGIC = "clrt program " + LAYOUT_VERSION + "\n";

std::uint64_t checksum(const char* data, size_t bytes) {
    return XXH3_64bits(data, bytes);
}

/// Appends numbers and strings to a byte string.
class Writer {
public:
    void number(std::uint64_t value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
    void text(const std::string& value) {
        number(value.size());
        bytes_ += value;
    }
    std::string bytes_;
};

/// Takes them back. A read past the end gives zeros and clears ok_.
class Reader {
public:
    Reader(const char* data, size_t bytes) : data_(data), left_(bytes) {}
    std::uint64_t number() {
        std::uint64_t value = 0;
        if (const char* source = take(sizeof value))
            std::memcpy(&value, source, sizeof value);
        return value;
    }
    std::string text() {
        const std::uint64_t size = number();
        const char* source = take(size);
        return source ? std::string(source, size) : std::string();
    }
    bool ok() const { return ok_; }
    bool at_end() const { return left_ == 0; }

private:
    const char* take(std::uint64_t bytes) {
        if (bytes > left_) {
            ok_ = false;
            left_ = 0;
            return nullptr;
        }
        const char* taken = data_;
        data_ += bytes;
        left_ -= bytes;
        return taken;
    }
    const char* data_;
    size_t left_;
    bool ok_ = true;
};

std::string encode(const std::string& key, const CachedProgram& program) {
    Writer writer;
    writer.text(MAGIC);
    writer.text(key);
    writer.number(program.arguments.size());
    for (const auto& [kernel, positions] : program.arguments) {
        writer.text(kernel);
        writer.number(positions.size());
        for (const auto& [argument, position] : positions) {
            writer.text(argument);
            writer.number(position);
        }
    }
    writer.text(std::string(program.binary.begin(), program.binary.end()));
    writer.number(checksum(writer.bytes_.data(), writer.bytes_.size()));
    return std::move(writer.bytes_);
}

std::optional<CachedProgram> decode(const std::string& key, const std::string& bytes) {
    // The checksum comes first, so that nothing damaged is interpreted.
    if (bytes.size() < sizeof(std::uint64_t))
        return std::nullopt;
    const size_t content = bytes.size() - sizeof(std::uint64_t);
    if (Reader(bytes.data() + content, sizeof(std::uint64_t)).number() != checksum(bytes.data(), content))
        return std::nullopt;

    Reader reader(bytes.data(), content);
    if (reader.text() != MAGIC || reader.text() != key)
        return std::nullopt;
    CachedProgram program;
    for (std::uint64_t kernels = reader.number(); kernels > 0 && reader.ok(); --kernels) {
        auto& positions = program.arguments[reader.text()];
        for (std::uint64_t arguments = reader.number(); arguments > 0 && reader.ok(); --arguments) {
            const std::string name = reader.text();
            positions[name] = static_cast<unsigned>(reader.number());
        }
    }
    const std::string binary = reader.text();
    if (!reader.ok() || !reader.at_end() || binary.empty())
        return std::nullopt;
    program.binary.assign(binary.begin(), binary.end());
    return program;
}

const char* const ENTRY_EXTENSION = ".clrtprogram";
const char* const TEMPORARY_NAME = "new-XXXXXX";
/// A temporary file of this age belongs to a process that was killed: writing one takes milliseconds.
constexpr auto ABANDONED_AGE = std::chrono::hours(1);

fs::path entry_path(const std::string& folder, const std::string& key) {
    return fs::path(folder) / (key + ENTRY_EXTENSION);
}

/// A file of the cache as it was when it was looked at; others may remove it at any time.
struct CacheFile {
    fs::path path;
    fs::file_time_type used;
    std::uint64_t bytes = 0;
};

/// Lists the entries, and removes abandoned temporary files.
std::vector<CacheFile> list_entries(const fs::path& folder) {
    std::vector<CacheFile> entries;
    std::error_code error;
    const std::string temporary = std::string(TEMPORARY_NAME).substr(0, 4);
    for (fs::directory_iterator file(folder, error), end; !error && file != end; file.increment(error)) {
        std::error_code gone;
        const CacheFile found{file->path(), file->last_write_time(gone), file->file_size(gone)};
        if (gone)
            continue;
        if (found.path.extension() == ENTRY_EXTENSION)
            entries.push_back(found);
        else if (found.path.filename().string().compare(0, temporary.size(), temporary) == 0 &&
                 fs::file_time_type::clock::now() - found.used > ABANDONED_AGE)
            fs::remove(found.path, gone);
    }
    return entries;
}

/// Removes the least recently used entries but `kept` until the rest fits.
void limit_size(const fs::path& folder, const fs::path& kept, std::uint64_t limit_bytes) {
    std::vector<CacheFile> entries = list_entries(folder);
    std::sort(entries.begin(), entries.end(),
              [](const CacheFile& a, const CacheFile& b) { return a.used < b.used; });
    std::uint64_t total = 0;
    for (const CacheFile& entry : entries)
        total += entry.bytes;
    for (const CacheFile& entry : entries) {
        if (total <= limit_bytes)
            return;
        std::error_code ignored; // another process may have been faster
        if (entry.path == kept)
            continue;
        fs::remove(entry.path, ignored);
        total -= entry.bytes;
    }
}

/// Writes a new file with a name that no other process has; empty on failure.
std::string write_temporary(const fs::path& folder, const std::string& bytes) {
    std::string path = (folder / TEMPORARY_NAME).string();
    const int descriptor = mkstemp(path.data());
    if (descriptor < 0)
        return {};
    close(descriptor);
    std::ofstream stream(path, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (stream)
        return path;
    std::error_code ignored;
    fs::remove(path, ignored);
    return {};
}

} // namespace

bool uses_program_cache(const ProgramCache& cache, const DeviceInfo& device) {
    return cache.use == Toggle::ON || (cache.use == Toggle::AUTO && !driver_caches_programs(device));
}

std::string program_cache_folder(const ProgramCache& cache) {
    if (!cache.folder.empty())
        return cache.folder;
    // The XDG base directory specification: a relative path counts as unset.
    if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && fs::path(xdg).is_absolute())
        return (fs::path(xdg) / "clrt").string();
    if (const char* home = std::getenv("HOME"); home && *home)
        return (fs::path(home) / ".cache" / "clrt").string();
    return {};
}

std::string program_cache_obstacle(const ProgramCache& cache) {
    const std::string folder = program_cache_folder(cache);
    if (cache.use == Toggle::OFF || folder.empty())
        return {};
    std::error_code error;
    fs::create_directories(folder, error);
    if (!error && faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) != 0)
        error = std::error_code(errno, std::generic_category());
    return error ? error.message() : std::string();
}

std::string program_cache_key(const DeviceInfo& device, const std::string& source,
                              const std::string& options) {
    // Each part goes with its length, so that no two lists of parts give the same bytes.
    Writer parts;
    for (const std::string& part : {LAYOUT_VERSION, source, options, device.platform, device.platform_vendor,
                                    device.name, device.vendor, device.version, device.driver})
        parts.text(part);
    const XXH128_hash_t hash = XXH3_128bits(parts.bytes_.data(), parts.bytes_.size());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::optional<CachedProgram> read_cached_program(const std::string& folder, const std::string& key) {
    std::ifstream stream(entry_path(folder, key), std::ios::binary);
    if (!stream)
        return std::nullopt;
    std::ostringstream bytes; // unlike stream iterators, it does not throw when reading fails
    bytes << stream.rdbuf();
    auto program = decode(key, bytes.str());
    if (!program)
        spdlog::debug("The program cache's entry {} is damaged or not ours; it will be replaced.",
                      entry_path(folder, key).string());
    std::error_code ignored; // a folder that only can be read serves as well
    if (program)
        fs::last_write_time(entry_path(folder, key), fs::file_time_type::clock::now(), ignored);
    return program;
}

void write_cached_program(const std::string& folder, const std::string& key, const CachedProgram& program,
                          std::uint64_t limit_bytes) {
    std::error_code error;
    fs::create_directories(folder, error);
    const std::string temporary = write_temporary(folder, encode(key, program));
    if (temporary.empty()) {
        spdlog::debug("The program cache's folder {} cannot be written; the program is not kept.", folder);
        return;
    }
    fs::rename(temporary, entry_path(folder, key), error);
    if (error) {
        spdlog::debug("The program cache's entry {} cannot be written: {}.", entry_path(folder, key).string(),
                      error.message());
        fs::remove(temporary, error);
    }
    limit_size(folder, entry_path(folder, key), limit_bytes);
}

} // namespace clrt
