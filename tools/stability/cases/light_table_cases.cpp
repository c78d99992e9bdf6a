// SPDX-License-Identifier: Apache-2.0
// The tables that lights are chosen by.
#include "stability/cases/shading_expressions.h"
#include "stability/choices.h"

#include "probes/random_inputs.h"
#include "scene/alias_table.h"
#include "scene/lights.h"

#include <fmt/format.h>
#include <numeric>

namespace clrt {

namespace {

constexpr double WORDS = 4294967296.0;
constexpr u32 TABLE_SIZE = 4096;

/// What the integers of a table choose: word below threshold keeps i, else alias.
std::vector<double> enumerate(const AliasTable& table) {
    std::vector<double> p(table.entries.size(), 0);
    for (size_t i = 0; i < p.size(); ++i) {
        const double kept = table.entries[i].threshold / WORDS;
        p[i] += kept / double(p.size());
        p[table.entries[i].alias] += (1 - kept) / double(p.size());
    }
    return p;
}

/// What running sums in float choose with numbers of 24 bits, which a float cannot tell apart more finely
/// near 1.
std::vector<double> by_float_sums(const std::vector<double>& weights) {
    const double whole = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<double> p(weights.size());
    float sum = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
        const float next = sum + float(weights[i] / whole);
        p[i] = double(next) - double(sum);
        sum = next;
    }
    return p;
}

/// Powers of lights over four decades.
std::vector<double> powers(size_t count) {
    Random random(1);
    std::vector<double> weights(count);
    for (double& weight : weights)
        weight = std::pow(random.unit(), 4) + 1e-4;
    return weights;
}

/// a: a number for the naive way; b: a word's bits; c, d, e: running sums, thresholds' bits, aliases.
const ProbedExpression CHOICE = {
    "choice", 5, 1,
    "const u32 w = as_uint(in_b[i]), slot = warp_index(w, 4096u);"
    "out[0] = sampler_hash(w) < as_uint(in_d[slot]) ? (real)slot : (real)in_e[slot];",
    "u32 low = 0u, high = 4095u; while (low < high) { const u32 middle = (low + high) / 2u; if "
    "(in_c[middle] > in_a[i]) high = middle;"
    "else low = middle + 1u; } out[0] = (real)low;"};

} // namespace

void dark_lights(CaseRun& run) {
    Figure& dark = run.figure("dark lamps that can be chosen", 0);
    Figure& lost = run.figure("lamps with power that cannot", 0);
    Random random(2);
    std::vector<vec4> positions;
    std::vector<Triangle> triangles;
    std::vector<double> exitance;
    std::vector<bool> shines;
    for (u32 i = 0; i < 10000; ++i) {
        const glm::dvec3 p = random.in_cube(1), e = random.in_cube(0.1), f = random.in_cube(0.1);
        const u32 kind = random.word() % 4; // two corners in one place, three in line, black, or a lamp
        for (const glm::dvec3& corner : {p, kind == 0 ? p : p + e, kind == 1 ? p : p + f})
            positions.push_back(to_vec4(corner));
        Triangle triangle{};
        triangle.v0 = 3 * i;
        triangle.v1 = 3 * i + 1;
        triangle.v2 = 3 * i + 2;
        triangle.material = i;
        triangles.push_back(triangle);
        exitance.push_back(kind == 2 ? 0 : std::abs(random.signed_log(1e-20, 1e20)));
        shines.push_back(kind == 3);
    }
    const Emitters built = build_emitters(positions, triangles, exitance);
    std::vector<double> chance(triangles.size(), 0);
    for (const Emitter& emitter : built.emitters) {
        chance[emitter.triangle] += emitter.threshold / WORDS;
        chance[built.emitters[emitter.alias].triangle] += 1 - emitter.threshold / WORDS;
    }
    for (size_t i = 0; i < triangles.size(); ++i) {
        dark[Build::SINGLE].count(!shines[i] && chance[i] > 0, [&] { return fmt::format("triangle {}", i); });
        lost[Build::SINGLE].count(shines[i] && !(chance[i] > 0),
                                  [&] { return fmt::format("triangle {}", i); });
    }
}

void many_lights(CaseRun& run) {
    Figure& error = run.figure("relative error of a light's probability", 1e-6);
    Figure& stored = run.figure("relative error of what the densities say", 1e-12);
    const std::vector<double> weights = powers(run.count(1e6, 1e7, 1e7));
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    const AliasTable table = build_alias_table(weights);
    const std::vector<double> p = enumerate(table), naive = by_float_sums(weights);
    for (size_t i = 0; i < p.size(); ++i) {
        const auto describe = [&] { return fmt::format("light {} of power {}", i, weights[i]); };
        error[Build::SINGLE].see(std::abs(p[i] * sum / weights[i] - 1), describe);
        error[Build::NAIVE].see(std::abs(naive[i] * sum / weights[i] - 1), describe);
        stored[Build::SINGLE].see(std::abs(p[i] / table.probability[i] - 1), describe);
    }
}

ProbeTime time_light_choice(const ProbeDevice& device, int rounds) {
    const std::vector<double> weights = powers(TABLE_SIZE);
    const AliasTable table = build_alias_table(weights);
    const double whole = std::accumulate(weights.begin(), weights.end(), 0.0);
    Random random(3);
    Columns inputs(5);
    double sum = 0;
    for (u32 i = 0; i < 1u << 20; ++i) {
        const u32 entry = i % TABLE_SIZE;
        sum = entry == 0 ? weights[0] : sum + weights[entry];
        inputs[0].push_back(float(random.unit()));
        inputs[1].push_back(bits_to_float(random.word()));
        inputs[2].push_back(float(sum / whole));
        inputs[3].push_back(bits_to_float(table.entries[entry].threshold));
        inputs[4].push_back(float(table.entries[entry].alias));
    }
    return ProbeSet(device, {"numerics/warp.h"}, {CHOICE}).time("choice", inputs, rounds);
}

} // namespace clrt
