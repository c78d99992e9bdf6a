// SPDX-License-Identifier: Apache-2.0
// The same kernel expressions in every build, over arrays of float inputs: what a case compares and what a
// robust choice costs.
#pragma once

#include "probes/kernel_probe.h"
#include "stability/stability_case.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// The precision that a build is compiled in; naive is single.
Precision precision_of(Build build);

/// Statements that read the inputs a, b, c, ... (never i) and the index i, and assign out[0], out[1], ...
/// (all `real`).
struct ProbedExpression {
    std::string name;
    int inputs = 1, outputs = 1;
    std::string code;
    std::string naive; ///< the textbook's way to the same outputs; empty: there is none to show
};

/// Arrays of equal length, one for each input.
using Columns = std::vector<std::vector<float>>;

/// Seconds of an expression for one element.
struct ProbeTime {
    double naive = 0, single = 0;         ///< medians
    double ratio = 0;                     ///< median over the rounds of single over naive
    double ratio_low = 0, ratio_high = 0; ///< its quartiles
};

/// Seconds that the device has worked, from some moment on: CPU seconds of this process where the device is a
/// CPU, so that other programs do not count, else wall seconds.
double device_seconds(const Device& device);

/// Times two ways of doing the same to `elements` inputs in turns; the first round of each, in which drivers
/// compile, does not count.
ProbeTime time_in_turns(const Device& device, const std::function<void()>& naive,
                        const std::function<void()>& single, size_t elements, int rounds);

class ProbeSet {
public:
    /// `headers` by their path below kernels/; `text`: functions that the expressions need. One program a
    /// build, made when it is first needed.
    ProbeSet(const ProbeDevice& device, std::vector<std::string> headers,
             std::vector<ProbedExpression> expressions, std::string text = "",
             std::vector<std::string> defines = {});

    /// Gives the naive build kernel files of its own: so the same expression shows what they do.
    void use_naive_kernels(KernelFiles files);

    /// The outputs, one array each, widened to double. Inputs stay float in every build.
    std::vector<std::vector<double>> run(Build build, const std::string& expression, const Columns& inputs);

    /// Whether the expression has such a build on this device.
    bool has(Build build, const std::string& expression) const;

    /// Times naive against single in turns. The expression needs a naive form; at least 2^16 inputs say
    /// something.
    ProbeTime time(const std::string& expression, const Columns& inputs, int rounds);

    /// The program of a build.
    KernelProbe& probe(Build build);

private:
    const ProbedExpression& find(const std::string& name) const;
    Kernel prepare(Build build, const std::string& kernel, const Columns& inputs, cl::Buffer& out,
                   size_t out_values);

    const ProbeDevice& device_;
    std::vector<std::string> headers_;
    std::vector<ProbedExpression> expressions_;
    std::string text_;
    std::vector<std::string> defines_;
    std::optional<KernelFiles> naive_kernels_;
    std::map<Build, std::unique_ptr<KernelProbe>> probes_;
};

} // namespace clrt
