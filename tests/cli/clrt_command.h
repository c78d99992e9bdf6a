// SPDX-License-Identifier: Apache-2.0
// Runs the built clrt in a folder of the test's own.
#pragma once

#include "probes/scratch_folder.h"
#include "support/run_command.h"
#include "support/test_device.h"

#include <algorithm>
#include <filesystem>
#include <gtest/gtest.h>
#include <OpenImageIO/imageio.h>
#include <string>
#include <vector>

namespace clrt {

/// A picture file as floats, all channels.
struct ReadPicture {
    OIIO::ImageSpec spec;
    std::vector<float> values;

    explicit ReadPicture(const std::string& path) {
        const auto input = OIIO::ImageInput::open(path);
        if (!input)
            throw std::runtime_error("cannot open " + path + ": " + OIIO::geterror());
        spec = input->spec();
        values.resize(size_t(spec.image_pixels()) * size_t(spec.nchannels));
        if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data()))
            throw std::runtime_error("cannot read " + path + ": " + input->geterror());
    }
    /// A value of the pixel at column x and row y of the file's window; the channel by its name.
    float at(int x, int y, const std::string& channel) const {
        const int index = spec.channelindex(channel);
        if (index < 0)
            throw std::runtime_error("no channel " + channel);
        const double value = double(values[size_t((y * spec.width + x) * spec.nchannels + index)]);
        const bool is_id = spec.channelformat(index) == OIIO::TypeDesc::UINT32; // read as a share of 2^32 - 1
        return float(is_id ? value * 4294967295.0 : value);
    }
};

/// A test that runs clrt; the scratch folder is the current folder of the command.
class ClrtCommand : public testing::Test {
protected:
    /// Runs clrt with these arguments. The device is that of the other tests.
    CommandResult clrt(const std::vector<std::string>& arguments, CommandSettings settings = {}) const {
        settings.environment.emplace("CLRT_DEVICE", test_device_name());
        if (settings.folder.empty())
            settings.folder = path();
        std::vector<std::string> command{CLRT_EXECUTABLE};
        command.insert(command.end(), arguments.begin(), arguments.end());
        const CommandResult result = run_command(command, settings);
        EXPECT_EQ(result.signal, 0) << "clrt crashed or hung:\n" << result.err;
        return result;
    }
    /// lamp.obj: a floor below a lamp, with its camera.
    void write_lamp() const {
        folder.write("lamp.mtl", "newmtl white\nKd 0.7 0.7 0.7\nnewmtl lamp\nKd 0 0 0\nKe 9 8 6\n");
        folder.write("lamp.obj", "mtllib lamp.mtl\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nv -2 0 -2\n"
                                 "v -.5 1 -.5\nv .5 1 -.5\nv .5 1 .5\nv -.5 1 .5\n"
                                 "usemtl white\nf 1 2 3 4\nusemtl lamp\nf 5 6 7 8\n");
        folder.write("lamp.clrt", "--eye 0,3,0.1\n--at 0,0,0\n--size 32x24\n");
    }
    std::string path() const { return std::filesystem::path(folder.file("x")).parent_path().string(); }

    /// A file of these names is there.
    bool exists(const std::string& name) const { return std::filesystem::exists(folder.file(name)); }

    /// Names of all files and folders in the scratch folder, sorted.
    std::vector<std::string> listing() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(path()))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }

    /// Writes NAME.obj: a square from (-1,-1) to (1,1) in the plane z = 0, facing +z, with this text before
    /// its face.
    void write_square(const std::string& name, const std::string& before_face = "") const {
        folder.write(name + ".obj",
                     "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n" +
                         before_face + "f 1/1 2/2 3/3 4/4\n");
    }

    /// Arguments for a picture of 16 x 12 pixels that takes no time.
    static std::vector<std::string> quick(std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"-i", "raycast", "-s", "1", "-r", "16x12"});
        return arguments;
    }

    ScratchFolder folder;
};

/// Whether a text holds all parts; says which one is missing.
inline testing::AssertionResult holds(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts)
        if (text.find(part) == std::string::npos)
            return testing::AssertionFailure() << "\"" << part << "\" is not in:\n" << text;
    return testing::AssertionSuccess();
}

} // namespace clrt
