// SPDX-License-Identifier: Apache-2.0
// Builds kernel programs, or loads them from the cache, and binds arguments by name.
#include "device/program.h"

#include "console/address_space.h"
#include "device/compile_ahead.h"
#include "device/program_cache.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <optional>
#include <spdlog/spdlog.h>
#include <sstream>

namespace fs = std::filesystem;

namespace clrt {

namespace {

/// Compilers can say thousands of lines; the first ones name the cause.
constexpr size_t LOG_LINES_SHOWN = 60;

std::string first_lines(const std::string& text, size_t count) {
    std::istringstream lines(text);
    std::string line, result;
    for (size_t i = 0; i < count && std::getline(lines, line); ++i)
        result += line + '\n';
    if (std::getline(lines, line))
        result += fmt::format("(the log goes on after these {} lines)\n", count);
    return result;
}

std::string all_options(const Device& device, const ProgramRequest& request) {
    std::string options = build_options(device.info, request.precision);
    if (request.warnings_are_errors)
        options += " -Werror";
    std::vector<std::string> defines = request.defines;
    std::sort(defines.begin(), defines.end());
    for (const std::string& define : defines)
        options += " -D" + define;
    return options;
}

void write_text(const fs::path& path, const std::string& text) {
    std::ofstream stream(path, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream)
        throw SceneError(path.string(), 0, "the kernel source cannot be dumped here. Check --dump-kernels.");
}

/// Writes exactly what is compiled, and with which options.
void dump(const ProgramRequest& request, const std::string& options) {
    std::error_code error;
    fs::create_directories(request.dump_folder, error);
    const DumpPaths paths = dump_paths(request.dump_folder, request.name);
    write_text(paths.source, request.source);
    write_text(paths.options, options + "\n");
}

/// Where the source of a failed build is: in the dump folder, else in a new temporary one. Empty if it could
/// not be written: that must not hide the compiler's message.
std::string dump_after_failure(const ProgramRequest& request, const std::string& options) {
    if (!request.dump_folder.empty())
        return dump_paths(request.dump_folder, request.name).source;
    std::error_code error;
    std::string folder = (fs::temp_directory_path(error) / "clrt-XXXXXX").string();
    if (error || !mkdtemp(folder.data()))
        return {};
    const fs::path path = fs::path(folder) / (request.name + ".cl");
    try {
        write_text(path, "// Built with: " + options + "\n" + request.source);
    } catch (const SceneError&) {
        return {};
    }
    return path.string();
}

[[noreturn]] void throw_build_error(const Device& device, const ProgramRequest& request,
                                    const std::string& options, const std::string& what,
                                    const std::string& log) {
    const std::string path = dump_after_failure(request, options);
    throw KernelBuildError(
        fmt::format("The compiler of device {}:{} ({}, driver {}) refused the program \"{}\": {}.\nOptions: "
                    "{}\n{}{}\nTry another "
                    "device (--list-devices), or report this message with that file.",
                    device.info.platform_index, device.info.device_index, device.info.name,
                    device.info.driver, request.name, what, options, first_lines(log, LOG_LINES_SHOWN),
                    path.empty() ? "The source could not be written to the temporary folder."
                                 : "The source is in " + path));
}

std::string build_log(const Device& device, const cl::Program& program) {
    return check_opencl("reading a program's build log", [&] {
        return std::string(program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.handle));
    });
}

cl::Program compile(const Device& device, const ProgramRequest& request, const std::string& options) {
    cl::Program program = check_opencl("creating the program " + request.name, [&] {
        return cl::Program(device.context, request.source, /*build=*/false);
    });
    try {
        program.build({device.handle}, options.c_str());
    } catch (const cl::BuildError& error) {
        const auto logs = error.getBuildLog();
        throw_build_error(device, request, options, opencl_error_name(error.err()),
                          logs.empty() ? std::string() : logs.front().second);
    } catch (const cl::Error& error) {
        throw_build_error(device, request, options, opencl_error_name(error.err()), {});
    }
    // Not every compiler knows -Werror.
    const std::string log = build_log(device, program);
    if (request.warnings_are_errors && log.find("warning:") != std::string::npos)
        throw_build_error(device, request, options, "it has warnings", log);
    return program;
}

/// Asks for the names of all kernels' arguments; works for programs built from source only.
KernelArguments ask_arguments(cl::Program& program) {
    std::vector<cl::Kernel> kernels;
    program.createKernels(&kernels);
    KernelArguments result;
    for (const cl::Kernel& kernel : kernels) {
        auto& positions = result[std::string(kernel.getInfo<CL_KERNEL_FUNCTION_NAME>().c_str())];
        const unsigned count = kernel.getInfo<CL_KERNEL_NUM_ARGS>();
        for (unsigned position = 0; position < count; ++position)
            positions[kernel.getArgInfo<CL_KERNEL_ARG_NAME>(position).c_str()] = position;
    }
    return result;
}

/// The program of a cache entry; nothing if there is none or the driver does not take it.
std::optional<Program> load_cached(const Device& device, const std::string& folder, const std::string& key,
                                   const std::string& options) {
    auto entry = read_cached_program(folder, key);
    if (!entry)
        return std::nullopt;
    try {
        Program program;
        program.handle = cl::Program(device.context, {device.handle}, cl::Program::Binaries{entry->binary});
        program.handle.build({device.handle}, options.c_str());
        program.arguments = std::move(entry->arguments);
        program.from_cache = true;
        return program;
    } catch (const cl::Error& error) {
        spdlog::debug("{}; it is compiled anew.", opencl_error_text(error, "loading a cached program"));
        return std::nullopt;
    }
}

void store(const Program& program, const std::string& folder, const std::string& key) {
    try {
        const auto binaries = program.handle.getInfo<CL_PROGRAM_BINARIES>();
        if (binaries.size() == 1 && !binaries[0].empty())
            write_cached_program(folder, key, {binaries[0], program.arguments});
    } catch (const cl::Error& error) {
        spdlog::debug("{}; it is not kept.", opencl_error_text(error, "reading a program's binary"));
    }
}

} // namespace

DumpPaths dump_paths(const std::string& folder, const std::string& program) {
    return {(fs::path(folder) / (program + ".cl")).string(),
            (fs::path(folder) / (program + ".options.txt")).string()};
}

std::string build_options(const DeviceInfo& device, Precision precision) {
    std::string options = "-cl-std=CL1.2 -cl-kernel-arg-info";
    // Relaxed maths is there to show what exact division costs, so it does not ask for it.
    if (precision == Precision::FAST)
        return options + " -cl-fast-relaxed-math -cl-denorms-are-zero -DREAL_IS_FAST=1";
    if (device.correctly_rounded_division)
        options += " -cl-fp32-correctly-rounded-divide-sqrt";
    if (precision == Precision::DOUBLE) {
        if (!device.fp64)
            throw DeviceError(
                fmt::format("--precision double needs 64-bit floating point, which device {}:{} ({}) does "
                            "not have. Choose a device with fp64 (--list-devices), such as the CPU.",
                            device.platform_index, device.device_index, device.name));
        options += " -DREAL_IS_DOUBLE=1";
    } else if (driver_inlines_slow_fma(device)) {
        options += " -DCLRT_SOFTWARE_FMA=1";
    }
    return options;
}

Program build_program(const Device& device, const ProgramRequest& request) {
    const auto start = std::chrono::steady_clock::now();
    const auto turn = device.ahead ? device.ahead->take(request) : nullptr;
    const std::string options = all_options(device, request);
    if (!request.dump_folder.empty())
        dump(request, options);
    if (const std::string obstacle = address_space_obstacle(COMPILER_BYTES, "compiling kernels");
        !obstacle.empty())
        throw DeviceError(obstacle);

    // Take the program from our cache.
    const std::string folder =
        uses_program_cache(request.cache, device.info) ? program_cache_folder(request.cache) : std::string();
    std::string key;
    std::optional<Program> program;
    if (!folder.empty()) {
        key = program_cache_key(device.info, request.source, options);
        program = load_cached(device, folder, key, options);
    }

    // Else compile it, and keep it.
    if (!program) {
        program.emplace();
        program->handle = compile(device, request, options);
        program->arguments = check_opencl("asking for the arguments of " + request.name,
                                          [&] { return ask_arguments(program->handle); });
        if (!folder.empty())
            store(*program, folder, key);
    }
    program->log = build_log(device, program->handle);
    if (program->log.find_first_not_of(" \t\r\n") != std::string::npos)
        spdlog::debug("the compiler about the program {}:\n{}", request.name,
                      first_lines(program->log, LOG_LINES_SHOWN));
    program->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    spdlog::debug("the program {} was there after {:.1f} s", request.name, program->seconds);
    return std::move(*program);
}

Kernel::Kernel(const Program& program, const std::string& name) : name_(name) {
    const auto found = program.arguments.find(name);
    if (found == program.arguments.end())
        throw DeviceError(fmt::format("The program has no kernel \"{}\".", name));
    positions_ = found->second;
    handle_ =
        check_opencl("making the kernel " + name, [&] { return cl::Kernel(program.handle, name.c_str()); });
}

bool Kernel::has(const std::string& argument) const {
    return positions_.count(argument) > 0;
}

unsigned Kernel::position(const std::string& argument) const {
    const auto found = positions_.find(argument);
    if (found == positions_.end())
        throw DeviceError(fmt::format("The kernel \"{}\" has no argument \"{}\".", name_, argument));
    return found->second;
}

} // namespace clrt
