// SPDX-License-Identifier: Apache-2.0
#include "guide/guide_buffers.h"

#include "device/opencl_error.h"

namespace clrt {

namespace {

constexpr size_t NODE_BYTES = GUIDE_NODES * sizeof(GuideNode);
constexpr size_t CELL_BYTES = GUIDE_CELLS * sizeof(GuideCell);
constexpr size_t SUM_BYTES = size_t(GUIDE_CELLS) * GUIDE_SUMS * sizeof(std::uint64_t);

template <class T>
void write_buffer(const Device& device, const cl::Buffer& buffer, const std::vector<T>& values) {
    device.queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(T), values.data());
}

} // namespace

GuideBuffers::GuideBuffers(const Device& device)
    : device_(device), nodes_(create_buffer(device, "guide_nodes", NODE_BYTES)),
      cells_(create_buffer(device, "guide_cells", CELL_BYTES)),
      sums_(create_buffer(device, "guide_sums", SUM_BYTES)) {}

void GuideBuffers::bind(Kernel& kernel) const {
    kernel.set("guide_nodes", nodes_);
    kernel.set("guide_cells", cells_);
    kernel.set("guide_sums", sums_);
}

void GuideBuffers::write(const Guide& guide, const std::vector<std::uint64_t>& sums) const {
    const std::vector<std::uint64_t> zeros(sums.empty() ? guide.lore().size() * GUIDE_SUMS : 0);
    check_opencl("writing the guide", [&] {
        write_buffer(device_, nodes_, guide.device_nodes());
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

size_t guide_device_bytes() {
    return NODE_BYTES + CELL_BYTES + SUM_BYTES;
}

} // namespace clrt
