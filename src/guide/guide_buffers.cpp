// SPDX-License-Identifier: Apache-2.0
#include "guide/guide_buffers.h"

#include "device/opencl_error.h"

#include <numeric>

namespace clrt {

namespace {

constexpr size_t LINK_BYTES = GUIDE_LINKS * sizeof(u32);
constexpr size_t CELL_BYTES = GUIDE_CELLS * sizeof(GuideCell);
constexpr size_t SUM_BYTES = size_t(GUIDE_CELLS) * GUIDE_SUMS * sizeof(std::uint64_t);

template <class T>
void write_buffer(const Device& device, const cl::Buffer& buffer, const std::vector<T>& values) {
    device.queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(T), values.data());
}

} // namespace

GuideBuffers::GuideBuffers(const Device& device, size_t tiles)
    : device_(device), tiles_(tiles), links_(create_buffer(device, "guide_links", LINK_BYTES)),
      cells_(create_buffer(device, "guide_cells", CELL_BYTES)),
      sums_(create_buffer(device, "guide_sums", SUM_BYTES)),
      weights_(create_buffer(device, "guide_weights", tiles * sizeof(float))),
      gains_(create_buffer(device, "guide_gains", tiles * sizeof(std::int64_t))) {}

void GuideBuffers::bind(Kernel& kernel) const {
    kernel.set("guide_links", links_);
    kernel.set("guide_cells", cells_);
    kernel.set("guide_sums", sums_);
    kernel.set("guide_weights", weights_);
    kernel.set("guide_gains", gains_);
}

void GuideBuffers::write(const Guide& guide, const std::vector<std::uint64_t>& sums) const {
    const std::vector<std::uint64_t> zeros(sums.empty() ? guide.lore().size() * GUIDE_SUMS : 0);
    check_opencl("writing the guide", [&] {
        write_buffer(device_, links_, guide.device_links());
        write_buffer(device_, cells_, guide.device_cells());
        write_buffer(device_, sums_, sums.empty() ? zeros : sums);
    });
}

std::vector<std::uint64_t> GuideBuffers::read_sums(size_t cells) const {
    std::vector<std::uint64_t> sums(cells * GUIDE_SUMS);
    check_opencl("reading the guide", [&] {
        device_.queue.enqueueReadBuffer(sums_, CL_TRUE, 0, sums.size() * sizeof(sums[0]), sums.data());
    });
    return sums;
}

void GuideBuffers::write_weights(const std::vector<float>& weights) const {
    check_opencl("writing what a guide's gains weigh", [&] {
        write_buffer(device_, weights_, weights);
        write_buffer(device_, gains_, std::vector<std::int64_t>(tiles_));
    });
}

double GuideBuffers::read_gain() const {
    std::vector<std::int64_t> gains(tiles_);
    check_opencl("reading a guide's gains", [&] {
        device_.queue.enqueueReadBuffer(gains_, CL_TRUE, 0, gains.size() * sizeof(gains[0]), gains.data());
    });
    return std::accumulate(gains.begin(), gains.end(), 0.0) / GUIDE_GAIN_UNITS;
}

size_t guide_device_bytes() {
    return LINK_BYTES + CELL_BYTES + SUM_BYTES;
}

} // namespace clrt
