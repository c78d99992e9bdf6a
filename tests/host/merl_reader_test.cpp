// SPDX-License-Identifier: Apache-2.0
// Files of measured BRDFs: what is read, what is refused and why, and the tables made from them.
#include "error.h"
#include "probes/merl_file.h"
#include "probes/scratch_folder.h"
#include "scene/measured_sampling.h"
#include "scene/measured_store.h"
#include "scene/readers/merl_reader.h"
#include "scene/vectors.h"
#include "support/mtl_material.h"

#include <cstring>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

using namespace clrt;
using glm::dvec3;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

constexpr MerlCounts SMALL = {6, 5, 4};
constexpr size_t CELLS = 6 * 5 * 4;

const BrdfFunction GREY = matte_and_glossy({0.75, 0.5, 0.25});

/// Puts a number in the place of one of the file's.
void set_number(std::string& bytes, size_t channel, size_t cell, double number) {
    std::memcpy(&bytes[12 + 8 * (channel * CELLS + cell)], &number, sizeof number);
}

void set_count(std::string& bytes, size_t axis, i32 count) {
    std::memcpy(&bytes[4 * axis], &count, sizeof count);
}

std::string refusal(const std::string& bytes) {
    try {
        parse_merl(bytes, "gold.binary");
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

/// A store, the folder of its files, and what it says.
struct StoreTest : testing::Test {
    ScratchFolder folder;
    NoticeList notices;
    MeasuredStore store;
    u32 add(const std::string& file) { return store.add({file, {folder.file("a.mtl"), 7}}, notices); }
};

} // namespace

TEST(MerlReader, ReadsTheValuesOfAllCells) {
    const MeasuredValues table = parse_merl(merl_file(GREY, SMALL), "grey.binary");
    EXPECT_EQ(table.half_count, 6u);
    EXPECT_EQ(table.difference_count, 5u);
    EXPECT_EQ(table.azimuth_count, 4u);
    ASSERT_EQ(table.values.size(), CELLS);
    EXPECT_EQ(table.missing, 0u);
    // Below the horizon the values above it go on.
    for (const glm::vec3& value : table.values)
        EXPECT_LE(glm::length(dvec3(value) - dvec3(0.75, 0.5, 0.25) / PI), 1e-7);
}

TEST(MerlReader, TheCellsOfAFileOfTheDatabaseLieWhereItsReaderLooksForThem) {
    // The index of a cell and the factors are those of BRDFRead.cpp, which comes with the database.
    std::string bytes = merl_file(matte_and_glossy(dvec3(0)));
    ASSERT_EQ(bytes.size(), 34992012u);
    const size_t cell = 20 + 10 * 180 + 5 * 180 * 90, cells = 90 * 90 * 180;
    for (size_t channel = 0; channel < 3; ++channel) {
        const double number = 1500;
        std::memcpy(&bytes[12 + 8 * (channel * cells + cell)], &number, sizeof number);
    }
    const MeasuredValues table = parse_merl(bytes, "one.binary");
    const double half = PI / 2 * std::pow(5.5 / 90, 2), difference = PI / 2 * 10.5 / 90,
                 azimuth = PI * 20.5 / 180;
    const dvec3 h(std::sin(half), 0, std::cos(half)), across(h.z, 0, -h.x), aside(0, 1, 0);
    const dvec3 wi = std::cos(difference) * h +
                     std::sin(difference) * (std::cos(azimuth) * across + std::sin(azimuth) * aside);
    const dvec3 wo = 2 * glm::dot(wi, h) * h - wi, expected(1, 1.15, 1.66);
    EXPECT_LE(glm::length(table.at(wo, wi) - expected), 1e-6);
    EXPECT_LE(glm::length(table.at(wi, wo) - expected), 1e-6);
    EXPECT_EQ(glm::length(table.at(wo, {wi.x, -wi.y, wi.z})), 0);
}

TEST(MerlReader, WhatIsMissingAboveTheHorizonIsBlackAndCounted) {
    std::string bytes = merl_file(GREY, SMALL);
    set_number(bytes, 0, 3, -1);
    set_number(bytes, 2, 3, -0.5);
    set_number(bytes, 1, 9, -1);
    const MeasuredValues table = parse_merl(bytes, "grey.binary");
    EXPECT_EQ(table.missing, 2u);
    EXPECT_EQ(table.values[3].x, 0);
    EXPECT_NEAR(table.values[3].y, 0.5 / PI, 1e-7);
    EXPECT_EQ(table.values[3].z, 0);
    EXPECT_EQ(table.values[9].y, 0);
}

TEST(MerlReader, OtherFilesAreRefusedByWhatWasExpectedAndFound) {
    const std::string good = merl_file(GREY, SMALL);
    EXPECT_EQ(refusal(good), "");
    EXPECT_EQ(refusal(good.substr(0, 5)),
              "gold.binary: no MERL file: expected three counts in 12 bytes, found 5 bytes");
    EXPECT_EQ(refusal(good.substr(0, good.size() - 8)),
              "gold.binary: no MERL file: expected 2892 bytes for 6 x 5 x 4 values of three channels, found "
              "2884: it is truncated");
    EXPECT_EQ(refusal(good + "!"), "gold.binary: no MERL file: expected 2892 bytes for 6 x 5 x 4 values of "
                                   "three channels, found 2893");
    for (const auto& [axis, count] : {std::pair<size_t, i32>{0, 0}, {1, -5}, {2, 360}, {0, 1 << 24}}) {
        std::string bytes = good;
        set_count(bytes, axis, count);
        EXPECT_THAT(refusal(bytes),
                    HasSubstr("expected counts of half angles, difference angles and azimuths of "
                              "90 90 180 or less, found "));
        EXPECT_THAT(refusal(bytes), HasSubstr(std::to_string(count)));
    }
    for (const double number :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
          -std::numeric_limits<double>::infinity(), 1e300}) {
        std::string bytes = good;
        set_number(bytes, 1, (2 * 5 + 3) * 4 + 1, number);
        EXPECT_THAT(refusal(bytes), HasSubstr("expected finite numbers"));
        EXPECT_THAT(refusal(bytes), HasSubstr("in green of half angle 2, difference angle 3, azimuth 1"));
    }
}

TEST(MeasuredSampling, MatteIsSampledByTheCosineAlone) {
    const MeasuredValues table = parse_merl(merl_file(GREY, {12, 12, 12}), "grey.binary");
    for (u32 i = 0; i < MEASURED_VIEWS; ++i) {
        const MeasuredView view = sample_measured(table, i);
        EXPECT_EQ(MEASURED_COSINE_SHARE(view), 1) << i;
        EXPECT_NEAR(view.albedo.x, 0.75, 0.0075) << i;
        EXPECT_NEAR(view.albedo.z, 0.25, 0.0025) << i;
    }
}

TEST(MeasuredSampling, APolishIsSampledByItsHalfVectors) {
    const MeasuredValues table =
        parse_merl(merl_file(matte_and_glossy(dvec3(0.05), dvec3(0.9), 0.05)), "polish.binary");
    const MeasuredView view = sample_measured(table, 10);
    EXPECT_GT(MEASURED_COSINE_SHARE(view), 0);
    EXPECT_LT(MEASURED_COSINE_SHARE(view), 0.3);
    for (u32 cell = 1; cell < MEASURED_CELLS; ++cell)
        EXPECT_GE(view.cumulative[cell], view.cumulative[cell - 1]);
    EXPECT_EQ(view.cumulative[MEASURED_CELLS - 1], 1);
}

TEST(MeasuredSampling, WhatIsBlackHasADensityToo) {
    const MeasuredValues table = parse_merl(merl_file(matte_and_glossy(dvec3(0)), SMALL), "black.binary");
    const MeasuredView view = sample_measured(table, 8);
    EXPECT_EQ(MEASURED_COSINE_SHARE(view), 1);
    EXPECT_EQ(view.albedo.x, 0);
}

TEST(MerlRule, ItTakesThePlaceOfEverythingThatReflects) {
    NoticeList notices;
    const LoadMap no_map = [](const TextureUse&, TextureRole role) {
        return role == TextureRole::COLOUR ? 0u : NO_INDEX;
    };
    const std::string others = "Kd 1 0 0\nKs 1 1 1\nPm 1\nPr 0.2\nillum 7\nconductor gold\nmap_Kd a.png\n";
    const auto rule = [&](const std::string& text) {
        const MtlMaterial mtl = parse_mtl("newmtl m\n" + text + "merl a.binary\n", "a.mtl", notices).at(0);
        return rule_material(mtl, {}, no_map, notices);
    };
    const RuledMaterial plain = rule("");
    EXPECT_EQ(plain.material.lobes, LOBE_MEASURED);
    EXPECT_EQ(plain.rule, "measured BRDF merl");
    EXPECT_TRUE(plain.extension.is_needed);
    const RuledMaterial ruled = rule(others);
    EXPECT_EQ(std::memcmp(&ruled.material, &plain.material, sizeof(Material)), 0);
    EXPECT_TRUE(notices.lines().empty());
    EXPECT_EQ(rule("Pc 1\nPs 0.5\n").material.lobes, LOBE_MEASURED);
    EXPECT_THAT(notices.lines(), ElementsAre("a.mtl:2: Pc has no effect beside merl",
                                             "a.mtl:3: Ps has no effect beside merl"));
    const RuledMaterial lamp = rule("Ke 1 2 3\nmap_Ke a.png\nd 0.5\n");
    EXPECT_EQ(lamp.material.emission.z, 3);
    EXPECT_EQ(lamp.material.map_emission, 0u);
    EXPECT_EQ(MATERIAL_COVERAGE(lamp.material), 0.5f);
}

TEST_F(StoreTest, AFileIsReadOnceAndNamed) {
    folder.write("grey.binary", merl_file(GREY, SMALL));
    folder.write("red.binary", merl_file(matte_and_glossy({1, 0, 0}), {3, 4, 5}));
    EXPECT_EQ(add("grey.binary"), 0u);
    const u32 red = add("red.binary");
    EXPECT_EQ(red, sizeof(MeasuredBrdf) / 4 + CELLS * 3 / 2);
    EXPECT_EQ(add("grey.binary"), 0u);
    Scene scene;
    store.take(scene);
    EXPECT_EQ(scene.measured.size(), red + sizeof(MeasuredBrdf) / 4 + 92); // 90 words of values, rounded up
    EXPECT_EQ(measured_at(scene.measured, red).azimuth_count, 5u);
    EXPECT_EQ(scene.measured_names.at(red), "red.binary");
    EXPECT_EQ(scene.files.size(), 2u);
    EXPECT_TRUE(notices.lines().empty());
}

TEST_F(StoreTest, WhatIsOddIsSaid) {
    std::string holed = merl_file(GREY, SMALL);
    set_number(holed, 0, 2, -1);
    folder.write("holed.binary", holed);
    folder.write("bright.binary", merl_file(matte_and_glossy({1.5, 1, 1}), {12, 12, 12}));
    add("holed.binary");
    add("bright.binary");
    ASSERT_EQ(notices.lines().size(), 2u);
    EXPECT_THAT(
        notices.lines()[0],
        HasSubstr("a.mtl:7: measured BRDF 'holed.binary': 1 of 120 values are missing and taken as 0"));
    EXPECT_THAT(notices.lines()[1], HasSubstr("reflects up to 1.5"));
}

TEST_F(StoreTest, AFileThatIsNotThereIsAnError) {
    try {
        add("none.binary");
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_THAT(error.what(), HasSubstr("a.mtl:7: merl: expected the file of a measured BRDF, found none "
                                            "called 'none.binary'"));
    }
}
