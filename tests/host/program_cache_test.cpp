// SPDX-License-Identifier: Apache-2.0
// The cache of compiled programs: sound entries are found, everything else is a miss.
#include "device/program_cache.h"
#include "probes/kernel_probe.h"
#include "probes/scratch_folder.h"
#include "support/file_size_limit.h"
#include "support/test_device.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <map>
#include <optional>
#include <sys/wait.h>
#include <unistd.h>

using namespace clrt;
namespace fs = std::filesystem;

namespace {

const std::string KEY = "0123456789abcdef0123456789abcdef";

CachedProgram example(unsigned char filling, size_t bytes = 1000) {
    return {std::vector<unsigned char>(bytes, filling),
            {{"render", {{"params", 0}, {"nodes", 1}}}, {"clear", {}}}};
}

std::string read_bytes(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write_bytes(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

class ProgramCacheTest : public testing::Test {
protected:
    void TearDown() override {
        for (const auto& [name, value] : environment_)
            value ? setenv(name, value->c_str(), 1) : unsetenv(name);
    }

    static std::optional<std::string> variable(const char* name) {
        const char* value = std::getenv(name);
        return value ? std::optional<std::string>(value) : std::nullopt;
    }

    std::vector<fs::path> files() const {
        return {fs::directory_iterator(folder_), fs::directory_iterator()};
    }

    const ScratchFolder scratch_;
    const std::string folder_ = fs::path(scratch_.file("any")).parent_path().string();
    const std::map<const char*, std::optional<std::string>> environment_ = {
        {"HOME", variable("HOME")}, {"XDG_CACHE_HOME", variable("XDG_CACHE_HOME")}};
};

/// A program that doubles a buffer's values, with the cache of the test.
ProgramRequest doubling_request(const std::string& folder) {
    ProgramRequest request;
    request.name = "doubling";
    request.source = "__kernel void doubling(__global float *restrict values) {\n"
                     "    values[get_global_id(0)] *= FACTOR;\n}\n";
    request.defines = {"FACTOR=2.0f"};
    request.cache = {Toggle::ON, folder};
    return request;
}

std::vector<float> run_doubling(const Program& program) {
    const Device& device = test_device();
    cl::Buffer values = create_buffer(device, "values", 4 * sizeof(float));
    std::vector<float> host = {1, 2, 3, 4};
    device.queue.enqueueWriteBuffer(values, CL_TRUE, 0, 4 * sizeof(float), host.data());
    Kernel kernel(program, "doubling");
    kernel.set("values", values);
    device.queue.enqueueNDRangeKernel(kernel.handle(), cl::NullRange, cl::NDRange(4), cl::NDRange(4));
    device.queue.enqueueReadBuffer(values, CL_TRUE, 0, 4 * sizeof(float), host.data());
    return host;
}

} // namespace

TEST_F(ProgramCacheTest, AnEntryComesBackAsWritten) {
    EXPECT_FALSE(read_cached_program(folder_, KEY));
    write_cached_program(folder_, KEY, example(7));
    const auto entry = read_cached_program(folder_, KEY);
    ASSERT_TRUE(entry);
    EXPECT_EQ(entry->binary, example(7).binary);
    EXPECT_EQ(entry->arguments, example(7).arguments);
    EXPECT_EQ(files().size(), 1u) << "a temporary file was left";
}

TEST_F(ProgramCacheTest, EveryDamagedByteIsAMiss) {
    write_cached_program(folder_, KEY, example(7, 20));
    const fs::path path = files().at(0);
    const std::string sound = read_bytes(path);
    for (size_t i = 0; i < sound.size(); ++i) {
        std::string damaged = sound;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
        write_bytes(path, damaged);
        EXPECT_FALSE(read_cached_program(folder_, KEY)) << "byte " << i;
    }
    for (size_t size = 0; size < sound.size(); ++size) {
        write_bytes(path, sound.substr(0, size));
        EXPECT_FALSE(read_cached_program(folder_, KEY)) << "cut to " << size;
    }
    write_bytes(path, sound);
    EXPECT_TRUE(read_cached_program(folder_, KEY));
}

TEST_F(ProgramCacheTest, AnEntryOfAnotherKeyIsAMiss) {
    write_cached_program(folder_, KEY, example(7));
    const std::string other(32, 'f');
    fs::rename(files().at(0), fs::path(folder_) / (other + files().at(0).extension().string()));
    EXPECT_FALSE(read_cached_program(folder_, other));
}

TEST_F(ProgramCacheTest, FoldersThatCannotBeUsedAreMisses) {
    const std::string file = folder_ + "/file";
    write_bytes(file, "not a folder");
    write_cached_program(file, KEY, example(1));
    EXPECT_FALSE(read_cached_program(file, KEY));
    fs::create_directory(folder_ + "/" + KEY + ".clrtprogram");
    write_cached_program(folder_, KEY, example(1));
    EXPECT_FALSE(read_cached_program(folder_, KEY));
}

TEST_F(ProgramCacheTest, AFullDiskKeepsTheOlderEntryAndNothingElse) {
    write_cached_program(folder_, KEY, example(7));
    for (const rlim_t room : {rlim_t(0), rlim_t(100)}) {
        const FileSizeLimit limit(room);
        write_cached_program(folder_, KEY, example(8));
    }
    EXPECT_EQ(files().size(), 1u);
    const auto entry = read_cached_program(folder_, KEY);
    ASSERT_TRUE(entry);
    EXPECT_EQ(entry->binary, example(7).binary);
}

TEST_F(ProgramCacheTest, ReadersNeverSeeHalfAnEntryWhileProcessesWrite) {
    constexpr int WRITES = 300;
    write_cached_program(folder_, KEY, example(0, 1 << 16));
    std::vector<pid_t> writers;
    for (unsigned char filling : {1, 2}) {
        const pid_t writer = fork();
        ASSERT_GE(writer, 0);
        if (writer == 0) {
            for (int i = 0; i < WRITES; ++i)
                write_cached_program(folder_, KEY, example(filling, 1 << 16));
            _exit(0);
        }
        writers.push_back(writer);
    }
    for (int i = 0; i < WRITES; ++i) {
        const auto entry = read_cached_program(folder_, KEY);
        ASSERT_TRUE(entry) << "read " << i;
        EXPECT_EQ(entry->binary, example(entry->binary[0], 1 << 16).binary);
    }
    for (const pid_t writer : writers) {
        int status = 0;
        EXPECT_EQ(waitpid(writer, &status, 0), writer);
        EXPECT_EQ(status, 0);
    }
    EXPECT_EQ(files().size(), 1u);
}

TEST_F(ProgramCacheTest, TheLeastRecentlyUsedEntriesMakeRoom) {
    constexpr std::uint64_t LIMIT = 4500; // three entries of about 1300 bytes
    const auto key = [](int i) { return std::string(31, '0') + char('a' + i); };
    const auto now = fs::file_time_type::clock::now();
    for (int i = 0; i < 3; ++i) {
        write_cached_program(folder_, key(i), example(7), LIMIT);
        for (const fs::path& file : files())
            if (file.stem() == key(i))
                fs::last_write_time(file, now - std::chrono::minutes(10 - i));
    }
    EXPECT_EQ(files().size(), 3u);
    EXPECT_TRUE(read_cached_program(folder_, key(0))); // the oldest is used again
    write_cached_program(folder_, key(3), example(7), LIMIT);
    EXPECT_EQ(files().size(), 3u);
    EXPECT_TRUE(read_cached_program(folder_, key(0)));
    EXPECT_FALSE(read_cached_program(folder_, key(1)));
    EXPECT_TRUE(read_cached_program(folder_, key(2)));
    // One that is larger than the whole cache stays as long as it is the newest.
    write_cached_program(folder_, key(4), example(7, 10000), LIMIT);
    EXPECT_EQ(files().size(), 1u);
    EXPECT_TRUE(read_cached_program(folder_, key(4)));
}

TEST_F(ProgramCacheTest, OnlyAbandonedFilesOfTheCacheAreRemoved) {
    for (const char* name : {"new-abcdef", "new-uvwxyz", "notes.txt"})
        write_bytes(fs::path(folder_) / name, "x");
    const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(2);
    for (const char* name : {"new-abcdef", "notes.txt"})
        fs::last_write_time(fs::path(folder_) / name, long_ago);
    write_cached_program(folder_, KEY, example(7), 1);
    EXPECT_FALSE(fs::exists(fs::path(folder_) / "new-abcdef"));
    EXPECT_TRUE(fs::exists(fs::path(folder_) / "new-uvwxyz"));
    EXPECT_TRUE(fs::exists(fs::path(folder_) / "notes.txt"));
}

TEST_F(ProgramCacheTest, ProcessesThatMakeRoomAtOnceDoNoHarm) {
    constexpr std::uint64_t LIMIT = 4500;
    constexpr int WRITES = 200;
    const auto key = [](int i) { return std::string(31, '0') + char('a' + i % 8); };
    std::vector<pid_t> writers;
    for (int first : {0, 4}) {
        const pid_t writer = fork();
        ASSERT_GE(writer, 0);
        if (writer == 0) {
            for (int i = 0; i < WRITES; ++i)
                write_cached_program(folder_, key(first + i),
                                     example(static_cast<unsigned char>(i % 250 + 1)), LIMIT);
            _exit(0);
        }
        writers.push_back(writer);
    }
    for (int i = 0; i < WRITES; ++i) {
        const auto entry = read_cached_program(folder_, key(i));
        EXPECT_TRUE(!entry || entry->binary == example(entry->binary[0]).binary);
    }
    for (const pid_t writer : writers) {
        int status = 0;
        EXPECT_EQ(waitpid(writer, &status, 0), writer);
        EXPECT_EQ(status, 0);
    }
    write_cached_program(folder_, KEY, example(7), LIMIT);
    EXPECT_EQ(files().size(), 3u);
}

TEST_F(ProgramCacheTest, TheKeyChangesWithAllThatDecidesAboutTheBinary) {
    DeviceInfo device;
    device.platform = "platform";
    device.name = "device";
    device.driver = "1.0";
    const std::string key = program_cache_key(device, "source", "options");
    EXPECT_EQ(key.size(), 32u);
    EXPECT_EQ(program_cache_key(device, "source", "options"), key);
    EXPECT_NE(program_cache_key(device, "source ", "options"), key);
    EXPECT_NE(program_cache_key(device, "source", "options "), key);
    EXPECT_NE(program_cache_key(device, "sourceo", "ptions"), key);
    for (std::string DeviceInfo::*part : {&DeviceInfo::platform, &DeviceInfo::name, &DeviceInfo::driver}) {
        DeviceInfo other = device;
        (other.*part) += "x";
        EXPECT_NE(program_cache_key(other, "source", "options"), key);
    }
}

TEST_F(ProgramCacheTest, AutoIsOffWhereTheDriverCachesByItself) {
    DeviceInfo device;
    for (const char* suffix : {"POCL", "NV"}) {
        device.icd_suffix = suffix;
        EXPECT_FALSE(uses_program_cache({Toggle::AUTO, ""}, device)) << suffix;
        EXPECT_TRUE(uses_program_cache({Toggle::ON, ""}, device)) << suffix;
    }
    for (const char* suffix : {"INTEL", "AMD", ""}) {
        device.icd_suffix = suffix;
        EXPECT_TRUE(uses_program_cache({Toggle::AUTO, ""}, device)) << suffix;
        EXPECT_FALSE(uses_program_cache({Toggle::OFF, ""}, device)) << suffix;
    }
}

TEST_F(ProgramCacheTest, TheFolderIsTheUsersCacheFolder) {
    setenv("HOME", "/home/someone", 1);
    unsetenv("XDG_CACHE_HOME");
    EXPECT_EQ(program_cache_folder({Toggle::ON, ""}), "/home/someone/.cache/clrt");
    setenv("XDG_CACHE_HOME", "/var/cache/someone", 1);
    EXPECT_EQ(program_cache_folder({Toggle::ON, ""}), "/var/cache/someone/clrt");
    setenv("XDG_CACHE_HOME", "relative", 1);
    EXPECT_EQ(program_cache_folder({Toggle::ON, ""}), "/home/someone/.cache/clrt");
    EXPECT_EQ(program_cache_folder({Toggle::ON, "/given"}), "/given");
    unsetenv("XDG_CACHE_HOME");
    unsetenv("HOME");
    EXPECT_EQ(program_cache_folder({Toggle::ON, ""}), "");
}

TEST_F(ProgramCacheTest, ASecondBuildComesFromTheCacheAndRunsAlike) {
    const ProgramRequest request = doubling_request(folder_);
    const Program compiled = build_program(test_device(), request);
    EXPECT_FALSE(compiled.from_cache);
    const Program loaded = build_program(test_device(), request);
    EXPECT_TRUE(loaded.from_cache);
    EXPECT_EQ(loaded.arguments, compiled.arguments);
    for (const Program* program : {&compiled, &loaded})
        EXPECT_EQ(run_doubling(*program), (std::vector<float>{2, 4, 6, 8}));

    ProgramRequest other = request;
    other.defines = {"FACTOR=3.0f"};
    const Program tripling = build_program(test_device(), other);
    EXPECT_FALSE(tripling.from_cache);
    EXPECT_EQ(run_doubling(tripling), (std::vector<float>{3, 6, 9, 12}));
}

TEST_F(ProgramCacheTest, ADamagedEntryIsCompiledAnewAndReplaced) {
    const ProgramRequest request = doubling_request(folder_);
    build_program(test_device(), request);
    const fs::path path = files().at(0);
    std::string bytes = read_bytes(path);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    write_bytes(path, bytes);
    const Program again = build_program(test_device(), request);
    EXPECT_FALSE(again.from_cache);
    EXPECT_EQ(run_doubling(again), (std::vector<float>{2, 4, 6, 8}));
    EXPECT_TRUE(build_program(test_device(), request).from_cache);
}

TEST_F(ProgramCacheTest, ABinaryThatTheDriverRefusesIsCompiledAnew) {
    ProgramRequest request = doubling_request(folder_);
    const std::string key =
        program_cache_key(test_device().info, request.source,
                          build_options(test_device().info, request.precision) + " -DFACTOR=2.0f");
    write_cached_program(folder_, key, {{'n', 'o', 'n', 'e'}, {{"doubling", {{"values", 0}}}}});
    ASSERT_TRUE(read_cached_program(folder_, key));
    const Program program = build_program(test_device(), request);
    EXPECT_FALSE(program.from_cache);
    EXPECT_EQ(run_doubling(program), (std::vector<float>{2, 4, 6, 8}));
    EXPECT_TRUE(build_program(test_device(), request).from_cache);
}
