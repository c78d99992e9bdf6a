// SPDX-License-Identifier: Apache-2.0
#include "scene/build_material.h"

#include "colour.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

namespace clrt {
namespace {

bool is_positive(double value) {
    return value > 0;
}

bool is_positive(const glm::dvec3& colour) {
    return largest_component(colour) > 0;
}

/// GGX roughness along and across the tangent; `sqrt_x` squared is `x`, so that a map can scale it.
struct Roughness {
    double x = 0, y = 0, sqrt_x = 0, sqrt_y = 0;
    double mean() const { return std::sqrt(x * y); }
};

/// Builds one material.
class MaterialBuilder {
public:
    MaterialBuilder(const MaterialDescription& description, const MaterialContext& context,
                    const LoadMap& load_map)
        : from_(description), context_(context), load_map_(load_map) {}

    Material build() {
        clear();
        switch (from_.reflection) {
        case Reflection::NONE:
            set_matte();
            break;
        case Reflection::CONSTANT:
        case Reflection::SCHLICK:
            set_matte();
            set_reflection();
            break;
        case Reflection::METALLIC:
            set_metallic_or_glass();
            break;
        case Reflection::DIELECTRIC:
            set_dielectric(from_.transmission);
            break;
        case Reflection::CONDUCTOR:
            set_conductor();
            break;
        case Reflection::MEASURED:
            m_.lobes = LOBE_MEASURED;
            break;
        }
        set_extension_flags();
        set_emission();
        set_coverage();
        set_shape_maps();
        const bool is_all_glass = (m_.lobes & LOBES_GLASS) && !(m_.flags & MATERIAL_PART_GLASS);
        if (is_positive(to_dvec3(m_.matte)) && !is_all_glass)
            m_.lobes |= LOBE_MATTE;
        return m_;
    }

private:
    void clear() {
        m_.transmission = to_vec4(from_.transmission, from_.ior);
        m_.fresnel = FRESNEL_NONE;
        m_.map_matte = m_.map_specular = m_.map_emission = m_.map_coverage = m_.map_roughness = NO_INDEX;
        m_.map_metallic = m_.map_normal = m_.map_bump = NO_INDEX;
    }

    /// Loads the map of a quantity that is not 0 and returns the value that holds with it or without it.
    template <typename T>
    T load(const Mapped<T>& quantity, TextureRole role, u32& map) {
        if (!quantity.map || !is_positive(quantity.value))
            return quantity.value;
        map = load_map_(*quantity.map, role);
        return map == NO_INDEX ? quantity.without_map.value_or(quantity.value) : quantity.value;
    }

    void set_matte() { m_.matte = to_vec4(load(from_.base, TextureRole::COLOUR, m_.map_matte), 1); }

    Roughness roughness() {
        const double value = load(from_.roughness, TextureRole::SCALAR, m_.map_roughness);
        const double root_aspect = std::sqrt(std::sqrt(1 - 0.9 * from_.anisotropy));
        Roughness r;
        r.sqrt_x = value / root_aspect;
        r.sqrt_y = value * root_aspect;
        r.x = r.sqrt_x * r.sqrt_x;
        r.y = r.sqrt_y * r.sqrt_y;
        if (r.mean() >= SMOOTH_ALPHA)
            return r;
        m_.map_roughness = NO_INDEX;
        return {};
    }

    void set_roughness(const Roughness& r) {
        m_.alpha_x = float(r.x);
        m_.alpha_y = float(r.y);
        m_.roughness_sqrt_x = float(r.sqrt_x);
        m_.roughness_sqrt_y = float(r.sqrt_y);
    }

    /// Phong's exponent for the local models: the given one unless a map says how rough the lobe is.
    double phong_exponent(const Roughness& r) const {
        if (r.x <= 0)
            return 0;
        const bool is_given = from_.phong_exponent && m_.map_roughness == NO_INDEX;
        return std::max(is_given ? *from_.phong_exponent : phong_of_alpha(r.mean()), SMALLEST_PHONG_EXPONENT);
    }

    /// The reflection lobe of every model but dielectrics.
    void set_lobe(const glm::dvec3& specular) {
        const Roughness r = roughness();
        set_roughness(r);
        m_.specular = to_vec4(specular, phong_exponent(r));
        m_.lobes |= r.x > 0 ? LOBE_GLOSSY : LOBE_MIRROR;
        if (r.x <= 0) // a delta lobe has no highlight: it is followed whatever the model
            m_.flags |= MATERIAL_WHITTED_MIRROR;
    }

    void set_reflection() {
        const glm::dvec3 specular = load(from_.specular, TextureRole::COLOUR, m_.map_specular);
        if (!is_positive(specular))
            return;

        // Keep matte and reflection together from giving back more than they get; maps count as 1. Below
        // Fresnel's reflection the kernels see to it (scattering/bsdf_energy.h).
        const glm::dvec3 matte = to_dvec3(m_.matte);
        const bool is_coupled = from_.reflection == Reflection::SCHLICK;
        const double sum = is_coupled ? 1.0 : std::max(1.0, largest_component(matte + specular));
        m_.matte = to_vec4(matte / sum, 1);
        set_lobe(specular / sum);
        if (from_.whitted_mirror)
            m_.flags |= MATERIAL_WHITTED_MIRROR;
        if (is_coupled)
            m_.fresnel = FRESNEL_SCHLICK;
    }

    u32 glass_lobe() const { return from_.is_thin ? LOBE_PANE : LOBE_DIELECTRIC; }

    /// The surface is rough unless the indices are equal and nothing is bent at all.
    void set_dielectric(const glm::dvec3& tint) {
        m_.transmission = to_vec4(tint, from_.ior);
        m_.specular = to_vec4(glm::dvec3(1), 0);
        m_.lobes = glass_lobe();
        if (MATERIAL_INDEX(m_) != 1.0f)
            set_roughness(roughness());
    }

    /// True where all of the surface is glass of one colour: no other lobe is there, and nothing varies.
    bool is_plain_glass() const {
        return from_.transmission_weight.value == 1 && !from_.transmission_weight.map &&
               from_.metallic.value == 0 && !from_.base.map;
    }

    /// What is no metal is partly glass, which the kernels mix (scattering/material.h).
    void set_metallic_or_glass() {
        if (is_plain_glass()) {
            const glm::dvec3 base = from_.base.value;
            set_dielectric(from_.is_thin ? base : glm::sqrt(base));
            return;
        }
        set_matte();
        set_metallic();
        if (is_part_glass())
            m_.lobes |= glass_lobe();
    }

    bool is_part_glass() const {
        const bool has_dielectric = from_.metallic.map || from_.metallic.value < 1;
        return from_.transmission_weight.value > 0 && has_dielectric;
    }

    /// What scattering/material.h reads from the extension.
    void set_extension_flags() {
        const bool is_solid = (m_.lobes & LOBE_DIELECTRIC) != 0;
        const bool is_dark = !is_positive(from_.emission.value); // lights know nothing of what is behind them
        if (is_solid && is_dark && from_.attenuation_distance > 0 &&
            from_.attenuation_colour != glm::dvec3(1))
            m_.flags |= MATERIAL_ATTENUATES;
        if (is_solid && context_.nested)
            m_.flags |= MATERIAL_NESTED;
        if (is_solid && from_.abbe > 0 && MATERIAL_INDEX(m_) > 1)
            m_.flags |= MATERIAL_DISPERSES;
        if ((m_.alpha_x != m_.alpha_y && from_.anisotropy_rotation != 0) ||
            (m_.alpha_x > 0 && from_.anisotropy_map))
            m_.flags |= MATERIAL_TURNED;
        if (from_.coat_weight.value > 0)
            m_.lobes |= LOBE_COAT;
        if (is_positive(from_.sheen.value))
            m_.lobes |= LOBE_SHEEN;
    }

    /// Nothing below a metal's surface is seen.
    void set_conductor() {
        const auto inside = [](const glm::dvec3& index, double smallest) {
            return glm::clamp(index, smallest, CONDUCTOR_LARGEST_INDEX);
        };
        set_lobe(inside(from_.conductor.k, 0));
        m_.transmission = to_vec4(inside(from_.conductor.eta, CONDUCTOR_SMALLEST_ETA), from_.ior);
        m_.fresnel = FRESNEL_CONDUCTOR;
        if (from_.whitted_mirror)
            m_.flags |= MATERIAL_WHITTED_MIRROR;
    }

    /// F0 = mix(F, base, metallic), where F is the part's that is no metal; matte base (1 - metallic) of what
    /// the reflection leaves to it (scattering/bsdf_energy.h).
    void set_metallic() {
        const double metallic = load(from_.metallic, TextureRole::SCALAR, m_.map_metallic);
        MATERIAL_METALLIC(m_) = float(metallic);
        const bool by_map = m_.map_metallic != NO_INDEX;
        const double dielectric = by_map || metallic < 1
                                      ? load(from_.dielectric_f0, from_.dielectric_f0_role, m_.map_specular)
                                      : from_.dielectric_f0.value;
        const glm::dvec3 base = to_dvec3(m_.matte);
        glm::dvec3 f0 = glm::min(dielectric * from_.specular_tint, glm::dvec3(1));

        // Where maps make the mix vary the kernels do it; a pure metal's map is the colour of its reflection.
        m_.fresnel = FRESNEL_SCHLICK;
        const bool has_colour_map = m_.map_matte != NO_INDEX || m_.map_specular != NO_INDEX;
        if (is_part_glass() || by_map || (has_colour_map && metallic > 0 && metallic < 1)) {
            m_.flags |= MATERIAL_METALLIC_ROUGHNESS | (is_part_glass() ? MATERIAL_PART_GLASS : 0u);
        } else {
            f0 = glm::mix(f0, base, metallic);
            m_.matte = to_vec4(base * (1 - metallic), 1);
            if (metallic == 1)
                std::swap(m_.map_specular, m_.map_matte);
        }
        if (m_.flags & MATERIAL_METALLIC_ROUGHNESS || is_positive(f0))
            set_lobe(f0);
        if (from_.whitted_mirror)
            m_.flags |= MATERIAL_WHITTED_MIRROR;
    }

    void set_emission() {
        const glm::dvec3 radiance = load(from_.emission, TextureRole::COLOUR, m_.map_emission);
        m_.emission = to_vec4(radiance, double(MATERIAL_METALLIC(m_)));
        if ((context_.two_sided || from_.emits_both_sides) && is_positive(radiance))
            m_.flags |= MATERIAL_EMITS_BOTH_SIDES;
    }

    void set_coverage() {
        MATERIAL_COVERAGE(m_) = float(load(from_.coverage, TextureRole::COVERAGE, m_.map_coverage));
        if (MATERIAL_COVERAGE(m_) < 1 || m_.map_coverage != NO_INDEX)
            m_.flags |= MATERIAL_CUT_OUT;
    }

    /// A bump map's height takes the place of a normal map's strength.
    void set_shape_maps() {
        if (from_.normal_map) {
            m_.map_normal = load_map_(*from_.normal_map, TextureRole::NORMAL);
            m_.bump_scale = float(from_.normal_strength);
        }
        if (from_.bump_map)
            m_.map_bump = load_map_(*from_.bump_map, TextureRole::SCALAR);
        if (m_.map_bump != NO_INDEX)
            m_.bump_scale = float(from_.bump_height * context_.unit);
    }

    const MaterialDescription& from_;
    const MaterialContext& context_;
    const LoadMap& load_map_;
    Material m_{};
};

} // namespace

double alpha_of_phong(double exponent) {
    return std::sqrt(2 / (exponent + 2));
}

double phong_of_alpha(double alpha) {
    return std::max(2 / (alpha * alpha) - 2, 0.0);
}

Material build_material(const MaterialDescription& description, const MaterialContext& context,
                        const LoadMap& load_map) {
    return MaterialBuilder(description, context, load_map).build();
}

} // namespace clrt
