// SPDX-License-Identifier: Apache-2.0
#include "denoise/feature_filter.h"

#include "denoise/smooth.h"
#include "device/buffer_values.h"
#include "device/kernel_source.h"
#include "kernels/shared/denoise_types.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace clrt {

namespace {

/// Standard deviations within which colours are alike, of the candidates, squared.
constexpr std::array NOISES = {0.5f, 8.0f};
/// Colours are compared after smoothing by this radius.
constexpr int GUIDE_RADIUS = 2;
/// A launch has this many work-items or fewer, so that no watchdog fires.
constexpr size_t LARGEST_LAUNCH = size_t(1) << 18;

/// Added to the share of the samples that hit something where a pixel is lit: it looks unlike all that are
/// not.
constexpr float APART = 8;

/// Rows of the regression (denoise_types.h).
std::vector<float> make_rows(const HalfPicture& half) {
    const size_t pixels = half.mean.size() / 3, width = size_t(half.width);
    std::vector<float> rows(DENOISE_ROW * pixels);
    for (size_t pixel = 0; pixel < pixels; ++pixel) {
        float* row = &rows[DENOISE_ROW * pixel];
        row[DENOISE_PLACE] = float(pixel % width) / DENOISE_RADIUS;
        row[DENOISE_PLACE + 1] = float(pixel / width) / DENOISE_RADIUS;
        std::copy_n(&half.albedo[3 * pixel], 3, row + DENOISE_ALBEDO);
        std::copy_n(&half.normal[3 * pixel], 3, row + DENOISE_NORMAL);
        row[DENOISE_SHARE] = half.share[pixel] + (half.lit[pixel] ? APART : 0);
        std::copy_n(&half.quarter[0][3 * pixel], 3, row + DENOISE_COLOURS);
        std::copy_n(&half.quarter[1][3 * pixel], 3, row + DENOISE_COLOURS + 3);
    }
    return rows;
}

/// Distance of two pixels' positions; infinite where one of them has none.
double distance(const HalfPicture& half, size_t a, size_t b) {
    if (!(half.share[a] > 0 && half.share[b] > 0))
        return INFINITY;
    double square = 0;
    for (size_t c = 0; c < 3; ++c) {
        const double d = double(half.position[3 * a + c]) - double(half.position[3 * b + c]);
        square += d * d;
    }
    return std::sqrt(square);
}

/// Positions, and 1 over the distance to the nearest of the four pixels around.
std::vector<vec4> make_places(const HalfPicture& half) {
    const size_t width = size_t(half.width), height = size_t(half.height);
    std::vector<vec4> places(width * height);
    for (size_t y = 0; y < height; ++y)
        for (size_t x = 0; x < width; ++x) {
            const size_t pixel = y * width + x;
            double nearest = INFINITY;
            for (const size_t other : {x > 0 ? pixel - 1 : pixel, x + 1 < width ? pixel + 1 : pixel,
                                       y > 0 ? pixel - width : pixel, y + 1 < height ? pixel + width : pixel})
                if (other != pixel)
                    nearest = std::min(nearest, distance(half, pixel, other));
            const float* p = &half.position[3 * pixel];
            places[pixel] = {p[0], p[1], p[2], nearest > 1e-20 ? float(1 / nearest) : 0.0f};
        }
    return places;
}

/// A quarter's colours, smoothed, with the variance that is left, summed over channels.
std::vector<vec4> make_guide(const HalfPicture& half, size_t quarter) {
    const size_t pixels = half.mean.size() / 3;
    Pixels variance(pixels, 0.0f);
    for (size_t i = 0; i < 3 * pixels; ++i) {
        const float difference = half.quarter[0][i] - half.quarter[1][i];
        variance[i / 3] += 0.5f * difference * difference;
    }
    variance = smooth_alike(variance, half.lit, half.width, half.height, 1, 2 * GUIDE_RADIUS);
    const Pixels colour =
        smooth_alike(half.quarter[quarter], half.lit, half.width, half.height, 3, GUIDE_RADIUS);
    const float left = float(binomial_variance(GUIDE_RADIUS));
    std::vector<vec4> guide(pixels);
    for (size_t pixel = 0; pixel < pixels; ++pixel)
        guide[pixel] = {colour[3 * pixel], colour[3 * pixel + 1], colour[3 * pixel + 2],
                        left * variance[pixel]};
    return guide;
}

ProgramRequest filter_program(const DenoiseRequest& request) {
    ProgramRequest program;
    program.name = DENOISE_PROGRAM;
    program.source = expand_kernel_source(kernel_files(request.kernels_folder), "denoise/filter.cl");
    program.dump_folder = request.dump_folder;
    program.cache = request.cache;
    return program;
}

size_t over_stride(int pixels) {
    return (size_t(pixels) + DENOISE_STRIDE - 1) / DENOISE_STRIDE;
}

} // namespace

FeatureFilter::FeatureFilter(const Device& device, const DenoiseRequest& request)
    : device_(device), program_(build_program(device, filter_program(request))),
      fit_(program_, "denoise_fit"), apply_(program_, "denoise_apply") {}

/// Launches whole lines of work-items.
void FeatureFilter::run(Kernel& kernel, size_t columns, size_t lines) {
    const size_t at_once = std::max<size_t>(LARGEST_LAUNCH / columns, 1);
    check_opencl("denoising", [&] {
        for (size_t line = 0; line < lines; line += at_once) {
            device_.queue.enqueueNDRangeKernel(kernel.handle(), cl::NDRange(0, line),
                                               cl::NDRange(columns, std::min(at_once, lines - line)));
            device_.queue.finish();
        }
    });
}

DenoiseCandidate FeatureFilter::candidate(const HalfPicture& half, float noise) {
    const size_t pixels = half.mean.size() / 3;
    const size_t columns = over_stride(half.width), lines = over_stride(half.height);
    const cl::Buffer models =
        create_buffer(device_, "denoise_models", DENOISE_MODEL * columns * lines * sizeof(float));
    const cl::Buffer colours = create_buffer(device_, "denoise_colours", pixels * sizeof(vec4));
    DenoiseCandidate result;
    for (size_t quarter = 0; quarter < 2; ++quarter) {
        const cl::Buffer guide = upload_buffer(device_, "denoise_guide", make_guide(half, 1 - quarter));
        for (Kernel* kernel : {&fit_, &apply_}) {
            kernel->set("noise", noise);
            kernel->set("quarter", u32(quarter));
            kernel->set("guide", guide);
            kernel->set("models", models);
        }
        apply_.set("colours", colours);
        run(fit_, columns, lines);
        run(apply_, size_t(half.width), size_t(half.height));
        const auto values = read_values<vec4>(device_, "reading the denoised picture", colours, 0, pixels);
        for (const vec4& value : values)
            result.quarter[quarter].insert(result.quarter[quarter].end(), {value.x, value.y, value.z});
    }
    result.half.resize(3 * pixels);
    for (size_t i = 0; i < 3 * pixels; ++i)
        result.half[i] = 0.5f * (result.quarter[0][i] + result.quarter[1][i]);
    return result;
}

std::vector<DenoiseCandidate> FeatureFilter::candidates(const HalfPicture& half) {
    const cl::Buffer rows = upload_buffer(device_, "denoise_rows", make_rows(half));
    const cl::Buffer places = upload_buffer(device_, "denoise_places", make_places(half));
    for (Kernel* kernel : {&fit_, &apply_}) {
        kernel->set("width", u32(half.width));
        kernel->set("height", u32(half.height));
        kernel->set("rows", rows);
        kernel->set("places", places);
    }
    std::vector<DenoiseCandidate> result;
    for (const float noise : NOISES)
        result.push_back(candidate(half, noise));
    return result;
}

} // namespace clrt
