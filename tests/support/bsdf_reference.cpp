// SPDX-License-Identifier: Apache-2.0
#include "support/bsdf_reference.h"

#include "probes/reference.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace clrt::reference {

using glm::dvec3;

dvec3 reflection_color(const LobeSet& set, double cosine) {
    if (set.fresnel == FRESNEL_CONDUCTOR)
        return {fresnel_conductor(cosine, set.transmission.x, set.specular.x),
                fresnel_conductor(cosine, set.transmission.y, set.specular.y),
                fresnel_conductor(cosine, set.transmission.z, set.specular.z)};
    const auto channel = [&](double f0) {
        return set.fresnel == FRESNEL_SCHLICK ? fresnel_schlick(f0, cosine) : f0;
    };
    return {channel(set.specular.x), channel(set.specular.y), channel(set.specular.z)};
}

namespace {

/// The facets' mean reflectance as the kernels have it: 1 / 21 of Schlick's, three nodes of Gauss's rule for
/// the weight 2 c of a conductor's.
dvec3 facet_mean(const LobeSet& set) {
    if (set.fresnel == FRESNEL_CONDUCTOR)
        return reflection_color(set, 0.212340538239153) * 0.139653959802914 +
               reflection_color(set, 0.590533135559265) * 0.458482212719170 +
               reflection_color(set, 0.911412040487296) * 0.401863827477916;
    return set.fresnel == FRESNEL_SCHLICK ? set.specular + (dvec3(1) - set.specular) / 21.0 : set.specular;
}

} // namespace

dvec3 multiple_color(const LobeSet& set, double mean_loss) {
    const dvec3 f = facet_mean(set);
    return f * f * (1 - mean_loss) / (dvec3(1) - f * mean_loss);
}

bool is_coupled(const LobeSet& set) {
    return (set.lobes & LOBE_MATTE) && (set.lobes & ~LOBE_MATTE) && set.fresnel == FRESNEL_SCHLICK;
}

namespace {

/// Walter et al. 2007, eqs. 20, 21, 14 and 17, with |cos_i| inside and radiance scaled by eta^2.
BsdfReference rough_dielectric(const LobeSet& set, const dvec3& wo, const dvec3& wi) {
    dvec3 h = wi.z > 0 ? wo + wi : set.eta * wo + wi;
    h = glm::normalize(h.z < 0 ? -h : h);
    const double oh = glm::dot(wo, h), ih = glm::dot(wi, h);
    if (oh <= 0 || ih * wi.z <= 0)
        return {};
    const double f = fresnel_dielectric(oh, set.eta), d = ggx_d(h, set.alpha_x, set.alpha_y);
    const double g1 = ggx_g1(wo, set.alpha_x, set.alpha_y);
    const double g2 = ggx_g2(wo, wi, set.alpha_x, set.alpha_y);
    const double visible = g1 * oh * d / wo.z;
    if (wi.z > 0)
        return {set.specular * (f * d * g2 / (4 * wo.z * wi.z) * wi.z), f * visible / (4 * oh)};
    const double denominator = std::pow(set.eta * oh + ih, 2);
    // (index on wi's side)^2 of eq. 21 is 1 where eta is the index on wo's side.
    const double btdf = std::abs(oh * ih) / std::abs(wo.z * wi.z) * (1 - f) * g2 * d / denominator;
    return {set.transmission * (btdf * std::abs(wi.z) * set.eta * set.eta),
            (1 - f) * visible * std::abs(ih) / denominator};
}

/// 1 - E of the reflection above the matte lobe: what one facet, Schlick's part and more facets leave.
dvec3 passing(const LobeSet& set, double loss, double schlick, double mean_loss) {
    const dvec3 one(1), multiple = mean_loss > 0 ? multiple_color(set, mean_loss) : dvec3(0);
    return one - set.specular * (1 - loss) - (one - set.specular) * schlick - multiple * loss;
}

/// What the facets of a rough dielectric do not send on, leaves on both sides: the reflected share by which
/// the squared index times the transmission is the same both ways.
double multiple_reflects(double eta, double here, double there) {
    const double n = std::max(eta, 1 / eta), outside = (n - 1) / (4.08567 + 1.00071 * n);
    const double crossing = eta > 1 ? (1 - outside) / (n * n) : 1 - outside;
    return 1 - crossing * there / std::max(here, there);
}

BsdfReference dielectric_eval(const LobeSet& set, const dvec3& wo, const dvec3& wi, const AlbedoSample& o,
                              const AlbedoSample& i, double there) {
    BsdfReference sum = rough_dielectric(set, wo, wi);
    const double reflects = multiple_reflects(set.eta, o.mean_loss, there),
                 side = wi.z > 0 ? reflects : 1 - reflects;
    const dvec3 color = wi.z > 0 ? set.specular : set.transmission * (set.eta * set.eta);
    sum.value += color * (side * o.loss * i.loss / i.mean_loss * std::abs(wi.z) / PI);
    sum.pdf_w = (1 - o.loss) * sum.pdf_w + o.loss * side / (2 * PI);
    return sum;
}

} // namespace

dvec3 matte_albedo(const LobeSet& set, const AlbedoSample& o) {
    return is_coupled(set) ? set.matte * passing(set, o.loss, o.schlick, o.mean_loss) : set.matte;
}

BsdfReference bsdf_eval(const LobeSet& set, const dvec3& wo, const dvec3& wi, const AlbedoSample& o,
                        const AlbedoSample& i, double there) {
    if (set.lobes == LOBE_DIELECTRIC)
        return dielectric_eval(set, wo, wi, o, i, there);
    if (wi.z <= 0)
        return {};
    const bool has_matte = set.lobes & LOBE_MATTE;
    const bool glossy = set.lobes & LOBE_GLOSSY;
    const dvec3 more = glossy ? multiple_color(set, o.mean_loss) : dvec3(0);
    const double matte = has_matte ? glm::length(matte_albedo(set, o)) : 0;
    const double reflection = set.lobes == LOBE_MATTE ? 0 : glm::length(reflection_color(set, wo.z));
    const double multiple = glm::length(more) * o.loss, sizes = matte + reflection + multiple;
    const double choose_matte = matte / sizes, choose_multiple = multiple / sizes;
    BsdfReference sum{set.matte * (wi.z / PI), choose_matte * wi.z / PI};
    if (is_coupled(set))
        sum.value *= passing(set, o.loss, o.schlick, o.mean_loss) *
                     passing(set, i.loss, i.schlick, o.mean_loss) /
                     passing(set, o.mean_loss, o.mean_schlick, o.mean_loss);
    if (glossy) {
        sum.value += more * (o.loss * i.loss / o.mean_loss * wi.z / PI);
        sum.pdf_w += choose_multiple / (2 * PI);
        const dvec3 h = glm::normalize(wo + wi);
        const double d = ggx_d(h, set.alpha_x, set.alpha_y);
        const double g1 = ggx_g1(wo, set.alpha_x, set.alpha_y);
        const double g2 = ggx_g2(wo, wi, set.alpha_x, set.alpha_y);
        sum.value += reflection_color(set, glm::dot(wo, h)) * (d * g2 / (4 * wo.z));
        sum.pdf_w += (1 - choose_matte - choose_multiple) * g1 * d / (4 * wo.z);
    }
    return sum;
}

double first_facet_albedo(const LobeSet& set, const dvec3& wo, size_t radii, size_t angles) {
    double sum = 0;
    for (size_t i = 0; i < radii; ++i)
        for (size_t j = 0; j < angles; ++j) {
            const double q = (double(i) + 0.5) / double(radii) * PI / 2,
                         phi = (double(j) + 0.5) / double(angles) * 2 * PI;
            const double r = std::tan(q);
            const dvec3 h =
                glm::normalize(dvec3(set.alpha_x * r * std::cos(phi), set.alpha_y * r * std::sin(phi), 1));
            const double oh = glm::dot(wo, h);
            if (oh <= 0)
                continue;
            const double jacobian =
                set.alpha_x * set.alpha_y * r * std::pow(h.z, 3) / std::pow(std::cos(q), 2);
            const double density = oh * ggx_d(h, set.alpha_x, set.alpha_y) / wo.z * jacobian;
            const double f =
                set.lobes == LOBE_DIELECTRIC ? fresnel_dielectric(oh, set.eta) : reflection_color(set, oh).x;
            const dvec3 mirrored = 2 * oh * h - wo;
            if (mirrored.z > 0)
                sum += density * f * ggx_g2(wo, mirrored, set.alpha_x, set.alpha_y);
            const double cos_t_squared = 1 - set.eta * set.eta * (1 - oh * oh);
            if (set.lobes != LOBE_DIELECTRIC || cos_t_squared <= 0)
                continue;
            const dvec3 refracted = h * (set.eta * oh - std::sqrt(cos_t_squared)) - set.eta * wo;
            if (refracted.z < 0)
                sum += density * (1 - f) * ggx_g2(wo, refracted, set.alpha_x, set.alpha_y);
        }
    return sum * (PI / 2 / double(radii)) * (2 * PI / double(angles));
}

} // namespace clrt::reference
