// SPDX-License-Identifier: Apache-2.0
// Which film a run writes, and that no film is lost: a resumed run goes on in its own film, and samples are
// replaced by fewer or by others only with --force.
#include "clrt_command.h"
#include "film/film_file.h"

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

namespace clrt {

namespace {

class FilmReplacement : public ClrtCommand {
protected:
    FilmReplacement() { write_square("scene"); }

    /// Renders scene.obj, or what the arguments name, and returns the result.
    CommandResult render(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(), {"-i", "raycast", "-r", "16x12"});
        return clrt(arguments);
    }
    /// A film of the scene, NAME, with so many samples a pixel.
    void make_film(const std::string& name, int spp, const std::vector<std::string>& further = {}) const {
        std::vector<std::string> arguments = {"scene.obj", "-s", std::to_string(spp), "--checkpoint", name};
        arguments.insert(arguments.end(), further.begin(), further.end());
        const CommandResult result = render(arguments);
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    std::uint64_t samples(const std::string& name) const {
        return film_samples(read_film_file(folder.file(name)).render.film);
    }
    CommandResult merge(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), CLRT_MERGE_EXECUTABLE);
        CommandSettings settings;
        settings.folder = path();
        return run_command(arguments, settings);
    }
    /// Expects this exit code and message, and that the film stays as it is.
    void expect_kept(const std::string& name, const CommandResult& result, int code,
                     const std::vector<std::string>& message, const std::string& before) const {
        EXPECT_EQ(result.exit_code, code) << result.err;
        EXPECT_TRUE(holds(result.err, message));
        EXPECT_TRUE(folder.read(name) == before) << name;
    }
    nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(folder.read(name)); }
};

} // namespace

TEST_F(FilmReplacement, AResumedRunWritesTheFilmThatItResumed) {
    make_film("a.film", 32, {"-o", "a.png"});
    const std::string before = folder.read("a.film");
    std::filesystem::copy_file(folder.file("a.film"), folder.file("b.film"));
    // A copy that is resumed alone leaves the film in its command as it is.
    CommandResult result = clrt({"--resume", "b.film", "-s", "40", "--stats", "s.json"});
    expect_kept("a.film", result, 0, {"resumed at 32 spp", "wrote b.film"}, before);
    EXPECT_EQ(samples("b.film"), 40u);
    EXPECT_EQ(json("s.json")["resumed_at_spp"], 32);
    EXPECT_EQ(json("s.json")["spp"], 40);
    // So does the whole command.
    result = render({"scene.obj", "--resume", "b.film", "-s", "48"});
    expect_kept("a.film", result, 0, {"resumed at 40 spp", "wrote b.film"}, before);
    EXPECT_EQ(samples("b.film"), 48u);
    // Unless it is told otherwise.
    result = clrt({"--resume", "b.film", "-s", "64", "--checkpoint", "c.film"});
    expect_kept("a.film", result, 0, {"wrote c.film"}, before);
    EXPECT_EQ(samples("b.film"), 48u);
    EXPECT_EQ(samples("c.film"), 64u);
    // A film named in the options file is not "told otherwise".
    folder.write("scene.clrt", "--checkpoint a.film\n");
    result = render({"scene.obj", "--resume", "b.film", "-s", "56"});
    expect_kept("a.film", result, 0, {"wrote b.film"}, before);
    EXPECT_EQ(samples("b.film"), 56u);
}

TEST_F(FilmReplacement, AFreshRunAsksWhatToDoWithAFilmThatIsThere) {
    make_film("a.film", 8);
    const std::string before = folder.read("a.film");
    std::filesystem::remove(folder.file("scene.png"));
    for (const char* spp : {"4", "8", "64"})
        expect_kept("a.film", render({"scene.obj", "-s", spp, "--checkpoint", "a.film"}), 2,
                    {"--checkpoint", "a.film", "8 spp", "--resume a.film", "--force"}, before);
    EXPECT_FALSE(exists("scene.png")) << "it is asked before rendering";
    EXPECT_EQ(render({"scene.obj", "-s", "4", "--checkpoint", "a.film", "--force"}).exit_code, 0);
    EXPECT_EQ(samples("a.film"), 4u);
    folder.write("text.film", "no film");
    expect_kept("text.film", render({"scene.obj", "-s", "4", "--checkpoint", "text.film"}), 2,
                {"--checkpoint", "text.film", "--force"}, "no film");
    EXPECT_EQ(render({"scene.obj", "-s", "4", "--checkpoint", "text.film", "--force"}).exit_code, 0);
    EXPECT_EQ(samples("text.film"), 4u);
    // What renders no film asks nothing.
    EXPECT_EQ(render({"scene.obj", "--checkpoint", "a.film", "--explain"}).exit_code, 0);
    EXPECT_EQ(render({"scene.obj", "--checkpoint", "a.film", "--pixel", "3,3"}).exit_code, 0);
}

TEST_F(FilmReplacement, AnotherFilmIsReplacedByMoreOfTheSameOnly) {
    make_film("small.film", 8);
    make_film("large.film", 32);
    make_film("seed.film", 4, {"--seed", "3"});
    make_film("late.film", 4, {"--first-sample", "64"});
    folder.write("text", "no film");
    const std::vector<std::string> resume = {"--resume", "small.film", "-s", "64", "--checkpoint"};
    for (const auto& [name, part] : {std::pair{"large.film", "32 spp"},
                                     {"seed.film", "seed: expected 3, found 0"},
                                     {"late.film", "samples 64 to 67"},
                                     {"text", "no film"}}) {
        const std::string before = folder.read(name);
        std::vector<std::string> arguments = resume;
        arguments.push_back(name);
        expect_kept(name, clrt(arguments), 2, {"--checkpoint", name, part, "--force"}, before);
    }
    std::vector<std::string> forced = resume;
    forced.insert(forced.end(), {"seed.film", "--force"});
    EXPECT_EQ(clrt(forced).exit_code, 0);
    EXPECT_EQ(samples("seed.film"), 64u);
    // A film whose samples are all in the resumed one.
    EXPECT_EQ(clrt({"--resume", "large.film", "-s", "64", "--checkpoint", "small.film"}).exit_code, 0);
    EXPECT_EQ(samples("small.film"), 64u);
}

TEST_F(FilmReplacement, AFilmThatAnotherRunPutThereMeanwhileIsNotReplaced) {
    make_film("a.film", 8);
    make_film("seed.film", 4, {"--seed", "3"});
    const std::string other = folder.read("seed.film");
    std::filesystem::remove(folder.file("scene.png"));
    // When the first picture so far is there, the render goes on: the other film comes, then the signal.
    std::thread other_run([&] {
        for (int i = 0; i < 6000 && !exists("slow.png"); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        std::filesystem::rename(folder.file("seed.film"), folder.file("a.film"));
        folder.write("moved", "");
    });
    CommandSettings settings;
    settings.signals = {{0.1, SIGINT}};
    settings.signals_after_file = "moved";
    const CommandResult result =
        clrt({"--resume", "a.film", "-t", "60", "-s", "2000000", "-o", "slow.png", "--save-every", "0.05"},
             settings);
    other_run.join();
    expect_kept("a.film", result, 1, {"a.film", "seed: expected 3, found 0", "--force"}, other);
    EXPECT_TRUE(exists("slow.png"));
}

TEST_F(FilmReplacement, NothingToRenderIsSaidAsItIs) {
    make_film("a.film", 32);
    const std::string before = folder.read("a.film");
    std::filesystem::remove(folder.file("scene.png"));
    CommandResult result = clrt({"--resume", "a.film", "-s", "16"});
    expect_kept("a.film", result, 0, {"the film has 32 spp already", "--spp 16", "wrote scene.png"}, before);
    EXPECT_TRUE(holds(result.out, {"32 spp"}));
    EXPECT_EQ(result.err.find("16 is complete"), std::string::npos) << result.err;
    EXPECT_EQ(result.out.find("16 is complete"), std::string::npos) << result.out;
    result = clrt({"--resume", "a.film", "-s", "32"});
    expect_kept("a.film", result, 0, {"--spp 32 is complete"}, before);
}

TEST_F(FilmReplacement, HowARunTalksIsNotInherited) {
    make_film("a.film", 4, {"-q", "--progress", "on"});
    const CommandResult result = clrt({"--resume", "a.film", "-s", "8"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(holds(result.err, {"resumed at 4 spp", "wrote a.film"}));
    EXPECT_TRUE(holds(result.out, {"8 spp"}));
    // Nor is what it was allowed to replace.
    make_film("b.film", 4, {"--force", "-v"});
    make_film("c.film", 4, {"--seed", "3"});
    const std::string before = folder.read("c.film");
    expect_kept("c.film", clrt({"--resume", "b.film", "-s", "8", "--checkpoint", "c.film"}), 2, {"--force"},
                before);
}

TEST_F(FilmReplacement, MergingReplacesNoFilmByFewerSamples) {
    make_film("a.film", 4);
    make_film("b.film", 4, {"--first-sample", "4"});
    make_film("whole.film", 16);
    make_film("seed.film", 4, {"--seed", "3"});
    for (const char* name : {"whole.film", "seed.film"}) {
        const std::string before = folder.read(name);
        expect_kept(name, merge({"a.film", "b.film", "-o", "out.png", "-o", name}), 2, {name, "--force"},
                    before);
        EXPECT_FALSE(exists("out.png"));
    }
    EXPECT_EQ(merge({"a.film", "b.film", "-o", "ab.film"}).exit_code, 0);
    EXPECT_EQ(merge({"a.film", "b.film", "-o", "ab.film"}).exit_code, 0) << "the same again";
    EXPECT_EQ(merge({"a.film", "b.film", "-o", "seed.film", "--force"}).exit_code, 0);
    EXPECT_EQ(samples("seed.film"), 8u);
}

} // namespace clrt
