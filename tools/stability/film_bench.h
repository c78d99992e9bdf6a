// SPDX-License-Identifier: Apache-2.0
// Long sums: 64 pixels that add up one series of values, by the renderer's film and in the textbook's ways.
#pragma once

#include "film/film.h"
#include "kernels/shared/render_types.h"
#include "render/render.h"
#include "stability/probe_set.h"

namespace clrt {

/// Ways to add up a pixel's samples, all in memory and in three channels as the film does; only the film's
/// keep the replicates apart.
enum class SumKind {
    FILM,      ///< the renderer's: 64-bit fixed point, bad samples kept out
    UNGUARDED, ///< the same without looking for bad samples
    PLAIN,     ///< a sum in the kernels' number type
    SQUARES,   ///< PLAIN with a sum of squares: channel 0 the sum, channel 1 the squares
    BLOCKS,    ///< blocks of 1024 in float, joined by two-sum
    DOUBLE     ///< a sum in double; needs fp64
};

/// The program of all ways in a build's precision, one a device.
KernelProbe& film_bench_probe(const ProbeDevice& device, Build build);

class FilmBench {
public:
    static constexpr u32 PIXELS = 64, REPLICATES = 8;

    /// Pixel i adds the series from place 8 i k on, round its end: all pixels and their replicates sum the
    /// same values in another order. The length is a multiple of 512. The film's scale is that of a scene of
    /// this mean radiance.
    FilmBench(const ProbeDevice& device, std::vector<float> series, double mean_radiance);

    const std::vector<float>& series() const { return series_; }
    FilmScale scale() const { return scale_; }

    /// The film of 64 x 1 pixels, by the film in that build's precision.
    Film film(Build build);
    /// What the last film() counted.
    const RenderCounts& counts() const { return counts_; }
    /// The sums of all pixels, [pixel][rgb], in single precision; not for FILM and UNGUARDED.
    std::vector<double> sums(SumKind kind);
    /// Times the film against another way, for one sample of three channels.
    ProbeTime time_film_against(SumKind naive, int rounds);
    /// Mean of each replicate's part of the series in long double; the mean of these is that of the series.
    std::vector<long double> replicate_means() const;
    long double mean() const;

private:
    /// A kernel with its buffers; `samples` of the series, from the first on.
    struct Bound {
        Kernel kernel;
        cl::Buffer film, counters;
    };
    Bound bind(Build build, SumKind kind, u32 samples) const;
    RenderParams params() const;

    const ProbeDevice& device_;
    std::vector<float> series_;
    cl::Buffer series_buffer_;
    FilmScale scale_;
    RenderCounts counts_;
};

} // namespace clrt
