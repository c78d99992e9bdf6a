// SPDX-License-Identifier: Apache-2.0
#include "replay/replay.h"

#include "device/opencl_error.h"
#include "render/light_outlines.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace clrt {

namespace {

/// Records of one launch take about this much memory, and no launch has more samples.
constexpr size_t LAUNCH_BYTES = size_t(1) << 26;
constexpr size_t LAUNCH_SAMPLES = size_t(1) << 16;

size_t record_words(u32 capacity) {
    return TRACE_HEAD_WORDS + size_t(TRACE_EVENT_WORDS) * capacity;
}

SampleTrace read_record(const std::uint64_t* words, u32 capacity, const SampleAddress& address,
                        Precision precision) {
    SampleTrace trace;
    trace.address = address;
    trace.precision = precision;
    trace.decisions = u32(words[TRACE_HEAD_DECISIONS]);
    trace.fault = u32(words[TRACE_HEAD_FAULT]);
    for (size_t c = 0; c < 3; ++c)
        trace.film[c] = std::int64_t(words[TRACE_HEAD_FILM + c]);
    trace.event_count = u32(words[TRACE_HEAD_COUNT]);
    trace.events.resize(std::min<size_t>(words[TRACE_HEAD_COUNT], capacity));
    const std::uint64_t* event = words + TRACE_HEAD_WORDS;
    for (TraceEvent& to : trace.events) {
        to.quantity = u32(event[0]);
        std::copy_n(event + 1, 3, to.bits.begin());
        event += TRACE_EVENT_WORDS;
    }
    return trace;
}

} // namespace

double trace_value(const SampleTrace& trace, const TraceEvent& event, int i) {
    const std::uint64_t bits = event.bits[size_t(i)];
    if (is_choice(event.quantity))
        return double(bits);
    if (trace.precision == Precision::DOUBLE) {
        double value = 0;
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }
    const std::uint32_t low = std::uint32_t(bits);
    float value = 0;
    std::memcpy(&value, &low, sizeof value);
    return double(value);
}

u32 trace_bounce(const SampleTrace& trace, size_t index) {
    for (size_t i = std::min(index + 1, trace.events.size()); i-- > 0;)
        if (trace.events[i].quantity == TRACE_VERTEX)
            return u32(trace.events[i].bits[0]);
    return 0;
}

Replay::Replay(const PreparedScene& prepared, Precision precision)
    : device_(prepared.device), precision_(precision), params_(launch_params(*prepared.planned)),
      outlines_(find_light_outlines(prepared.planned->scene, params_)),
      program_(build_replay_program(prepared, precision)), kernel_(program_, "replay_samples") {
    bind_scene(prepared.buffers, kernel_);
    kernel_.set("params", params_);
}

u32 Replay::emission_of(u32 pixel) const {
    // Left of or above the window these are large.
    const u32 x = pixel % params_.width - params_.crop_x, y = pixel / params_.width - params_.crop_y;
    if (outlines_.empty() || x >= params_.crop_width || y >= params_.crop_height)
        return EMISSION_BY_PATHS;
    return outlines_[size_t(y) * params_.crop_width + x];
}

std::vector<SampleTrace> Replay::launch(const SampleAddress* addresses, size_t count, u32 capacity) {
    // Upload the addresses, run one work-item each.
    std::vector<u32> words(TRACE_ADDRESS_FIRST);
    words[TRACE_ADDRESS_COUNT] = u32(count);
    words[TRACE_ADDRESS_CAPACITY] = capacity;
    for (size_t i = 0; i < count; ++i)
        words.insert(words.end(), {addresses[i].pixel, addresses[i].sample, emission_of(addresses[i].pixel)});
    std::vector<std::uint64_t> records(count * record_words(capacity));
    const cl::Buffer list = upload_buffer(device_, "addresses", words);
    const cl::Buffer buffer = create_buffer(device_, "records", records.size() * sizeof(std::uint64_t));
    kernel_.set("addresses", list);
    kernel_.set("records", buffer);
    check_opencl("replaying samples", [&] {
        device_.queue.enqueueNDRangeKernel(kernel_.handle(), cl::NullRange, cl::NDRange(count));
        device_.queue.enqueueReadBuffer(buffer, CL_TRUE, 0, records.size() * sizeof(std::uint64_t),
                                        records.data());
    });

    std::vector<SampleTrace> traces;
    for (size_t i = 0; i < count; ++i)
        traces.push_back(
            read_record(&records[i * record_words(capacity)], capacity, addresses[i], precision_));
    return traces;
}

/// The records without their events.
std::vector<SampleTrace> Replay::run_heads(const std::vector<SampleAddress>& addresses) {
    std::vector<SampleTrace> heads;
    for (size_t first = 0; first < addresses.size(); first += LAUNCH_SAMPLES) {
        std::vector<SampleTrace> part =
            launch(&addresses[first], std::min(LAUNCH_SAMPLES, addresses.size() - first), 0);
        std::move(part.begin(), part.end(), std::back_inserter(heads));
    }
    return heads;
}

std::vector<SampleTrace> Replay::run(const std::vector<SampleAddress>& addresses, TraceEvents events) {
    // Count the events; then give each launch as many samples as its memory has room for.
    std::vector<SampleTrace> heads = run_heads(addresses);
    if (events == TraceEvents::NONE)
        return heads;
    std::vector<SampleTrace> traces;
    while (traces.size() < addresses.size()) {
        const size_t first = traces.size();
        size_t count = 1;
        u32 capacity = heads[first].event_count;
        for (; first + count < heads.size(); ++count) {
            const u32 larger = std::max(capacity, heads[first + count].event_count);
            if ((count + 1) * record_words(larger) * sizeof(std::uint64_t) > LAUNCH_BYTES)
                break;
            capacity = larger;
        }
        std::vector<SampleTrace> part = launch(&addresses[first], count, capacity);
        std::move(part.begin(), part.end(), std::back_inserter(traces));
    }
    return traces;
}

} // namespace clrt
