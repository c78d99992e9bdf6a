// SPDX-License-Identifier: Apache-2.0
#include "guide/guide_buffers.h"

#include "device/buffer_values.h"

#include <numeric>

namespace clrt {

namespace {

constexpr size_t LINK_BYTES = GUIDE_LINKS * sizeof(u32);
constexpr size_t CELL_BYTES = GUIDE_CELLS * sizeof(GuideCell);
constexpr size_t SUM_BYTES = size_t(GUIDE_CELLS) * GUIDE_SUMS * sizeof(std::uint64_t);

const char* const WRITING_GUIDE = "writing the guide";
const char* const READING_GUIDE = "reading the guide";

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
    write_values(device_, WRITING_GUIDE, links_, guide.device_links());
    write_values(device_, WRITING_GUIDE, cells_, guide.device_cells());
    write_values(device_, WRITING_GUIDE, sums_, sums.empty() ? zeros : sums);
}

std::vector<std::uint64_t> GuideBuffers::read_sums(size_t cells) const {
    return read_values<std::uint64_t>(device_, READING_GUIDE, sums_, 0, cells * GUIDE_SUMS);
}

void GuideBuffers::write_weights(const std::vector<float>& weights) const {
    write_values(device_, WRITING_GUIDE, weights_, weights);
    write_values(device_, WRITING_GUIDE, gains_, std::vector<std::int64_t>(tiles_));
}

double GuideBuffers::read_gain() const {
    const auto gains = read_values<std::int64_t>(device_, READING_GUIDE, gains_, 0, tiles_);
    return std::accumulate(gains.begin(), gains.end(), 0.0) / GUIDE_GAIN_UNITS;
}

size_t guide_device_bytes() {
    return LINK_BYTES + CELL_BYTES + SUM_BYTES;
}

} // namespace clrt
