// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/merl_reader.h"

#include "error.h"
#include "scene/vectors.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>

namespace clrt {
namespace {

constexpr size_t COUNTS_BYTES = 3 * sizeof(std::int32_t), CHANNELS = 3;
constexpr const char* CHANNEL_NAMES[CHANNELS] = {"red", "green", "blue"};
constexpr double CHANNEL_FACTORS[CHANNELS] = {MERL_RED, MERL_GREEN, MERL_BLUE};

/// A little-endian number of 4 or 8 bytes.
template <typename T>
T number_at(std::string_view bytes, size_t offset) {
    std::uint64_t bits = 0;
    for (size_t i = 0; i < sizeof(T); ++i)
        bits |= std::uint64_t((unsigned char)bytes[offset + i]) << (8 * i);
    T value;
    if constexpr (sizeof(T) == 4) {
        const auto low = std::uint32_t(bits);
        std::memcpy(&value, &low, sizeof value);
    } else {
        std::memcpy(&value, &bits, sizeof value);
    }
    return value;
}

/// Reads one file.
class MerlReader {
public:
    MerlReader(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}

    MeasuredValues read() {
        read_counts();
        table_.values.resize(cells());
        for (u32 i = 0; i < table_.half_count; ++i)
            for (u32 j = 0; j < table_.difference_count; ++j)
                for (u32 k = 0; k < table_.azimuth_count; ++k)
                    read_cell(i, j, k);
        return std::move(table_);
    }

private:
    [[noreturn]] void fail(const std::string& message) const {
        throw SceneError(path_, 0, "no MERL file: " + message);
    }

    size_t cells() const {
        return size_t(table_.half_count) * table_.difference_count * table_.azimuth_count;
    }

    void read_counts() {
        if (bytes_.size() < COUNTS_BYTES)
            fail(fmt::format("expected three counts in {} bytes, found {} bytes", COUNTS_BYTES,
                             bytes_.size()));
        std::int32_t counts[3];
        for (size_t i = 0; i < 3; ++i)
            counts[i] = number_at<std::int32_t>(bytes_, i * sizeof(std::int32_t));
        const auto is_count = [](std::int32_t n, u32 most) { return n > 0 && u32(n) <= most; };
        if (!is_count(counts[0], MERL_HALF_ANGLES) || !is_count(counts[1], MERL_DIFFERENCE_ANGLES) ||
            !is_count(counts[2], MERL_AZIMUTHS))
            fail(fmt::format("expected counts of half angles, difference angles and azimuths of {} {} {} or "
                             "less, found {} {} {}",
                             MERL_HALF_ANGLES, MERL_DIFFERENCE_ANGLES, MERL_AZIMUTHS, counts[0], counts[1],
                             counts[2]));
        table_.half_count = u32(counts[0]);
        table_.difference_count = u32(counts[1]);
        table_.azimuth_count = u32(counts[2]);
        const size_t expected = COUNTS_BYTES + CHANNELS * sizeof(double) * cells();
        if (bytes_.size() != expected)
            fail(fmt::format("expected {} bytes for {} x {} x {} values of three channels, found {}{}",
                             expected, counts[0], counts[1], counts[2], bytes_.size(),
                             bytes_.size() < expected ? ": it is truncated" : ""));
    }

    /// True if one of the directions at the middle of a cell is below the surface.
    bool is_below_horizon(u32 i, u32 j, u32 k) const {
        const double root = (i + 0.5) / table_.half_count;
        return std::tan(PI / 2 * root * root) * std::tan(PI / 2 * (j + 0.5) / table_.difference_count) *
                   std::fabs(std::cos(PI * (k + 0.5) / table_.azimuth_count)) >
               1;
    }

    void read_cell(u32 i, u32 j, u32 k) {
        const size_t row = table_.azimuth_count, cell = (size_t(i) * table_.difference_count + j) * row + k;
        bool is_missing = false;
        for (size_t channel = 0; channel < CHANNELS; ++channel) {
            const double value = number_of(channel, cell, i, j, k);
            const bool is_measured = value >= 0, is_below = !is_measured && is_below_horizon(i, j, k);
            is_missing |= !is_measured && !is_below;
            table_.values[cell][int(channel)] = is_measured         ? float(value)
                                                : is_below && j > 0 ? table_.values[cell - row][int(channel)]
                                                                    : 0;
        }
        table_.missing += is_missing;
    }

    double number_of(size_t channel, size_t cell, u32 i, u32 j, u32 k) const {
        const double number =
            number_at<double>(bytes_, COUNTS_BYTES + sizeof(double) * (channel * cells() + cell));
        const double value = number * CHANNEL_FACTORS[channel];
        if (!std::isfinite(value) || value > MERL_LARGEST)
            fail(fmt::format("expected finite numbers of a BRDF up to {:g} per steradian, found {} in {} of "
                             "half angle {}, difference angle {}, azimuth {}",
                             MERL_LARGEST, number, CHANNEL_NAMES[channel], i, j, k));
        return value;
    }

    std::string_view bytes_;
    const std::string& path_;
    MeasuredValues table_;
};

} // namespace

MeasuredValues parse_merl(std::string_view bytes, const std::string& path) {
    return MerlReader(bytes, path).read();
}

} // namespace clrt
