// SPDX-License-Identifier: Apache-2.0
// What the keys of an MTL material mean: lobes, roughness, emission, coverage. The rules are one table and
// the functions beside it.
#pragma once

#include "scene/notices.h"
#include "scene/readers/mtl_reader.h"
#include "scene/texture_store.h"

#include <functional>
#include <string>
#include <vector>

namespace clrt {

/// GGX lobes narrower than this become delta lobes: microfacet arithmetic is tested down to alpha = 1e-4 and
/// the pictures do not differ from there on.
constexpr double SMOOTH_ALPHA = 1e-4;

/// From this Ns on the reflection of illum 3 and 8 is a perfect mirror, as exporters write it.
constexpr double MIRROR_NS = 1000;

/// A Phong exponent of 0 says "no highlight" to the kernels; the widest highlight gets this one instead.
constexpr double SMALLEST_PHONG_EXPONENT = 1e-3;

/// Up to this roughness `whitted` follows the reflection of a metallic-roughness material as a mirror's.
constexpr double WHITTED_MIRROR_PR = 0.1;

/// Matte reflectance of a material that says nothing about itself, and of faces without one.
constexpr double DEFAULT_KD = 0.8;

/// An index of 1.5 reflects 4 % head-on: the F0 of metallic-roughness materials that are no metal and do not
/// say otherwise.
constexpr double DIELECTRIC_F0 = 0.04;

/// GGX alpha of a Phong exponent, sqrt(2 / (Ns + 2)), and back, 2 / alpha^2 - 2 (Walter et al. 2007,
/// section 5.2, and Blinn-Phong's usual match).
double alpha_of_ns(double ns);
double ns_of_alpha(double alpha);

struct RuledMaterial {
    Material material;
    std::string rule; ///< the row of the table that made it: "illum 2: matte Kd, glossy Ks", ...
};

/// A row of the table: a line of MTL that selects it, and what it makes.
struct MaterialRow {
    std::string keys, text;
};
std::vector<MaterialRow> material_rows();

/// Reads a map and returns its index, or NO_INDEX.
using LoadMap = std::function<u32(const MtlTexture&, TextureRole)>;

struct MaterialContext {
    double unit = 1;        ///< one scene unit in the normalised frame, for bump heights
    bool two_sided = false; ///< --two-sided-lights
};

/// Gives a material the meaning that the table has for its keys. Only the maps that can have an effect are
/// loaded.
RuledMaterial rule_material(const MtlMaterial& mtl, const MaterialContext& context, const LoadMap& load_map,
                            NoticeList& notices);

/// Whether the rules make glass of the material's keys.
bool is_dielectric(const MtlMaterial& mtl);

/// The material of faces without one: matte, Kd 0.8.
RuledMaterial default_material();

/// A material as a witness: its name and, where it has one, its place: `material "glass" (room.mtl:12)`.
std::string describe_material(const Scene& scene, size_t index);

/// What a material of a scene became, such as "matte 0.5 0.5 0.5, Kd map "wood.png"".
std::string material_summary(const Scene& scene, size_t index);

/// The materials of a scene as a table for --explain: name, rule, what each became.
std::string material_table(const Scene& scene);

} // namespace clrt
