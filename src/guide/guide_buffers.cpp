// SPDX-License-Identifier: Apache-2.0
#include "guide/guide_buffers.h"

#include "device/opencl_error.h"

namespace clrt {

namespace {

constexpr size_t SUMS = size_t(GUIDE_CELLS) * GUIDE_SUMS;

} // namespace

GuideBuffers::GuideBuffers(const Device& device, double extent)
    : device_(device), guide_(extent),
      nodes_(create_buffer(device, "guide_nodes", GUIDE_NODES * sizeof(GuideNode))),
      cells_(create_buffer(device, "guide_cells", GUIDE_CELLS * sizeof(GuideCell))),
      sums_(create_buffer(device, "guide_sums", SUMS * sizeof(std::uint64_t))) {
    write();
}

void GuideBuffers::bind(Kernel& kernel) const {
    kernel.set("guide_nodes", nodes_);
    kernel.set("guide_cells", cells_);
    kernel.set("guide_sums", sums_);
}

void GuideBuffers::write() const {
    const std::vector<GuideCell> cells = guide_.cells();
    const std::vector<GuideNode> nodes = guide_.nodes();
    check_opencl("writing the guide", [&] {
        device_.queue.enqueueWriteBuffer(nodes_, CL_TRUE, 0, nodes.size() * sizeof(nodes[0]), nodes.data());
        device_.queue.enqueueWriteBuffer(cells_, CL_TRUE, 0, cells.size() * sizeof(cells[0]), cells.data());
    });
}

void GuideBuffers::advance() {
    std::vector<std::uint64_t> sums(guide_.cell_count() * GUIDE_SUMS);
    check_opencl("reading the guide", [&] {
        device_.queue.enqueueReadBuffer(sums_, CL_TRUE, 0, sums.size() * sizeof(sums[0]), sums.data());
    });
    guide_.learn(sums);
    write();
    sums.assign(sums.size(), 0);
    check_opencl("clearing the guide", [&] {
        device_.queue.enqueueWriteBuffer(sums_, CL_TRUE, 0, sums.size() * sizeof(sums[0]), sums.data());
    });
}

} // namespace clrt
