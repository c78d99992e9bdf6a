// SPDX-License-Identifier: Apache-2.0
// The command line: every option and its values.
#include "app/command_line.h"

#include "app/option_table.h"
#include "effects/effect_table.h"
#include "error.h"
#include "host/command_line_support.h"
#include "probes/scratch_folder.h"
#include "scene/camera_params.h"

#include <gtest/gtest.h>

namespace clrt {

TEST(CommandLine, DefaultsAreThoseOfTheInterface) {
    const Options o = parse({});
    EXPECT_EQ(o.scene.path, "scene.obj");
    EXPECT_EQ(o.transport.integrator, Integrator::PATH);
    EXPECT_EQ(o.transport.choose, Toggle::AUTO);
    EXPECT_FALSE(o.sampling.spp);
    EXPECT_FALSE(o.sampling.time_seconds);
    EXPECT_FALSE(o.sampling.error);
    EXPECT_EQ(effective_max_depth(o.transport), 4096);
    EXPECT_EQ(o.transport.roulette_depth, 5);
    EXPECT_EQ(o.transport.min_contribution, 0.002);
    EXPECT_EQ(o.sampling.replicates, 4);
    EXPECT_EQ(o.sampling.sampler, SamplerChoice::SOBOL);
    EXPECT_EQ(o.film.size, glm::ivec2(800, 600));
    EXPECT_EQ(o.output.files, std::vector<std::string>{"scene.png"});
    EXPECT_EQ(o.film.filter, Filter::BOX);
    EXPECT_EQ(o.run.check, Check::COUNT);
    EXPECT_FALSE(o.output.aovs);
    EXPECT_EQ(o.run.command, (std::vector<std::string>{"clrt", "scene.obj"}));
}

TEST(CommandLine, PictureIsNamedAfterTheSceneInTheCurrentFolder) {
    EXPECT_EQ(parse_all({"some/folder/my hall.v2.obj"}).options.output.files,
              std::vector<std::string>{"my hall.v2.png"});
}

TEST(CommandLine, DepthDefaultsDependOnTheIntegrator) {
    EXPECT_EQ(effective_max_depth(parse({"-i", "whitted"}).transport), 10);
    EXPECT_EQ(effective_max_depth(parse({"-i", "whitted", "--max-depth", "3"}).transport), 3);
    EXPECT_EQ(effective_max_depth(parse({"-i", "raycast", "--max-depth", "3"}).transport), 2);
    EXPECT_EQ(effective_max_depth(parse({"--max-depth", "3"}).transport), 3);
}

TEST(CommandLine, WorkOptionsArrive) {
    const Options o = parse({"-d",
                             "pocl",
                             "-i",
                             "raycast",
                             "-s",
                             "7",
                             "-t",
                             "90",
                             "--seed",
                             "3",
                             "-j",
                             "2",
                             "--precision",
                             "fast",
                             "--replicates",
                             "64",
                             "--bvh",
                             "bvh8",
                             "--min-contribution",
                             "2%",
                             "--roulette-depth",
                             "3",
                             "--first-sample",
                             "8"});
    EXPECT_EQ(o.device.name, "pocl");
    EXPECT_EQ(o.transport.integrator, Integrator::RAYCAST);
    EXPECT_EQ(o.sampling.spp, 7u);
    EXPECT_EQ(o.sampling.time_seconds, 90.0);
    EXPECT_EQ(o.sampling.seed, 3u);
    EXPECT_EQ(o.device.threads, 2);
    EXPECT_EQ(o.device.precision, Precision::FAST);
    EXPECT_EQ(o.sampling.replicates, 64);
    EXPECT_EQ(o.bvh.layout, BvhLayout::BVH8);
    EXPECT_EQ(o.transport.min_contribution, 0.02);
    EXPECT_EQ(o.transport.roulette_depth, 3);
    EXPECT_EQ(o.sampling.first_sample, 8u);
}

TEST(CommandLine, PictureOptionsArrive) {
    const Options o =
        parse({"-r", "1280X720", "-o", "a.PNG", "--output=b.exr", "--crop", "1,2,1280,720", "--filter",
               "tent:1.25", "--exposure", "-2", "--tonemap", "reinhard", "--aov", "N, Z"});
    EXPECT_EQ(o.film.size, glm::ivec2(1280, 720));
    EXPECT_EQ(o.output.files, (std::vector<std::string>{"a.PNG", "b.exr"}));
    ASSERT_TRUE(o.film.crop);
    EXPECT_EQ(o.film.crop->x0, 1);
    EXPECT_EQ(o.film.crop->y0, 2);
    EXPECT_EQ(o.film.crop->x1, 1280);
    EXPECT_EQ(o.film.crop->y1, 720);
    EXPECT_EQ(o.film.filter, Filter::TENT);
    EXPECT_EQ(o.film.filter_radius, 1.25);
    EXPECT_EQ(o.output.exposure_ev, -2);
    EXPECT_EQ(o.output.tonemap, Tonemap::REINHARD);
    EXPECT_EQ(o.output.aovs, (std::vector<std::string>{"N", "Z"}));
    EXPECT_TRUE(parse({"--aov", "none"}).output.aovs->empty());
    EXPECT_EQ(parse({"-i", "bdpt", "-o", "a.exr", "--aov", "N,strategies"}).output.strategies, 5);
    EXPECT_EQ(parse({"-i", "bdpt", "-o", "a.exr", "--aov", "strategies:8"}).output.strategies, 8);
    EXPECT_EQ(parse({}).output.exr_names, ExrNames::CLRT);
    EXPECT_EQ(parse({"--exr-names", "blender"}).output.exr_names, ExrNames::BLENDER);
    EXPECT_FALSE(o.output.auto_exposure);
    for (const auto& [text, ev] :
         std::map<std::string, double>{{"auto", 0}, {"auto+1", 1}, {"auto-0.5", -0.5}}) {
        EXPECT_TRUE(parse({"--exposure", text}).output.auto_exposure) << text;
        EXPECT_EQ(parse({"--exposure", text}).output.exposure_ev, ev) << text;
    }
    EXPECT_EQ(parse({"--tonemap", "filmic"}).output.tonemap, Tonemap::FILMIC);
    EXPECT_EQ(parse({"--tonemap", "agx"}).output.tonemap, Tonemap::AGX);
    EXPECT_EQ(o.scene.material_override, MaterialOverride::NONE);
    EXPECT_EQ(parse({"--material", "clay"}).scene.material_override, MaterialOverride::CLAY);
}

TEST(CommandLine, TreeTakesLayoutAndQuality) {
    EXPECT_FALSE(parse({}).bvh.quality);
    const Options both = parse({"--bvh", "high,bvh2"});
    EXPECT_EQ(both.bvh.layout, BvhLayout::BVH2);
    EXPECT_EQ(both.bvh.quality, BvhQuality::HIGH);
    const Options compressed = parse({"--bvh", "cwbvh,high"});
    EXPECT_EQ(compressed.bvh.layout, BvhLayout::CWBVH);
    EXPECT_EQ(compressed.bvh.quality, BvhQuality::HIGH);
    const Options quality = parse({"--bvh", "fast"});
    EXPECT_FALSE(quality.bvh.layout);
    EXPECT_EQ(quality.bvh.quality, BvhQuality::FAST);
    EXPECT_FALSE(parse({"--bvh", "high", "--bvh", "auto"}).bvh.quality);
}

TEST(CommandLine, CameraOptionsArrive) {
    const Options o = parse({"--eye", "-1,-2,-3", "--at=-.5,+1,1e2", "--up", "-0,1,-0", "--focal-length",
                             "35", "--film-width", "24"});
    EXPECT_EQ(o.camera.eye, glm::dvec3(-1, -2, -3));
    EXPECT_EQ(o.camera.at, glm::dvec3(-0.5, 1, 100));
    EXPECT_EQ(o.camera.up, glm::dvec3(0, 1, 0));
    EXPECT_EQ(o.camera.focal_length, 35.0);
    EXPECT_EQ(o.camera.film_width, 24.0);
    EXPECT_EQ(parse({"--fov", "39.3"}).camera.fov_degrees, 39.3);
    EXPECT_EQ(o.camera.projection, PROJECTION_PERSPECTIVE);
    EXPECT_EQ(parse({"--projection", "orthographic", "--ortho-height", "2.5"}).camera.ortho_height, 2.5);
    EXPECT_EQ(parse({"--projection", "fisheye", "--fov", "200"}).camera.fov_degrees, 200);
}

TEST(CommandLine, EveryProjectionHasItsNameAndIsInTheHelp) {
    const std::string help = find_option("--projection")->help;
    for (int i = 0; i < PROJECTION_COUNT; ++i) {
        const char* const name = name_of(Projection(i));
        EXPECT_EQ(parse({"--projection", name}).camera.projection, Projection(i));
        EXPECT_NE(help.find(name), std::string::npos) << name;
    }
}

TEST(CommandLine, StudioOptionsArrive) {
    EXPECT_TRUE(parse({}).light.studio);
    EXPECT_FALSE(parse({}).light.ground || parse({}).light.background);
    EXPECT_FALSE(parse({"--studio", "off"}).light.studio);
    EXPECT_EQ(parse({"--ground", "0.1,0.2,1"}).light.ground->albedo, glm::dvec3(0.1, 0.2, 1));
    EXPECT_TRUE(parse({"--ground", "none"}).light.ground &&
                !parse({"--ground", "none"}).light.ground->albedo);
    EXPECT_EQ(parse({"--background", "9,0,1"}).light.background->radiance, glm::dvec3(9, 0, 1));
    EXPECT_TRUE(has_transparent_background(parse({"--background", "transparent"}).light));
    EXPECT_FALSE(
        has_transparent_background(parse({"--background", "transparent", "--background", "1,1,1"}).light));
}

TEST(CommandLine, SpotsAndSkiesArrive) {
    const Options o =
        parse({"--spot", "1,2,3,0,-1,0,4,5,6", "--spot=1,2,3,0,-1,0,4,5,6,60,20", "--sky", "30,-120"});
    ASSERT_EQ(o.light.points.size(), 2u);
    EXPECT_EQ(o.light.points[0].position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(o.light.points[0].intensity, glm::dvec3(4, 5, 6));
    EXPECT_EQ(o.light.points[0].cone->direction, glm::dvec3(0, -1, 0));
    EXPECT_EQ(o.light.points[0].cone->outer_degrees, 45);
    EXPECT_EQ(o.light.points[0].cone->inner_degrees, 0);
    EXPECT_EQ(o.light.points[1].cone->outer_degrees, 60);
    EXPECT_EQ(o.light.points[1].cone->inner_degrees, 20);
    EXPECT_EQ(o.light.sky->azimuth_degrees, -120);
    EXPECT_EQ(o.light.sky->turbidity, 2.5);
    const Options given = parse({"--sky", "5,0,4,0.5"});
    EXPECT_EQ(given.light.sky->turbidity, 4);
    EXPECT_EQ(given.light.sky->ground_albedo, 0.5);
}

TEST(CommandLine, LightOptionsArrive) {
    const Options o = parse({"--env", "sky, blue.exr", "--env-scale", "2", "--env-rotate", "-90", "--sun",
                             "-1,2,3,4,5,6", "--sun=1,0,0,1,1,1,0.53", "--point", "-1,0,0,1,2,3", "--point",
                             "5,6,7,8,9,10", "--two-sided-lights"});
    EXPECT_EQ(o.light.environment_file, "sky, blue.exr");
    EXPECT_FALSE(o.light.environment);
    EXPECT_EQ(o.light.environment_scale, 2);
    EXPECT_EQ(o.light.environment_rotation_degrees, -90);
    ASSERT_EQ(o.light.suns.size(), 2u);
    EXPECT_EQ(o.light.suns[0].towards, glm::dvec3(-1, 2, 3));
    EXPECT_EQ(o.light.suns[0].irradiance, glm::dvec3(4, 5, 6));
    EXPECT_EQ(o.light.suns[0].diameter_degrees, 0);
    EXPECT_EQ(o.light.suns[1].diameter_degrees, 0.53);
    ASSERT_EQ(o.light.points.size(), 2u);
    EXPECT_EQ(o.light.points[1].position, glm::dvec3(5, 6, 7));
    EXPECT_EQ(o.light.points[1].intensity, glm::dvec3(8, 9, 10));
    EXPECT_TRUE(o.light.two_sided);
}

TEST(CommandLine, EnvironmentIsAColourWhereItLooksLikeNumbers) {
    const Options o = parse({"--env", "0.1, 0,1e1"});
    EXPECT_EQ(o.light.environment, glm::dvec3(0.1, 0, 10));
    EXPECT_TRUE(o.light.environment_file.empty());
    EXPECT_NE(refusal({"--env", "0.1,0.2", "s.obj"}).find("a radiance r,g,b"), std::string::npos);
    EXPECT_NE(refusal({"--env", "1,1,-1", "s.obj"}).find("a radiance r,g,b"), std::string::npos);
}

TEST(CommandLine, EffectsAreAListOrTakenAway) {
    const Options list = parse({"--effects", "matte, area-lights"});
    EXPECT_EQ(list.effects.list, std::optional<std::uint32_t>(EFFECT_MATTE | EFFECT_AREA_LIGHT));
    EXPECT_FALSE(list.effects.all);
    const Options less = parse({"--effects=all,-refraction,-interreflection"});
    EXPECT_TRUE(less.effects.all);
    EXPECT_EQ(less.effects.off, EFFECT_REFRACTION | EFFECT_INTERREFLECTION);
    EXPECT_EQ(parse({"--effects", "-matte"}).effects.off, EFFECT_MATTE);
    EXPECT_EQ(parse({"--effects", "all", "--effects", "auto"}).effects.all, false);
    EXPECT_NE(refusal({"--effects", "mate", "s.obj"}).find("the nearest to 'mate' is matte"),
              std::string::npos);
    for (const char* wrong : {"matte,all", "auto,matte", "-matte,glossy", ",", "-"})
        EXPECT_NE(refusal({std::string("--effects=") + wrong, "s.obj"}).find("--effects"), std::string::npos)
            << wrong;
}

TEST(CommandLine, PromisesAndRunOptionsArrive) {
    const Options o =
        parse({"--effects", "all", "--stats", "s.json", "--check", "off", "--kernels", "k", "--dump-kernels",
               "d", "--cache", "on", "--cache-dir", "c", "--progress", "on", "-v"});
    EXPECT_TRUE(o.effects.all);
    EXPECT_EQ(o.output.stats_path, "s.json");
    EXPECT_EQ(o.run.check, Check::OFF);
    EXPECT_EQ(o.device.kernels_folder, "k");
    EXPECT_EQ(o.device.dump_folder, "d");
    EXPECT_EQ(o.device.cache, Toggle::ON);
    EXPECT_EQ(o.device.cache_folder, "c");
    EXPECT_EQ(o.run.progress, Toggle::ON);
    EXPECT_EQ(o.run.verbosity, 1);
    EXPECT_EQ(parse({"-q"}).run.verbosity, -1);
    EXPECT_EQ(parse({"--no-cache"}).device.cache, Toggle::OFF);
    EXPECT_EQ(parse({"--check", "strict"}).run.check, Check::STRICT);
}

TEST(CommandLine, ExplainDoesNotSwallowTheScene) {
    EXPECT_EQ(parse({"--explain"}).run.explain, Explain::TABLE);
    EXPECT_EQ(parse({"--explain"}).scene.path, "scene.obj");
    EXPECT_EQ(parse({"--explain=json"}).run.explain, Explain::JSON);
    EXPECT_NE(refusal({"--explain=xml", "s.obj"}).find("--explain=json"), std::string::npos);
}

TEST(CommandLine, LedgerDoesNotSwallowTheScene) {
    EXPECT_EQ(parse({}).run.ledger, LedgerOf::NOTHING);
    EXPECT_EQ(parse({"--ledger"}).run.ledger, LedgerOf::SHOWN);
    EXPECT_EQ(parse({"--ledger"}).scene.path, "scene.obj");
    EXPECT_EQ(parse({"--ledger=absent"}).run.ledger, LedgerOf::ABSENT);
    EXPECT_NE(refusal({"--ledger=all", "s.obj"}).find("--ledger=absent"), std::string::npos);
}

TEST(CommandLine, AdaptiveNamesItsMeasureAndDoesNotSwallowTheScene) {
    EXPECT_FALSE(parse({}).sampling.adaptive);
    EXPECT_EQ(parse({}).sampling.measure(), ErrorMeasure::MSE);
    EXPECT_EQ(parse({"--adaptive"}).sampling.adaptive, ErrorMeasure::MSE);
    EXPECT_EQ(parse({"--adaptive"}).scene.path, "scene.obj");
    EXPECT_EQ(parse({"--adaptive=mse"}).sampling.adaptive, ErrorMeasure::MSE);
    EXPECT_EQ(parse({"--adaptive=relative"}).sampling.measure(), ErrorMeasure::RELATIVE);
    EXPECT_NE(refusal({"--adaptive=colour", "s.obj"}).find("mse or relative"), std::string::npos);
}

TEST(CommandLine, DurationsHaveUnits) {
    EXPECT_EQ(parse({"-t", "90s"}).sampling.time_seconds, 90.0);
    EXPECT_EQ(parse({"-t", "5m"}).sampling.time_seconds, 300.0);
    EXPECT_EQ(parse({"-t", "1.5h"}).sampling.time_seconds, 5400.0);
}

TEST(CommandLine, TheErrorTargetIsAFractionOrPercent) {
    EXPECT_EQ(parse({"-e", "0.02"}).sampling.error, 0.02);
    EXPECT_EQ(parse({"--error=2%"}).sampling.error, 0.02);
}

TEST(CommandLine, ACheckpointMayHaveAnInterval) {
    const auto expect = [](const std::string& text, const std::string& path, double seconds) {
        const Options o = parse({"--checkpoint", text});
        EXPECT_EQ(o.film_file.checkpoint_path, path);
        EXPECT_EQ(o.film_file.checkpoint_seconds, seconds);
    };
    expect("a.film", "a.film", 300);
    expect("a.film,90s", "a.film", 90);
    expect("a,b.film", "a,b.film", 300);
    expect("a,b.film,1.5m", "a,b.film", 90);
    EXPECT_NE(
        refusal({"--checkpoint", "a.film,5d", "s.obj"}).find("option --checkpoint: expected a duration"),
        std::string::npos);
    EXPECT_NE(refusal({"--checkpoint", ",5s", "s.obj"}).find("option --checkpoint: expected a path"),
              std::string::npos);
    EXPECT_NE(refusal({"--checkpoint", "a.png", "-o", "a.png", "s.obj"}).find("a file of its own"),
              std::string::npos);
}

TEST(CommandLine, TheCommandOfAFilmLacksWhatIsAboutOneRunAlone) {
    const Options o =
        parse({"--resume", "a.film", "-s", "16", "--checkpoint=b.film", "-v", "--force", "--progress", "on"});
    EXPECT_EQ(o.film_file.resume_path, "a.film");
    EXPECT_EQ(o.film_file.checkpoint_path, "b.film");
    EXPECT_TRUE(o.film_file.force);
    EXPECT_EQ(o.run.resumable_command,
              (std::vector<std::string>{"clrt", "--spp=16", "--checkpoint=b.film", "--", "scene.obj"}));
}

TEST(CommandLine, AResumedFilmIsWrittenAnewUnlessTheCommandLineNamesAnother) {
    EXPECT_EQ(parse({"--resume", "a.film"}).film_file.checkpoint_path, "a.film");
    EXPECT_EQ(parse({"-s", "16"}).film_file.checkpoint_path, "");
}

TEST(CommandLine, UpMayBeTheNameOfAnAxis) {
    EXPECT_EQ(parse({"--up", "x"}).camera.up, glm::dvec3(1, 0, 0));
    EXPECT_EQ(parse({"--up=y"}).camera.up, glm::dvec3(0, 1, 0));
    EXPECT_EQ(parse({"--up", "z"}).camera.up, glm::dvec3(0, 0, 1));
    EXPECT_EQ(parse({"--up", "0,0,-2"}).camera.up, glm::dvec3(0, 0, -2));
    EXPECT_NE(refusal({"--up", "0,0,0", "s.obj"}).find("x, y, z, or a direction"), std::string::npos);
}

TEST(CommandLine, FramesNumberTheNamesOfOutputs) {
    const Options o = parse({"--frames", "3", "--stats", "a.json", "-o", "b.png", "-o", "{frame}.exr"});
    EXPECT_EQ(o.output.files, (std::vector<std::string>{"b-{frame:4}.png", "{frame}.exr"}));
    EXPECT_EQ(o.output.stats_path, "a-{frame:4}.json");
    EXPECT_EQ(parse({}).output.files.front(), "scene.png");
}

TEST(CommandLine, ShortOptionsCanBeGlued) {
    const Options o = parse({"-s4", "-r16x8", "-lv"});
    EXPECT_EQ(o.sampling.spp, 4u);
    EXPECT_EQ(o.film.size, glm::ivec2(16, 8));
    EXPECT_TRUE(o.run.list_devices);
    EXPECT_EQ(o.run.verbosity, 1);
}

TEST(CommandLine, LastValueCounts) {
    EXPECT_EQ(parse({"--spp", "4", "--spp", "8"}).sampling.spp, 8u);
    EXPECT_FALSE(parse({"--filter", "tent:2", "--filter", "box"}).film.filter_radius);
    EXPECT_TRUE(parse({"--env", "1,1,1", "--env", "a.exr"}).light.environment == std::nullopt);
}

TEST(CommandLine, StatisticsNeverReplaceTheScene) {
    ScratchFolder folder;
    const std::string scene = folder.write("box.obj", "v 0 0 0\n");
    EXPECT_NE(refusal({"--stats", folder.file("./box.obj"), scene}).find("would replace the scene"),
              std::string::npos);
}

} // namespace clrt
