// SPDX-License-Identifier: Apache-2.0
#include "images/oiio_encoder.h"

#include "error.h"

#include <algorithm>

namespace clrt {

namespace {

OIIO::TypeDesc type_of(ChannelType type) {
    switch (type) {
    case ChannelType::UINT8:
        return OIIO::TypeUInt8;
    case ChannelType::UINT32:
        return OIIO::TypeUInt32;
    case ChannelType::FLOAT:
        break;
    }
    return OIIO::TypeFloat;
}

/// The type of all channels, or UNKNOWN: each has its own.
OIIO::TypeDesc common_type(const std::vector<ImageChannel>& channels) {
    const ChannelType first = channels.front().type;
    const bool all = std::all_of(channels.begin(), channels.end(),
                                 [&](const ImageChannel& channel) { return channel.type == first; });
    return all ? type_of(first) : OIIO::TypeUnknown;
}

OIIO::ImageSpec spec_of(const ImageLayout& layout) {
    const OIIO::TypeDesc type = common_type(layout.channels);
    const bool is_mixed = type == OIIO::TypeUnknown;
    // No channels yet: of four or more OpenImageIO would take the fourth for alpha.
    OIIO::ImageSpec spec(layout.width, layout.height, 0, is_mixed ? OIIO::TypeFloat : type);
    for (const ImageChannel& channel : layout.channels) {
        spec.channelnames.push_back(channel.name);
        if (is_mixed)
            spec.channelformats.push_back(type_of(channel.type));
    }
    spec.nchannels = static_cast<int>(spec.channelnames.size());
    if (layout.unassociated_alpha) {
        spec.alpha_channel = spec.nchannels - 1;
        spec.attribute("oiio:UnassociatedAlpha", 1);
    }
    spec.x = layout.x;
    spec.y = layout.y;
    spec.full_width = layout.full_width;
    spec.full_height = layout.full_height;
    for (const auto& [name, value] : layout.attributes)
        spec.attribute(name, value);
    return spec;
}

} // namespace

size_t OutputProxy::read(void* bytes, size_t count) {
    const size_t done = pread(bytes, count, m_pos);
    m_pos += static_cast<std::int64_t>(done);
    return done;
}

size_t OutputProxy::write(const void* bytes, size_t count) {
    m_pos += static_cast<std::int64_t>(pwrite(bytes, count, m_pos));
    return count;
}

size_t OutputProxy::pread(void* bytes, size_t count, std::int64_t position) {
    return file_.read_at(bytes, count, position);
}

size_t OutputProxy::pwrite(const void* bytes, size_t count, std::int64_t position) {
    file_.write_at(bytes, count, position);
    return count;
}

OiioEncoder::OiioEncoder(const std::string& path, const std::string& format, const ImageLayout& layout,
                         OutputFile& file)
    : path_(path), top_(layout.y), type_(common_type(layout.channels)), proxy_(path, file),
      encoder_(OIIO::ImageOutput::create(format)) {
    if (!encoder_)
        throw SceneError(path_, 0, "cannot write this kind of image: " + OIIO::geterror());
    // Some encoders look at the extension of the name, which the standard output does not have.
    check(encoder_->set_ioproxy(&proxy_) && encoder_->open("picture." + format, spec_of(layout)));
}

void OiioEncoder::write_rows(int first, int count, const void* pixels) {
    check(encoder_->write_scanlines(top_ + first, top_ + first + count, 0, type_, pixels));
}

void OiioEncoder::finish() {
    check(encoder_->close());
}

void OiioEncoder::check(bool done) const {
    if (!done)
        throw SceneError(path_, 0, "cannot write the image: " + encoder_->geterror());
}

} // namespace clrt
