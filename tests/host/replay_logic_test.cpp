// SPDX-License-Identifier: Apache-2.0
// What is concluded from records of samples, on records written by hand: causes of bad samples, where twins
// part, commands.
#include "replay/causes.h"
#include "replay/replay_command.h"
#include "replay/replay_values.h"
#include "replay/twins.h"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>

namespace clrt {

namespace {

constexpr double INF = std::numeric_limits<double>::infinity();
constexpr double LARGEST = 1000;

/// A record in double precision; `put` adds events.
struct Record : SampleTrace {
    explicit Record(u32 kind = COUNT_WORDS) {
        precision = Precision::DOUBLE;
        fault = kind;
    }
    Record& choice(u32 id, std::uint64_t word) {
        events.push_back({id, {word, 0, 0}});
        return *this;
    }
    Record& put(u32 id, double x, double y = 0, double z = 0) {
        TraceEvent event{id, {}};
        const double values[] = {x, y, z};
        std::memcpy(event.bits.data(), values, sizeof values);
        events.push_back(event);
        return *this;
    }
    /// A vertex on triangle 0 or 1, whose materials are 7 and 8, or in the open.
    Record& vertex(u32 bounce, u32 triangle) {
        return choice(TRACE_VERTEX, bounce)
            .put(TRACE_RAY_ORIGIN, 0)
            .put(TRACE_RAY_DIRECTION, 1)
            .choice(TRACE_TRIANGLE, triangle);
    }
};

Scene two_triangles() {
    Scene scene;
    scene.triangles.resize(2);
    scene.triangles[0].material = 7;
    scene.triangles[1].material = 8;
    return scene;
}

void expect_cause(const Record& record, u32 quantity, u32 bounce, u32 material) {
    const Cause cause = find_cause(record, two_triangles(), LARGEST);
    EXPECT_EQ(cause.kind, record.fault);
    EXPECT_EQ(cause.quantity, quantity);
    EXPECT_EQ(cause.bounce, bounce);
    EXPECT_EQ(cause.material, material);
}

} // namespace

TEST(ReplayLogic, TheFirstBadValueOfTheVertexIsTheCause) {
    Record record(COUNT_NAN);
    record.vertex(1, 0).put(TRACE_WEIGHT, 0.5).put(TRACE_THROUGHPUT, 0.5);
    record.vertex(2, 1)
        .put(TRACE_NORMAL_S, NAN)
        .put(TRACE_WEIGHT, NAN)
        .put(TRACE_THROUGHPUT, NAN)
        .put(TRACE_RADIANCE, NAN);
    expect_cause(record, TRACE_NORMAL_S, 2, 8);
}

TEST(ReplayLogic, AnInfiniteDensityThatDoesNoHarmIsNoCause) {
    Record record(COUNT_NEGATIVE);
    record.vertex(1, 0).put(TRACE_LIGHT_PDF, INF).put(TRACE_ADDED, 0).put(TRACE_THROUGHPUT, 1);
    record.vertex(2, 1).put(TRACE_EMITTED, -1).put(TRACE_ADDED, -1).put(TRACE_RADIANCE, -1);
    expect_cause(record, TRACE_EMITTED, 2, 8);
}

TEST(ReplayLogic, ARayIsTheFaultOfTheVertexThatSentIt) {
    Record record(COUNT_NAN);
    record.vertex(1, 0).put(TRACE_OFFSET, NAN).put(TRACE_THROUGHPUT, 1);
    record.choice(TRACE_VERTEX, 2).put(TRACE_RAY_ORIGIN, NAN).put(TRACE_RADIANCE, NAN);
    expect_cause(record, TRACE_OFFSET, 1, 7);
    Record camera(COUNT_NAN);
    camera.choice(TRACE_VERTEX, 1)
        .put(TRACE_RAY_ORIGIN, 0)
        .put(TRACE_RAY_DIRECTION, NAN)
        .put(TRACE_RADIANCE, NAN);
    expect_cause(camera, TRACE_RAY_DIRECTION, 0, NO_INDEX);
}

TEST(ReplayLogic, OverflowIsWhatIsAboveTheLimitFirst) {
    Record record(COUNT_OVERFLOW);
    record.vertex(1, 0).put(TRACE_LIGHT_PDF, 2 * LARGEST).put(TRACE_LIGHT_RADIANCE, 2 * LARGEST);
    record.put(TRACE_ADDED, 2 * LARGEST).put(TRACE_RADIANCE, 2 * LARGEST);
    expect_cause(record, TRACE_LIGHT_RADIANCE, 1, 7);
    Record sum(COUNT_OVERFLOW);
    sum.vertex(1, 0)
        .put(TRACE_ADDED, 0.7 * LARGEST)
        .put(TRACE_ADDED, 0.7 * LARGEST)
        .put(TRACE_RADIANCE, 1.4 * LARGEST);
    expect_cause(sum, 0, 0, NO_INDEX);
}

TEST(ReplayLogic, ASampleThatIsGoodWhenReplayedHasNoCause) {
    Record record;
    record.vertex(1, 0).put(TRACE_RADIANCE, 1);
    expect_cause(record, 0, 0, NO_INDEX);
    const std::vector<CauseCount> causes = count_causes({record, record}, two_triangles(), LARGEST);
    ASSERT_EQ(causes.size(), 1u);
    EXPECT_EQ(causes[0].count, 2u);
    EXPECT_NE(format_causes(causes, 2, two_triangles(), {}).find("good when replayed"), std::string::npos);
    EXPECT_EQ(format_causes(causes, 2, two_triangles(), {}).find("bad samples"), std::string::npos);
    EXPECT_NE(format_causes(causes, 9, two_triangles(), {}).find("of 9 bad samples, 2 were replayed"),
              std::string::npos);
}

TEST(ReplayLogic, CausesAreCountedTheMostFrequentFirst) {
    Record weight(COUNT_NAN), emitted(COUNT_NEGATIVE);
    weight.vertex(1, 0).put(TRACE_WEIGHT, NAN).put(TRACE_THROUGHPUT, NAN).put(TRACE_RADIANCE, NAN);
    emitted.vertex(1, 1).put(TRACE_EMITTED, -1).put(TRACE_ADDED, -1).put(TRACE_RADIANCE, -1);
    emitted.address = {5, 3};
    const std::vector<CauseCount> causes = count_causes({weight, emitted, emitted}, two_triangles(), LARGEST);
    ASSERT_EQ(causes.size(), 2u);
    EXPECT_EQ(causes[0].cause.quantity, TRACE_EMITTED);
    EXPECT_EQ(causes[0].count, 2u);
    EXPECT_EQ(causes[0].example.sample, 3u);
    EXPECT_EQ(causes[1].cause.quantity, TRACE_WEIGHT);
}

TEST(ReplayLogic, TwinsPartAtTheFirstChoiceThatDiffers) {
    Record a, b;
    a.vertex(1, 0).put(TRACE_PDF, 1).choice(TRACE_LOBE, LOBE_MATTE).put(TRACE_PDF, 5);
    b.vertex(1, 0).put(TRACE_PDF, 1.01).choice(TRACE_LOBE, LOBE_GLOSSY).put(TRACE_PDF, 9);
    const TwinDifference difference = compare_twins(a, b);
    EXPECT_EQ(difference.decision, 5u);
    EXPECT_EQ(decision_name(a, b, difference.decision), "lobe");
    EXPECT_EQ(difference.largest, 4u);
    EXPECT_NEAR(difference.largest_relative, 0.01 / 1.01, 1e-12);
    EXPECT_EQ(trace_bounce(a, difference.decision), 1u);
}

TEST(ReplayLogic, TwinsOfDifferentLengthPartAtTheEndOfTheShorter) {
    Record a, b;
    a.vertex(1, 0);
    b.vertex(1, 0).choice(TRACE_FRONT, 1);
    EXPECT_EQ(compare_twins(a, b).decision, 4u);
    EXPECT_EQ(decision_name(a, b, 4), "end of the path");
    EXPECT_FALSE(compare_twins(a, a).has_decision());
    EXPECT_FALSE(compare_twins(a, a).has_largest());
}

TEST(ReplayLogic, DifferencesAreRelativeToTheLargestComponent) {
    Record a, b;
    a.put(TRACE_POSITION, 100, 1, 0).put(TRACE_PDF, INF).put(TRACE_PDF, NAN).put(TRACE_PDF, NAN);
    b.put(TRACE_POSITION, 100, 2, 0).put(TRACE_PDF, INF).put(TRACE_PDF, NAN).put(TRACE_PDF, 1);
    EXPECT_NEAR(trace_difference(a, 0, b, 0), 0.01, 1e-12);
    EXPECT_EQ(trace_difference(a, 1, b, 1), 0);
    EXPECT_EQ(trace_difference(a, 2, b, 2), 0);
    EXPECT_EQ(trace_difference(a, 3, b, 3), INF);
}

TEST(ReplayLogic, FloatsAndDoublesAreReadByTheirBits) {
    SampleTrace single;
    const float x = 0.1f;
    std::uint32_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    EXPECT_EQ(trace_value(single, {TRACE_PDF, {bits, 0, 0}}, 0), double(0.1f));
    EXPECT_EQ(event_hex(single, {TRACE_PDF, {bits, 0, 0}})[0], "0x1.99999ap-4");
    Record in_double;
    in_double.put(TRACE_PDF, 0.1);
    EXPECT_EQ(trace_value(in_double, in_double.events[0], 0), 0.1);
}

TEST(ReplayLogic, PositionsAndLengthsAreInSceneUnits) {
    Scene scene;
    scene.normalisation.centre = {10, 20, 30};
    scene.normalisation.scale = 0.5;
    Record record;
    record.put(TRACE_POSITION, 1, 2, 3).put(TRACE_DISTANCE, 4).put(TRACE_WI, 0, 1, 0);
    EXPECT_EQ(event_values(record, record.events[0], scene), (std::vector<double>{12, 24, 36}));
    EXPECT_EQ(event_values(record, record.events[1], scene), (std::vector<double>{8}));
    EXPECT_EQ(event_values(record, record.events[2], scene), (std::vector<double>{0, 1, 0}));
}

TEST(ReplayLogic, EveryQuantityHasARowOfItsOwn) {
    for (u32 id = TRACE_RAY_ORIGIN; id < TRACE_QUANTITIES; ++id)
        EXPECT_EQ(quantity(id).id, id);
    for (u32 id = TRACE_VERTEX; id <= TRACE_VISIBLE; ++id)
        EXPECT_TRUE(is_choice(quantity(id).id));
    EXPECT_THROW(quantity(TRACE_QUANTITIES), std::out_of_range);
}

TEST(ReplayLogic, TheCommandNamesTheSampleAndWritesNothing) {
    Options options;
    options.film.size = {100, 50};
    options.scene.path = "my scene.obj";
    options.run.resumable_command = {
        "clrt",           "--spp=4", "--output=a b.exr", "--stats=s.json", "--paths=L(D)*E",
        "--check=strict", "--",      "my scene.obj"};
    EXPECT_EQ(replay_command(options, {203, 3}),
              "clrt --pixel=3,2 --sample=3 --spp=4 '--paths=L(D)*E' 'my scene.obj'");
    options.scene.path = options.run.resumable_command.back() = "-it's.obj";
    EXPECT_EQ(replay_command(options, {0, 0}),
              "clrt --pixel=0,0 --sample=0 --spp=4 '--paths=L(D)*E' -- '-it'\\''s.obj'");
}

} // namespace clrt
