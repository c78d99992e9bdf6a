// SPDX-License-Identifier: Apache-2.0
// A device that fails in the middle, for LD_PRELOAD: of the command queues of a process, those that
// FAILING_QUEUES names ("2", "12": by their order) launch FAILING_AFTER render kernels, and no more.
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <mutex>
#include <vector>

namespace {

/// The queues so far and how many render kernels each has launched.
struct Queue {
    cl_command_queue queue;
    int launches;
};
std::mutex mutex;
std::vector<Queue> queues;

template <class Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

bool is_render(cl_kernel kernel) {
    char name[256] = "";
    clGetKernelInfo(kernel, CL_KERNEL_FUNCTION_NAME, sizeof name, name, nullptr);
    return std::strncmp(name, "render_", 7) == 0;
}

/// Counts a launch; true if it is to fail.
bool fails(cl_command_queue queue) {
    const char* const which = std::getenv("FAILING_QUEUES");
    const char* const after = std::getenv("FAILING_AFTER");
    const std::lock_guard lock(mutex);
    for (size_t i = 0; i < queues.size(); ++i)
        if (queues[i].queue == queue)
            return which && after && std::strchr(which, char('1' + i)) &&
                   ++queues[i].launches > std::atoi(after);
    return false;
}

} // namespace

extern "C" {

cl_command_queue clCreateCommandQueue(cl_context context, cl_device_id device,
                                      cl_command_queue_properties properties, cl_int* error) {
    const auto create = next<decltype(clCreateCommandQueue)>("clCreateCommandQueue");
    const cl_command_queue queue = create(context, device, properties, error);
    const std::lock_guard lock(mutex);
    queues.push_back({queue, 0});
    return queue;
}

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                              const size_t* offset, const size_t* global, const size_t* local, cl_uint waits,
                              const cl_event* wait, cl_event* event) {
    if (is_render(kernel) && fails(queue))
        return CL_OUT_OF_RESOURCES;
    const auto enqueue = next<decltype(clEnqueueNDRangeKernel)>("clEnqueueNDRangeKernel");
    return enqueue(queue, kernel, dimensions, offset, global, local, waits, wait, event);
}
}
