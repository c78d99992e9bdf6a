// SPDX-License-Identifier: Apache-2.0
// The probe itself: types, statement lists, kernels of one's own, and refusals of wrong use.
#include "probes/kernel_probe.h"
#include "support/test_device.h"

#include <gtest/gtest.h>
#include <numeric>
#include <stdexcept>

using namespace clrt;

namespace {

const KernelFiles FILES = {{"shared/types.h", embedded_kernel_files().at("shared/types.h")},
                           {"numerics/device.h", embedded_kernel_files().at("numerics/device.h")},
                           {"half.h",
                            "#include \"shared/types.h\"\n"
                            "float half_of(float x) { return x * 0.5f; }\n"
                            "float2 sum_and_product(float x, float y) { return (float2)(x + y, x * y); }\n"}};

KernelProbe make_probe() {
    return KernelProbe(test_device(), {"half.h"}, {Precision::SINGLE, {"OFFSET=3u"}}, FILES);
}

KernelProbe& probe() {
    static KernelProbe instance = [] {
        KernelProbe made = make_probe();
        made.add<float(float)>("half", "half_of(a)");
        made.add<u32(u32, i32)>("offset", "a + (u32)b + OFFSET");
        made.add<vec4(vec4, float)>("scale", "a * b");
        made.add<float(float, float)>("statements",
                                      "const float2 both = sum_and_product(a, b); out = both.x - both.y;");
        made.add<u32()>("square", "i * i");
        made.add<i32(float)>("rounded", "convert_int_rte(a)");
        made.add_text(
            "__kernel void reverse(const u32 count, __global const float *in, __global float *out) {\n"
            "    const size_t i = get_global_id(0);\n"
            "    if (i < count)\n        out[i] = in[count - 1 - i];\n}\n");
        return made;
    }();
    return instance;
}

} // namespace

TEST(KernelProbe, ExpressionsOfEachTypeAreEvaluatedElementByElement) {
    std::vector<float> numbers(1000);
    std::iota(numbers.begin(), numbers.end(), 0.0f);
    const std::vector<float> halves = probe().run<float>("half", numbers);
    ASSERT_EQ(halves.size(), 1000u);
    for (size_t i = 0; i < halves.size(); ++i)
        ASSERT_EQ(halves[i], static_cast<float>(i) / 2);

    EXPECT_EQ(probe().run<u32>("offset", std::vector<u32>{10, 4000000000u}, std::vector<i32>{-1, 1}),
              (std::vector<u32>{12, 4000000004u}));
    EXPECT_EQ(probe().run<i32>("rounded", std::vector<float>{-1.6f, 2.5f}), (std::vector<i32>{-2, 2}));
    const vec4 scaled =
        probe().run<vec4>("scale", std::vector<vec4>{{1, 2, 3, 4}}, std::vector<float>{10}).at(0);
    EXPECT_EQ(scaled.x, 10);
    EXPECT_EQ(scaled.y, 20);
    EXPECT_EQ(scaled.z, 30);
    EXPECT_EQ(scaled.w, 40);
}

TEST(KernelProbe, StatementListsAssignTheOutput) {
    EXPECT_EQ(probe().run<float>("statements", std::vector<float>{2, 5}, std::vector<float>{3, 7}),
              (std::vector<float>{-1, -23}));
}

TEST(KernelProbe, ExpressionsMayReadTheIndexAlone) {
    EXPECT_EQ(probe().run_count<u32>("square", 5), (std::vector<u32>{0, 1, 4, 9, 16}));
    EXPECT_TRUE(probe().run_count<u32>("square", 0).empty());
}

TEST(KernelProbe, KernelsOfTheTextRunWithBuffersByName) {
    Kernel kernel = probe().kernel("reverse");
    const cl::Buffer out = create_buffer(test_device(), "out", 3 * sizeof(float));
    kernel.set("in", probe().upload(std::vector<float>{1, 2, 3}));
    kernel.set("out", out);
    kernel.set("count", u32{3});
    probe().launch(kernel, 3);
    EXPECT_EQ(probe().read<float>(out, 3), (std::vector<float>{3, 2, 1}));
}

TEST(KernelProbe, DoublePrecisionIsDouble) {
    if (!test_device().info.fp64) {
        KernelProbe single_only(test_device(), {"half.h"}, {Precision::DOUBLE, {}}, FILES);
        EXPECT_THROW(single_only.program(), DeviceError);
        return;
    }
    KernelProbe wide(test_device(), {"half.h"}, {Precision::DOUBLE, {}}, FILES);
    wide.add_text("#pragma OPENCL EXTENSION cl_khr_fp64 : enable");
    wide.add<double(float)>("third", "a / 3.0");
    EXPECT_EQ(wide.run<double>("third", std::vector<float>{1}), (std::vector<double>{1.0 / 3}));
}

TEST(KernelProbe, WrongUseIsRefused) {
    EXPECT_THROW(probe().run<float>("absent", std::vector<float>{1}), std::logic_error);
    EXPECT_THROW(probe().run<u32>("half", std::vector<float>{1}), std::logic_error);
    EXPECT_THROW(probe().run<float>("half", std::vector<u32>{1}), std::logic_error);
    EXPECT_THROW(probe().run<float>("statements", std::vector<float>{1, 2}, std::vector<float>{1}),
                 std::logic_error);
    probe().program();
    EXPECT_THROW(probe().add<float(float)>("late", "a"), std::logic_error);
    KernelProbe fresh = make_probe();
    fresh.add<float(float)>("twice", "a");
    EXPECT_THROW(fresh.add<float(float)>("twice", "a"), std::logic_error);
}

TEST(KernelProbe, CompilerWarningsAreErrors) {
    KernelProbe warned = make_probe();
    warned.add_text("#warning \"a warning\"");
    warned.add<float(float)>("same", "a");
    EXPECT_THROW(warned.program(), KernelBuildError);
}
