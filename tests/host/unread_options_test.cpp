// SPDX-License-Identifier: Apache-2.0
#include "host/command_line_support.h"
#include "options/unread_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace clrt {

namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

} // namespace

TEST(UnreadOptions, ThoseOfOtherIntegratorsAreTold) {
    EXPECT_THAT(
        unread_options(parse({"-i", "whitted", "--gloss-rays", "4", "--max-depth", "3"})),
        ElementsAre("--gloss-rays changes nothing with --integrator whitted: it is for distribution"));
    EXPECT_THAT(unread_options(parse({"-i", "mlt", "--emission-rays", "4", "--light-samples", "2"})),
                ElementsAre(StartsWith("--emission-rays changes nothing with --integrator mlt"),
                            "--light-samples changes nothing with --integrator mlt: it is for path"));
    // They ask for what is done without them as well.
    EXPECT_THAT(unread_options(parse({"-i", "mlt", "--emission-rays", "1", "--light-samples", "auto",
                                      "--guide", "off", "--path-reuse", "auto"})),
                IsEmpty());
}

TEST(UnreadOptions, OptionsFilesAreForAllIntegrators) {
    Options options = parse({"-i", "raycast", "--max-depth", "5"});
    EXPECT_EQ(unread_options(options).size(), 1u);
    options.run.given["--max-depth"] = "scene.clrt:3";
    EXPECT_THAT(unread_options(options), IsEmpty());
}

TEST(UnreadOptions, AnEnvironmentMustBeThereToBeTurned) {
    EXPECT_EQ(unread_options(parse({"--env-rotate", "30"})).size(), 1u);
    EXPECT_EQ(unread_options(parse({"--env", "1,1,1", "--env-rotate", "30"})).size(), 1u);
    EXPECT_THAT(unread_options(parse({"--env", "sky.hdr", "--env-rotate", "30"})), IsEmpty());
    EXPECT_EQ(unread_options(parse({"--env-scale", "2"})).size(), 1u);
    EXPECT_THAT(unread_options(parse({"--env", "1,1,1", "--env-scale", "2"})), IsEmpty());
    EXPECT_THAT(unread_options(parse({"--sky", "30,0", "--env-scale", "2"})), IsEmpty());
}

TEST(UnreadOptions, ACameraThatIsPlacedIsNoneOfTheFile) {
    EXPECT_THAT(unread_options(parse({"--camera", "1"})), IsEmpty());
    for (const std::vector<std::string>& place :
         {std::vector<std::string>{"--eye", "1,2,3"}, {"--view", "front"}})
        EXPECT_THAT(unread_options(parse({"--camera", "1", place[0], place[1]})),
                    ElementsAre("--camera changes nothing: --eye, --at or --view place the camera"));
    Options options = parse({"--camera", "1", "--at", "0,0,0"});
    options.run.given["--camera"] = "scene.clrt:3";
    EXPECT_THAT(unread_options(options), IsEmpty());
}

} // namespace clrt
