// SPDX-License-Identifier: Apache-2.0
// Cryptomatte 1.2.0 (Friedman, Jones: Fully Automatic ID Mattes with Support for Motion Blur and
// Transparency, 2015): how much of each pixel shows which name, from a few layers of floats.
#pragma once

#include "output/image.h"

#include <cstdint>
#include <string>
#include <vector>

namespace clrt {

/// Pairs of an id and its coverage that are written of a pixel, two in a layer.
constexpr size_t MATTE_RANKS = 6;

/// A pixel's share of one id.
struct MatteShare {
    float id = 0; ///< matte_id()
    double coverage = 0;
};

/// MurmurHash3_32 (Appleby) with the seed 0.
std::uint32_t murmur_hash_3(const std::string& text);

/// The hash of a name as the bits of a float that is neither subnormal nor infinite nor NaN.
float matte_id(const std::string& name);

/// The names of the channels of a kind of mattes: "CryptoObject00.R" to "CryptoObject02.A".
std::vector<std::string> matte_channels(const std::string& kind);

/// What an EXR file says of a kind of mattes: the hash, and the manifest of all names as JSON.
Metadata matte_attributes(const std::string& kind, const std::vector<std::string>& names);

/// Appends the values of a pixel: those of most coverage first, each id once; of equal coverage the smaller
/// id. What is left over is 0.
void append_mattes(std::vector<float>& values, std::vector<MatteShare> shares);

} // namespace clrt
