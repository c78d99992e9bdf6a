// SPDX-License-Identifier: Apache-2.0
// The picture has the same bits with any number of threads, in every instruction set that PoCL compiles for
// here, and on every CPU device that is there and promises it. With one device only, the fixed bits of the
// functions (real_functions_test) and the rules of the device (device_facts_test) say what others give.
#include "clrt_command.h"
#include "film/film_file.h"
#include "support/instruction_sets.h"

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

namespace clrt {

namespace {

/// A picture with all its layers, and the film behind it.
struct RenderedBits {
    std::vector<float> channels;
    std::vector<std::int64_t> sums;
    bool promised = false;
};

class SameBitsCommand : public ClrtCommand {
protected:
    /// Renders the scene that has every effect; `more` are further arguments.
    RenderedBits render(const std::string& integrator, const std::vector<std::string>& more,
                        const CommandSettings& settings = {}) const {
        std::vector<std::string> arguments = {std::string(CLRT_SCENES_FOLDER) +
                                                  "/every_effect/every_effect.obj",
                                              "-i",
                                              integrator,
                                              "-r",
                                              "48x32",
                                              "-s",
                                              "8",
                                              "-o",
                                              "p.exr",
                                              "--checkpoint",
                                              "p.film",
                                              "--force",
                                              "--stats",
                                              "p.json",
                                              "-q"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const CommandResult result = clrt(arguments, settings);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        std::ifstream stats(folder.file("p.json"));
        const auto same_bits = nlohmann::json::parse(stats)["device"]["same_bits"];
        return {ReadPicture(folder.file("p.exr")).values,
                read_film_file(folder.file("p.film")).render.film.sums,
                same_bits.is_boolean() && same_bits.get<bool>()};
    }

    /// Indices of all CPU devices, as --device takes them.
    std::vector<std::string> cpu_devices() const {
        std::vector<std::string> indices;
        const std::string list = clrt({"--list-devices"}).out;
        const std::regex row(R"((\d+:\d+) .*  CPU  .*)");
        for (std::sregex_iterator match(list.begin(), list.end(), row), end; match != end; ++match)
            indices.push_back((*match)[1]);
        return indices;
    }
};

void expect_same(const RenderedBits& a, const RenderedBits& b, const std::string& what) {
    ASSERT_EQ(a.sums.size(), b.sums.size()) << what;
    ASSERT_EQ(a.channels.size(), b.channels.size()) << what;
    size_t sums = 0, channels = 0;
    for (size_t i = 0; i < a.sums.size(); ++i)
        sums += a.sums[i] != b.sums[i];
    // As words: two NaN would differ as numbers, 0 and -0 would not.
    for (size_t i = 0; i < a.channels.size(); ++i)
        channels += std::memcmp(&a.channels[i], &b.channels[i], sizeof(float)) != 0;
    EXPECT_EQ(sums, 0u) << what << ", of " << a.sums.size();
    EXPECT_EQ(channels, 0u) << what << ", of " << a.channels.size();
}

} // namespace

TEST_F(SameBitsCommand, ThreadsAndDevicesDoNotChangeThePicture) {
    const std::vector<std::string> devices = cpu_devices();
    RecordProperty("cpu_devices", int(devices.size()));
    for (const char* integrator : {"path", "distribution", "whitted", "raycast"}) {
        const RenderedBits whole = render(integrator, {});
        EXPECT_TRUE(whole.promised);
        expect_same(whole, render(integrator, {"--threads", "1"}), std::string(integrator) + ", one thread");
        if (devices.size() < 2)
            continue;
        for (const std::string& device : devices)
            if (const RenderedBits other = render(integrator, {"--device", device}); other.promised)
                expect_same(whole, other, std::string(integrator) + ", device " + device);
    }
    // The comparison sees a difference.
    const RenderedBits other = render("raycast", {"--seed", "1"});
    EXPECT_NE(other.sums, render("raycast", {}).sums);
}

TEST_F(SameBitsCommand, InstructionSetsDoNotChangeThePicture) {
    const RenderedBits widest = render("path", {});
    for (const InstructionSet& set : instruction_sets()) {
        CommandSettings settings;
        settings.environment[InstructionSet::VARIABLE] = set.name;
        const RenderedBits other = render("path", {}, settings);
        EXPECT_TRUE(other.promised) << set.name;
        expect_same(widest, other, set.name);
    }
}

} // namespace clrt
