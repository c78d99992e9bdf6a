// SPDX-License-Identifier: Apache-2.0
// --checkpoint, --resume, --save-every and clrt-merge: however a run is cut into pieces, the bits are those
// of one run.
#include "clrt_command.h"
#include "error.h"
#include "film/film_file.h"

#include <csignal>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

class FilmCommand : public ClrtCommand {
protected:
    FilmCommand() { write_lamp(); }
    /// Renders samples first .. first + count - 1 into NAME.film and, unless told otherwise, NAME.exr.
    void render_part(const std::string& name, int first, int count,
                     std::vector<std::string> further = {}) const {
        std::vector<std::string> arguments{"lamp.obj",    "--first-sample",      std::to_string(first),
                                           "--spp",       std::to_string(count), "--checkpoint",
                                           name + ".film"};
        if (std::find(further.begin(), further.end(), "-o") == further.end())
            further.insert(further.end(), {"-o", name + ".exr"});
        arguments.insert(arguments.end(), further.begin(), further.end());
        const CommandResult result = clrt(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(holds(result.err, {"wrote " + name + ".film"}));
    }
    CommandResult merge(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), CLRT_MERGE_EXECUTABLE);
        CommandSettings settings;
        settings.folder = path();
        return run_command(arguments, settings);
    }
    FilmFile film(const std::string& name) const { return read_film_file(folder.file(name)); }

    /// Sums, ranges and counts are the same.
    void expect_same_film(const std::string& a, const std::string& b) const {
        const FilmFile one = film(a), other = film(b);
        EXPECT_TRUE(one.render.film.sums == other.render.film.sums) << a << ", " << b;
        EXPECT_EQ(one.render.film.ranges, other.render.film.ranges);
        EXPECT_EQ(one.render.film.shown, other.render.film.shown);
        EXPECT_EQ(one.render.counts.rays(), other.render.counts.rays());
        EXPECT_EQ(one.identity, other.identity);
    }
    /// Radiance and variance are the same.
    void expect_same_picture(const std::string& a, const std::string& b) const {
        const ReadPicture one(folder.file(a)), other(folder.file(b));
        for (const char* channel : {"R", "G", "B", "variance.R", "variance.G", "variance.B", "samples"})
            for (int y = 0; y < 24; ++y)
                for (int x = 0; x < 32; ++x)
                    ASSERT_EQ(one.at(x, y, channel), other.at(x, y, channel))
                        << channel << " " << x << "," << y;
    }
};

/// Arguments that keep the device busy for a minute.
const std::vector<std::string> LONG_RUN = {"lamp.obj", "-i",      "path", "-t",       "60",
                                           "-s",       "2000000", "-o",   "long.exr", "--checkpoint"};

} // namespace

TEST_F(FilmCommand, MergedRangesAreTheSingleRun) {
    render_part("whole", 0, 21);
    render_part("a", 0, 5);
    render_part("b", 5, 1, {"--effects", "all"});
    render_part("c", 6, 15, {"--bvh", "bvh2"});
    const CommandResult result =
        merge({"c.film", "a.film", "b.film", "-o", "merged.exr", "-o", "merged.film", "-o", "merged.png"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.out, {"21 spp of 3 films", "error    ",
                                   " % of the picture's mean brightness (root of mean square)"}));
    expect_same_film("merged.film", "whole.film");
    expect_same_picture("merged.exr", "whole.exr");
    EXPECT_TRUE(exists("merged.png"));
    // Two at a time, the other way round.
    EXPECT_EQ(merge({"b.film", "c.film", "-o", "bc.film"}).exit_code, 0);
    EXPECT_EQ(merge({"bc.film", "a.film", "-o", "abc.film"}).exit_code, 0);
    expect_same_film("abc.film", "whole.film");
}

TEST_F(FilmCommand, PixelsOfTheSceneAreThoseThatACameraRayHits) {
    const std::vector<std::string> view = {"--eye", "0,6,9", "--env", "1,1,1",    "--size",
                                           "48x32", "--aov", "alpha", "--filter", "gaussian"};
    for (std::vector<std::string> arguments : {std::vector<std::string>{"--integrator", "path"},
                                               {"--integrator", "whitted"},
                                               {"--integrator", "raycast"},
                                               {"--max-depth", "1"},
                                               {"--adaptive"}}) {
        arguments.insert(arguments.end(), view.begin(), view.end());
        arguments.push_back("--force");
        render_part("a", 0, 16, arguments);
        const ReadPicture picture(folder.file("a.exr"));
        const std::vector<std::uint8_t> shown = film("a.film").render.film.shown;
        ASSERT_EQ(shown.size(), 48u * 32);
        size_t with = 0;
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 48; ++x) {
                EXPECT_EQ(shown[size_t(48 * y + x)], picture.at(x, y, "A") > 0) << x << "," << y;
                with += shown[size_t(48 * y + x)];
            }
        EXPECT_GT(with, 100u);
        EXPECT_LT(with, 1400u);
    }
}

TEST_F(FilmCommand, LayersOfPathsGoAlong) {
    const std::vector<std::string> layer = {"--aov", "direct=LDE"};
    render_part("whole", 0, 12, layer);
    render_part("a", 0, 5, layer);
    render_part("b", 5, 4, layer);
    EXPECT_EQ(merge({"b.film", "a.film", "-o", "ab.film", "-o", "ab.exr"}).exit_code, 0);
    const CommandResult result = clrt({"--resume", "ab.film", "-s", "12", "-o", "resumed.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const ReadPicture whole(folder.file("whole.exr")), resumed(folder.file("resumed.exr")),
        ab(folder.file("ab.exr"));
    double sum = 0;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x) {
            ASSERT_EQ(resumed.at(x, y, "direct.R"), whole.at(x, y, "direct.R"));
            sum += double(ab.at(x, y, "direct.R"));
        }
    EXPECT_GT(sum, 0);
}

TEST_F(FilmCommand, MergingSaysWhatDoesNotFit) {
    const std::vector<std::string> quick = {"-i", "raycast", "-o", "part.png"};
    render_part("a", 0, 2, quick);
    EXPECT_EQ(merge({"a.film", "-o", "a.exr"}).exit_code, 0);
    const auto with = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), quick.begin(), quick.end());
        return arguments;
    };
    render_part("overlap", 1, 2, quick);
    render_part("seed", 2, 2, with({"--seed", "3"}));
    render_part("crop", 2, 2, with({"--crop", "0,0,8,8"}));
    render_part("gap", 4, 2, quick);
    const std::vector<std::string> before = listing();
    for (const auto& [name, part] : {std::pair{"overlap.film", "samples 1 to 1 in both"},
                                     {"seed.film", "seed: expected 0, found 3"},
                                     {"crop.film", "window: expected [0,0,32,24], found [0,0,8,8]"},
                                     {"a.exr", "expected a film file as --checkpoint writes it"},
                                     {"none.film", "the film file cannot be opened: No such file"}}) {
        const CommandResult result = merge({"a.film", name, "-o", "out.exr"});
        EXPECT_EQ(result.exit_code, 1) << result.err;
        EXPECT_TRUE(holds(result.err, {std::string("clrt-merge: error: ") + name + ": ", part}));
    }
    EXPECT_EQ(merge({"a.film"}).exit_code, 2);
    EXPECT_EQ(merge({"a.film", "-o", "out.gif"}).exit_code, 2);
    EXPECT_EQ(merge({"-o", "out.png"}).exit_code, 2);
    EXPECT_EQ(listing(), before);
    const CommandResult gap = merge({"gap.film", "a.film", "-o", "out.png"});
    EXPECT_EQ(gap.exit_code, 0);
    EXPECT_TRUE(holds(gap.err, {"samples 2 to 3 are in no film"}));
}

TEST_F(FilmCommand, AResumedRunIsTheSingleRun) {
    render_part("whole", 3, 29);
    render_part("a", 3, 6);
    // With the whole command, on another tree.
    CommandResult result =
        clrt({"lamp.obj", "--first-sample", "3", "--spp", "17", "--resume", "a.film", "--checkpoint",
              "b.film", "-o", "b.exr", "--bvh", "bvh2", "--stats", "s.json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(folder.read("s.json"), {"\"spp\": 17", "\"passes\": 11"}));
    // With the film alone.
    result = clrt({"--resume", "b.film", "-s", "29", "-o", "c.exr", "--checkpoint", "c.film"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    expect_same_film("c.film", "whole.film");
    expect_same_picture("c.exr", "whole.exr");
    // Another budget takes the place of the film's; nothing is left to do here.
    result = clrt({"--resume", "c.film", "--error", "99%", "-o", "d.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    expect_same_picture("d.exr", "whole.exr");
}

TEST_F(FilmCommand, AnAdaptiveRunGoesOnButDoesNotMerge) {
    const std::vector<std::string> adaptive = {"--adaptive", "--size", "48x32"};
    const auto with = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), adaptive.begin(), adaptive.end());
        return arguments;
    };
    render_part("whole", 0, 64, with({"-j", "1", "--stats", "s.json"}));
    EXPECT_TRUE(holds(folder.read("s.json"),
                      {"\"spp\": 64", "\"adaptive\": {", "\"measure\": \"mse\"", "\"tile_size\": 8"}));
    // Stop in the middle of rounds.
    render_part("a", 0, 20, adaptive);
    EXPECT_EQ(clrt({"--resume", "a.film", "-s", "43", "-o", "b.exr", "--checkpoint", "b.film"}).exit_code, 0);
    const CommandResult result =
        clrt({"--resume", "b.film", "-s", "64", "-o", "c.exr", "--checkpoint", "c.film"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.out, {" spp on average, ", " by tiles of 8 x 8"}));
    expect_same_film("c.film", "whole.film");
    expect_same_picture("c.exr", "whole.exr");
    EXPECT_EQ(merge({"c.film", "-o", "alone.exr"}).exit_code, 0);
    expect_same_picture("alone.exr", "whole.exr");
    render_part("uniform", 64, 8, {"--size", "48x32"});
    const CommandResult refused = merge({"uniform.film", "c.film", "-o", "out.exr"});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_TRUE(holds(refused.err, {"c.film: expected a film with adaptive: false, found adaptive: true"}));
}

TEST_F(FilmCommand, GuidedFilmsGoOnAndDoNotMergeWithOthers) {
    const auto guided = [&](const std::string& name, const std::string& spp) {
        return clrt(
            {"lamp.obj", "--guide", "on", "-s", spp, "-o", name + ".exr", "--checkpoint", name + ".film"});
    };
    EXPECT_TRUE(holds(guided("whole", "24").out, {"guide    from 4 spp; ", " cells, "}));
    EXPECT_EQ(guided("a", "10").exit_code, 0);
    const CommandResult result =
        clrt({"--resume", "a.film", "-s", "24", "-o", "b.exr", "--checkpoint", "b.film"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    expect_same_film("b.film", "whole.film");
    expect_same_picture("b.exr", "whole.exr");
    render_part("part", 24, 8, {"--guide", "auto"});
    const CommandResult refused = merge({"part.film", "whole.film", "-o", "out.exr"});
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_TRUE(
        holds(refused.err, {"whole.film: expected a film of the same scene and options", "another guide"}));
}

TEST_F(FilmCommand, ResumingSaysWhatDoesNotFit) {
    render_part("a", 0, 2, {"-o", "a.png"});
    for (const auto& [option, part] : {std::pair{"--seed=3", "seed: expected 0, found 3"},
                                       {"--max-depth=5", "max_depth: expected 4096, found 5"},
                                       {"--first-sample=2", "first_sample: expected 0, found 2"},
                                       {"-iraycast", "integrator: expected \"path\", found \"raycast\""}}) {
        const CommandResult result = clrt({"--resume", "a.film", option, "-s", "4", "-o", "b.png"});
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_TRUE(holds(result.err, {"--resume", "a.film", part}));
    }
    folder.write("lamp.mtl", "newmtl white\nKd 0.6 0.7 0.7\nnewmtl lamp\nKd 0 0 0\nKe 9 8 6\n");
    CommandResult result = clrt({"--resume", "a.film", "-s", "4", "-o", "b.png"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(holds(result.err, {"they differ in scene: it is another one, or its files"}));
    result = clrt({"lamp.obj", "--resume", "a.png", "-o", "a.png"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(holds(result.err, {"option --resume: expected a file of its own, found 'a.png'"}));
    EXPECT_FALSE(exists("b.png"));
    folder.write("short.film", folder.read("a.film").substr(0, 3000));
    result = clrt({"lamp.obj", "--resume", "short.film", "-o", "b.png"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(holds(result.err, {"short.film: truncated: expected"}));
    EXPECT_EQ(clrt({"--resume", "none.film"}).exit_code, 1);
    CommandSettings elsewhere;
    std::filesystem::create_directory(folder.file("sub"));
    elsewhere.folder = folder.file("sub");
    result = clrt({"--resume", "../a.film"}, elsewhere);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(holds(result.err, {"in the folder of the film's command"}));
}

TEST_F(FilmCommand, AnInterruptedRunCanGoOn) {
    CommandSettings settings;
    settings.signals = {{0.1, SIGINT}};
    settings.signals_after_file = "a.film";
    std::vector<std::string> arguments = LONG_RUN;
    arguments.emplace_back("a.film,0.01s");
    EXPECT_EQ(clrt(arguments, settings).exit_code, 130);
    const std::uint64_t samples = film_samples(film("a.film").render.film);
    ASSERT_GE(samples, 1u);
    const std::string spp = std::to_string(samples + 3);
    EXPECT_EQ(clrt({"--resume", "a.film", "-s", spp, "-o", "a.exr", "--checkpoint", "a.film"}).exit_code, 0);
    render_part("whole", 0, int(samples) + 3);
    expect_same_film("a.film", "whole.film");
}

TEST_F(FilmCommand, AKilledRunLeavesAWholeFilm) {
    render_part("a", 0, 1, {"--size", "256x256", "-o", "a.png"});
    for (const double seconds : {0.8, 1.2, 1.7, 2.4}) {
        std::vector<std::string> command{CLRT_EXECUTABLE};
        command.insert(command.end(), LONG_RUN.begin(), LONG_RUN.end());
        // A film of 12 MB takes a while to write.
        command.insert(command.end(), {"a.film,0.01", "--size", "256x256", "--force"});
        CommandSettings settings;
        settings.folder = path();
        settings.signals = {{seconds, SIGKILL}};
        settings.environment["CLRT_DEVICE"] = test_device_name();
        EXPECT_EQ(run_command(command, settings).signal, SIGKILL);
        EXPECT_NO_THROW(film("a.film")) << "killed after " << seconds;
    }
}

TEST_F(FilmCommand, PicturesSoFarAreSavedAtWholePasses) {
    CommandSettings settings;
    settings.signals = {{0.5, SIGKILL}};
    settings.signals_after_file = "so_far.exr";
    std::vector<std::string> command{
        CLRT_EXECUTABLE, "lamp.obj", "-i",         "path",         "-t",  "60", "-s",
        "2000000",       "-o",       "so_far.exr", "--save-every", "0.1s"};
    settings.folder = path();
    settings.environment["CLRT_DEVICE"] = test_device_name();
    EXPECT_EQ(run_command(command, settings).signal, SIGKILL);
    ASSERT_TRUE(exists("so_far.exr"));
    const ReadPicture so_far(folder.file("so_far.exr"));
    const int samples = int(so_far.at(0, 0, "samples"));
    ASSERT_GE(samples, 1);
    render_part("whole", 0, samples);
    expect_same_picture("so_far.exr", "whole.exr");
    EXPECT_EQ(so_far.at(5, 5, "albedo.R"), ReadPicture(folder.file("whole.exr")).at(5, 5, "albedo.R"));
}

TEST_F(FilmCommand, OneSampleAPixelKeepsReplicatesApartOnlyWhereAFilmIsWritten) {
    const auto replicates = [&](const std::string& name) {
        return nlohmann::json::parse(folder.read(name))["replicates"].get<int>();
    };
    render_part("kept", 0, 1, {"--stats", "kept.json"});
    ASSERT_EQ(clrt({"lamp.obj", "--spp", "1", "-o", "alone.exr", "--stats", "alone.json"}).exit_code, 0);
    EXPECT_EQ(replicates("kept.json"), 4);
    EXPECT_EQ(replicates("alone.json"), 1);
    const ReadPicture kept(folder.file("kept.exr")), alone(folder.file("alone.exr"));
    EXPECT_EQ(alone.spec.channelnames, kept.spec.channelnames);
    EXPECT_EQ(alone.values, kept.values);
}

} // namespace clrt
