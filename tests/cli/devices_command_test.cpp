// SPDX-License-Identifier: Apache-2.0
// --device A,B: the picture of one device, by two; what each did is told, one that fails or hangs is left
// out, and what cannot be shared is refused.
#include "clrt_command.h"
#include "film/film_file.h"

#include <csignal>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

class DevicesCommand : public ClrtCommand {
protected:
    DevicesCommand() { write_lamp(); }

    /// The test device twice: it is opened twice.
    static std::string two_devices() { return test_device_name() + "," + test_device_name(); }

    /// Renders by two devices, of which those of `failing` ("2", "12") fail after some launches, or hang.
    CommandResult share(std::vector<std::string> arguments, const std::string& failing = "",
                        bool hangs = false) const {
        arguments.insert(arguments.begin(), {"lamp.obj", "--device", two_devices()});
        CommandSettings settings;
        if (!failing.empty()) {
            settings.environment["LD_PRELOAD"] = CLRT_FAILING_LAUNCHES;
            settings.environment["FAILING_QUEUES"] = failing;
            settings.environment["FAILING_AFTER"] = "2"; // one without samples, one with
            if (hangs)
                settings.environment["FAILING_HANGS"] = "1";
        }
        return clrt(arguments, settings);
    }
    /// Films of both names have the same bits.
    void expect_same_film(const std::string& a, const std::string& b) const {
        const FilmFile one = read_film_file(folder.file(a)), other = read_film_file(folder.file(b));
        EXPECT_TRUE(one.render.film.sums == other.render.film.sums);
        EXPECT_EQ(one.render.film.ranges, other.render.film.ranges);
        EXPECT_EQ(one.identity, other.identity);
    }
    void expect_same_colours(const std::string& a, const std::string& b) const {
        const ReadPicture one(folder.file(a)), other(folder.file(b));
        for (int y = 0; y < one.spec.height; ++y)
            for (int x = 0; x < one.spec.width; ++x)
                for (const char* channel : {"R", "G", "B"})
                    ASSERT_EQ(one.at(x, y, channel), other.at(x, y, channel)) << x << "," << y;
    }
    void render_by_one() const {
        EXPECT_EQ(clrt({"lamp.obj", "-s", "40", "--checkpoint", "one.film"}).exit_code, 0);
    }
    nlohmann::json stats() const { return nlohmann::json::parse(folder.read("s.json")); }
};

} // namespace

TEST_F(DevicesCommand, TwoMakeTheFilmOfOneAndTellWhatEachDid) {
    render_by_one();
    const CommandResult result = share({"-s", "40", "--checkpoint", "two.film", "--stats", "s.json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    expect_same_film("one.film", "two.film");
    EXPECT_TRUE(holds(result.out, {"on 2 devices", "\ndevice   "}));
    const nlohmann::json devices = stats()["devices"];
    ASSERT_EQ(devices.size(), 2u);
    EXPECT_EQ(devices[0]["spp"].get<int>() + devices[1]["spp"].get<int>(), 40);
    EXPECT_GT(devices[0]["seconds"].get<double>(), 0);
    EXPECT_TRUE(devices[0]["failure"].is_null());
}

TEST_F(DevicesCommand, OneThatFailsIsLeftOutAndItsSamplesAreRenderedByTheOther) {
    render_by_one();
    for (const std::string failing : {"1", "2"}) {
        const CommandResult result =
            share({"-s", "40", "--checkpoint", failing + ".film", "--stats", "s.json"}, failing);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(holds(result.err, {"has failed and is left out", "the others render its samples",
                                       "CL_OUT_OF_RESOURCES"}));
        EXPECT_TRUE(holds(result.out, {"which failed and was left out"}));
        expect_same_film("one.film", failing + ".film");
        const nlohmann::json devices = stats()["devices"];
        const size_t index = failing == "1" ? 0 : 1;
        EXPECT_FALSE(devices[index]["failure"].is_null());
        EXPECT_EQ(devices[index]["spp"].get<int>() + devices[1 - index]["spp"].get<int>(), 40);
    }
}

TEST_F(DevicesCommand, WithoutADeviceLeftItIsADeviceError) {
    const CommandResult result = share({"-s", "40"}, "12");
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_TRUE(holds(result.err, {"no device is left", "CL_OUT_OF_RESOURCES"}));
}

TEST_F(DevicesCommand, OneThatHangsIsLeftOutForAllFramesAndTheProgramEnds) {
    EXPECT_EQ(
        clrt({"lamp.obj", "-s", "40", "--frames", "2", "--guide", "off", "-o", "one{frame}.exr"}).exit_code,
        0);
    // The first device is the one that would denoise.
    const CommandResult result =
        share({"-s", "40", "--frames", "2", "--denoise=filter", "-o", "two{frame}.exr"}, "1", true);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.err, {"has failed and is left out", "the others render its samples"}));
    const std::string silence = "told nothing for";
    EXPECT_NE(result.err.find(silence), result.err.npos) << result.err;
    EXPECT_EQ(result.err.find(silence), result.err.rfind(silence)) << "the second frame does not ask it";
    for (const std::string frame : {"1", "2"})
        expect_same_colours("one" + frame + ".exr", "two" + frame + ".exr");
}

TEST_F(DevicesCommand, AStoppedRunIsGoneOnWithByOne) {
    CommandSettings settings;
    settings.signals_after_file = "f.film";
    settings.signals = {{0.1, SIGINT}};
    const CommandResult stopped = clrt(
        {"lamp.obj", "-i", "path", "--device", two_devices(), "-s", "2000000", "--checkpoint", "f.film,0.3"},
        settings);
    EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
    const FilmFile film = read_film_file(folder.file("f.film"));
    ASSERT_EQ(film.render.film.ranges.size(), 1u);
    const std::string more = std::to_string(film.render.film.ranges[0].end + 8);
    EXPECT_EQ(clrt({"--resume", "f.film", "--device", test_device_name(), "-s", more}).exit_code, 0);
    EXPECT_EQ(clrt({"lamp.obj", "-s", more, "--guide", "off", "--checkpoint", "one.film"}).exit_code, 0);
    expect_same_film("one.film", "f.film");
}

TEST_F(DevicesCommand, ResumeFillsTheGapsOfAMergedFilm) {
    render_by_one();
    for (const char* first : {"0", "16"}) // samples 8 to 15 are in neither
        EXPECT_EQ(clrt({"lamp.obj", "-s", "8", "--first-sample", first, "--guide", "off", "--checkpoint",
                        std::string(first) + ".film"})
                      .exit_code,
                  0);
    for (const std::string& device : {test_device_name(), two_devices()}) {
        CommandSettings settings;
        settings.folder = path();
        EXPECT_EQ(
            run_command({CLRT_MERGE_EXECUTABLE, "0.film", "16.film", "-o", "gap.film"}, settings).exit_code,
            0);
        const CommandResult result =
            clrt({"--resume", "gap.film", "-s", "40", "--device", device, "-o", "gap.exr"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        expect_same_film("one.film", "gap.film");
        EXPECT_EQ(result.err.find("lack samples"), result.err.npos) << result.err;
        std::filesystem::remove(folder.file("gap.film"));
    }
}

TEST_F(DevicesCommand, WhatCannotBeSharedIsRefusedWithTheReason) {
    const std::pair<std::vector<std::string>, std::string> cases[] = {
        {{"--adaptive"}, "by the noise of all before it"},
        {{"-i", "mlt"}, "a step of a chain"},
        {{"--guide", "on"}, "guided samples need all those before them"},
        {{"--ledger"}, "its seconds are those of one device"},
        {{"--pixel", "1,1"}, "a sample is replayed on one device"},
        {{"--device", test_device_name() + ","}, "expected a name between commas"}};
    for (const auto& [arguments, reason] : cases) {
        std::vector<std::string> all{"lamp.obj"};
        if (arguments[0] != "--device")
            all.insert(all.end(), {"--device", two_devices()});
        all.insert(all.end(), arguments.begin(), arguments.end());
        const CommandResult result = clrt(all);
        EXPECT_EQ(result.exit_code, 2) << arguments[0];
        EXPECT_TRUE(holds(result.err, {reason}));
    }
}

} // namespace clrt
