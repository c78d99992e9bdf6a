// SPDX-License-Identifier: Apache-2.0
#include "render/scene_buffers.h"

#include "render/scene_heaps.h"

namespace clrt {

namespace {

/// An array of the host.
struct HostArray {
    const char* name;
    const void* data;
    size_t bytes;
};

/// A row of kernels/shared/scene_arrays.h whose elements the kernels read as `Element`.
template <class Element, class T>
HostArray host_array(const char* name, const std::vector<T>& values) {
    static_assert(sizeof(Element) % sizeof(T) == 0, "host and kernels take the array for different things");
    return {name, values.data(), values.size() * sizeof(T)};
}

/// All arrays, in the order of ArrayPlaces.
std::vector<HostArray> host_arrays(const Scene& scene, const Bvh& bvh, const PathTables& paths) {
#define BVH_ARRAY(type, name, member) host_array<type>(#name, bvh.member),
#define SCENE_ARRAY(type, name, member) host_array<type>(#name, scene.member),
#define PATH_ARRAY(type, name, member) host_array<type>(#name, paths.member),
    return {BVH_ARRAYS(BVH_ARRAY) SCENE_ARRAYS(SCENE_ARRAY) PATH_ARRAYS(PATH_ARRAY)};
#undef BVH_ARRAY
#undef SCENE_ARRAY
#undef PATH_ARRAY
}

std::string heap_argument(size_t heap) {
    return "scene_heap" + std::to_string(heap);
}

/// Uploads the arrays that lie in a heap, and `head` in front of those of heap 0.
cl::Buffer upload_heap(const Device& device, u32 heap, const std::vector<HostArray>& arrays,
                       const HeapPlan& plan, const BufferPiece& head) {
    std::string names;
    std::vector<BufferPiece> pieces;
    if (heap == 0)
        pieces.push_back(head);
    for (size_t i = 0; i < arrays.size(); ++i)
        if (plan.places[i].heap == heap && arrays[i].bytes > 0) {
            names += (names.empty() ? "" : ", ") + std::string(arrays[i].name);
            pieces.push_back(
                {size_t(plan.places[i].first) * SCENE_ALIGNMENT, arrays[i].data, arrays[i].bytes});
        }
    return upload_pieces(device, names.c_str(), pieces);
}

} // namespace

SceneBuffers upload_scene(const Device& device, const Scene& scene, const Bvh& bvh, const PathTables& paths) {
    const std::vector<HostArray> arrays = host_arrays(scene, bvh, paths);
    std::vector<size_t> sizes;
    for (const HostArray& array : arrays)
        sizes.push_back(array.bytes);
    const HeapPlan plan = place_arrays(sizes, sizeof(ArrayPlaces));
    const BufferPiece head = {0, plan.places.data(), plan.places.size() * sizeof(ArrayPlace)};
    SceneBuffers result;
    for (u32 heap = 0; heap < SCENE_HEAPS; ++heap)
        result.heaps[heap] = upload_heap(device, heap, arrays, plan, head);
    return result;
}

bool takes_scene(const Kernel& kernel) {
    return kernel.has(heap_argument(0));
}

void bind_scene(const SceneBuffers& scene, Kernel& kernel) {
    for (size_t heap = 0; heap < SCENE_HEAPS; ++heap)
        kernel.set(heap_argument(heap), scene.heaps[heap]);
}

} // namespace clrt
