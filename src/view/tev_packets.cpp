// SPDX-License-Identifier: Apache-2.0
#include "view/tev_packets.h"
#include "float_bits.h"

#include <utility>

namespace clrt {

namespace {

constexpr char CREATE_IMAGE = 4, UPDATE_IMAGE_V3 = 6;

/// A packet while it is filled.
class TevPacket {
public:
    explicit TevPacket(char type) : bytes_(sizeof(std::uint32_t), '\0') { bytes_ += type; }

    void boolean(bool value) { bytes_ += char(value); }
    void text(const std::string& value) { bytes_.append(value.c_str(), value.size() + 1); }
    void texts(const std::vector<std::string>& values) {
        whole<std::int32_t>(std::int32_t(values.size()));
        for (const std::string& value : values)
            text(value);
    }
    /// A whole number of so many bytes.
    template <class T>
    void whole(T value) {
        for (size_t i = 0; i < sizeof value; ++i)
            bytes_ += char(std::uint64_t(value) >> (8 * i) & 0xff);
    }
    void floats(const std::vector<float>& values) {
        bytes_.reserve(bytes_.size() + sizeof(float) * values.size());
        for (const float value : values)
            whole(float_bits(value));
    }
    /// Its bytes, the length now known.
    std::string finish() {
        const size_t length = bytes_.size();
        for (size_t i = 0; i < sizeof(std::uint32_t); ++i)
            bytes_[i] = char(length >> (8 * i) & 0xff);
        return std::move(bytes_);
    }

private:
    std::string bytes_;
};

} // namespace

std::string tev_create(const TevImage& image) {
    TevPacket packet(CREATE_IMAGE);
    packet.boolean(true);
    packet.text(image.name);
    packet.whole<std::int32_t>(image.width);
    packet.whole<std::int32_t>(image.height);
    packet.texts(image.channels);
    return packet.finish();
}

std::string tev_update(const TevImage& image, int y, int rows, const std::vector<float>& values) {
    TevPacket packet(UPDATE_IMAGE_V3);
    packet.boolean(false);
    packet.text(image.name);
    packet.texts(image.channels);
    for (const int number : {0, y, image.width, rows})
        packet.whole<std::int32_t>(number);
    const size_t count = image.channels.size();
    for (size_t channel = 0; channel < count; ++channel)
        packet.whole<std::int64_t>(std::int64_t(channel)); // where it starts
    for (size_t channel = 0; channel < count; ++channel)
        packet.whole<std::int64_t>(std::int64_t(count)); // from pixel to pixel
    packet.floats(values);
    return packet.finish();
}

} // namespace clrt
