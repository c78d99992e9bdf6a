// SPDX-License-Identifier: Apache-2.0
#include "stability/catalogue.h"

#include "stability/choices.h"

#include <algorithm>

namespace clrt {

const std::vector<CaseGroup>& catalogue() {
    static const std::vector<CaseGroup> groups = {
        {'I', "Intersection", intersection_cases()},
        {'S', "Leaving surfaces", offsets_cases()},
        {'C', "Scale and position", scale_cases()},
        {'D', "Degenerate geometry", degenerate_cases()},
        {'G', "Grazing incidence", grazing_cases()},
        {'T', "Dielectrics", dielectric_cases()},
        {'R', "Roughness", roughness_cases()},
        {'F', "Furnaces", furnace_cases()},
        {'P', "Reciprocity and probability", distribution_cases()},
        {'L', "Lights", light_cases()},
        {'E', "Environment", environment_cases()},
        {'K', "Cameras", camera_cases()},
        {'A', "Film", film_cases()},
        {'B', "Bidirectional", bidirectional_cases()},
        {'M', "Metropolis", {}},
        {'X', "Bad samples", sample_cases()},
        {'V', "Devices", device_cases()},
    };
    return groups;
}

bool is_asked_for(const std::string& id, const std::vector<std::string>& ids) {
    return ids.empty() || std::any_of(ids.begin(), ids.end(), [&](const std::string& beginning) {
               return id.rfind(beginning, 0) == 0;
           });
}

std::vector<const StabilityCase*> chosen_cases(const std::vector<std::string>& ids) {
    std::vector<const StabilityCase*> chosen;
    for (const CaseGroup& group : catalogue())
        for (const StabilityCase& subject : group.cases)
            if (is_asked_for(subject.id, ids))
                chosen.push_back(&subject);
    return chosen;
}

const std::vector<RobustChoice>& robust_choices() {
    static const std::vector<RobustChoice> choices = {
        {"Edge test of triangles", "Moeller-Trumbore", "sheared corners, exact signs", "I01", 0,
         time_edge_test},
        {"Box test", "plain slabs", "padded slabs", "I05", 0, time_slab},
        {"Leaving a surface", "Waechter-Binder", "error bound of the hit", "S04", 0, time_offset},
        {"Point of a hit", "origin + t direction", "by weights, on pieces of vast triangles", "C04", 0,
         time_hit_point},
        {"Fresnel reflectance", "1 - eta^2 (1 - cos^2)", "two-product form", "T01", 0, time_fresnel},
        {"Film sum", "a float", "64-bit fixed point", "A02", 0, time_film_plain},
        {"Film sum", "blocks of 1024 floats, two-sum", "64-bit fixed point", "A02", 1, time_film_blocks},
        {"Film sum", "a double", "64-bit fixed point", "A02", 2, time_film_double},
        {"Guard against bad samples", "none", "exponent bits, counted by kind", "X01", 0, time_film_guard},
        {"Distribution of normals", "by cos^2", "by local components", "R01", 0, time_ggx_d},
        {"Random number from a word", "word / 2^32", "odd multiples of 2^-24", "P05", 0, time_uniforms},
        {"Frame around a normal", "1 / (1 + z)", "1 / (|z| + 1)", "P04", 0, time_frames},
        {"Choice among 4096 lights", "sums in float, bisection", "alias table of integers", "L07", 0,
         time_light_choice},
        {"Point of a near lamp", "by area", "by solid angle", "L06", 0, time_solid_angle},
        {"MIS weight", "squares of densities", "square of their ratio", "L09", 0, time_mis_weight},
    };
    return choices;
}

} // namespace clrt
