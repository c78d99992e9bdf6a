// SPDX-License-Identifier: Apache-2.0
// A device that fails in the middle, for LD_PRELOAD: of the command queues of a process, those that
// FAILING_QUEUES names ("2", "12": by their order) launch FAILING_AFTER kernels of integrators, and no more.
// With FAILING_HANGS the next one never ends, nor does anything that is asked of the queue later, or
// unloading.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <mutex>
#include <unistd.h>
#include <vector>

namespace {

/// The queues so far and how many render kernels each has launched.
struct Queue {
    cl_command_queue queue;
    int launches;
    bool hangs;
};
std::mutex mutex;
std::vector<Queue> queues;

template <class Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// Does not return.
[[noreturn]] void hang() {
    for (;;)
        pause();
}

/// A driver may wait for its threads at the end of the process.
__attribute__((destructor)) void unload() {
    const std::lock_guard lock(mutex);
    for (const Queue& queue : queues)
        if (queue.hangs)
            hang();
}

bool is_render(cl_kernel kernel) {
    char name[256] = "";
    clGetKernelInfo(kernel, CL_KERNEL_FUNCTION_NAME, sizeof name, name, nullptr);
    return std::strncmp(name, "render_", 7) == 0 && std::strcmp(name, "render_aov") != 0;
}

/// The record of a queue. The mutex is held.
Queue* find(cl_command_queue queue) {
    const auto found =
        std::find_if(queues.begin(), queues.end(), [&](const Queue& each) { return each.queue == queue; });
    return found == queues.end() ? nullptr : &*found;
}

/// Counts a launch; true if it is to fail. One that is to hang does.
bool fails(cl_command_queue queue) {
    const char* const which = std::getenv("FAILING_QUEUES");
    const char* const after = std::getenv("FAILING_AFTER");
    {
        const std::lock_guard lock(mutex);
        Queue* const found = find(queue);
        if (!found || !which || !after || !std::strchr(which, char('1' + (found - queues.data()))) ||
            ++found->launches <= std::atoi(after))
            return false;
        if (!std::getenv("FAILING_HANGS"))
            return true;
        found->hangs = true;
    }
    hang();
}

/// Waits for a queue that hangs as long as it does.
void wait_for(cl_command_queue queue) {
    {
        const std::lock_guard lock(mutex);
        const Queue* const found = find(queue);
        if (!found || !found->hangs)
            return;
    }
    hang();
}

} // namespace

extern "C" {

cl_command_queue clCreateCommandQueue(cl_context context, cl_device_id device,
                                      cl_command_queue_properties properties, cl_int* error) {
    const auto create = next<decltype(clCreateCommandQueue)>("clCreateCommandQueue");
    const cl_command_queue queue = create(context, device, properties, error);
    const std::lock_guard lock(mutex);
    queues.push_back({queue, 0, false});
    return queue;
}

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                              const size_t* offset, const size_t* global, const size_t* local, cl_uint waits,
                              const cl_event* wait, cl_event* event) {
    if (is_render(kernel) && fails(queue))
        return CL_OUT_OF_RESOURCES;
    wait_for(queue);
    const auto enqueue = next<decltype(clEnqueueNDRangeKernel)>("clEnqueueNDRangeKernel");
    return enqueue(queue, kernel, dimensions, offset, global, local, waits, wait, event);
}

cl_int clFinish(cl_command_queue queue) {
    wait_for(queue);
    return next<decltype(clFinish)>("clFinish")(queue);
}

cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset,
                           size_t size, void* data, cl_uint waits, const cl_event* wait, cl_event* event) {
    wait_for(queue);
    return next<decltype(clEnqueueReadBuffer)>("clEnqueueReadBuffer")(queue, buffer, blocking, offset, size,
                                                                      data, waits, wait, event);
}

cl_int clReleaseCommandQueue(cl_command_queue queue) {
    cl_uint references = 0;
    clGetCommandQueueInfo(queue, CL_QUEUE_REFERENCE_COUNT, sizeof references, &references, nullptr);
    if (references <= 1) // the last one waits
        wait_for(queue);
    return next<decltype(clReleaseCommandQueue)>("clReleaseCommandQueue")(queue);
}
}
