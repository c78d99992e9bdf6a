// SPDX-License-Identifier: Apache-2.0
// Replays single samples of a picture by kernels that are built to write down what they compute: the same
// code on the same random numbers, so the same bits.
#pragma once

#include "kernels/shared/render_types.h"
#include "render/prepared_scene.h"
#include "replay/quantities.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace clrt {

/// One sample of a picture.
struct SampleAddress {
    u32 pixel = 0; ///< y width + x of the whole picture
    u32 sample = 0;
};

/// One line of a record.
struct TraceEvent {
    u32 quantity = 0;                    ///< TRACE_*
    std::array<std::uint64_t, 3> bits{}; ///< integers of a choice, else floats or doubles by their bits
};

/// The record of a sample.
struct SampleTrace {
    SampleAddress address;
    Precision precision = Precision::SINGLE;
    std::vector<TraceEvent> events;     ///< in the order of evaluation; empty where they were not asked for
    u32 event_count = 0;                ///< how many the sample has
    u32 decisions = 0;                  ///< hash of all choices
    u32 fault = 0;                      ///< COUNT_* that the film books it under; COUNT_WORDS if it is good
    std::array<std::int64_t, 3> film{}; ///< what the film adds, in quanta
};

/// Value i of an event as a double, exact.
double trace_value(const SampleTrace& trace, const TraceEvent& event, int i);

/// Bounce of the vertex that event `index` belongs to: 0 for the camera, n for the end of segment n.
u32 trace_bounce(const SampleTrace& trace, size_t index);

/// Which events a replay brings back.
enum class TraceEvents { NONE, ALL };

/// Replays samples of one picture in one precision.
class Replay {
public:
    /// Compiles the kernel; the scene may be prepared without programs. Keeps a reference to its device.
    /// Throws DeviceError and KernelBuildError.
    Replay(const PreparedScene& prepared, Precision precision);

    /// The records of samples, in their order.
    std::vector<SampleTrace> run(const std::vector<SampleAddress>& addresses,
                                 TraceEvents events = TraceEvents::ALL);

    /// Of the film, radiance.
    double quantum() const { return double(params_.quantum); }
    /// Largest radiance that the film takes.
    double largest() const { return double(params_.largest_contribution); }

private:
    std::vector<SampleTrace> launch(const SampleAddress* addresses, size_t count, u32 capacity);
    /// EMISSION_* of pixel y width + x.
    u32 emission_of(u32 pixel) const;
    std::vector<SampleTrace> run_heads(const std::vector<SampleAddress>& addresses);

    const Device& device_;
    Precision precision_;
    RenderParams params_;
    std::vector<std::uint8_t> outlines_; ///< EMISSION_* of the window's pixels; empty: all emission is paths'
    Program program_;
    Kernel kernel_;
};

} // namespace clrt
