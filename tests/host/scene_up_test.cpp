// SPDX-License-Identifier: Apache-2.0
// Which way is up in a file: recognised where it is sure, hinted at where it is likely, else not mentioned.
#include "scene/scene_up.h"

#include "scene/assemble_geometry.h"

#include <cmath>
#include <gtest/gtest.h>

using namespace clrt;

namespace {

/// A mesh that is put together from boxes and cones.
struct Thing {
    Mesh mesh;
    std::string z_up_reason;

    Thing& box(const glm::dvec3& low, const glm::dvec3& high) {
        const u32 first = u32(mesh.positions.size());
        for (int i = 0; i < 8; ++i)
            mesh.positions.emplace_back((i & 1 ? high : low).x, (i & 2 ? high : low).y,
                                        (i & 4 ? high : low).z);
        const u32 faces[6][4] = {{4, 5, 7, 6}, {1, 0, 2, 3}, {5, 1, 3, 7},
                                 {0, 4, 6, 2}, {6, 7, 3, 2}, {0, 1, 5, 4}};
        for (const auto& f : faces) {
            add(first + f[0], first + f[1], first + f[2]);
            add(first + f[0], first + f[2], first + f[3]);
        }
        return *this;
    }
    /// Along +z, standing at z = 0.
    Thing& cone(double radius, double height) {
        const u32 first = u32(mesh.positions.size()), sides = 32;
        mesh.positions.emplace_back(0, 0, height);
        mesh.positions.emplace_back(0, 0, 0);
        for (u32 i = 0; i < sides; ++i)
            mesh.positions.emplace_back(radius * std::cos(i * 0.19634954), radius * std::sin(i * 0.19634954),
                                        0);
        for (u32 i = 0; i < sides; ++i) {
            add(first, first + 2 + i, first + 2 + (i + 1) % sides);
            add(first + 1, first + 2 + (i + 1) % sides, first + 2 + i);
        }
        return *this;
    }
    /// A rectangle across z that faces +z.
    Thing& wall(const glm::dvec3& low, const glm::dvec3& high) {
        const u32 first = u32(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(),
                              {low, {high.x, low.y, low.z}, high, {low.x, high.y, low.z}});
        add(first, first + 1, first + 2);
        add(first, first + 2, first + 3);
        return *this;
    }
    /// (x, y, z) -> (x, z, -y): what is up along z is up along y.
    Thing& make_y_up() {
        for (glm::dvec3& p : mesh.positions)
            p = {p.x, p.z, -p.y};
        return *this;
    }
    Thing& move(const glm::dvec3& by) {
        for (glm::dvec3& p : mesh.positions)
            p += by;
        return *this;
    }
    FoundUp find() const { return find_up(mesh, bounds_of_triangles(mesh), z_up_reason); }
    Footing footing() const { return measure_footing(mesh, bounds_of_triangles(mesh)); }

private:
    void add(u32 a, u32 b, u32 c) {
        MeshTriangle triangle{};
        triangle.v[0] = a;
        triangle.v[1] = b;
        triangle.v[2] = c;
        mesh.triangles.push_back(triangle);
    }
};

/// A seat on four legs, with a back.
Thing chair() {
    Thing thing;
    for (const double x : {0., 0.36})
        for (const double y : {0., 0.36})
            thing.box({x, y, 0}, {x + 0.04, y + 0.04, 0.45});
    thing.box({0, 0, 0.45}, {0.4, 0.4, 0.5}).box({0.02, 0.38, 0.5}, {0.38, 0.4, 0.9});
    return thing;
}

} // namespace

TEST(SceneUp, AConeStandsOnItsBase) {
    const Footing footing = Thing().cone(1, 3).footing();
    EXPECT_NEAR(footing[4], 0.785, 0.04); // a disc in its square
    EXPECT_EQ(footing[5], 0);
}

TEST(SceneUp, WhatStandsOnItsLowestZAloneIsZUp) {
    const FoundUp cone = Thing().cone(1, 3).find();
    EXPECT_TRUE(cone.is_z_likely);
    EXPECT_TRUE(cone.is_sure);
    EXPECT_FALSE(Thing().cone(1, 3).make_y_up().find().is_z_likely);
}

TEST(SceneUp, LegsAreAFoot) {
    EXPECT_NEAR(chair().footing()[4], 1, 0.01);
    EXPECT_TRUE(chair().find().is_z_likely);
    EXPECT_FALSE(chair().make_y_up().find().is_z_likely);
}

TEST(SceneUp, WhatWouldToppleDoesNotStand) {
    // A small foot at the edge of a large plate.
    EXPECT_EQ(Thing().box({0, 0, 0}, {1, 1, 1}).box({0, 0, 1}, {20, 20, 2}).footing()[4], 0);
}

TEST(SceneUp, BoxesAndRoomsTellNothing) {
    EXPECT_FALSE(Thing().box({0, 0, 0}, {3, 2, 1}).find().is_z_likely);
    EXPECT_FALSE(Thing().box({0, 0, 0}, {8, 0.1, 6}).box({0, 0, 0}, {8, 3, 0.1}).find().is_z_likely)
        << "floor and back wall";
    EXPECT_FALSE(Thing().find().is_z_likely) << "nothing";
}

TEST(SceneUp, AGableIsAHouseWithZUp) {
    Thing house;
    house.box({0, 0, 0}, {8, 6, 3}).box({0, 2.5, 3}, {8, 3.5, 5});
    EXPECT_TRUE(house.find().is_sure);
    EXPECT_FALSE(house.make_y_up().find().is_z_likely);
}

TEST(SceneUp, WhatAlsoStandsOnASideIsHintedAt) {
    // A cone with a handle that ends in a plate at the box's side.
    Thing thing;
    thing.cone(1, 3).box({-0.1, -1.4, 0.9}, {0.1, 0, 1.1}).box({-0.5, -1.5, 0.4}, {0.5, -1.4, 1.6});
    const FoundUp found = thing.find();
    EXPECT_TRUE(found.is_z_likely);
    EXPECT_FALSE(found.is_sure);
}

TEST(SceneUp, TheBackOfARoomIsNoFoot) {
    // Floor, ceiling and side walls that end at different depths before a back wall: thin boxes, fronts
    // outwards, but for the back wall, which only shows its front.
    Thing room;
    room.box({0, 0, 0}, {4, 0.1, 5}).box({0, 2.9, 0}, {4, 3, 4}).box({0, 0, 0}, {0.1, 3, 4.5});
    room.box({3.9, 0, 0}, {4, 3, 4.5}).wall({0, 0, 0.01}, {4, 3, 0.01});
    EXPECT_FALSE(room.find().is_sure);
}

TEST(SceneUp, AReaderThatKnowsIsBelieved) {
    Thing box;
    box.box({0, 0, 0}, {1, 1, 1});
    EXPECT_FALSE(box.find().is_z_likely);
    box.z_up_reason = "it says so";
    EXPECT_TRUE(box.find().is_sure);
    EXPECT_EQ(box.find().reason, "it says so");
}

TEST(SceneUp, MapCoordinatesHaveZUp) {
    Thing box;
    EXPECT_TRUE(box.box({0, 0, 0}, {90, 50, 20}).move({691000, 5334000, 520}).find().is_sure);
    EXPECT_FALSE(box.make_y_up().find().is_sure) << "x and z are far";
}
