// SPDX-License-Identifier: Apache-2.0
// The layers of EXR files under the names of Blender's passes: the same bits, and a channel each that Blender
// asks for.
#include "clrt_command.h"

#include <cstring>

namespace clrt {

namespace {

/// Our names and those of Blender 5.0's passes, which RenderLayer.load_from_file looks for.
const std::vector<std::pair<std::string, std::string>> NAME_PAIRS = {
    {"R", "Combined.R"},
    {"G", "Combined.G"},
    {"B", "Combined.B"},
    {"Z", "Depth.Z"},
    {"N.X", "Normal.X"},
    {"N.Y", "Normal.Y"},
    {"N.Z", "Normal.Z"},
    {"P.X", "Position.X"},
    {"P.Y", "Position.Y"},
    {"P.Z", "Position.Z"},
    {"albedo.R", "Albedo.R"},
    {"albedo.G", "Albedo.G"},
    {"albedo.B", "Albedo.B"},
    {"objectId", "Object Index.X"},
    {"materialId", "Material Index.X"},
    {"samples", "Debug Sample Count.X"},
    {"denoisingAlbedo.G", "Denoising Albedo.G"},
    {"denoisingNormal.Z", "Denoising Normal.Z"},
    {"sky.R", "sky.R"},
};

/// A lamp before a sky.
class ExrNamesCommand : public ClrtCommand {
protected:
    ExrNamesCommand() {
        folder.write("scene.mtl", "newmtl lamp\nKd 0.5 0.4 0.3\nKe 1 2 3\n");
        folder.write("scene.obj",
                     "mtllib scene.mtl\nusemtl lamp\nv -1 -0.8 0\nv 0.9 -0.3 0.2\nv 0.1 1 -0.1\nf 1 2 3\n");
    }

    ReadPicture render(std::vector<std::string> further) const {
        for (const char* word : {"scene.obj", "-r", "24x20", "--eye", "0,0,4", "--at", "0,0,0", "-s", "6",
                                 "--env", "0.5,0.5,0.5", "-o", "a.exr"})
            further.emplace_back(word);
        const CommandResult result = clrt(further);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return ReadPicture(folder.file("a.exr"));
    }
};

bool same_bits(float a, float b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

} // namespace

TEST_F(ExrNamesCommand, BlendersNamesHoldTheSameBits) {
    const std::vector<std::string> layers = {
        "--aov", "albedo,N,Z,P,objectId,materialId,samples,denoisingAlbedo,denoisingNormal,sky=LE"};
    std::vector<std::string> blender = layers;
    blender.insert(blender.end(), {"--exr-names", "blender"});
    const ReadPicture ours = render(layers), theirs = render(blender);
    EXPECT_EQ(theirs.spec.nchannels, ours.spec.nchannels + 1) << "alpha comes in addition";
    for (const auto& [own, other] : NAME_PAIRS)
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 24; ++x)
                ASSERT_TRUE(same_bits(ours.at(x, y, own), theirs.at(x, y, other))) << other;
}

TEST_F(ExrNamesCommand, EveryPictureForBlenderHasAnAlpha) {
    const ReadPicture opaque = render({"--exr-names", "blender"});
    const ReadPicture coverage = render({"--exr-names", "blender", "--aov", "alpha"});
    const ReadPicture transparent = render({"--exr-names", "blender", "--background", "transparent"});
    int edges = 0;
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 24; ++x) {
            ASSERT_EQ(opaque.at(x, y, "Combined.A"), 1);
            const float share = coverage.at(x, y, "Combined.A");
            ASSERT_EQ(transparent.at(x, y, "Combined.A"), share);
            edges += share > 0 && share < 1;
        }
    EXPECT_GT(edges, 20);
}

TEST_F(ExrNamesCommand, OurNamesStayWithoutTheOption) {
    const ReadPicture picture = render({"--background", "transparent"});
    for (const char* channel : {"R", "A", "albedo.R", "N.X", "Z", "P.X", "objectId", "variance.R", "samples"})
        EXPECT_GE(picture.spec.channelindex(channel), 0) << channel;
    for (const std::string& channel : picture.spec.channelnames)
        EXPECT_EQ(channel.find("Combined"), channel.npos) << channel;
}

} // namespace clrt
