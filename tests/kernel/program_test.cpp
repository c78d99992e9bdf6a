// SPDX-License-Identifier: Apache-2.0
// Building programs on the device: options, dumps, messages, named arguments; and buffers.
#include "device/program.h"
#include "probes/kernel_probe.h"
#include "probes/scratch_folder.h"
#include "support/test_device.h"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iterator>
#include <numeric>
#include <regex>

using namespace clrt;
namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

namespace {

const char* const SOURCE = "#line 1 \"some/file.cl\"\n"
                           "__kernel void add(__global float *restrict sums, const float summand) {\n"
                           "    sums[get_global_id(0)] += summand;\n"
                           "}\n"
                           "__kernel void idle(void) {}\n";

ProgramRequest request_of(const std::string& source) {
    ProgramRequest request;
    request.name = "example";
    request.source = source;
    request.cache.use = Toggle::OFF;
    return request;
}

std::string read_text(const fs::path& path) {
    std::ifstream stream(path);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// The message of the KernelBuildError that a request ends with.
std::string refusal(const ProgramRequest& request) {
    try {
        build_program(test_device(), request);
        return "built";
    } catch (const KernelBuildError& error) {
        return error.what();
    }
}

class ProgramTest : public testing::Test {
protected:
    const ScratchFolder scratch_;
    const std::string folder_ = fs::path(scratch_.file("any")).parent_path().string();
};

} // namespace

TEST_F(ProgramTest, OptionsFollowThePrecision) {
    DeviceInfo device;
    EXPECT_EQ(build_options(device, Precision::SINGLE), "-cl-std=CL1.2 -cl-kernel-arg-info");
    EXPECT_THROW(build_options(device, Precision::DOUBLE), DeviceError);
    device.fp64 = device.correctly_rounded_division = true;
    EXPECT_EQ(build_options(device, Precision::SINGLE),
              "-cl-std=CL1.2 -cl-kernel-arg-info -cl-fp32-correctly-rounded-divide-sqrt");
    EXPECT_EQ(build_options(device, Precision::DOUBLE),
              "-cl-std=CL1.2 -cl-kernel-arg-info -cl-fp32-correctly-rounded-divide-sqrt -DREAL_IS_DOUBLE=1");
    EXPECT_EQ(build_options(device, Precision::FAST),
              "-cl-std=CL1.2 -cl-kernel-arg-info -cl-fast-relaxed-math "
              "-cl-denorms-are-zero -DREAL_IS_FAST=1");
}

TEST_F(ProgramTest, ArgumentsAreSetByName) {
    const Program program = build_program(test_device(), request_of(SOURCE));
    EXPECT_EQ(program.arguments, (KernelArguments{{"add", {{"sums", 0}, {"summand", 1}}}, {"idle", {}}}));
    EXPECT_GT(program.seconds, 0);
    EXPECT_FALSE(program.from_cache);

    const Device& device = test_device();
    const cl::Buffer sums = create_buffer(device, "sums", 3 * sizeof(float));
    Kernel kernel(program, "add");
    EXPECT_TRUE(kernel.has("summand"));
    EXPECT_FALSE(kernel.has("other"));
    kernel.set("summand", 2.5f);
    kernel.set("sums", sums);
    device.queue.enqueueNDRangeKernel(kernel.handle(), cl::NullRange, cl::NDRange(3), cl::NDRange(1));
    std::vector<float> got(3);
    device.queue.enqueueReadBuffer(sums, CL_TRUE, 0, 3 * sizeof(float), got.data());
    EXPECT_EQ(got, (std::vector<float>{2.5f, 2.5f, 2.5f}));
}

TEST_F(ProgramTest, BuffersLiveAsLongAsTheKernelThatUsesThem) {
    const Program program = build_program(test_device(), request_of(SOURCE));
    Kernel kernel(program, "add");
    cl::Buffer sums = create_buffer(test_device(), "sums", sizeof(float));
    const auto references = [&] { return sums.getInfo<CL_MEM_REFERENCE_COUNT>(); };
    const unsigned before = references();
    kernel.set("sums", sums);
    EXPECT_GT(references(), before);
    kernel.set("sums", create_buffer(test_device(), "other", sizeof(float)));
    EXPECT_EQ(references(), before);
}

TEST_F(ProgramTest, WrongNamesAndValuesNameKernelAndArgument) {
    const Program program = build_program(test_device(), request_of(SOURCE));
    EXPECT_THROW(Kernel(program, "absent"), DeviceError);
    Kernel kernel(program, "add");
    const auto message_of = [&](const char* argument, auto value) -> std::string {
        try {
            kernel.set(argument, value);
            return "set";
        } catch (const DeviceError& error) {
            return error.what();
        }
    };
    EXPECT_EQ(message_of("scale", 1.0f), "The kernel \"add\" has no argument \"scale\".");
    EXPECT_THAT(message_of("summand", 1.0), HasSubstr("clSetKernelArg failed with CL_INVALID_ARG_SIZE"));
    EXPECT_THAT(message_of("summand", 1.0), HasSubstr("argument summand of kernel add"));
}

TEST_F(ProgramTest, DefinesReachTheCompilerInAnyOrder) {
    ProgramRequest request =
        request_of("__kernel void give(__global int *out) { out[0] = FIRST * 10 + SECOND; }\n");
    request.dump_folder = folder_;
    request.defines = {"SECOND=2", "FIRST=1"};
    build_program(test_device(), request);
    EXPECT_THAT(read_text(folder_ + "/example.options.txt"), HasSubstr(" -DFIRST=1 -DSECOND=2\n"));
}

TEST_F(ProgramTest, TheDumpIsWhatWasCompiled) {
    ProgramRequest request = request_of(SOURCE);
    request.dump_folder = folder_ + "/new/folder";
    build_program(test_device(), request);
    EXPECT_EQ(read_text(request.dump_folder + "/example.cl"), SOURCE);
    EXPECT_EQ(read_text(request.dump_folder + "/example.options.txt"),
              build_options(test_device().info, Precision::SINGLE) + "\n");

    std::ofstream(folder_ + "/file") << "in the way";
    request.dump_folder = folder_ + "/file";
    EXPECT_THROW(build_program(test_device(), request), SceneError);
}

TEST_F(ProgramTest, ARefusedProgramShowsTheLogAndWhereItsSourceIs) {
    const std::string source =
        "#line 41 \"some/file.cl\"\n__kernel void broken(void) { undeclared_thing = 1; }\n";
    const std::string message = refusal(request_of(source));
    EXPECT_THAT(message, HasSubstr("program \"example\""));
    EXPECT_THAT(message, HasSubstr("undeclared_thing"));
    EXPECT_THAT(message, HasSubstr("-cl-std=CL1.2"));
    std::smatch path;
    ASSERT_TRUE(std::regex_search(message, path, std::regex("The source is in (.*/example\\.cl)")));
    EXPECT_EQ(read_text(path[1].str()),
              "// Built with: " + build_options(test_device().info, Precision::SINGLE) + "\n" + source);
    fs::remove_all(fs::path(path[1].str()).parent_path());

    ProgramRequest dumped = request_of(source);
    dumped.dump_folder = folder_;
    EXPECT_THAT(refusal(dumped), HasSubstr("The source is in " + folder_ + "/example.cl"));
    EXPECT_EQ(read_text(folder_ + "/example.cl"), source);
}

TEST_F(ProgramTest, ALongLogIsCut) {
    std::string source = "__kernel void broken(void) {\n";
    for (int i = 0; i < 100; ++i)
        source += "#warning number_" + std::to_string(i) + "\n";
    ProgramRequest request = request_of(source + "}\n#error end\n");
    request.dump_folder = folder_;
    const std::string message = refusal(request);
    EXPECT_THAT(message, HasSubstr("number_0"));
    EXPECT_THAT(message, Not(HasSubstr("number_99")));
    EXPECT_THAT(message, HasSubstr("the log goes on after these 60 lines"));
}

TEST_F(ProgramTest, BuffersHoldWhatWasUploadedAndZerosElse) {
    const Device& device = test_device();
    // A few words, and more than an ordinary page holds: the two ways to upload.
    for (const size_t count : {size_t{3}, size_t{3} << 19}) {
        std::vector<u32> words(count), got(count);
        std::iota(words.begin(), words.end(), 1u);
        const cl::Buffer uploaded = upload_buffer(device, "words", words);
        device.queue.enqueueReadBuffer(uploaded, CL_TRUE, 0, 4 * count, got.data());
        EXPECT_EQ(got, words);
    }

    for (const size_t bytes : {size_t{1}, size_t{7}, size_t{64}, size_t{1000003}}) {
        const cl::Buffer zeros = create_buffer(device, "zeros", bytes);
        std::vector<unsigned char> read(bytes, 1);
        device.queue.enqueueReadBuffer(zeros, CL_TRUE, 0, bytes, read.data());
        EXPECT_EQ(read, std::vector<unsigned char>(bytes, 0)) << bytes;
    }
    EXPECT_GT(upload_buffer(device, "empty", std::vector<u32>()).getInfo<CL_MEM_SIZE>(), 0u);
    EXPECT_GT(create_buffer(device, "empty", 0).getInfo<CL_MEM_SIZE>(), 0u);
}

TEST_F(ProgramTest, ABufferThatDoesNotFitIsNamedWithItsSizeAndTheLimit) {
    Device small = test_device();
    small.info.largest_buffer_bytes = size_t{3} << 20;
    small.info.memory_bytes = size_t{8} << 20;
    EXPECT_NO_THROW(create_buffer(small, "fits", size_t{3} << 20));
    const std::vector<char> too_big(size_t{5} << 20);
    for (const bool upload : {true, false})
        try {
            upload ? upload_buffer(small, "triangles", too_big)
                   : create_buffer(small, "triangles", too_big.size());
            FAIL() << "no error";
        } catch (const DeviceError& error) {
            for (const char* part : {"\"triangles\"", "5.0 MiB", "3.0 MiB", "8.0 MiB", "--list-devices"})
                EXPECT_THAT(error.what(), HasSubstr(part));
        }
}

TEST_F(ProgramTest, ErrorCodesHaveNames) {
    EXPECT_EQ(opencl_error_name(CL_OUT_OF_RESOURCES), "CL_OUT_OF_RESOURCES");
    EXPECT_EQ(opencl_error_name(CL_INVALID_KERNEL_ARGS), "CL_INVALID_KERNEL_ARGS");
    EXPECT_EQ(opencl_error_name(-9999), "unknown error");
    try {
        check_opencl("testing", [] { throw cl::Error(CL_INVALID_EVENT, "clWaitForEvents"); });
        FAIL() << "no error";
    } catch (const DeviceError& error) {
        EXPECT_STREQ(error.what(), "clWaitForEvents failed with CL_INVALID_EVENT (-58) while testing");
    }
    EXPECT_EQ(check_opencl("testing", [] { return 7; }), 7);
}

TEST_F(ProgramTest, AnOpenedDeviceHasAProfilingQueue) {
    EXPECT_TRUE(test_device().queue.getInfo<CL_QUEUE_PROPERTIES>() & CL_QUEUE_PROFILING_ENABLE);
    DeviceInfo absent = test_device().info;
    absent.device_index = 99;
    EXPECT_THROW(open_device(absent), DeviceError);
}
