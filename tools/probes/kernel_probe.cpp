// SPDX-License-Identifier: Apache-2.0
// Writes one kernel around each expression and builds them as one program.
#include "probes/kernel_probe.h"

#include <fmt/format.h>
#include <stdexcept>
#include <utility>

namespace clrt {

namespace {

/// Where the generated text stands among the kernel files.
const char* const PROBE_FILE = "probe.cl";

/// A kernel that evaluates the expression for each element.
std::string kernel_text(const std::string& name, const std::string& code, const std::string& output,
                        const std::vector<std::string>& inputs) {
    std::string parameters, inputs_read;
    for (size_t i = 0; i < inputs.size(); ++i) {
        const char letter = static_cast<char>('a' + i);
        parameters += fmt::format("__global const {} *restrict in_{}, ", inputs[i], letter);
        inputs_read += fmt::format("    const {} {} = in_{}[i];\n", inputs[i], letter, letter);
    }
    const bool is_statements = code.find(';') != std::string::npos;
    return fmt::format("CLRT_KERNEL void probe_{}({}const u32 count, __global {} *restrict out_values) {{\n"
                       "    const u32 i = (u32)get_global_id(0);\n"
                       "    if (i >= count)\n"
                       "        return;\n"
                       "{}    {} out;\n"
                       "    {}\n"
                       "    out_values[i] = out;\n"
                       "}}\n",
                       name, parameters, output, inputs_read, output,
                       is_statements ? "{ " + code + " }" : "out = (" + code + ");");
}

} // namespace

KernelProbe::KernelProbe(const Device& device, std::vector<std::string> headers, ProbeOptions options,
                         KernelFiles files)
    : device_(device), headers_(std::move(headers)), options_(std::move(options)), files_(std::move(files)) {}

KernelProbe::KernelProbe(const ProbeDevice& device, std::vector<std::string> headers, ProbeOptions options)
    : KernelProbe(device, std::move(headers), std::move(options), device.kernels()) {}

void KernelProbe::add_expression(const std::string& name, Expression expression) {
    if (program_)
        throw std::logic_error("the probe's program is built already; add \"" + name +
                               "\" before the first run");
    if (!expressions_.emplace(name, std::move(expression)).second)
        throw std::logic_error("the probe has an expression \"" + name + "\" already");
}

void KernelProbe::add_text(const std::string& text) {
    if (program_)
        throw std::logic_error("the probe's program is built already; add text before the first run");
    text_ += text + '\n';
}

void KernelProbe::check_run(const std::string& name, const std::string& signature,
                            const std::vector<size_t>& sizes, size_t count) const {
    const auto found = expressions_.find(name);
    if (found == expressions_.end())
        throw std::logic_error("the probe has no expression \"" + name + "\"");
    if (found->second.signature != signature)
        throw std::logic_error(fmt::format("the probe's expression \"{}\" is {}, run as {}", name,
                                           found->second.signature, signature));
    for (const size_t size : sizes)
        if (size != count)
            throw std::logic_error(fmt::format(
                "the inputs of the probe's expression \"{}\" have {} and {} elements", name, count, size));
}

std::string KernelProbe::source() const {
    std::string probe = "#include \"shared/types.h\"\n#include \"numerics/device.h\"\n";
    for (const std::string& header : headers_)
        probe += fmt::format("#include \"{}\"\n", header);
    probe += text_;
    for (const auto& [name, expression] : expressions_)
        probe += kernel_text(name, expression.code, expression.output, expression.inputs);
    KernelFiles files = files_;
    files[PROBE_FILE] = probe;
    return expand_kernel_source(files, PROBE_FILE);
}

const Program& KernelProbe::program() {
    if (!program_) {
        ProgramRequest request;
        request.name = "probe";
        request.source = source();
        request.defines = options_.defines;
        request.precision = options_.precision;
        request.warnings_are_errors = true;
        request.cache.use = Toggle::OFF; // a test is of what is compiled now
        program_ = build_program(device_, request);
    }
    return *program_;
}

Kernel KernelProbe::kernel(const std::string& name) {
    return Kernel(program(), name);
}

void KernelProbe::launch(const Kernel& kernel, size_t global_size, size_t local_size) {
    const size_t groups = (global_size + local_size - 1) / local_size;
    check_opencl("running kernel " + kernel.name(), [&] {
        if (groups > 0)
            device_.queue.enqueueNDRangeKernel(kernel.handle(), cl::NullRange,
                                               cl::NDRange(groups * local_size), cl::NDRange(local_size));
        device_.queue.finish();
    });
}

} // namespace clrt
