// SPDX-License-Identifier: Apache-2.0
#include "stability/probe_set.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <stdexcept>
#include <sys/resource.h>

namespace clrt {

namespace {

/// The name of input `k`: a, b, ... without i, which is the index.
char input_letter(int k) {
    return static_cast<char>('a' + k + (k >= 'i' - 'a'));
}

/// Elements that a work-item of a timed kernel goes through, so that arithmetic and not the launch is timed.
constexpr u32 TIMED_ELEMENTS = 64;

std::string input_parameters(const ProbedExpression& e) {
    std::string text;
    for (int k = 0; k < e.inputs; ++k)
        text += fmt::format("__global const float *restrict in_{}, ", input_letter(k));
    return text;
}

std::string read_inputs(const ProbedExpression& e) {
    std::string text;
    for (int k = 0; k < e.inputs; ++k) {
        const char letter = input_letter(k);
        text += fmt::format("const real {0} = (real)in_{0}[i]; (void){0}; ", letter);
    }
    return text;
}

/// A kernel that keeps every output, and one that adds them all up, to be timed.
std::string kernel_text(const ProbedExpression& e, const std::string& code) {
    std::string keep, add = "sum += out[0]";
    for (int k = 0; k < e.outputs; ++k)
        keep += fmt::format("out_values[(size_t){}u * count + i] = out[{}]; ", k, k);
    for (int k = 1; k < e.outputs; ++k)
        add += fmt::format(" + out[{}]", k);
    return fmt::format(
        "CLRT_KERNEL void run_{0}({1}const u32 count, __global real *restrict out_values) {{\n"
        "    const u32 i = (u32)get_global_id(0);\n"
        "    if (i < count) {{ {2} real out[{3}]; {{ {4} }} {5} }}\n"
        "}}\n"
        "CLRT_KERNEL void time_{0}({1}const u32 count, __global real *restrict out_values) {{\n"
        "    real sum = REAL(0.0);\n"
        "    for (u32 k = 0; k < {6}u; ++k) {{\n"
        "        const u32 i = (u32)get_global_id(0) * {6}u + k;\n"
        "        if (i < count) {{ {2} real out[{3}]; {{ {4} }} {7}; }}\n"
        "    }}\n"
        "    out_values[get_global_id(0)] = sum;\n"
        "}}\n",
        e.name, input_parameters(e), read_inputs(e), e.outputs, code, keep, TIMED_ELEMENTS, add);
}

size_t length_of(const ProbedExpression& e, const Columns& inputs) {
    if (inputs.size() != size_t(e.inputs) || inputs.empty())
        throw std::logic_error(
            fmt::format("expression {}: expected {} inputs, found {}", e.name, e.inputs, inputs.size()));
    for (const std::vector<float>& column : inputs)
        if (column.size() != inputs[0].size())
            throw std::logic_error("expression " + e.name + ": inputs of different lengths");
    return inputs[0].size();
}

double median(std::vector<double> values, double share = 0.5) {
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, size_t(share * double(values.size())))];
}

} // namespace

Precision precision_of(Build build) {
    return build == Build::DOUBLE ? Precision::DOUBLE
           : build == Build::FAST ? Precision::FAST
                                  : Precision::SINGLE;
}

ProbeSet::ProbeSet(const ProbeDevice& device, std::vector<std::string> headers,
                   std::vector<ProbedExpression> expressions, std::string text,
                   std::vector<std::string> defines)
    : device_(device), headers_(std::move(headers)), expressions_(std::move(expressions)),
      text_(std::move(text)), defines_(std::move(defines)) {}

const ProbedExpression& ProbeSet::find(const std::string& name) const {
    for (const ProbedExpression& expression : expressions_)
        if (expression.name == name)
            return expression;
    throw std::logic_error("no expression " + name);
}

void ProbeSet::use_naive_kernels(KernelFiles files) {
    naive_kernels_ = std::move(files);
    for (ProbedExpression& expression : expressions_)
        if (expression.naive.empty())
            expression.naive = expression.code;
}

bool ProbeSet::has(Build build, const std::string& expression) const {
    if (build == Build::DOUBLE)
        return device_.info.fp64;
    return build != Build::NAIVE || !find(expression).naive.empty();
}

KernelProbe& ProbeSet::probe(Build build) {
    std::unique_ptr<KernelProbe>& made = probes_[build];
    if (!made) {
        made = std::make_unique<KernelProbe>(device_, headers_, ProbeOptions{precision_of(build), defines_},
                                             build == Build::NAIVE && naive_kernels_ ? *naive_kernels_
                                                                                     : device_.kernels());
        made->add_text(text_);
        for (const ProbedExpression& e : expressions_)
            if (build != Build::NAIVE || !e.naive.empty())
                made->add_text(kernel_text(e, build == Build::NAIVE ? e.naive : e.code));
    }
    return *made;
}

Kernel ProbeSet::prepare(Build build, const std::string& kernel, const Columns& inputs, cl::Buffer& out,
                         size_t out_values) {
    KernelProbe& p = probe(build);
    Kernel made = p.kernel(kernel);
    for (size_t k = 0; k < inputs.size(); ++k)
        made.set(std::string("in_") + input_letter(int(k)), p.upload(inputs[k]));
    out =
        create_buffer(device_, "out", out_values * (build == Build::DOUBLE ? sizeof(double) : sizeof(float)));
    made.set("out_values", out);
    made.set("count", static_cast<u32>(inputs[0].size()));
    return made;
}

std::vector<std::vector<double>> ProbeSet::run(Build build, const std::string& expression,
                                               const Columns& inputs) {
    const ProbedExpression& e = find(expression);
    const size_t count = length_of(e, inputs);
    cl::Buffer out;
    const Kernel kernel = prepare(build, "run_" + e.name, inputs, out, count * size_t(e.outputs));
    KernelProbe& p = probe(build);
    p.launch(kernel, count);
    std::vector<std::vector<double>> columns(size_t(e.outputs), std::vector<double>(count));
    const auto widen = [&](const auto& values) {
        for (size_t k = 0; k < columns.size(); ++k)
            std::copy_n(values.begin() + std::ptrdiff_t(k * count), count, columns[k].begin());
    };
    if (build == Build::DOUBLE)
        widen(p.read<double>(out, count * size_t(e.outputs)));
    else
        widen(p.read<float>(out, count * size_t(e.outputs)));
    return columns;
}

ProbeTime ProbeSet::time(const std::string& expression, const Columns& inputs, int rounds) {
    const ProbedExpression& e = find(expression);
    const size_t count = length_of(e, inputs);
    const size_t items = (count + TIMED_ELEMENTS - 1) / TIMED_ELEMENTS;
    const size_t rounded_items = (items + 63) / 64 * 64;
    cl::Buffer outs[2];
    const Build builds[2] = {Build::NAIVE, Build::SINGLE};
    const Kernel kernels[2] = {prepare(builds[0], "time_" + e.name, inputs, outs[0], rounded_items),
                               prepare(builds[1], "time_" + e.name, inputs, outs[1], rounded_items)};
    const auto launch = [&](int side) {
        return [&, side] { probe(builds[side]).launch(kernels[side], items); };
    };
    return time_in_turns(device_, launch(0), launch(1), count, rounds);
}

double device_seconds(const Device& device) {
    if (device.info.type != "CPU")
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

ProbeTime time_in_turns(const Device& device, const std::function<void()>& naive,
                        const std::function<void()>& single, size_t elements, int rounds) {
    std::vector<double> seconds[2], ratios;
    for (int round = 0; round <= rounds; ++round) {
        double taken[2];
        for (int side = 0; side < 2; ++side) {
            const double start = device_seconds(device);
            (side ? single : naive)();
            taken[side] = (device_seconds(device) - start) / double(elements);
        }
        if (round == 0)
            continue;
        seconds[0].push_back(taken[0]);
        seconds[1].push_back(taken[1]);
        ratios.push_back(taken[1] / taken[0]);
    }
    return {median(seconds[0]), median(seconds[1]), median(ratios), median(ratios, 0.25),
            median(ratios, 0.75)};
}

} // namespace clrt
