// SPDX-License-Identifier: Apache-2.0
// Faults around a render: full disks, folders that cannot be written, kills, little memory, files that lie.
// What was there stays whole, what can be saved is, and the exit code says so.
#include "clrt_command.h"
#include "error.h"
#include "film/film_file.h"

#include <csignal>
#include <random>
#include <sys/resource.h>

namespace clrt {

namespace {

constexpr size_t MEBIBYTE = size_t(1) << 20;
/// More than a driver writes to compile a kernel, less than a film or a float picture of 800 x 600 pixels.
constexpr size_t FULL_DISK_BYTES = 4 * MEBIBYTE;

class Fault : public ClrtCommand {
protected:
    Fault() { write_square("scene"); }

    /// Runs clrt through the shell, which redirects its output.
    CommandResult shell(const std::string& arguments) const {
        CommandSettings settings;
        settings.folder = path();
        settings.environment["CLRT_DEVICE"] = test_device_name();
        return run_command({"/bin/sh", "-c", std::string(CLRT_EXECUTABLE) + " " + arguments}, settings);
    }

    /// Names of temporary files beside results.
    std::vector<std::string> partial_files() const {
        std::vector<std::string> names;
        for (const std::string& name : listing())
            if (name.find(".partial-") != name.npos)
                names.push_back(name);
        return names;
    }

    /// A PNG whose header claims a size and whose data end after the first row, as zlib stores them.
    void write_lying_png(const std::string& name, bool interlaced) const;
    /// Triangles, of at least so many bytes of text.
    void write_mesh(const std::string& name, size_t bytes) const;
    /// The least memory (RLIMIT_AS, to a few mebibytes) in which the program explains a scene of two
    /// triangles: what it takes itself, libraries and driver included.
    size_t least_memory() const;
};

/// Sanitizers reserve terabytes of addresses: no limit of them can be set.
#ifdef __SANITIZE_ADDRESS__
constexpr bool IS_SANITIZED = true;
#else
constexpr bool IS_SANITIZED = false;
#endif

/// A number as four bytes, most significant first.
std::string big_endian(std::uint32_t value) {
    return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

/// A chunk of a PNG with its checksum (PNG specification, annex D).
std::string png_chunk(const std::string& content) {
    std::uint32_t crc = 0xffffffffu;
    for (const char c : content) {
        crc ^= static_cast<unsigned char>(c);
        for (int bit = 0; bit < 8; ++bit)
            crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
    }
    return big_endian(std::uint32_t(content.size() - 4)) + content + big_endian(~crc);
}

void Fault::write_mesh(const std::string& name, size_t bytes) const {
    std::string block;
    for (int i = 0; i < 10000; ++i)
        block += "v " + std::to_string(i % 97) + ".5 " + std::to_string(i % 89) + ".25 0\nf -1 -2 -3\n";
    std::ofstream file(folder.file(name), std::ios::binary);
    file << "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (size_t written = 0; written < bytes; written += block.size())
        file << block;
}

size_t Fault::least_memory() const {
    constexpr size_t STEP = 16 * MEBIBYTE;
    size_t fails = 0, succeeds = 4096 * MEBIBYTE;
    while (succeeds - fails > STEP) {
        const size_t limit = (fails + succeeds) / 2;
        CommandSettings settings;
        settings.folder = path();
        settings.environment["CLRT_DEVICE"] = "pocl"; // --explain opens none
        settings.limits[RLIMIT_AS] = limit;
        const bool runs =
            run_command({CLRT_EXECUTABLE, "scene.obj", "--explain", "-j", "2"}, settings).exit_code == 0;
        (runs ? succeeds : fails) = limit;
    }
    return succeeds;
}

void Fault::write_lying_png(const std::string& name, bool interlaced) const {
    constexpr std::uint32_t WIDTH = 50000, HEIGHT = 20000;
    const std::string header = std::string("IHDR") + big_endian(WIDTH) + big_endian(HEIGHT) + '\x08' +
                               '\x02' + '\0' + '\0' + char(interlaced);
    const std::string ten_zeros("\x78\x01\x01\x0a\x00\xf5\xff\0\0\0\0\0\0\0\0\0\0", 17); // zlib, stored
    folder.write(name, "\x89PNG\r\n\x1a\n" + png_chunk(header) +
                           png_chunk("IDAT" + ten_zeros + big_endian(0x000a0001)) + png_chunk("IEND"));
}

} // namespace

TEST_F(Fault, AFullDiskUnderTheReportIsAnError) {
    for (const char* arguments : {"--help", "--version", "--list-devices", "scene.obj --explain"}) {
        const CommandResult result = shell(std::string(arguments) + " > /dev/full");
        EXPECT_EQ(result.exit_code, 1) << arguments;
        EXPECT_TRUE(holds(result.err, {"clrt: error: ", "No space left on device"})) << arguments;
    }
    const CommandResult result = shell("scene.obj -i raycast -s 1 -r 16x12 > /dev/full");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(exists("scene.png")) << "the picture is there all the same";
    EXPECT_EQ(shell("scene.obj -i raycast -s 1 -r 16x12 2> /dev/full").exit_code, 0)
        << "the log is not asked for";
}

TEST_F(Fault, AFullDiskCostsOnlyTheFilesThatDoNotFit) {
    const std::vector<std::string> words = {
        "scene.obj", "-i",           "raycast", "-s",           "1", "-o",      "a.pfm",  "-o",
        "b.ppm",     "--checkpoint", "a.film",  "--replicates", "1", "--stats", "s.json", "--force"};
    folder.write("a.pfm", "older picture");
    folder.write("a.film", "older film");
    CommandSettings full;
    full.limits[RLIMIT_FSIZE] = FULL_DISK_BYTES;
    const CommandResult result = clrt(words, full);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_TRUE(holds(result.err,
                      {"clrt: error: a.film: cannot write the file: File too large", "a.pfm: cannot write"}));
    // What was rendered is told all the same, with what is not there.
    EXPECT_TRUE(holds(result.out,
                      {"picture  b.ppm, 800 x 600, 1 spp", "time ", "error ", "lost     a.film, a.pfm: "}));
    EXPECT_EQ(folder.read("a.pfm"), "older picture");
    EXPECT_EQ(folder.read("a.film"), "older film");
    EXPECT_EQ(ReadPicture(folder.file("b.ppm")).spec.width, 800) << "what fits is written";
    EXPECT_TRUE(
        holds(folder.read("s.json"), {"\"spp\": 1", "\"lost_files\": [\n    \"a.film\",\n    \"a.pfm\"\n"}));
    EXPECT_EQ(partial_files(), std::vector<std::string>());
    const CommandResult roomy = clrt(words);
    EXPECT_EQ(roomy.exit_code, 0) << "with room";
    EXPECT_TRUE(holds(roomy.out, {"picture  a.pfm, b.ppm, 800 x 600"}));
    EXPECT_EQ(roomy.out.find("lost "), roomy.out.npos);
    EXPECT_TRUE(holds(folder.read("s.json"), {"\"lost_files\": []"}));
}

TEST_F(Fault, WhatWasRenderedIsToldWhereNothingCanBeWritten) {
    CommandSettings full;
    full.limits[RLIMIT_FSIZE] = FULL_DISK_BYTES;
    CommandResult result = clrt({"scene.obj", "-i", "raycast", "-s", "1", "-o", "a.pfm"}, full);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_TRUE(holds(result.out, {"picture  none, 800 x 600, 1 spp", "time ", "lost     a.pfm: "}));
    result = clrt(quick({"scene.obj", "-o", "a.png", "--stats", "/proc/s.json"}));
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_TRUE(holds(result.out, {"picture  a.png, 16 x 12, 1 spp", "time ", "lost     /proc/s.json: "}));
    // The picture goes to the standard output and does not get there.
    result = shell("scene.obj -i raycast -s 1 -r 16x12 -o png:- --stats s.json > /dev/full");
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_TRUE(holds(result.err, {"standard output", "picture  none, 16 x 12", "lost     png:-: "}));
    EXPECT_TRUE(holds(folder.read("s.json"), {"png:-"}));
    // What misses its error is told so beside it; the file's code is the graver one.
    result = clrt(
        {"scene.obj", "-i", "raycast", "-s", "16", "-e", "0.0001%", "--point", "0,0,3,9,9,9", "-o", "a.pfm"},
        full);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_TRUE(holds(result.out + result.err, {"missed   --error 0.0001 %", "is not reached", "lost "}));
}

TEST_F(Fault, AFrameThatCannotBeWrittenCostsNoOther) {
    std::filesystem::create_directory(folder.file("a-0001.pfm")); // stands in its way
    const CommandResult result = clrt(quick({"scene.obj", "--frames", "2", "-o", "a.pfm"}));
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_TRUE(holds(result.err, {"clrt: error: a-0001.pfm: "}));
    EXPECT_TRUE(holds(result.out, {"frame 1 of 2", "frame 2 of 2"}));
    EXPECT_EQ(ReadPicture(folder.file("a-0002.pfm")).spec.width, 16);
}

TEST_F(Fault, FullDisksCostMergedFilmsNoReport) {
    for (const char* first : {"0", "1"})
        ASSERT_EQ(clrt({"scene.obj", "-i", "raycast", "-s", "1", "--replicates", "1", "--first-sample", first,
                        "--checkpoint", std::string(first) + ".film"})
                      .exit_code,
                  0);
    CommandSettings full;
    full.folder = path();
    full.limits[RLIMIT_FSIZE] = FULL_DISK_BYTES;
    const CommandResult result =
        run_command({CLRT_MERGE_EXECUTABLE, "0.film", "1.film", "-o", "a.pfm", "-o", "b.ppm"}, full);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(holds(result.err, {"clrt-merge: error: a.pfm: cannot write the file: File too large"}));
    EXPECT_TRUE(holds(result.out, {"800 x 600, 2 spp of 2 films", "error "}));
    EXPECT_TRUE(exists("b.ppm"));
}

TEST_F(Fault, AFullDiskOnTheWayIsAWarningAndTheRenderGoesOn) {
    CommandSettings full;
    full.limits[RLIMIT_FSIZE] = FULL_DISK_BYTES;
    const CommandResult result = clrt({"scene.obj", "-i", "raycast", "-s", "40", "--replicates", "1", "-o",
                                       "b.ppm", "--checkpoint", "a.film,0.01"},
                                      full);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_TRUE(holds(result.err, {"a.film: cannot write the file", "the render goes on", "wrote b.ppm"}));
    EXPECT_EQ(listing(), (std::vector<std::string>{"b.ppm", "scene.obj"}));
}

TEST_F(Fault, FoldersThatNobodyCanWriteAreErrorsForResultsAndNoneForTheCache) {
    folder.write("file", "");
    const std::vector<std::string> before = listing();
    for (const std::string place : {"/proc", "file", "none"}) { // not even root can
        EXPECT_EQ(clrt(quick({"scene.obj", "-o", place + "/a.png"})).exit_code, 1);
        EXPECT_EQ(clrt(quick({"scene.obj", "--stats", place + "/s.json"})).exit_code, 1);
        EXPECT_EQ(clrt(quick({"scene.obj", "--checkpoint", place + "/a.film"})).exit_code, 1);
    }
    EXPECT_EQ(clrt(quick({"scene.obj", "--dump-kernels", "file/kernels"})).exit_code, 1);
    // Where root may look as if it could write, the picture of such a run is there.
    std::filesystem::remove(folder.file("scene.png"));
    EXPECT_EQ(listing(), before);
    for (const char* place : {"/proc/clrt", "file/cache"}) {
        const CommandResult result = clrt(quick({"scene.obj", "--cache", "on", "--cache-dir", place, "-v"}));
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(holds(result.err, {"The program cache's folder", "cannot be written"}));
    }
}

TEST_F(Fault, KillsAtAnyMomentLeaveWholeFilesAndOneTemporaryFileAtMost) {
    const std::vector<std::string> words = {
        "scene.obj", "-i",           "raycast",     "-t",      "60",        "-s",        "2000000",
        "-r",        "256x256",      "-o",          "a.pfm",   "-o",        "begun.ppm", "--save-every",
        "0.01",      "--checkpoint", "a.film,0.01", "--force", "--threads", "1"};
    ASSERT_EQ(clrt({"scene.obj", "-i", "raycast", "-s", "1", "-r", "256x256", "-o", "a.pfm", "--checkpoint",
                    "a.film"})
                  .exit_code,
              0);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> moment(0, 1);
    for (int kill = 0; kill < 8; ++kill) {
        CommandSettings settings;
        settings.folder = path();
        settings.environment["CLRT_DEVICE"] = test_device_name();
        std::filesystem::remove(folder.file("begun.ppm"));
        settings.signals_after_file = "begun.ppm"; // from then on there is always one to write
        settings.signals = {{moment(random), SIGKILL}};
        std::vector<std::string> command{CLRT_EXECUTABLE};
        command.insert(command.end(), words.begin(), words.end());
        EXPECT_EQ(run_command(command, settings).signal, SIGKILL);
        EXPECT_NO_THROW(read_film_file(folder.file("a.film"))) << "kill " << kill;
        EXPECT_EQ(ReadPicture(folder.file("a.pfm")).spec.width, 256) << "kill " << kill;
        EXPECT_LE(partial_files().size(), 3u) << "one for each file that is written";
    }
    EXPECT_EQ(
        clrt(quick({"scene.obj", "-o", "a.pfm", "-o", "begun.ppm", "--checkpoint", "a.film", "--force"}))
            .exit_code,
        0);
    EXPECT_EQ(partial_files(), std::vector<std::string>()) << "a run that ends removes what the others left";
}

TEST_F(Fault, AFilmThatNoDeviceHoldsIsAnErrorOfTheDevice) {
    CommandSettings settings;
    if (!IS_SANITIZED)
        settings.limits[RLIMIT_AS] = 3072 * MEBIBYTE; // less than a byte a pixel: none of it is made before
    const CommandResult result =
        clrt({"scene.obj", "-i", "raycast", "-s", "1", "-r", "65535x65535", "-o", "a.pfm"}, settings);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_TRUE(holds(result.err, {"clrt: error: ", "\"film\" needs", "Choose a smaller --size (--crop"}));
    EXPECT_EQ(listing(), (std::vector<std::string>{"scene.obj"}));
}

TEST_F(Fault, PicturesThatLieAboutTheirSizeAreIgnoredWithoutTheMemoryTheyClaim) {
    if (IS_SANITIZED)
        GTEST_SKIP() << "needs a limit of memory";
    CommandSettings little;
    little.limits[RLIMIT_AS] = 2048 * MEBIBYTE;
    for (const bool interlaced : {false, true}) {
        write_lying_png("lie.png", interlaced);
        folder.write("m.mtl", "newmtl m\nKd 0.8 0.8 0.8\nmap_Kd lie.png\n");
        write_square("lie", "mtllib m.mtl\nusemtl m\n");
        const CommandResult result = clrt({"lie.obj", "--explain"}, little);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(holds(result.out, {"m.mtl:3: lie.png: the picture ", "the map is ignored"}));
    }
}

TEST_F(Fault, AnObjThatTheMemoryCannotHoldIsAnError) {
    if (IS_SANITIZED)
        GTEST_SKIP() << "needs a limit of memory";
    // Zeros that take no room on the disk: two gigabytes of a line.
    folder.write("large.obj", "v 0 0 0\n");
    std::filesystem::resize_file(folder.file("large.obj"), 2048 * MEBIBYTE);
    CommandSettings little;
    little.limits[RLIMIT_AS] = 1024 * MEBIBYTE;
    const CommandResult result = clrt({"large.obj", "--explain"}, little);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(holds(result.err, {"clrt: error: large.obj: not enough memory to load the scene"}));
}

TEST_F(Fault, ALimitOfTheAddressSpaceIsAnErrorBeforeLibrariesMeetIt) {
    if (IS_SANITIZED)
        GTEST_SKIP() << "needs a limit of memory";
    // Libraries that meet the limit abort or wait for ever, at one limit and not at the next.
    constexpr int LOADER_FAILED = 127; // the dynamic linker's: no line of ours has run
    bool loads = false, renders = false;
    int refused = 0;
    for (size_t limit = 360; limit <= 1080; limit += limit < 480 ? 20 : 40) {
        CommandSettings little;
        little.limits[RLIMIT_AS] = limit * MEBIBYTE;
        little.limit_seconds = 60;
        const CommandResult result = clrt(quick({"scene.obj"}), little);
        if (result.exit_code == LOADER_FAILED && !loads)
            continue;
        loads = true;
        SCOPED_TRACE(testing::Message() << limit << " MiB: " << result.err);
        renders = result.exit_code == 0;
        if (renders)
            continue;
        EXPECT_TRUE(result.exit_code == 1 || result.exit_code == 3) << result.exit_code;
        EXPECT_TRUE(holds(result.err, {"clrt: error: ", "not enough memory", "ulimit -v"}));
        ++refused;
    }
    EXPECT_GT(refused, 0);
    EXPECT_TRUE(renders) << "a gigabyte is enough";
}

TEST_F(Fault, AMeshThatTheMemoryCannotHoldIsAnErrorWhereverItRunsOut) {
    if (IS_SANITIZED)
        GTEST_SKIP() << "needs a limit of memory";
    // The long tier reads a file of two gigabytes, more than a machine may have memory to succeed with.
    const size_t bytes = (tests_are_long() ? 2048 : 24) * MEBIBYTE;
    write_mesh("mesh.obj", bytes);
    const size_t base = least_memory();
    // The mesh takes more than four bytes for each byte of its text and less than sixteen.
    const auto succeeds = [&](size_t room) {
        CommandSettings little;
        little.limits[RLIMIT_AS] = base + room;
        const CommandResult result = clrt({"mesh.obj", "--explain", "-j", "2"}, little);
        if (result.exit_code != 0) {
            EXPECT_EQ(result.exit_code, 1) << room;
            EXPECT_TRUE(holds(result.err, {"clrt: error: ", "not enough memory"}));
        }
        return result.exit_code == 0;
    };
    for (const size_t room : {bytes / 2, bytes, 2 * bytes, 4 * bytes})
        EXPECT_FALSE(succeeds(room)) << room << " bytes more than the program itself needs";
    if (!tests_are_long()) {
        const bool with_six = succeeds(6 * bytes), with_eight = succeeds(8 * bytes);
        EXPECT_TRUE(with_eight || !with_six) << "more memory, less success";
        EXPECT_TRUE(succeeds(16 * bytes));
    }
}

TEST_F(Fault, ATruncatedPngIsToldInOurWordsOnly) {
    folder.write("scene.mtl", "newmtl leaf\nmap_Kd cut.png\n");
    write_square("textured", "mtllib scene.mtl\nusemtl leaf\n");
    ASSERT_EQ(clrt(quick({"scene.obj", "-o", "whole.png", "--sun", "1,2,3,9,9,9"})).exit_code, 0);
    const std::string whole = folder.read("whole.png");
    const size_t pixels = whole.find("IDAT");
    ASSERT_NE(pixels, whole.npos);
    for (const size_t size : {whole.size() - 20, pixels + 4, pixels + 6, pixels - 2, size_t(20), size_t(8)}) {
        folder.write("cut.png", whole.substr(0, size));
        const CommandResult result = clrt(quick({"textured.obj", "-o", "a.png"}));
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(holds(result.err, {"scene.mtl:2: cut.png: the picture ", "the map is ignored"})) << size;
        EXPECT_EQ(result.err.find("libpng"), result.err.npos) << size << ": " << result.err;
        EXPECT_TRUE(holds(result.err,
                          {"is cut off: expected ",
                           "bytes or more, found " + std::to_string(size) + "; copy or export it again"}));
    }
    // Without its last chunk a PNG has all its pixels.
    folder.write("cut.png", whole.substr(0, whole.find("IEND") - 4));
    const CommandResult result = clrt(quick({"textured.obj", "-o", "a.png"}));
    EXPECT_EQ(result.err.find("cut.png: "), result.err.npos) << result.err;
    // An environment map is an error.
    folder.write("sky.png", whole.substr(0, pixels + 6));
    const CommandResult sky = clrt(quick({"scene.obj", "--env", "sky.png"}));
    EXPECT_EQ(sky.exit_code, 1);
    EXPECT_TRUE(holds(sky.err, {"clrt: error: sky.png: the picture is cut off"}));
    EXPECT_EQ(sky.err.find("libpng"), sky.err.npos) << sky.err;
}

} // namespace clrt
