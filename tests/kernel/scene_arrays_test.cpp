// SPDX-License-Identifier: Apache-2.0
// Kernels find every array of a scene where the upload has put it.
#include "probes/kernel_probe.h"
#include "render/scene_buffers.h"
#include "support/test_device.h"

#include <cstring>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace clrt;

namespace {

/// Reads the words of the array of a number, in the order of the rows.
const char* const READ_ARRAY = R"(
CLRT_KERNEL void read_array(SCENE_PARAMS, const u32 array, const u32 count, global u32* restrict out)
{
    const Scene scene = SCENE_MAKE;
    const u32 i = (u32)get_global_id(0);
    u32 row = 0u;
#define READ(type, name, member)                                                                                        \
    if (i < count && row++ == array)                                                                                    \
        out[i] = ((global const u32*)scene.name)[i];
    BVH_ARRAYS(READ)
    SCENE_ARRAYS(READ)
    PATH_ARRAYS(READ)
}
)";

KernelProbe& probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"geometry/scene.h"});
        made.add_text(READ_ARRAY);
        return made;
    }();
    return instance;
}

/// Words that differ from those of other arrays and places.
class Words {
public:
    template <class T>
    void fill(std::vector<T>& values, size_t count) {
        values.resize(count);
        std::vector<u32> words(count * sizeof(T) / sizeof(u32));
        for (u32& word : words)
            word = ++last_;
        std::memcpy(static_cast<void*>(values.data()), words.data(), count * sizeof(T));
        arrays_.push_back(words);
    }
    const std::vector<std::vector<u32>>& arrays() const { return arrays_; }

private:
    u32 last_ = 0;
    std::vector<std::vector<u32>> arrays_;
};

/// A scene, a tree and tables of paths, of arrays of different lengths, and their words.
struct Filled {
    Scene scene;
    Bvh bvh;
    PathTables paths;
    Words words;
    explicit Filled(size_t first_count) {
        size_t count = first_count;
#define FILL_BVH(type, name, member) words.fill(bvh.member, 1 + (count = count * 7 % 97));
#define FILL_PATHS(type, name, member) words.fill(paths.member, 1 + (count = count * 7 % 97));
#define FILL_SCENE(type, name, member) words.fill(scene.member, 1 + (count = count * 7 % 97));
        BVH_ARRAYS(FILL_BVH)
        SCENE_ARRAYS(FILL_SCENE)
        PATH_ARRAYS(FILL_PATHS)
    }
};

} // namespace

TEST(SceneArrays, KernelsFindEveryWordOfEveryArray) {
    for (const size_t first_count : {1, 5, 30}) {
        const Filled filled(first_count);
        const SceneBuffers buffers = upload_scene(test_device(), filled.scene, filled.bvh, filled.paths);
        for (size_t array = 0; array < filled.words.arrays().size(); ++array) {
            const std::vector<u32>& words = filled.words.arrays()[array];
            const cl::Buffer out = create_buffer(test_device(), "out", words.size() * sizeof(u32));
            Kernel kernel = probe().kernel("read_array");
            bind_scene(buffers, kernel);
            kernel.set("array", u32(array));
            kernel.set("count", u32(words.size()));
            kernel.set("out", out);
            probe().launch(kernel, words.size());
            EXPECT_EQ(probe().read<u32>(out, words.size()), words) << "array " << array;
        }
    }
}

TEST(SceneArrays, ASceneWithoutAnythingIsBound) {
    Kernel kernel = probe().kernel("read_array");
    EXPECT_TRUE(takes_scene(kernel));
    EXPECT_NO_THROW(bind_scene(upload_scene(test_device(), Scene(), Bvh()), kernel));
}

TEST(SceneArrays, AnArrayThatDoesNotFitIsNamed) {
    Device small = test_device();
    small.info.largest_buffer_bytes = size_t{1} << 20;
    Scene scene;
    scene.texel_words.resize(size_t{1} << 18);
    EXPECT_NO_THROW(upload_scene(small, scene, Bvh()));
    scene.texel_words.push_back(0);
    try {
        upload_scene(small, scene, Bvh());
        FAIL() << "no error";
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("The buffer \"texel_words\" needs 1.0 MiB"));
    }
}
