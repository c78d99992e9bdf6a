// SPDX-License-Identifier: Apache-2.0
// Homes and temporary folders in which nothing can be kept.
#include "clrt_command.h"

namespace clrt {

namespace {

class HomeFolder : public ClrtCommand {
protected:
    HomeFolder() {
        write_square("scene");
        folder.write("file", "");
        std::filesystem::create_directory(folder.file("tmp"));
    }
    /// Circumstances of a user without a folder to keep things in: not even root can make folders there.
    CommandSettings without_home(const std::string& home, const std::string& temporary) const {
        CommandSettings settings;
        settings.environment = {{"HOME", home}, {"XDG_CACHE_HOME", ""}, {"TMPDIR", temporary}};
        return settings;
    }
    bool is_pocl() const { return test_device_name() == "pocl"; }
};

} // namespace

TEST_F(HomeFolder, ADriverWithoutAPlaceForItsCacheGetsATemporaryOne) {
    if (!is_pocl())
        GTEST_SKIP() << "PoCL lists no device unless it can make its cache folder; others do not mind";
    for (const std::string& home : {folder.file("file"), std::string("/proc")}) {
        const CommandSettings settings = without_home(home, folder.file("tmp"));
        const CommandResult result = clrt(quick({"scene.obj"}), settings);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_TRUE(holds(result.err, {"clrt: warning: ", "cache", "temporary folder", "POCL_CACHE_DIR"}));
        EXPECT_TRUE(exists("scene.png"));
        EXPECT_TRUE(std::filesystem::is_empty(folder.file("tmp"))) << "it is gone with the run";
        const CommandResult list = clrt({"--list-devices"}, settings);
        EXPECT_EQ(list.exit_code, 0);
        EXPECT_TRUE(holds(list.out, {"Portable Computing Language", "0:0", "POCL_CACHE_DIR"}));
        EXPECT_EQ(list.out.find("apt install"), std::string::npos) << list.out;
        EXPECT_TRUE(std::filesystem::is_empty(folder.file("tmp")));
    }
}

TEST_F(HomeFolder, WithoutAnyPlaceTheMessageNamesTheCause) {
    if (!is_pocl())
        GTEST_SKIP() << "a habit of PoCL";
    const CommandResult result = clrt(quick({"scene.obj"}), without_home("/proc", "/proc"));
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_TRUE(holds(result.err, {"POCL_CACHE_DIR"}));
    EXPECT_EQ(result.err.find("apt install"), std::string::npos) << "PoCL is there\n" << result.err;
    EXPECT_FALSE(exists("scene.png"));
}

TEST_F(HomeFolder, OurOwnCacheThatCannotBeWrittenIsSaid) {
    const CommandSettings settings = without_home("/proc", folder.file("tmp"));
    const CommandResult result = clrt(quick({"scene.obj", "--cache", "on"}), settings);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.err, {"clrt: warning: ", "/proc/.cache/clrt", "--cache-dir"}));
    EXPECT_EQ(clrt(quick({"scene.obj", "--cache", "on", "--cache-dir", folder.file("mine")}), settings)
                  .err.find("--cache-dir"),
              std::string::npos);
    EXPECT_EQ(clrt(quick({"scene.obj", "--cache", "off"}), settings).err.find("--cache-dir"),
              std::string::npos)
        << "nothing is to be kept";
}

} // namespace clrt
