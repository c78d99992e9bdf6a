// SPDX-License-Identifier: Apache-2.0
#include "output/cryptomatte.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

constexpr size_t RANKS_A_LAYER = 2;
constexpr std::uint32_t EXPONENT_MASK = 0x7f800000u, LOWEST_EXPONENT_BIT = 0x00800000u;
/// Digits of the hash of a kind's name that its metadata has.
constexpr size_t KEY_DIGITS = 7;

std::uint32_t rotate_left(std::uint32_t x, int bits) {
    return x << bits | x >> (32 - bits);
}

std::uint32_t mix_block(std::uint32_t block) {
    return rotate_left(block * 0xcc9e2d51u, 15) * 0x1b873593u;
}

/// Turns the hash so that it is a normal float.
std::uint32_t matte_bits(const std::string& name) {
    const std::uint32_t hash = murmur_hash_3(name), exponent = hash & EXPONENT_MASK;
    return exponent == 0 || exponent == EXPONENT_MASK ? hash ^ LOWEST_EXPONENT_BIT : hash;
}

/// Makes one share of those of the same id; they are sorted by id then.
void unite(std::vector<MatteShare>& shares) {
    std::sort(shares.begin(), shares.end(),
              [](const MatteShare& a, const MatteShare& b) { return a.id < b.id; });
    std::vector<MatteShare> united;
    for (const MatteShare& share : shares)
        if (!united.empty() && united.back().id == share.id)
            united.back().coverage += share.coverage;
        else
            united.push_back(share);
    shares = std::move(united);
}

} // namespace

std::uint32_t murmur_hash_3(const std::string& text) {
    std::uint32_t hash = 0;
    const size_t blocks = text.size() / 4;
    for (size_t i = 0; i < blocks; ++i) {
        std::uint32_t block = 0;
        for (size_t byte = 0; byte < 4; ++byte)
            block |= std::uint32_t(std::uint8_t(text[4 * i + byte])) << (8 * byte);
        hash = rotate_left(hash ^ mix_block(block), 13) * 5 + 0xe6546b64u;
    }
    std::uint32_t rest = 0;
    for (size_t byte = 4 * blocks; byte < text.size(); ++byte)
        rest |= std::uint32_t(std::uint8_t(text[byte])) << (8 * (byte % 4));
    hash ^= mix_block(rest) ^ std::uint32_t(text.size());
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

float matte_id(const std::string& name) {
    const std::uint32_t bits = matte_bits(name);
    float id = 0;
    std::memcpy(&id, &bits, sizeof id);
    return id;
}

std::vector<std::string> matte_channels(const std::string& kind) {
    std::vector<std::string> channels;
    for (size_t layer = 0; layer < MATTE_RANKS / RANKS_A_LAYER; ++layer)
        for (const char channel : {'R', 'G', 'B', 'A'})
            channels.push_back(fmt::format("{}{:02}.{}", kind, layer, channel));
    return channels;
}

Metadata matte_attributes(const std::string& kind, const std::vector<std::string>& names) {
    nlohmann::json manifest = nlohmann::json::object();
    for (const std::string& name : names)
        manifest[name] = fmt::format("{:08x}", matte_bits(name));
    const std::string key =
        "cryptomatte/" + fmt::format("{:08x}", murmur_hash_3(kind)).substr(0, KEY_DIGITS) + "/";
    return {{key + "name", kind},
            {key + "hash", "MurmurHash3_32"},
            {key + "conversion", "uint32_to_float32"},
            {key + "manifest", manifest.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)}};
}

void append_mattes(std::vector<float>& values, std::vector<MatteShare> shares) {
    unite(shares);
    std::stable_sort(shares.begin(), shares.end(),
                     [](const MatteShare& a, const MatteShare& b) { return a.coverage > b.coverage; });
    shares.resize(MATTE_RANKS);
    for (const MatteShare& share : shares) {
        values.push_back(share.id);
        values.push_back(float(share.coverage));
    }
}

} // namespace clrt
