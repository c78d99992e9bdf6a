// SPDX-License-Identifier: Apache-2.0
// Rows of pixels -> OpenImageIO's encoder -> a file or the standard output.
#include "output/image_stream.h"

#include "error.h"
#include "output/image.h"
#include "output/standard_streams.h"

namespace clrt {

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

ImageStream::ImageStream(const std::string& path, const OIIO::ImageSpec& spec)
    : path_(path), top_(spec.y), file_(open_output(path)), proxy_(path, *file_),
      encoder_(OIIO::ImageOutput::create(output_format(path))) {
    if (!encoder_)
        throw SceneError(path_, 0, "cannot write this kind of image: " + OIIO::geterror());
    // Some encoders look at the extension of the name.
    const std::string name = is_standard_output(path) ? "picture." + output_format(path) : path;
    check(encoder_->set_ioproxy(&proxy_) && encoder_->open(name, spec));
}

void ImageStream::write_rows(int first, int count, OIIO::TypeDesc type, const void* pixels) {
    check(encoder_->write_scanlines(top_ + first, top_ + first + count, 0, type, pixels));
}

void ImageStream::finish() {
    check(encoder_->close());
    file_->commit();
}

void ImageStream::check(bool done) const {
    if (!done)
        throw SceneError(path_, 0, "cannot write the image: " + encoder_->geterror());
}

} // namespace clrt
