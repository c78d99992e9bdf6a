// SPDX-License-Identifier: Apache-2.0
// --mtl: material libraries as their writers mean them, or word by word.
#include "clrt_command.h"
#include "support/blender_mtl.h"

#include <nlohmann/json.hpp>

namespace clrt {

namespace {

class MtlCommand : public ClrtCommand {
protected:
    /// The text of --explain for a square of one material of a library.
    std::string explain(const std::string& library, const std::string& material,
                        std::vector<std::string> arguments = {}) {
        folder.write("scene.mtl", library);
        write_square("scene", "mtllib scene.mtl\nusemtl " + material + "\n");
        arguments.insert(arguments.begin(), {"scene.obj", "--explain"});
        const auto result = clrt(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.out;
    }
};

} // namespace

TEST_F(MtlCommand, AutoTakesBlenderAtItsMeaningAndSaysSo) {
    const std::string text = explain(BLENDER_DEFAULT_MTL, "gold");
    EXPECT_TRUE(
        holds(text, {"metallic-roughness Kd, Pm, Pr (repaired: Blender's roughness and metal, "
                     "Blender's level)",
                     "glossy F0 0.9 0.6 0.2 alpha 0.04",
                     "scene.mtl: written by Blender 5.0.1: read as it means its keys (--mtl auto)",
                     "scene.mtl:14: Blender's export without PBR: roughness from Ns, metal from Ka"}));
    EXPECT_EQ(explain(BLENDER_DEFAULT_MTL, "gold", {"--mtl", "auto"}), text);
    EXPECT_TRUE(holds(explain(BLENDER_PBR_MTL, "glass"), {"dielectric Ni 1.45 Tf 0.8 0.9 1"}));
}

TEST_F(MtlCommand, PlainTakesEveryKeyAtItsWord) {
    const std::string text = explain(BLENDER_DEFAULT_MTL, "gold", {"--mtl", "plain"});
    EXPECT_TRUE(holds(text, {"illum 3: matte Kd, reflection Ks by Ns ", "matte 0.6429 0.4286 0.1429"}));
    for (const char* absent : {"Blender", "repaired"})
        EXPECT_EQ(text.find(absent), std::string::npos) << text;
    EXPECT_TRUE(holds(explain(BLENDER_PBR_MTL, "coated", {"--mtl=plain"}), {"coat 1 alpha "}));
}

TEST_F(MtlCommand, RepairsAreInTheLogAndInJson) {
    const std::string maya = "newmtl m\nillum 4\nKd 0.5 0.5 0.5\nTf 1.00 1.00 1.00\nNi 1.00\n";
    const auto json = nlohmann::json::parse(explain(maya, "m", {"--explain=json", "-q"}));
    EXPECT_EQ(json["materials"][0]["rule"], "illum 2: matte Kd, glossy Ks by Ns (repaired: opaque Ni 1)");
    EXPECT_EQ(json["notices"][0],
              "scene.mtl:5: glass with Ni 1 and d 1 would be invisible: illum 2 is taken");
    const auto result = clrt(quick({"scene.obj"}));
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(holds(result.err, {"scene.mtl:5: glass with Ni 1 and d 1 would be invisible"}));
}

TEST_F(MtlCommand, OtherValuesAreRefusedAndTheOptionsFileMaySayIt) {
    const std::string maya = "newmtl m\nillum 4\nKd 0.5 0.5 0.5\nNi 1\n";
    EXPECT_TRUE(holds(explain(maya, "m"), {"matte 0.5 0.5 0.5"}));
    folder.write("scene.clrt", "--mtl plain\n");
    EXPECT_TRUE(holds(explain(maya, "m"), {"dielectric Ni 1 "}));
    const auto wrong = clrt({"scene.obj", "--mtl", "maya"});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_TRUE(holds(wrong.err, {"--mtl: expected auto or plain, found 'maya'"}));
}

} // namespace clrt
