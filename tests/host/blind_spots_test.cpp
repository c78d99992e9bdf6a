// SPDX-License-Identifier: Apache-2.0
// Paths that a scene has and no technique samples: points and suns without a disc behind mirrors and glass.
#include "paths/blind_spots.h"

#include "effects/effects.h"
#include "effects/explain.h"
#include "paths/expression_text.h"
#include "paths/path_plan.h"
#include "render/error_text.h"
#include "support/render_scene.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

/// A matte floor below a point light; tests put something between them.
class LitFloor : public TestScene {
public:
    LitFloor() {
        options.effects.all = false;
        build.material("floor", "Kd 0.5 0.5 0.5").material("glass", "Ni 1.5\nillum 7");
        build.material("mirror", "Kd 0 0 0\nKs 1 1 1\nillum 3")
            .material("frosted", "Ni 1.5\nillum 7\nPr 0.5")
            .material("polished", "Ni 1.5\nillum 7\nPr 0.05");
        build.material("shiny", "Kd 0.3 0.3 0.3\nKs 0.3 0.3 0.3\nNs 20\nillum 2");
        build.use("floor").floor(1);
        options.light.points = {{{0, 2, 0}, glm::dvec3(1)}};
    }
    LitFloor& pane(const std::string& material) {
        build.use(material).box({-0.5, 1, -0.5}, {0.5, 1.1, 0.5});
        return *this;
    }
    std::vector<BlindSpot> spots() const { return plan_paths(load(), options).blind_spots; }
    /// Their expressions, separated by blanks.
    std::string paths() const {
        std::string text;
        for (const BlindSpot& spot : spots())
            text += (text.empty() ? "" : " ") + spot.paths;
        return text;
    }
};

/// Whether two expressions hold the same paths.
bool same_paths(const std::string& a, const std::string& b) {
    const PathAlphabet all{(1u << LETTER_COUNT) - 1, KINDS_ALL};
    const Automaton x = make_automaton(parse_path_expression(a), {}, all),
                    y = make_automaton(parse_path_expression(b), {}, all);
    return std::equal(x.states.begin(), x.states.end(), y.states.begin(), y.states.end(),
                      [](const AutomatonState& s, const AutomatonState& t) {
                          return s.next == t.next && s.kinds == t.kinds;
                      });
}

} // namespace

TEST(BlindSpots, LightPathsMeetNoLightBelowRoundedFacets) {
    for (const Integrator integrator : {Integrator::LIGHT, Integrator::PATH, Integrator::BDPT}) {
        LitFloor scene;
        scene.options.transport.integrator = integrator;
        scene.build.raw("vn 0 1 0.004\nv 1 0 1\nv 2 0 1\nv 2 0 0\nf -3//-1 -2//-1 -1//-1");
        EXPECT_EQ(scene.paths(), "") << "as flat as vn of two decimals can tell";
        scene.build.use("shiny").icosphere({3, 0, 0}, 0.5, 1, Facing::OUTWARD, Shading::SMOOTH);
        const std::vector<BlindSpot> spots = scene.spots();
        ASSERT_EQ(spots.size(), integrator == Integrator::LIGHT ? 1u : 0u) << name_of(integrator);
        for (const BlindSpot& spot : spots) {
            EXPECT_EQ(spot.paths, "part of L(D|S)*DE");
            EXPECT_NE(spot.cause.find(" degrees, in material \"shiny\" ("), std::string::npos) << spot.cause;
            EXPECT_NE(spot.where.find("scene.mtl:"), std::string::npos) << spot.where;
        }
    }
}

TEST(BlindSpots, AnOpenFloorHasNone) {
    LitFloor scene;
    EXPECT_EQ(scene.paths(), "");
    EXPECT_EQ(scene.pane("frosted").pane("shiny").paths(), "") << "what is rough can be connected";
}

TEST(BlindSpots, APointBehindGlassIsNotSeen) {
    LitFloor scene;
    const std::vector<BlindSpot> spots = scene.pane("glass").spots();
    ASSERT_EQ(spots.size(), 1u);
    EXPECT_EQ(spots[0].paths, "LpS+D(D|S)*E");
    EXPECT_NE(spots[0].cause.find("point light (1 by --point), next to it material \"glass\" ("),
              std::string::npos)
        << spots[0].cause;
    EXPECT_NE(spots[0].where.find("scene.mtl:"), std::string::npos) << spots[0].where;
    EXPECT_NE(spots[0].cause.find(spots[0].where), std::string::npos) << "the witness's place";
}

TEST(BlindSpots, SplatsFindThatWhereTheEyeLooksAtAMatteSurface) {
    LitFloor scene;
    scene.options.transport.integrator = Integrator::PATH_LIGHT;
    EXPECT_TRUE(same_paths(scene.pane("glass").paths(), "LpS+D(D|S)*SE")) << scene.paths();
    scene.options.transport.integrator = Integrator::LIGHT;
    EXPECT_EQ(scene.paths(), "") << "what it never simulates is no blind spot";
}

TEST(BlindSpots, NorByMirrors) {
    LitFloor scene;
    EXPECT_EQ(scene.pane("mirror").paths(), "LpR+D(D|R)*E");
}

TEST(BlindSpots, EveryMaterialNextToTheLightIsNamed) {
    // The mirror is the first material that writes R, the glass the first that writes T.
    LitFloor scene;
    const std::vector<BlindSpot> spots = scene.pane("mirror").pane("glass").spots();
    ASSERT_EQ(spots.size(), 2u);
    EXPECT_EQ(spots[0].paths, "LpRS*D(D|S)*E");
    EXPECT_NE(spots[0].cause.find("\"mirror\""), std::string::npos);
    EXPECT_EQ(spots[1].paths, "LpTS*D(D|S)*E");
    EXPECT_NE(spots[1].cause.find("\"glass\""), std::string::npos);
}

TEST(BlindSpots, GlossyAndMatteAreOneLetterUntilTheyDiffer) {
    LitFloor scene;
    scene.pane("glass").pane("shiny");
    EXPECT_EQ(scene.paths(), "LpS+D.*E");
    scene.options.transport.paths = "L.*GE";
    EXPECT_TRUE(same_paths(scene.paths(), "LpS(D|G|S)*GE")) << scene.paths();
}

TEST(BlindSpots, SunsWithoutADiscToo) {
    LitFloor scene;
    scene.pane("glass").options.light.points.clear();
    scene.options.light.suns = {{{0, 1, 0}, glm::dvec3(1), 0}};
    EXPECT_EQ(scene.paths(), "LdS+D(D|S)*E");
    EXPECT_NE(scene.spots().at(0).cause.find("sun without a disc"), std::string::npos);
    scene.options.light.suns[0].diameter_degrees = 0.5;
    EXPECT_EQ(scene.paths(), "") << "rays meet its disc";
    scene.options.light.suns.push_back({{1, 1, 0}, glm::dvec3(1), 0});
    EXPECT_EQ(scene.paths(), "LdS+D(D|S)*E") << "one of them has none";
    scene.options.light.points = {{{0, 2, 0}, glm::dvec3(1)}};
    EXPECT_EQ(scene.paths(), "LpS+D(D|S)*E LdS+D(D|S)*E");
}

TEST(BlindSpots, LampsAndSkiesAreMetByRays) {
    LitFloor scene;
    scene.pane("glass").options.light.points.clear();
    scene.options.light.environment = glm::dvec3(1);
    scene.build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp").floor(0.1, 3);
    EXPECT_EQ(scene.paths(), "");
}

TEST(BlindSpots, OnlyWhatIsAskedForCounts) {
    LitFloor scene;
    scene.pane("glass");
    const auto asked = [&](const char* paths) {
        scene.options.transport.paths = paths;
        return scene.paths();
    };
    EXPECT_EQ(asked("LD+S*E"), "") << "no caustics";
    EXPECT_EQ(asked("LaD*E|LeD*E"), "") << "no points";
    EXPECT_EQ(asked("LS*E"), "") << "the image of a point has no brightness";
    EXPECT_EQ(asked("LS+DE"), "LpS+DE");
    EXPECT_EQ(asked("LTTDE"), "LpTTDE");
    EXPECT_EQ(asked("LDE|LRDE"), "LpRDE");
    EXPECT_EQ(asked("E(S|D)*L"), "LpS+D(D|S)*E") << "written from the eye";
    scene.options.transport.paths.clear();
    scene.options.transport.max_depth = 2;
    EXPECT_EQ(scene.paths(), "") << "a caustic has three segments";
    scene.options.transport.max_depth = 3;
    EXPECT_EQ(scene.paths(), "LpS+D(D|S)*E");
}

TEST(BlindSpots, LongExpressionsAreHeldByAShortOne) {
    LitFloor scene;
    scene.pane("glass").options.transport.paths = "LS+" + std::string(40, 'D') + "E";
    EXPECT_EQ(scene.paths(), "LpS.*E");
}

TEST(BlindSpots, TheOtherIntegratorsSampleAllOfTheirLanguage) {
    LitFloor scene;
    scene.pane("glass").pane("mirror").pane("frosted").options.light.suns = {{{0, 1, 0}, glm::dvec3(1), 0}};
    for (const Integrator integrator : {Integrator::WHITTED, Integrator::RAYCAST}) {
        scene.options.transport.integrator = integrator;
        EXPECT_EQ(scene.paths(), "") << int(integrator);
    }
}

TEST(BlindSpots, ThoseOfDistributionEndAtRoughSurfaces) {
    LitFloor scene;
    scene.options.transport.integrator = Integrator::DISTRIBUTION;
    EXPECT_EQ(scene.pane("glass").paths(), "")
        << "what matte surfaces get so is left out, as the report says";
    EXPECT_EQ(scene.pane("shiny").paths(), "LpS+G(G|S)*E");
}

TEST(HitPaths, AreThoseThatNoConnectionAndNoSplatFinds) {
    const auto hits = [](Integrator integrator, const std::string& pane, const std::string& asked = "") {
        LitFloor scene;
        scene.options.light.environment = glm::dvec3(1);
        scene.options.transport.integrator = integrator;
        scene.options.transport.paths = asked;
        if (!pane.empty())
            scene.pane(pane);
        return plan_paths(scene.load(), scene.options).hit_paths;
    };
    EXPECT_EQ(hits(Integrator::PATH, "").paths, "") << "all is connected";
    EXPECT_EQ(hits(Integrator::PATH, "frosted").paths, "");
    EXPECT_EQ(hits(Integrator::PATH, "polished").paths, "LeS+D.*E") << "as rare as by smooth glass";
    EXPECT_EQ(hits(Integrator::PATH_LIGHT, "polished").paths, hits(Integrator::PATH, "polished").paths)
        << "nothing is aimed at it";
    LitFloor both;
    both.options.light.environment = glm::dvec3(1);
    both.options.transport.integrator = Integrator::PATH_LIGHT;
    both.pane("polished").pane("mirror");
    EXPECT_EQ(plan_paths(both.load(), both.options).hit_paths.paths, "LeS+D.*E") << "whatever else is there";
    EXPECT_EQ(hits(Integrator::PATH, "polished", "LS+DE|LDE").paths, "") << "none of its paths is an S";
    EXPECT_EQ(hits(Integrator::PATH, "mirror").kinds, unsigned(KIND_SKY)) << "no ray meets the point";
    EXPECT_TRUE(same_paths(hits(Integrator::PATH, "mirror").paths, "LeR+D(D|R)*E"))
        << hits(Integrator::PATH, "mirror").paths;
    for (const Integrator integrator : {Integrator::PATH_LIGHT, Integrator::MLT})
        EXPECT_TRUE(same_paths(hits(integrator, "mirror").paths, "LeR+D(D|R)*RE"))
            << hits(integrator, "mirror").paths;
    EXPECT_TRUE(same_paths(hits(Integrator::BDPT, "mirror").paths, "LeR+D(R+D)*R+E"))
        << hits(Integrator::BDPT, "mirror").paths << ": two matte vertices in a row are connected";
    EXPECT_EQ(hits(Integrator::LIGHT, "mirror").paths, "");
    EXPECT_EQ(hits(Integrator::WHITTED, "mirror").paths, "") << "images are met always";
    EXPECT_EQ(hits(Integrator::PATH, "mirror", "LD+E|LS+E").paths, "") << "not asked for";
}

TEST(BlindSpots, AreExplained) {
    LitFloor scene;
    const auto text = [&] {
        return explain(scene.load(), find_effects(scene.load(), scene.options), scene.options);
    };
    EXPECT_EQ(text().find("Not seen"), std::string::npos);
    scene.pane("glass");
    EXPECT_NE(text().find("\nNot seen:\n  LpS+D(D|S)*E: point light"), std::string::npos) << text();
    scene.options.run.explain = Explain::JSON;
    const auto json = nlohmann::json::parse(text());
    ASSERT_EQ(json["blind_spots"].size(), 1u);
    EXPECT_EQ(json["blind_spots"][0]["paths"], "LpS+D(D|S)*E");
    scene.options.light.points.clear();
    EXPECT_EQ(nlohmann::json::parse(text())["blind_spots"], nlohmann::json::array());
}

TEST(BlindSpots, AreKeptByJson) {
    const std::vector<BlindSpot> spots = {{"LpS+DE", "a light", "room.mtl:3"}, {"LdS+DE", "a sun", ""}};
    const auto json = blind_spots_json(spots);
    EXPECT_TRUE(json[1]["where"].is_null());
    const std::vector<BlindSpot> read = read_blind_spots(json);
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0].where, "room.mtl:3");
    EXPECT_EQ(read[1].cause, "a sun");
    EXPECT_EQ(read[1].where, "");
}

TEST(BlindSpots, TheVerdictOnTheErrorNamesThem) {
    ErrorReport report;
    report.error = FilmError{0.01, 0.009, 0.011};
    report.spread = ErrorSpread{};
    EXPECT_NE(format_error_report(report).find("verdict  trust the error\n"), std::string::npos);
    report.blind_spots = {{"LpS+DE", "a light", ""}};
    std::string text = format_error_report(report);
    EXPECT_NE(text.find("not seen LpS+DE: a light\n"), std::string::npos) << text;
    EXPECT_NE(text.find("for what was sampled, which is not all: not seen: LpS+DE\n"), std::string::npos)
        << text;
    report.cut.paths = 5;
    text = format_error_report(report);
    EXPECT_NE(text.find("which is not all: long paths are cut; not seen: LpS+DE\n"), std::string::npos)
        << text;
    report.unmet = UnmetLight{"LS+DE", 0.5, 0.13};
    text = format_error_report(report);
    EXPECT_NE(text.find("; not seen: LpS+DE; hardly ever met: LS+DE\n"), std::string::npos) << text;
    EXPECT_NE(
        text.find(
            "unmet    hardly any but paths that happen to hit a light find LS+DE: by ways that no sample "
            "took, the picture may lack up to 13 % of the scene's mean (95 % confidence)\n"),
        std::string::npos)
        << text;
    report.error.reset();
    EXPECT_NE(format_error_report(report).find("not seen LpS+DE"), std::string::npos) << "of black pictures";
}

TEST(SurfaceExpression, EliminatesStates) {
    const auto text = [](std::vector<LightState> states) { return surface_expression(states); };
    const LightState end{{-1, -1, -1, -1}, true};
    EXPECT_EQ(text({{{1, -1, -1, -1}}, end}), "D");
    EXPECT_EQ(text({{{1, -1, -1, 1}}, end}), "(D|T)");
    EXPECT_EQ(text({{{1, 1, 1, 1}}, end}), ".");
    EXPECT_EQ(text({{{1, -1, 2, -1}}, end, {{1, -1, -1, -1}}}), "(D|RD)");
    EXPECT_EQ(text({{{1, -1, -1, -1}}, {{1, -1, -1, -1}, true}}), "D+");
    EXPECT_EQ(text({{{1, -1, -1, -1}}, {{-1, -1, 2, -1}, true}, end}), "DR?");
    EXPECT_EQ(text({{{1, 2, -1, -1}}, {{1, 1, 1, 1}, true}, {{-1, -1, 1, -1}}}), "(D|GR)(D|G|S)*")
        << "matte and glossy part, so that D means matte alone";
}

} // namespace clrt
