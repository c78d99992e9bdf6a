// SPDX-License-Identifier: Apache-2.0
#include "stability/bsdf_set.h"

#include <algorithm>
#include <fmt/format.h>

namespace clrt {

namespace {

std::string real_text(double value) {
    return fmt::format("REAL({:.9e})", value);
}

std::string vector_text(const glm::dvec3& v) {
    return fmt::format("vector_make({}, {}, {})", real_text(v.x), real_text(v.y), real_text(v.z));
}

std::string flags_text(const LobeSet& set) {
    return std::string(set.glass > 0 ? "MATERIAL_PART_GLASS" : "0u") +
           (set.is_inside ? " | BSDF_INSIDE" : "");
}

/// A function that makes the BSDF of a set's number.
std::string sets_text() {
    std::string cases;
    const std::vector<LobeSet> sets = all_lobe_sets();
    for (size_t i = 0; i < sets.size(); ++i) {
        const LobeSet& s = sets[i];
        cases += fmt::format("    case {}: bsdf.matte = {}; bsdf.specular = {}; bsdf.transmission = {};\n"
                             "        bsdf.alpha_x = {}; bsdf.alpha_y = {}; bsdf.eta = {}; bsdf.lobes = {}u; "
                             "bsdf.fresnel = {}u;\n"
                             "        bsdf.glass = {}; bsdf.flags = {}; bsdf.cover.coat = {}; "
                             "bsdf.cover.coat_alpha = {};\n"
                             "        bsdf.cover.sheen = {}; bsdf.cover.sheen_alpha = {}; break;\n",
                             i, vector_text(s.matte), vector_text(s.specular), vector_text(s.transmission),
                             real_text(s.alpha_x), real_text(s.alpha_y), real_text(s.eta), s.lobes, s.fresnel,
                             real_text(s.glass), flags_text(s), real_text(s.coat), real_text(s.coat_alpha),
                             vector_text(s.sheen), real_text(s.sheen_alpha));
    }
    return "static CLRT_NOINLINE Bsdf set_bsdf(real set, real alpha, real3 wo)\n{\n"
           "    Bsdf bsdf;\n"
           "    bsdf.normal_g = vector_make(REAL(0.0), REAL(0.0), REAL(1.0));\n"
           "    bsdf.frame = frame_make(bsdf.normal_g);\n"
           "    bsdf.wo = wo; bsdf.is_curved = false; bsdf.exponent = REAL(0.0);\n"
           "    switch ((uint)set) {\n    default:\n" +
           cases +
           "    }\n"
           "    if (alpha > REAL(0.0)) { bsdf.alpha_x = alpha; bsdf.alpha_y = alpha; }\n"
           "    bsdf_energy_set(&bsdf);\n"
           "    bsdf_choose_lobes(&bsdf);\n"
           "    return bsdf;\n}\n";
}

const ProbedExpression EVAL = {
    "eval", 8, 4,
    "const Bsdf bsdf = set_bsdf(a, b, vector_make(c, d, e)); const BsdfValue v = bsdf_eval(&bsdf, "
    "vector_make(f, g, h));"
    "out[0] = v.value.x; out[1] = v.value.y; out[2] = v.value.z; out[3] = v.pdf_w;",
    ""};

const ProbedExpression SAMPLE = {
    "sample", 8, 12,
    "const Bsdf bsdf = set_bsdf(a, b, vector_make(c, d, e)); const BsdfSample s = bsdf_sample(&bsdf, f, "
    "(real2)(g, h));"
    "const BsdfValue v = bsdf_eval(&bsdf, s.wi);"
    "out[0] = s.wi.x; out[1] = s.wi.y; out[2] = s.wi.z; out[3] = s.weight.x; out[4] = s.weight.y; out[5] = "
    "s.weight.z;"
    "out[6] = s.pdf_w; out[7] = s.is_valid ? s.eta : REAL(0.0);"
    "out[8] = v.value.x; out[9] = v.value.y; out[10] = v.value.z; out[11] = v.pdf_w;",
    ""};

} // namespace

void BsdfInputs::add(size_t set, double alpha, const glm::dvec3& wo, const glm::dvec3& rest) {
    const double row[] = {double(set), alpha, wo.x, wo.y, wo.z, rest.x, rest.y, rest.z};
    for (size_t k = 0; k < columns.size(); ++k)
        columns[k].push_back(float(row[k]));
}

std::string BsdfInputs::describe(size_t i) const {
    std::string text = all_lobe_sets()[size_t(columns[0][i])].name;
    if (columns[1][i] > 0)
        text += fmt::format(", alpha {:g}", columns[1][i]);
    return text + fmt::format(", wo {:a} {:a} {:a}, then {:a} {:a} {:a}", columns[2][i], columns[3][i],
                              columns[4][i], columns[5][i], columns[6][i], columns[7][i]);
}

ProbeSet& bsdf_probes(const ProbeDevice& device) {
    return device.once<ProbeSet>("lobe sets", [&] {
        return ProbeSet(device, {"scattering/bsdf.h"}, {EVAL, SAMPLE}, sets_text());
    });
}

std::vector<LobeSet> textbook_sets() {
    std::vector<LobeSet> sets = all_lobe_sets();
    const auto has_none = [](const LobeSet& set) { return !set.has_textbook; };
    sets.erase(std::find_if(sets.begin(), sets.end(), has_none), sets.end());
    return sets;
}

bool is_smooth(const LobeSet& set) {
    return (set.lobes & (LOBE_MATTE | LOBE_GLOSSY)) != 0 ||
           ((set.lobes & LOBE_DIELECTRIC) && set.alpha_x > 0);
}

} // namespace clrt
