// SPDX-License-Identifier: Apache-2.0
// A material as readers of any format give it: quantities of the field, with the pictures that vary them.
#pragma once

#include "scene/texture_use.h"

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// Matte reflectance of a material that says nothing about itself, and of faces without one.
constexpr double DEFAULT_REFLECTANCE = 0.8;

/// An index of 1.5 reflects 4 % head-on: the F0 of metallic-roughness materials that are no metal and do not
/// say otherwise.
constexpr double DIELECTRIC_F0 = 0.04;

/// The index of refraction of glass, where nothing else is said.
constexpr double DEFAULT_IOR = 1.5;

/// Glass disperses no more than this Abbe number says: the index of every colour stays above 1.
constexpr double SMALLEST_ABBE = 1;

/// A quantity: a constant, and the picture that multiplies it.
template <typename T>
struct Mapped {
    T value{};
    std::optional<TextureUse> map = std::nullopt;
    std::optional<T> without_map = std::nullopt; ///< the value where the map cannot be read; absent: the same
};

/// What a surface reflects beside its matte part.
enum class Reflection {
    NONE,
    CONSTANT, ///< `specular` at every angle
    SCHLICK,  ///< `specular` head-on, 1 at grazing angles
    /// Metallic-roughness: Schlick with F0 = mix(dielectric_f0, base, metallic), matte base (1 - metallic)
    METALLIC,
    DIELECTRIC, ///< reflection and refraction with exact Fresnel; no matte part
    CONDUCTOR,  ///< exact Fresnel by `conductor`; no matte part
    MEASURED    ///< `measured` and nothing else
};

/// Complex index of refraction, channel by channel: eta + i k.
struct ConductorIndex {
    glm::dvec3 eta{1}, k{0};
};

/// The file of a measured BRDF.
struct MeasuredUse {
    std::string file;  ///< as written; relative to the file in `place` (find_file.h)
    SourcePlace place; ///< of the statement that names it
};

/// Something that a material asks for and does not get.
struct Remark {
    std::string text;
    SourcePlace place;
};

/// Colours are linear and in [0,1] but for emission. What is not set is a matte grey.
struct MaterialDescription {
    std::string name;                               ///< "" for faces without a material
    SourcePlace place;                              ///< of its definition
    std::string rule = "no material: matte Kd 0.8"; ///< by what it became what it is, for --explain

    Mapped<glm::dvec3> base{glm::dvec3(DEFAULT_REFLECTANCE)}; ///< matte reflectance, colour of a metal
    Reflection reflection = Reflection::NONE;
    Mapped<glm::dvec3> specular;                         ///< of CONSTANT and SCHLICK
    Mapped<double> metallic;                             ///< of METALLIC, in [0,1]
    Mapped<double> dielectric_f0{DIELECTRIC_F0};         ///< of METALLIC, in [0,1]
    TextureRole dielectric_f0_role = TextureRole::LEVEL; ///< of its map: or COLOUR
    Mapped<double> roughness;                            ///< in [0,1]; GGX alpha is its square, 0 a mirror
    double anisotropy = 0; ///< in [0,1]; stretches the roughness along the tangent (Burley 2012, section 5.4)
    std::optional<double> phong_exponent; ///< that the roughness was made of, where no map multiplies it
    bool whitted_mirror = false;          ///< `whitted` follows its reflection as a mirror's
    double anisotropy_rotation = 0;       ///< turns of the stretched highlight, from growing u to growing v
    /// Stretches by KHR_materials_anisotropy, in the place of `anisotropy`, which is 0: r and g the
    /// direction, b the factor of the strength, in [0,1].
    std::optional<TextureUse> anisotropy_map;
    double anisotropy_strength = 0;
    glm::dvec3 specular_tint{1}; ///< of METALLIC: factor of dielectric_f0
    double ior = DEFAULT_IOR;    ///< of DIELECTRIC and transmission_weight, above 0
    double abbe = 0;             ///< Abbe number of the glass, from SMALLEST_ABBE; 0: no dispersion
    /// Of solid glass: of two solids in one place the one of greater priority is there. Where no material of
    /// a scene has one, surfaces are what they are alone.
    std::optional<double> priority;
    ConductorIndex conductor;   ///< of CONDUCTOR, from 0
    glm::dvec3 transmission{1}; ///< of DIELECTRIC: tint of each crossing
    MeasuredUse measured;       ///< of MEASURED

    /// Of METALLIC, in [0,1]: the share of what is no metal that is glass of index `ior`. It is tinted by the
    /// root of the base at each crossing of a solid, by the base where the wall is thin.
    Mapped<double> transmission_weight;
    bool is_thin = false; ///< the surface is a wall of no thickness: what it lets pass goes straight on

    /// What white light has become behind attenuation_distance (scene units; 0: nothing is absorbed) inside
    /// the solid (Beer and Lambert).
    glm::dvec3 attenuation_colour{1};
    double attenuation_distance = 0;

    Mapped<double> coat_weight;     ///< of a clear film of index 1.5 above everything, in [0,1]
    Mapped<double> coat_roughness;  ///< in [0,1]; GGX alpha is its square
    Mapped<glm::dvec3> sheen;       ///< colour of fibres above everything but the coat, in [0,1]
    Mapped<double> sheen_roughness; ///< in [0,1]; alpha of their distribution is its square

    Mapped<glm::dvec3> emission;   ///< radiance on the front side
    bool emits_both_sides = false; ///< and on the back
    Mapped<double> coverage{1};    ///< in [0,1]; below 1 the surface is cut out
    std::optional<TextureUse> normal_map, bump_map;
    double normal_strength = 1; ///< factor of the x and y of a normal map
    double bump_height = 1;     ///< of a full-range bump map, scene units

    /// Of what is neither emission nor coverage: not said where another surface takes its place.
    std::vector<Remark> surface_remarks;
};

} // namespace clrt
