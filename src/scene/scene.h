// SPDX-License-Identifier: Apache-2.0
// A scene ready for the device: plain vectors of the shared structs, indices instead of pointers, no
// behaviour.
#pragma once

#include "bvh/instanced_bvh.h"
#include "kernels/shared/camera_types.h"
#include "kernels/shared/scene_types.h"
#include "options/integrators.h"
#include "output/named_file.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// World to normalised frame: p' = (p - centre) * scale, scale a power of two, half-diagonal in [1, 2).
/// Computed in double, so that scaling a scene by a power of two gives the same normalised bits.
struct Normalisation {
    glm::dvec3 centre{0};
    double scale = 1;
};

/// Where a camera is and how it is held, world units.
struct CameraPose {
    glm::dvec3 eye, at, up;
};

/// A camera in world units, as it is when the shutter opens.
struct Camera {
    glm::dvec3 eye{0}, at{0, 0, -1}, up{0, 1, 0};
    double fov_degrees = 40; ///< perspective: vertical angle of view
    Projection projection = PROJECTION_PERSPECTIVE;
    double ortho_height = 0; ///< orthographic: of what the picture shows
    glm::dvec2 shift{0}; ///< of the picture's middle from the axis: right over its width, up over its height
    double aperture = 0; ///< diameter of the lens; 0: a pinhole
    double focus = 1;    ///< depth of the plane in focus; may be infinite
    int blades = 0;      ///< corners of the lens; 0: round
    std::optional<CameraPose> end{}; ///< when the shutter closes; none: it does not move
};

/// The sky's light, luminance, on surfaces from which paths have gone on, on average, and what all portals
/// let in.
struct SkyThroughPortals {
    double irradiance = 0, flux = 0;
};

/// A lat-long environment or, without texels, a constant one.
struct Environment {
    glm::dvec3 radiance{0}; ///< constant radiance, or the factor of the map
    int width = 0, height = 0;
    u32 texel_format = SKY_TEXEL_FLOAT; ///< SKY_TEXEL_* (scene/sky_texels.h)
    std::vector<u32> texels;            ///< words, in tiles
    std::vector<SkyTile> tiles;         ///< the table for light sampling (scene/sky_table.h)
    double rotation_degrees = 0;        ///< about +Y
    double mean_radiance = 0;           ///< over the sphere, luminance, factor included
    /// What the table is made for; none: there is none yet.
    std::optional<SkySampling> sampling;
    double tabulated_share = 1;     ///< of the map's light: what the table is in proportion to
    std::vector<SkyPortal> portals; ///< through which it is seen (scene/sky_portals.h), normalised frame
    std::vector<u32> portal_sums;   ///< of the sky seen through them (scene/rectified_sky.h)
    double portal_share = 0;        ///< of its light samples
    SkyThroughPortals let_in;       ///< what they show of it
};

/// The tree that chooses lights (scene/light_tree.h); empty: tables do.
struct LightTree {
    std::vector<LightNode> nodes;
    std::vector<LightPlace> places; ///< of the emitters, then the lights, then the environment
};

/// Radiance that a material emits, its map included.
struct EmittedRadiance {
    glm::dvec3 mean{0};    ///< over the map's picture
    glm::dvec3 largest{0}; ///< of the map's texels, component by component
};

/// Where a material was defined, for witnesses and messages.
struct SourcePlace {
    std::string file;
    size_t line = 0; ///< from 1; 0: none
};

/// How long the parts of loading took and how much was read.
struct LoadStatistics {
    size_t obj_bytes = 0;
    double obj_seconds = 0; ///< reading and triangulating the OBJ text
    double texture_seconds = 0;
    size_t degenerate_triangles = 0; ///< of zero area: kept out of the lights
    size_t dropped_faces = 0;        ///< with a non-finite vertex or fewer than three corners
};

struct Scene {
    std::vector<vec4> positions; ///< normalised frame, w = 0
    std::vector<vec4> normals;   ///< unit or zero, w = 0
    /// From the shutter's opening to its closing, of each position and normal; empty where no triangle moves.
    std::vector<vec4> position_moves, normal_moves;
    std::vector<float> uvs;            ///< u, v pairs
    std::vector<float> second_uvs;     ///< beside them, or empty where no texture reads them
    std::vector<Triangle> triangles;   ///< the scene's own, then those of prototypes, in frames of their own
    std::vector<Prototype> prototypes; ///< of the meshes that instances share
    std::vector<Instance> instances;   ///< the first stands for the scene itself; empty without prototypes
    std::vector<Material> materials;
    std::vector<MaterialExtension> extensions; ///< one for each material, or none at all
    std::vector<EmittedRadiance> emitted;      ///< by each material
    std::vector<std::string> material_names;
    std::vector<SourcePlace> material_places;
    std::vector<std::string> material_rules; ///< the row of the MTL table that made each material
    std::vector<std::string> object_names;
    std::vector<Texture> textures;
    std::vector<u32> texel_words;
    std::vector<glm::vec3>
        vertex_colours;        ///< of each position, linear, while loading: then they are texel words
    std::vector<u32> measured; ///< words of measured BRDFs: each a MeasuredBrdf and its values
    std::map<u32, std::string> measured_names; ///< the file of each by its first word, as written
    std::vector<std::string> texture_names;
    std::vector<SourcePlace> texture_places; ///< the map_* statement of each
    std::vector<Emitter> emitters;
    std::vector<EmitterPart> emitter_parts; ///< one for each emitter; empty where all are whole triangles
    std::vector<double>
        emitter_exitance; ///< luminance of each over pi, both sides; empty: that of its material
    std::vector<Light> lights;
    std::vector<std::string> light_sources; ///< by what each of the lights is there, in messages
    std::vector<vec4> casters; ///< spheres at which emission is aimed (scene/casters.h); empty: it is not
    LightTree light_tree;
    Environment environment;
    std::optional<glm::dvec3>
        background;         ///< radiance that camera rays see outside the scene, not sky and suns
    bool is_studio = false; ///< lit by the studio, because nothing else gives light
    Camera camera;
    std::optional<glm::ivec2> picture_size; ///< where no option gives it and the file's camera has an aspect
    Normalisation normalisation;
    SourcePlace first_smooth; ///< the face that the first triangle with corner normals is from
    double radius = 1;        ///< of the bounding sphere of the file's geometry, normalised frame
    float extent = 0;         ///< largest |coordinate| of the file's geometry, normalised frame
    float ground_extent =
        0; ///< the same of the ground, whose triangles are the last of the scene's own; 0: none
    double emitted_power = 0;         ///< luminance of all lights but the environment, normalised frame
    std::vector<std::string> notices; ///< every fallback, one line each, for the log and --explain
    std::vector<NamedFile> files;     ///< all that were opened, those that could not be understood too
    LoadStatistics statistics;
};

} // namespace clrt
