// SPDX-License-Identifier: Apache-2.0
// Wavefront MTL text -> materials exactly as written: an absent key stays absent (mtl_rules.h gives it
// meaning).
#pragma once

#include "scene/material_description.h"
#include "scene/notices.h"
#include "scene/readers/mtl_dialect.h"
#include "scene/texture_use.h"

#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// A map_* statement: its file, -s, -o, -mm (base and gain), -clamp on and -imfchan are the use of a picture.
struct MtlTexture : TextureUse {
    double bump_multiplier = 1; ///< -bm
};

/// A newmtl block. Colours are linear; a colour with one component given is grey. Values are inside their
/// ranges: Ka Kd Ks Tf d Tr Pr Pm Ps Pcr aniso attenuation thin_walled in [0,1], Ke,
/// Ns, Pc, anisor, eta, k, abbe, priority and attenuation_distance not below 0, Ni above 0. attenuation,
/// attenuation_distance and thin_walled are our own, named as in glTF, abbe is the number of glass lists, and
/// priority that of solids which overlap.
struct MtlMaterial {
    std::string name;
    SourcePlace place;
    MtlWriter writer;                        ///< of the library
    std::map<std::string, size_t> key_lines; ///< where each key was given last; lower case, no other names
    std::optional<glm::dvec3> ka, kd, ks, ke, tf, attenuation;
    std::optional<glm::dvec3> eta, k; ///< complex index of refraction; `conductor` gives both by a name
    std::optional<double> ns, ni, d, tr, pr, pm, ps, pc, pcr, aniso, anisor;
    std::optional<double> attenuation_distance, thin_walled, abbe, priority;
    std::optional<int> illum;        ///< 0..9
    std::optional<MeasuredUse> merl; ///< a measured BRDF, of our own like `conductor`
    std::optional<MtlTexture> map_kd, map_ks, map_ke, map_d, map_pr, map_pm, map_ps, map_normal, map_bump;
    std::optional<MtlTexture> map_ns, map_refl; ///< of Ns, and of what is reflected

    // What no key says; mtl_repair.h does.
    std::optional<double> transmission_weight; ///< share of what is no metal that is glass
    std::optional<double> dielectric_f0; ///< reflectance head-on of the part that is no metal; absent: 4 %
    std::optional<MtlTexture> map_dielectric_f0; ///< multiplies it
    std::vector<std::string> repairs;            ///< names of the repairs that changed this material

    /// Where a key was given; the newmtl where it was not.
    SourcePlace place_of(const std::string& key) const {
        const auto found = key_lines.find(key);
        return found == key_lines.end() ? place : SourcePlace{place.file, found->second};
    }
};

/// Reads a material library. Keys in any case; Kt is another name of Tf, refl of map_refl. What has no
/// meaning anywhere is noted once and ignored: maps of Ka and others, spectral colours, statements before the
/// first newmtl, unknown keys; values outside their range are clamped with a notice. Throws SceneError
/// (file:line) for a missing file and for text where a number belongs.
std::vector<MtlMaterial> read_mtl(const std::string& path, NoticeList& notices);

/// The same for text that was read already; `path` only names it.
std::vector<MtlMaterial> parse_mtl(std::string_view text, const std::string& path, NoticeList& notices);

} // namespace clrt
