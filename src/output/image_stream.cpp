// SPDX-License-Identifier: Apache-2.0
#include "output/image_stream.h"

#include "output/image.h"
#include "output/standard_streams.h"

namespace clrt {

ImageStream::ImageStream(const std::string& path, const ImageLayout& layout)
    : file_(open_output(path)), encoder_(image_library().encode(path, output_format(path), layout, *file_)) {}

void ImageStream::finish() {
    encoder_->finish();
    file_->commit();
}

} // namespace clrt
