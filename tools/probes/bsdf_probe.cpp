// SPDX-License-Identifier: Apache-2.0
// The program that evaluates and samples a BSDF, and the lobe sets that tests go through.
#include "probes/bsdf_probe.h"

#include "probes/scratch_folder.h"
#include "scene/measured_store.h"

#include <stdexcept>

namespace clrt {

namespace {

const char* const TEXT = R"(
#define PROBE_BSDF const vec4 matte, const vec4 specular, const vec4 transmission, const vec4 shape, \
                   const vec4 normal_g, const vec4 parts, const vec4 sheen, const u32 lobes, const u32 fresnel, \
                   const u32 transport, global const u32* measured
#define PROBE_BSDF_ARGUMENTS matte, specular, transmission, shape, normal_g, parts, sheen, lobes, fresnel, \
                             transport, measured

Bsdf probe_bsdf(PROBE_BSDF, vec4 wo)
{
    Bsdf bsdf;
    const real3 n = vector_normalize(vector_make(REAL(0.36), REAL(-0.48), REAL(0.8)));
    bsdf.frame = frame_make_tangent(n, vector_make(REAL(0.3), REAL(1.0), REAL(0.2)));
    bsdf.wo = vector_from(wo);
    bsdf.normal_g = frame_to_world(&bsdf.frame, vector_from(normal_g));
    bsdf.is_curved = false;
    bsdf.matte = vector_from(matte);
    bsdf.specular = vector_from(specular);
    bsdf.transmission = vector_from(transmission);
    bsdf.alpha_x = (real)shape.x;
    bsdf.alpha_y = (real)shape.y;
    bsdf.eta = (real)shape.z;
    bsdf.exponent = REAL(0.0);
    bsdf.lobes = lobes;
    bsdf.fresnel = fresnel;
    bsdf.flags = transport & (TRANSPORT_IMPORTANCE | BSDF_INSIDE);
    bsdf.glass = (real)parts.x;
    bsdf.flags |= parts.x > 0.0f ? MATERIAL_PART_GLASS : 0u;
#if CLRT_EFFECTS & (EFFECT_COAT | EFFECT_SHEEN)
    bsdf.cover.coat = (lobes & LOBE_COAT) ? (real)parts.y : REAL(0.0);
    bsdf.cover.coat_alpha = (real)parts.z;
    bsdf.cover.sheen = (lobes & LOBE_SHEEN) ? vector_from(sheen) : (real3)(REAL(0.0));
    bsdf.cover.sheen_alpha = (real)parts.w;
#endif
    bsdf_set_measured(&bsdf, measured);
    bsdf_energy_set(&bsdf);
    bsdf_choose_lobes(&bsdf);
    return bsdf;
}

CLRT_KERNEL void probe_eval(PROBE_BSDF, global const vec4* in_a, global const vec4* in_b, const u32 count,
                       global vec4* out_first, global vec4* out_second)
{
    const size_t i = get_global_id(0);
    if (i >= count)
        return;
    const Bsdf bsdf = probe_bsdf(PROBE_BSDF_ARGUMENTS, in_a[i]);
    const real3 wi = frame_to_world(&bsdf.frame, vector_from(in_b[i]));
    const BsdfValue eval = bsdf_eval(&bsdf, wi);
    out_first[i] = (vec4)(convert_float3(eval.value), (float)eval.pdf_w);
    out_second[i] = (vec4)(bsdf_has_smooth_lobe(&bsdf) ? 1.0f : 0.0f, (float)bsdf_pdf_w_reverse(&bsdf, wi), 0.0f, 0.0f);
}

CLRT_KERNEL void probe_sample(PROBE_BSDF, global const vec4* in_a, global const vec4* in_b, const u32 count,
                         global vec4* out_first, global vec4* out_second)
{
    const size_t i = get_global_id(0);
    if (i >= count)
        return;
    const Bsdf bsdf = probe_bsdf(PROBE_BSDF_ARGUMENTS, in_a[i]);
    const vec4 u = in_b[i];
    const BsdfSample sample = bsdf_sample(&bsdf, (real)u.x, (real2)((real)u.y, (real)u.z));
    out_first[i] = (vec4)(convert_float3(frame_to_local(&bsdf.frame, sample.wi)), (float)sample.pdf_w);
    out_second[i] = (vec4)(convert_float3(sample.weight), sample.is_valid ? (float)sample.eta : 0.0f);
}
)";

/// Appended to TEXT: what the tables of albedo.h say of a set's roughness and of directions.
const char* const ALBEDO_TEXT = R"(
CLRT_KERNEL void probe_albedo(PROBE_BSDF, global const vec4* in_a, global const vec4* in_b, const u32 count,
                         global vec4* out_first, global vec4* out_second)
{
    const size_t i = get_global_id(0);
    if (i >= count)
        return;
    const vec4 up = (vec4)(0.0f, 0.0f, 1.0f, 0.0f);
    const Bsdf bsdf = probe_bsdf(PROBE_BSDF_ARGUMENTS, up);
    const real3 w = vector_from(in_a[i]);
    if (lobes & LOBE_DIELECTRIC) {
        const real eta = w.z > REAL(0.0) ? bsdf.eta : REAL(1.0) / bsdf.eta;
        out_first[i] = (vec4)((float)albedo_dielectric_loss(&bsdf.rough, eta, fabs(w.z)), 0.0f,
                              (float)albedo_dielectric_mean_loss(&bsdf.rough, eta), 0.0f);
        return;
    }
    const Albedo albedo = bsdf_energy_albedo(&bsdf, w);
    Albedo mean = {REAL(0.0), FRESNEL_SCHLICK_MEAN};
    if (bsdf.rough.alpha > REAL(0.0))
        mean = albedo_reflection_mean(&bsdf.rough);
    out_first[i] = (vec4)((float)albedo.loss, (float)albedo.schlick, (float)mean.loss, (float)mean.schlick);
}
)";

std::vector<vec4> to_vec4s(const std::vector<glm::dvec3>& values) {
    std::vector<vec4> converted;
    converted.reserve(values.size());
    for (const glm::dvec3& value : values)
        converted.push_back(to_vec4(value));
    return converted;
}

LobeSet rough(LobeSet set, const char* name, double alpha_x, double alpha_y, u32 fresnel) {
    set.name = name;
    set.alpha_x = alpha_x;
    set.alpha_y = alpha_y;
    set.fresnel = fresnel;
    return set;
}

/// Of bsdf_types.h.
constexpr u32 TRANSPORT_IMPORTANCE = 0x80000u, BSDF_INSIDE = 0x200000u;

LobeSet dielectric(const char* name, double alpha, double eta) {
    LobeSet set{name, LOBE_DIELECTRIC};
    set.specular = {1, 1, 1};
    set.transmission = {1, 0.8, 0.5};
    set.alpha_x = set.alpha_y = alpha;
    set.eta = eta;
    return set;
}

LobeSet with_coat(LobeSet set, const char* name, double weight, double alpha) {
    set.name = name;
    set.lobes |= LOBE_COAT;
    set.coat = weight;
    set.coat_alpha = alpha;
    return set;
}

LobeSet with_sheen(LobeSet set, const char* name, double alpha) {
    set.name = name;
    set.lobes |= LOBE_SHEEN;
    set.sheen = {0.9, 0.6, 0.8};
    set.sheen_alpha = alpha;
    return set;
}

/// Matte and Schlick's reflection with a share of glass.
LobeSet part_glass(const char* name, double alpha, double eta) {
    LobeSet set = dielectric(name, alpha, eta);
    set.lobes |= LOBE_MATTE | (alpha > 0 ? LOBE_GLOSSY : LOBE_MIRROR);
    set.fresnel = FRESNEL_SCHLICK;
    set.glass = 0.3;
    set.matte = (1 - set.glass) * glm::dvec3(0.5, 0.4, 0.8);
    set.specular = {0.04, 0.2, 0.3};
    set.transmission *= set.glass;
    return set;
}

/// Sets of the lobes that few materials have.
std::vector<LobeSet> rare_lobe_sets() {
    const LobeSet none{"", 0};
    LobeSet matte{"", LOBE_MATTE, {0.75, 0.5, 0.25}}, pane = dielectric("rough pane", 0.3, 1 / 1.5);
    pane.lobes = LOBE_PANE;
    const LobeSet coated = rough({"", LOBE_MATTE | LOBE_GLOSSY, {0.5, 0.3, 0.1}, {0.04, 0.04, 0.04}}, "", 0.3,
                                 0.3, FRESNEL_SCHLICK);
    LobeSet inside = with_coat(dielectric("", 0.3, 1.5), "coated glass from inside", 0.8, 0.2);
    inside.is_inside = true;
    LobeSet part_pane = part_glass("partly a rough pane", 0.3, 1 / 1.5);
    part_pane.lobes ^= LOBE_DIELECTRIC | LOBE_PANE;
    std::vector<LobeSet> sets = {
        rough(pane, "smooth pane", 0, 0, FRESNEL_NONE),
        pane,
        with_coat(none, "coat", 1, 0.2),
        with_coat(none, "narrow coat", 0.5, 0.15),
        with_sheen(none, "sheen", 0.25),
        with_sheen(none, "narrow sheen", 0.1),
        with_coat(matte, "coated matte", 1, 0.1),
        with_sheen(matte, "velvet", 0.25),
        with_coat(with_sheen(matte, "", 0.4), "coated velvet", 0.7, 0.15),
        with_coat(coated, "coated matte and glossy", 1, 0.15),
        part_glass("partly rough glass from outside", 0.3, 1 / 1.5),
        part_glass("partly rough glass from inside", 0.3, 1.5),
        part_glass("partly smooth glass", 0, 1 / 1.5),
        part_pane,
        with_coat(dielectric("", 0.3, 1 / 1.5), "coated glass from outside", 0.8, 0.2),
        inside};
    for (LobeSet& set : sets)
        set.has_textbook = false;
    return sets;
}

} // namespace

LobeSet LobeSet::from_other_side() const {
    LobeSet other = *this;
    if (!(lobes & LOBE_PANE))
        other.eta = 1 / eta;
    if (lobes & LOBE_DIELECTRIC)
        other.is_inside = !is_inside;
    return other;
}

std::vector<LobeSet> all_lobe_sets() {
    const LobeSet matte{"matte", LOBE_MATTE, {0.75, 0.5, 0.25}};
    const LobeSet glossy{"", LOBE_GLOSSY, {0, 0, 0}, {0.9, 0.6, 0.3}};
    const LobeSet mirror{"mirror", LOBE_MIRROR, {0, 0, 0}, {0.875, 0.75, 0.5}};
    // Silver, copper and lead, about: FRESNEL_CONDUCTOR has eta and k in these places.
    const LobeSet metal{"", LOBE_GLOSSY, {0, 0, 0}, {3.9, 2.6, 4.2}, {0.03, 0.8, 2.6}};
    LobeSet polished = metal;
    polished.lobes = LOBE_MIRROR;
    const LobeSet coated{"", LOBE_MATTE | LOBE_GLOSSY, {0.5, 0.3, 0.1}, {0.04, 0.04, 0.04}};
    const LobeSet varnished{
        "matte and mirror", LOBE_MATTE | LOBE_MIRROR, {0.5, 0.25, 0.125}, {0.25, 0.25, 0.5}};
    std::vector<LobeSet> sets = {matte,
                                 rough(glossy, "glossy", 0.4, 0.4, FRESNEL_NONE),
                                 rough(glossy, "glossy, Schlick", 0.2, 0.2, FRESNEL_SCHLICK),
                                 rough(glossy, "glossy, full roughness", 1, 1, FRESNEL_SCHLICK),
                                 rough(glossy, "glossy, anisotropic", 0.5, 0.15, FRESNEL_NONE),
                                 rough(glossy, "glossy, anisotropic, Schlick", 0.15, 0.6, FRESNEL_SCHLICK),
                                 mirror,
                                 rough(mirror, "mirror, Schlick", 0, 0, FRESNEL_SCHLICK),
                                 rough(metal, "glossy, conductor", 0.3, 0.3, FRESNEL_CONDUCTOR),
                                 rough(metal, "glossy, anisotropic, conductor", 0.2, 0.5, FRESNEL_CONDUCTOR),
                                 rough(polished, "mirror, conductor", 0, 0, FRESNEL_CONDUCTOR),
                                 dielectric("smooth glass from outside", 0, 1 / 1.5),
                                 dielectric("smooth glass from inside", 0, 1.5),
                                 dielectric("rough glass from outside", 0.3, 1 / 1.5),
                                 dielectric("rough glass from inside", 0.3, 1.5),
                                 rough(coated, "matte and glossy", 0.25, 0.25, FRESNEL_SCHLICK),
                                 rough(coated, "matte and glossy, no Fresnel", 0.3, 0.3, FRESNEL_NONE),
                                 varnished,
                                 rough(varnished, "matte and mirror, Schlick", 0, 0, FRESNEL_SCHLICK)};
    for (const LobeSet& set : rare_lobe_sets())
        sets.push_back(set);
    return sets;
}

LobeSet measured_set(const std::string& name, const BrdfFunction& brdf, const MerlCounts& counts) {
    const ScratchFolder folder;
    const std::string file = folder.write("measured.binary", merl_file(brdf, counts));
    NoticeList notices;
    MeasuredStore store;
    store.add({file, {folder.file("m.mtl"), 1}}, notices);
    auto scene = std::make_shared<Scene>();
    store.take(*scene);
    LobeSet set{name, LOBE_MEASURED};
    set.measured = scene;
    set.has_textbook = false;
    return set;
}

LobeSet lobe_set(const std::string& name) {
    for (const LobeSet& set : all_lobe_sets())
        if (set.name == name)
            return set;
    throw std::logic_error("there is no lobe set \"" + name + "\"");
}

std::vector<glm::dvec3> BsdfSamples::found() const {
    std::vector<glm::dvec3> directions;
    for (size_t i = 0; i < wi.size(); ++i)
        if (eta[i] > 0)
            directions.push_back(wi[i]);
    return directions;
}

BsdfProbe::BsdfProbe(const ProbeDevice& device, const ProbeOptions& options)
    : device_(device), probe_(device, {"scattering/bsdf_reverse.h"}, options) {
    probe_.add_text(TEXT);
    probe_.add_text(ALBEDO_TEXT);
}

Kernel BsdfProbe::prepare(const char* name, const LobeSet& set, const std::vector<glm::dvec3>& a,
                          const std::vector<glm::dvec3>& b, const glm::dvec3& normal_g) {
    if (a.size() != b.size())
        throw std::logic_error("BsdfProbe: expected as many inputs of one kind as of the other");
    Kernel kernel = probe_.kernel(name);
    kernel.set("matte", to_vec4(set.matte));
    kernel.set("specular", to_vec4(set.specular));
    kernel.set("transmission", to_vec4(set.transmission));
    kernel.set("shape", to_vec4({set.alpha_x, set.alpha_y, set.eta}));
    kernel.set("normal_g", to_vec4(normal_g));
    kernel.set("lobes", set.lobes);
    kernel.set("fresnel", set.fresnel);
    kernel.set("parts",
               vec4{float(set.glass), float(set.coat), float(set.coat_alpha), float(set.sheen_alpha)});
    kernel.set("sheen", to_vec4(set.sheen));
    kernel.set("transport",
               (set.is_importance ? TRANSPORT_IMPORTANCE : 0u) | (set.is_inside ? BSDF_INSIDE : 0u));
    kernel.set("measured", probe_.upload(set.measured ? set.measured->measured : std::vector<u32>(1)));
    kernel.set("in_a", probe_.upload(to_vec4s(a)));
    kernel.set("in_b", probe_.upload(to_vec4s(b)));
    kernel.set("count", u32(a.size()));
    return kernel;
}

BsdfValues BsdfProbe::eval(const LobeSet& set, const std::vector<glm::dvec3>& wo,
                           const std::vector<glm::dvec3>& wi, const glm::dvec3& normal_g) {
    Kernel kernel = prepare("probe_eval", set, wo, wi, normal_g);
    const cl::Buffer first = create_buffer(device_, "values", wo.size() * sizeof(vec4));
    const cl::Buffer second = create_buffer(device_, "smooth", wo.size() * sizeof(vec4));
    kernel.set("out_first", first);
    kernel.set("out_second", second);
    probe_.launch(kernel, wo.size());
    BsdfValues values;
    for (const vec4& v : probe_.read<vec4>(first, wo.size())) {
        values.value.push_back(to_dvec3(v));
        values.pdf_w.push_back(v.w);
    }
    for (const vec4& v : probe_.read<vec4>(second, wo.size()))
        values.pdf_w_reverse.push_back(v.y);
    return values;
}

BsdfSamples BsdfProbe::sample(const LobeSet& set, const std::vector<glm::dvec3>& wo,
                              const std::vector<glm::dvec3>& u, const glm::dvec3& normal_g) {
    Kernel kernel = prepare("probe_sample", set, wo, u, normal_g);
    const cl::Buffer first = create_buffer(device_, "directions", wo.size() * sizeof(vec4));
    const cl::Buffer second = create_buffer(device_, "weights", wo.size() * sizeof(vec4));
    kernel.set("out_first", first);
    kernel.set("out_second", second);
    probe_.launch(kernel, wo.size());
    BsdfSamples samples;
    for (const vec4& v : probe_.read<vec4>(first, wo.size())) {
        samples.wi.push_back(to_dvec3(v));
        samples.pdf_w.push_back(v.w);
    }
    for (const vec4& v : probe_.read<vec4>(second, wo.size())) {
        samples.weight.push_back(to_dvec3(v));
        samples.eta.push_back(v.w);
    }
    return samples;
}

std::vector<AlbedoSample> BsdfProbe::albedos(const LobeSet& set, const std::vector<glm::dvec3>& w) {
    Kernel kernel = prepare("probe_albedo", set, w, w, {0, 0, 1});
    const cl::Buffer first = create_buffer(device_, "albedos", w.size() * sizeof(vec4));
    const cl::Buffer second = create_buffer(device_, "nothing", w.size() * sizeof(vec4));
    kernel.set("out_first", first);
    kernel.set("out_second", second);
    probe_.launch(kernel, w.size());
    std::vector<AlbedoSample> samples;
    for (const vec4& v : probe_.read<vec4>(first, w.size()))
        samples.push_back({v.x, v.y, v.z, v.w});
    return samples;
}

bool BsdfProbe::has_smooth_lobe(const LobeSet& set) {
    const std::vector<glm::dvec3> up = {{0, 0, 1}};
    Kernel kernel = prepare("probe_eval", set, up, up, {0, 0, 1});
    const cl::Buffer first = create_buffer(device_, "values", sizeof(vec4));
    const cl::Buffer second = create_buffer(device_, "smooth", sizeof(vec4));
    kernel.set("out_first", first);
    kernel.set("out_second", second);
    probe_.launch(kernel, 1);
    return probe_.read<vec4>(second, 1)[0].x != 0;
}

std::vector<glm::dvec3> repeated(const glm::dvec3& value, size_t count) {
    return std::vector<glm::dvec3>(count, to_dvec3(to_vec4(value)));
}

std::vector<glm::dvec3> random_triples(size_t count, u32 seed) {
    Random random(seed);
    std::vector<glm::dvec3> triples;
    for (size_t i = 0; i < count; ++i) {
        const double a = random.unit(), b = random.unit();
        triples.push_back({a, b, random.unit()});
    }
    return triples;
}

} // namespace clrt
