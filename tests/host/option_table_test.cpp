// SPDX-License-Identifier: Apache-2.0
// The table of options: every one is accepted and stands in the help.
#include "app/option_table.h"

#include "app/help_text.h"
#include "host/command_line_support.h"

#include <gtest/gtest.h>
#include <map>
#include <sstream>

namespace clrt {

namespace {

/// A valid value of every option; flags have "".
const std::map<std::string, std::string>& samples() {
    static const std::map<std::string, std::string> values = {
        {"--device", "pocl"},
        {"--list-devices", ""},
        {"--integrator", "whitted"},
        {"--spp", "16"},
        {"--time", "5m"},
        {"--error", "2%"},
        {"--denoised-error", "5%"},
        {"--max-depth", "12"},
        {"--guide", "auto"},
        {"--path-reuse", "on"},
        {"--emission-rays", "4"},
        {"--light-samples", "4"},
        {"--roulette-depth", "9"},
        {"--min-contribution", "0.5%"},
        {"--shadow-rays", "8"},
        {"--gloss-rays", "64"},
        {"--translucent-rays", "1"},
        {"--denoise", ""},
        {"--oidn", "libOpenImageDenoise.so.2"},
        {"--png-from", "raw"},
        {"--instances", "on"},
        {"--texture-filter", "footprint"},
        {"--seed", "4294967295"},
        {"--first-sample", "32"},
        {"--replicates", "8"},
        {"--adaptive", ""},
        {"--sampler", "independent"},
        {"--light-sampler", "power"},
        {"--precision", "double"},
        {"--threads", "2"},
        {"--bvh", "bvh2"},
        {"--mtl", "plain"},
        {"--gltf-lights", "raw"},
        {"--gltf-solid-glass", ""},
        {"--camera", "Camera.001"},
        {"--material", "clay"},
        {"--size", "320x200"},
        {"--output", "a.exr"},
        {"--frames", "36"},
        {"--crop", "10,20,30,40"},
        {"--filter", "gaussian:2"},
        {"--exposure", "-1.5"},
        {"--tonemap", "aces"},
        {"--aov", "albedo,N"},
        {"--exr-names", "blender"},
        {"--eye", "-1,2,-3.5"},
        {"--at", "-0,.5,1e2"},
        {"--up", "0,0,1"},
        {"--view", "iso"},
        {"--projection", "orthographic"},
        {"--ortho-height", "2.5"},
        {"--fov", "35"},
        {"--focal-length", "50"},
        {"--film-width", "36"},
        {"--shift", "0.5,-0.25"},
        {"--aperture", "0.1"},
        {"--fstop", "2.8"},
        {"--focus", "1,2,3"},
        {"--blades", "6"},
        {"--end", "end.obj"},
        {"--animation-time", "1.5,1.54"},
        {"--animation", "walk"},
        {"--end-eye", "1,2,3"},
        {"--end-at", "1,2,3"},
        {"--end-up", "z"},
        {"--shutter", "0,0.5"},
        {"--env", "0.1,0.2,0.3"},
        {"--env-scale", "2"},
        {"--env-rotate", "-90"},
        {"--sun", "1,2,3,4,5,6,0.5"},
        {"--point", "-1,2,3,4,5,6"},
        {"--spot", "1,2,3,0,-1,0,4,5,6,30,10"},
        {"--sky", "30,120,3,0.3"},
        {"--two-sided-lights", ""},
        {"--studio", "auto"},
        {"--ground", "none"},
        {"--background", "transparent"},
        {"--explain", ""},
        {"--ledger", ""},
        {"--effects", "all"},
        {"--paths", "L(D|S)*E"},
        {"--stats", "run.json"},
        {"--check", "strict"},
        {"--pixel", "3,4"},
        {"--sample", "5"},
        {"--checkpoint", "a.film,90s"},
        {"--resume", "a.film"},
        {"--force", ""},
        {"--save-every", "1m"},
        {"--serve", "0,stay"},
        {"--display-server", "localhost:14158"},
        {"--kernels", "kernels"},
        {"--dump-kernels", "dump"},
        {"--cache", "on"},
        {"--no-cache", ""},
        {"--cache-dir", "cache"},
        {"--progress", "off"},
        {"--quiet", ""},
        {"--verbose", ""},
        {"--no-sidecar", ""},
        {"--help", ""},
        {"--version", ""},
    };
    return values;
}

/// What an option needs beside it.
std::vector<std::string> companions(const std::string& option) {
    if (option == "--focal-length")
        return {"--film-width", "36"};
    if (option == "--film-width")
        return {"--focal-length", "50"};
    if (option == "--ortho-height")
        return {"--projection", "orthographic"};
    if (option == "--fstop")
        return {"--focal-length", "50", "--film-width", "36"};
    if (option == "--focus" || option == "--blades")
        return {"--aperture", "0.1"};
    if (option == "--shutter")
        return {"--end-eye", "1,2,3"};
    if (option == "--animation")
        return {"--animation-time", "2"};
    if (option == "--sample")
        return {"--pixel", "3,4"};
    return {};
}

} // namespace

TEST(OptionTable, EveryOptionOfTheTableIsAccepted) {
    for (const OptionSpec& spec : option_table()) {
        ASSERT_TRUE(samples().count(spec.long_name)) << spec.long_name << " has no sample value in this test";
        const std::string name = spec.long_name, value = samples().at(name);
        std::vector<std::string> apart = companions(name), joined = apart;
        apart.push_back(name);
        if (!value.empty())
            apart.push_back(value);
        joined.push_back(value.empty() ? name : name + "=" + value);
        apart.emplace_back("scene.obj");
        joined.emplace_back("scene.obj");
        EXPECT_EQ(refusal(apart), "accepted") << name;
        EXPECT_EQ(refusal(joined), "accepted") << name;
    }
    EXPECT_EQ(samples().size(), option_table().size());
}

TEST(OptionTable, HelpNamesEveryOptionAndFitsTheTerminal) {
    for (const size_t columns : {80, 100}) {
        const std::string help = help_text(columns);
        for (const OptionSpec& spec : option_table())
            EXPECT_NE(help.find(std::string(spec.long_name) + (is_flag(spec) ? "" : " ") + spec.value_name),
                      std::string::npos)
                << spec.long_name;
        for (const char* heading :
             {"Work:", "Picture:", "Camera:", "Light:", "The promises:", "Runs:", "Exit codes:"})
            EXPECT_NE(help.find(std::string("\n") + heading + "\n"), std::string::npos) << heading;
        std::istringstream lines(help);
        for (std::string line; std::getline(lines, line);)
            EXPECT_LE(line.size(), columns) << line;
    }
}

TEST(OptionTable, HelpAndVersionNeedNoScene) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"-h"}, {"--nonsense", "--help"}}) {
        const std::optional<std::string> text = parse_all(arguments).print;
        ASSERT_TRUE(text);
        EXPECT_EQ(text->find("Usage: clrt [options] scene.obj\n"), 0u);
    }
    EXPECT_EQ(parse_all({"--version"}).print, "clrt " CLRT_VERSION "\n");
    EXPECT_TRUE(parse_all({"-l"}).options.run.list_devices);
}

} // namespace clrt
