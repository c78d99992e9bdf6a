// SPDX-License-Identifier: Apache-2.0
// Rooms under every kind of light, and whether two integrators agree about them, tile by tile.
#pragma once

#include "support/render_scene.h"

#include <functional>
#include <vector>

namespace clrt {

struct TileMeans {
    std::vector<double> mean, variance;
};

/// Mean and squared standard error of each tile of 8 x 8 pixels and channel, over the replicates.
TileMeans tile_means(const TestScene& scene, Options options, Integrator integrator, const char* paths);

/// Whether two integrators agree in every tile, to `sharpness` of the picture's mean.
void expect_equal(const TileMeans& a, const TileMeans& b, double sharpness);

/// A floor and a wall with plates of metal and rough glass in front of the camera; no light.
struct Room : TestScene {
    Room();
    void add_lamp();
    /// Mirrors beside the view that throw caustics into it.
    void add_hidden_mirrors();
    /// Bodies that throw caustics.
    void add_caustics();
    /// Plates that reflect almost like mirrors, in view and beside it: metal, metal that is brushed, lacquer.
    void add_sharp_reflections();
    /// A bumpy plate, and coarse balls with smooth normals: matte, of rough and of smooth glass.
    void add_bent_normals();
    /// Plates beside the camera's way of matte, metal and rough glass, whose maps lean far to all sides.
    void add_steep_normals();
};

/// Whether a window of a lit room has the bits that it has in the whole picture.
void expect_crop_is_a_part(Integrator integrator, const Crop& window = {5, 9, 24, 30},
                           Toggle path_reuse = Toggle::OFF);

/// A way to light a room.
struct Lighting {
    const char* name;
    std::function<void(Room&)> add;
    bool is_delta = false; ///< lights that no ray meets
};

/// One for every kind of light, and all at once.
const std::vector<Lighting>& lightings();

} // namespace clrt
