// SPDX-License-Identifier: Apache-2.0
// Device buffers, checked against what the device can hold before they are made.
#include "device/buffer_size.h"
#include "device/device.h"
#include "device/opencl_error.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <sys/mman.h>

namespace clrt {

namespace {

/// Size of the stand-in for an empty buffer: one element of the largest basic type, a float16.
constexpr size_t EMPTY_BUFFER_BYTES = 64;
/// New buffers are zeroed in pieces of this size.
constexpr size_t ZERO_PIECE_BYTES = size_t(1) << 22;

/// Size and alignment of a huge page on x86-64 and AArch64.
constexpr size_t HUGE_PAGE_BYTES = size_t(1) << 21;
/// Smaller buffers fit the processor's table of ordinary pages.
constexpr size_t HUGE_PAGES_FROM_BYTES = 2 * HUGE_PAGE_BYTES;

/// What is uploaded is the scene's, what is made empty the picture's.
const char* const SMALLER_SCENE = "a smaller scene or smaller textures";
const char* const SMALLER_PICTURE = "a smaller --size (--crop renders a large picture in parts)";

double mebibytes(size_t bytes) {
    return static_cast<double>(bytes) / (1 << 20);
}

/// Throws when `bytes` exceed the device's largest allocation or its memory; `remedy` ends the message.
void check_size(const DeviceInfo& device, const char* name, size_t bytes, const char* remedy) {
    const size_t possible = std::min(device.largest_buffer_bytes, device.memory_bytes);
    if (bytes > possible)
        throw DeviceError(
            fmt::format("The buffer \"{}\" needs {:.1f} MiB, but device {}:{} ({}) allows {:.1f} MiB for "
                        "one buffer and has {:.1f} MiB of memory. Choose {} or a device with more memory "
                        "(--list-devices).",
                        name, mebibytes(bytes), device.platform_index, device.device_index, device.name,
                        mebibytes(device.largest_buffer_bytes), mebibytes(device.memory_bytes), remedy));
}

std::string making(const char* name, size_t bytes) {
    return fmt::format("making the buffer \"{}\" of {:.1f} MiB", name, mebibytes(bytes));
}

void CL_CALLBACK free_memory(cl_mem, void* memory) {
    std::free(memory);
}

/// A buffer on a CPU whose memory we allocate, on huge pages where the system has them: rays visit a large
/// tree in no order, and with ordinary pages most visits would first look up the page. Null if the memory is
/// not to be had.
cl::Buffer upload_on_huge_pages(const Device& device, const char* name,
                                const std::vector<BufferPiece>& pieces, size_t bytes) {
    const size_t whole_pages = (bytes + HUGE_PAGE_BYTES - 1) / HUGE_PAGE_BYTES * HUGE_PAGE_BYTES;
    std::unique_ptr<void, decltype(&std::free)> memory(std::aligned_alloc(HUGE_PAGE_BYTES, whole_pages),
                                                       &std::free);
    if (!memory)
        return {};
#ifdef MADV_HUGEPAGE
    madvise(memory.get(), whole_pages, MADV_HUGEPAGE); // a wish; without it the buffer is only slower
#endif
    for (const BufferPiece& piece : pieces)
        std::memcpy(static_cast<char*>(memory.get()) + piece.offset, piece.data, piece.bytes);
    return check_opencl(making(name, bytes), [&] {
        cl::Buffer buffer(device.context, CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, bytes, memory.get());
        buffer.setDestructorCallback(free_memory, memory.get());
        memory.release();
        return buffer;
    });
}

} // namespace

cl::Buffer upload_pieces(const Device& device, const char* name, const std::vector<BufferPiece>& pieces) {
    if (pieces.empty())
        return create_buffer(device, name, 0);
    size_t bytes = 0;
    for (const BufferPiece& piece : pieces)
        bytes = std::max(bytes, piece.offset + piece.bytes);
    check_size(device.info, name, bytes, SMALLER_SCENE);
    if (device.info.type == "CPU" && bytes >= HUGE_PAGES_FROM_BYTES) {
        const cl::Buffer buffer = upload_on_huge_pages(device, name, pieces, bytes);
        if (buffer())
            return buffer;
    }
    return check_opencl(making(name, bytes), [&] {
        cl::Buffer buffer(device.context, CL_MEM_READ_ONLY, bytes);
        for (const BufferPiece& piece : pieces)
            device.queue.enqueueWriteBuffer(buffer, CL_TRUE, piece.offset, piece.bytes, piece.data);
        return buffer;
    });
}

void check_picture_buffer(const DeviceInfo& device, const char* name, size_t bytes) {
    check_size(device, name, bytes, SMALLER_PICTURE);
}

cl::Buffer create_buffer(const Device& device, const char* name, size_t bytes) {
    const size_t size = bytes == 0 ? EMPTY_BUFFER_BYTES : bytes;
    check_picture_buffer(device.info, name, size);
    return check_opencl(making(name, size), [&] {
        cl::Buffer buffer(device.context, CL_MEM_READ_WRITE, size);
        // Written in pieces, not by enqueueFillBuffer: Oclgrind takes filled memory for uninitialised.
        const std::vector<char> zeros(std::min(size, ZERO_PIECE_BYTES), 0);
        for (size_t start = 0; start < size; start += zeros.size())
            device.queue.enqueueWriteBuffer(buffer, CL_TRUE, start, std::min(zeros.size(), size - start),
                                            zeros.data());
        return buffer;
    });
}

} // namespace clrt
