// SPDX-License-Identifier: Apache-2.0
// Frames around normals and random numbers.
#include "stability/cases/shading_expressions.h"
#include "stability/choices.h"

#include "probes/random_inputs.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace clrt {

namespace {

using glm::dvec3;

/// a, b, c: normal. The frame's three axes. Naive: Frisvad's form (2012), which divides by 1 + z.
const ProbedExpression FRAME = {
    "frame", 3, 9,
    "const Frame f = frame_make(vector_make(a, b, c)); out[0] = f.x.x; out[1] = f.x.y; out[2] = f.x.z;"
    "out[3] = f.y.x; out[4] = f.y.y; out[5] = f.y.z; out[6] = f.z.x; out[7] = f.z.y; out[8] = f.z.z;",
    "const real3 n = vector_make(a, b, c); const real s = REAL(1.0) / (REAL(1.0) + c);"
    "out[0] = REAL(1.0) - a * a * s; out[1] = -a * b * s; out[2] = -a; out[3] = -a * b * s; out[4] = "
    "REAL(1.0) - b * b * s; "
    "out[5] = -b;"
    "out[6] = n.x; out[7] = n.y; out[8] = n.z;"};

/// a: the upper 24 bits of a word as a number. Naive: the word over 2^32.
const ProbedExpression UNIT = {"unit", 1, 1, "out[0] = sampler_unit(((uint)a << 8) | 0xffu);",
                               "out[0] = (real)(((uint)a << 8) | 0xffu) * (real)2.3283064365386963e-10f;"};

/// a: pixel. Halves of the key's word and of the first pair and word. Naive: a seed of 32 bits that is no
/// bijection of the pixel.
const ProbedExpression STREAM = {"stream", 1, 8,
                                 "const Sampler s = sampler_make(1u, (uint)a, 0u, 0u); const uint2 p = "
                                 "sampler_pair_words(&s, 0u, SAMPLE_FILM);"
                                 "const uint w[4] = {s.key, p.x, p.y, sampler_word(&s, 0u, SAMPLE_ROULETTE)};"
                                 "for (int k = 0; k < 4; ++k) { out[2 * k] = (real)(w[k] >> 16); out[2 * k + "
                                 "1] = (real)(w[k] & 0xffffu); }",
                                 "const uint x = (uint)a % 3840u, y = (uint)a / 3840u; const uint h = "
                                 "sampler_hash(x * 0x9e3779b9u) ^ sampler_hash(y + "
                                 "0x85ebca6bu);"
                                 "Sampler s; s.key = h; s.index_reversed = 0u; s.word_key = sampler_hash(h); "
                                 "const uint2 p = sampler_pair_words(&s, 0u, "
                                 "SAMPLE_FILM);"
                                 "const uint w[4] = {s.key, p.x, p.y, sampler_word(&s, 0u, SAMPLE_ROULETTE)};"
                                 "for (int k = 0; k < 4; ++k) { out[2 * k] = (real)(w[k] >> 16); out[2 * k + "
                                 "1] = (real)(w[k] & 0xffffu); }"};

/// a: pixel, b: sample, c: bounce, d: purpose. A pair. Naive: white noise.
const ProbedExpression PAIR = {"pair", 4, 4,
                               "const Sampler s = sampler_make(7u, (uint)a, 3u, (uint)b); const uint2 p = "
                               "sampler_net_words(&s, sampler_address((uint)c, (uint)d), false);"
                               "out[0] = (real)(p.x >> 16); out[1] = (real)(p.x & 0xffffu); out[2] = "
                               "(real)(p.y >> 16); out[3] = (real)(p.y & 0xffffu);",
                               "const Sampler s = sampler_make(7u, (uint)a, 3u, (uint)b); const uint2 p = "
                               "sampler_independent_words(&s, sampler_address((uint)c, (uint)d), false);"
                               "out[0] = (real)(p.x >> 16); out[1] = (real)(p.x & 0xffffu); out[2] = "
                               "(real)(p.y >> 16); out[3] = (real)(p.y & 0xffffu);"};

ProbeSet& number_probes(const ProbeDevice& device) {
    return device.once<ProbeSet>("numbers", [&] {
        return ProbeSet(device, {"numerics/frame.h", "numerics/sampler.h"}, {FRAME, UNIT, STREAM, PAIR});
    });
}

u32 word_of(const std::vector<std::vector<double>>& outputs, size_t first, size_t i) {
    return (u32(outputs[first][i]) << 16) | u32(outputs[first + 1][i]);
}

/// lowbias32 (Wellons 2018), written for the test.
u32 host_hash(u32 x) {
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

Columns normals(size_t count) {
    Columns inputs(3);
    const auto add = [&](const dvec3& n) {
        inputs[0].push_back(float(n.x));
        inputs[1].push_back(float(n.y));
        inputs[2].push_back(float(n.z));
    };
    for (const double s : {1.0, -1.0})
        for (const double zero : {0.0, -0.0}) {
            add({s, zero, zero});
            add({zero, s, zero});
            add({zero, zero, s});
            add({s * std::sqrt(0.5), s * std::sqrt(0.5), zero});
        }
    for (int k = 0; k < 4096; ++k) {
        const double z = -1 + k * FLOAT_U;
        add(direction_at(z, 0.001 * k));
        add(direction_at(-z, 0.001 * k));
        add(direction_at((k - 2048) * 1e-9, 0.001 * k));
    }
    Random random(1);
    while (inputs[0].size() < count)
        add(random.direction());
    return inputs;
}

/// Whether the words of some pairs fill every elementary interval of area 2^-m once: how many do not.
size_t empty_intervals(const std::vector<std::array<u32, 2>>& words, int m) {
    size_t empty = 0;
    for (int bits = 0; bits <= m; ++bits) {
        std::vector<char> seen(size_t(1) << m, 0);
        for (const auto& word : words) {
            const u32 x = bits ? word[0] >> (32 - bits) : 0, y = m - bits ? word[1] >> (32 - (m - bits)) : 0;
            seen[(size_t(x) << (m - bits)) | y] = 1;
        }
        empty += size_t(std::count(seen.begin(), seen.end(), 0));
    }
    return empty;
}

} // namespace

void bases(CaseRun& run) {
    Figure& error = run.figure("|dot products|, |lengths - 1|", 4 * FLOAT_U);
    Figure& handed = run.figure("left-handed or not finite", 0);
    const Columns inputs = normals(run.count(1e5, 2e6, 8e6));
    for (const Build build : run.builds()) {
        const auto got = number_probes(run.device).run(build, "frame", inputs);
        for (size_t i = 0; i < inputs[0].size(); ++i) {
            dvec3 axes[3];
            for (size_t k = 0; k < 3; ++k)
                axes[k] = {got[3 * k][i], got[3 * k + 1][i], got[3 * k + 2][i]};
            const auto describe = [&] {
                return fmt::format("{:a} {:a} {:a}", inputs[0][i], inputs[1][i], inputs[2][i]);
            };
            double worst = 0;
            for (int k = 0; k < 3; ++k)
                worst = std::max({worst, std::abs(glm::dot(axes[k], axes[(k + 1) % 3])),
                                  std::abs(glm::length(axes[k]) - 1)});
            const double det = glm::dot(glm::cross(axes[0], axes[1]), axes[2]);
            error[build].see(std::isfinite(det) ? worst : det, describe);
            handed[build].count(!(det > 0), describe);
        }
    }
}

void uniforms(CaseRun& run) {
    Figure& outside = run.figure("numbers outside (0, 1), or with 1 - u rounded", 0);
    Figure& words = run.figure("words that differ from the host's", 0);
    constexpr size_t PART = 1u << 20;
    for (const Build build : run.builds())
        for (size_t part = 0; part < 16; ++part) {
            // All of them in single; the ends elsewhere.
            if (build != Build::SINGLE && part > 0 && part < 15)
                continue;
            std::vector<float> upper(PART);
            for (size_t i = 0; i < PART; ++i)
                upper[i] = float(part * PART + i);
            const std::vector<double> u = number_probes(run.device).run(build, "unit", {upper})[0];
            for (size_t i = 0; i < PART; ++i)
                outside[build].count(!(u[i] > 0 && u[i] < 1 && 1 - double(float(1 - u[i])) == u[i]),
                                     [&] { return fmt::format("word {:#x}ff: {:a}", u32(upper[i]), u[i]); });
        }
    std::vector<float> pixels;
    for (u32 i = 0; i < 65536; ++i)
        pixels.push_back(float(i * 131));
    const auto got = number_probes(run.device).run(Build::SINGLE, "stream", {pixels});
    for (size_t i = 0; i < pixels.size(); ++i) {
        const u32 key = host_hash(u32(pixels[i]) ^ host_hash(0 + host_hash(1 + 0x9e3779b9u)));
        const u32 roulette = host_hash(host_hash(key) + 6u * 0x9e3779b9u);
        words[Build::SINGLE].count(word_of(got, 0, i) != key || word_of(got, 6, i) != roulette,
                                   [&] { return fmt::format("pixel {}", pixels[i]); });
    }
}

void streams(CaseRun& run) {
    Figure& alike = run.figure("pixels that repeat another's words", 0);
    const size_t count = run.count(1u << 20, 3840 * 2160, 3840 * 2160);
    std::vector<float> pixels(count);
    for (size_t i = 0; i < count; ++i)
        pixels[i] = float(i * (count < 4000000 ? 7 : 1));
    for (const Build build : {Build::NAIVE, Build::SINGLE}) {
        const auto got = number_probes(run.device).run(build, "stream", {pixels});
        std::vector<std::array<u32, 4>> words(count);
        for (size_t i = 0; i < count; ++i)
            words[i] = {word_of(got, 0, i), word_of(got, 2, i), word_of(got, 4, i), word_of(got, 6, i)};
        std::sort(words.begin(), words.end());
        for (size_t i = 1; i < count; ++i)
            alike[build].count(words[i] == words[i - 1],
                               [&] { return fmt::format("key {:#x}", words[i][0]); });
    }
}

void nets(CaseRun& run) {
    Figure& empty = run.figure("elementary intervals without their point", 0);
    const size_t addresses = run.count(24, 400, 4000);
    constexpr int M = 10;
    Columns inputs(4);
    for (size_t address = 0; address < addresses; ++address)
        for (u32 sample = 0; sample < 1u << M; ++sample) {
            inputs[0].push_back(float(address * 977));
            inputs[1].push_back(float(sample));
            inputs[2].push_back(float(address % 7));
            inputs[3].push_back(float(address % 10));
        }
    for (const Build build : {Build::NAIVE, Build::SINGLE}) {
        const auto got = number_probes(run.device).run(build, "pair", inputs);
        for (size_t address = 0; address < addresses; ++address)
            for (int m = 0; m <= M; m += 2) {
                std::vector<std::array<u32, 2>> words;
                for (size_t i = address << M; i < (address << M) + (size_t(1) << m); ++i)
                    words.push_back({word_of(got, 0, i), word_of(got, 2, i)});
                empty[build].see(double(empty_intervals(words, m)),
                                 [&] { return fmt::format("address {}, 2^{} samples", address, m); });
            }
    }
}

ProbeTime time_uniforms(const ProbeDevice& device, int rounds) {
    std::vector<float> upper(1u << 20);
    for (size_t i = 0; i < upper.size(); ++i)
        upper[i] = float(i * 16);
    return number_probes(device).time("unit", {upper}, rounds);
}

ProbeTime time_frames(const ProbeDevice& device, int rounds) {
    return number_probes(device).time("frame", normals(1u << 20), rounds);
}

} // namespace clrt
