// SPDX-License-Identifier: Apache-2.0
// Runs kernel functions over arrays, so that each can be tested against a double-precision reference or a
// law.
//
//     static KernelProbe& probe() {
//         static KernelProbe instance = [] {
//             KernelProbe made(test_device(), {"scattering/fresnel.h"});
//             made.add<float(float, float)>("fresnel", "fresnel_dielectric(a, b)");
//             return made;
//         }();
//         return instance;
//     }
//     TEST(Fresnel, ...) { const std::vector<float> got = probe().run<float>("fresnel", cosines, etas); ... }
//
// All expressions of a probe are one program, built on first use: a program costs seconds on some devices, an
// expression little. So one probe serves a test file, and add() comes before the first run().
#pragma once

#include "device/program.h"
#include "kernels/shared/types.h"
#include "probes/probe_device.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// How a probe's program is compiled.
struct ProbeOptions {
    Precision precision = Precision::SINGLE;
    std::vector<std::string> defines; ///< "NAME=value", such as "CLRT_EFFECTS=0xffffffffu"
};

/// The OpenCL C name of a probed type: float, double, u32, i32 or vec4.
template <class T>
constexpr const char* probe_type_name();
template <>
constexpr const char* probe_type_name<float>() {
    return "float";
}
template <>
constexpr const char* probe_type_name<double>() {
    return "double";
}
template <>
constexpr const char* probe_type_name<u32>() {
    return "u32";
}
template <>
constexpr const char* probe_type_name<i32>() {
    return "i32";
}
template <>
constexpr const char* probe_type_name<vec4>() {
    return "vec4";
}

class KernelProbe {
public:
    /// `headers` are kernel files that the expressions need, by their path below kernels/; `files` are where
    /// they come from.
    KernelProbe(const Device& device, std::vector<std::string> headers, ProbeOptions options,
                KernelFiles files);

    /// The same by the kernels of the device.
    KernelProbe(const ProbeDevice& device, std::vector<std::string> headers, ProbeOptions options = {});

    /// Registers an expression under a name (an identifier). Signature says the types, such as float(float,
    /// u32). The expression reads the inputs as a, b, c, ... and the element's index as `i` (u32); its value
    /// is converted to the output type as by assignment. With a semicolon it is a statement list that assigns
    /// to `out` itself:
    ///     add<vec4(float)>("sample", "real3 w; real p = f(a, &w); out = (vec4)(convert_float3(w),
    ///     (float)p);")
    template <class Signature>
    void add(const std::string& name, const std::string& code) {
        add_typed(name, code, static_cast<Signature*>(nullptr));
    }

    /// Adds text between the headers and the kernels: helper functions, or whole kernels for kernel().
    void add_text(const std::string& text);

    /// Runs an expression for every element; all inputs have the same length, and there is at least one
    /// input.
    template <class Out, class... In>
    std::vector<Out> run(const std::string& name, const std::vector<In>&... inputs) {
        static_assert(sizeof...(In) > 0, "run_count() is for expressions of the index alone");
        const size_t counts[] = {inputs.size()...};
        return run_count<Out>(name, counts[0], inputs...);
    }

    /// The same for `count` elements; serves expressions that read only `i`.
    template <class Out, class... In>
    std::vector<Out> run_count(const std::string& name, size_t count, const std::vector<In>&... inputs) {
        check_run(name, signature_text<Out, In...>(), {inputs.size()...}, count);
        Kernel probed = kernel("probe_" + name);
        [[maybe_unused]] char letter = 'a';
        (probed.set(std::string("in_") + letter++, upload(inputs)), ...);
        const cl::Buffer out = create_buffer(device_, "out", count * sizeof(Out));
        probed.set("out_values", out);
        probed.set("count", static_cast<u32>(count));
        launch(probed, count);
        return read<Out>(out, count);
    }

    /// A kernel of the text added; its arguments are set by name: kernel.set("nodes", buffer).
    Kernel kernel(const std::string& name);

    /// Runs a kernel over `global_size` work-items, rounded up to whole work-groups of `local_size`, and
    /// waits for it.
    void launch(const Kernel& kernel, size_t global_size, size_t local_size = LOCAL_SIZE);

    /// A read-only buffer of values.
    template <class T>
    cl::Buffer upload(const std::vector<T>& values) {
        return upload_buffer(device_, "probe input", values);
    }

    /// The first `count` values of a buffer.
    template <class T>
    std::vector<T> read(const cl::Buffer& buffer, size_t count) {
        std::vector<T> values(count);
        check_opencl("reading a probe's output", [&] {
            if (count > 0)
                device_.queue.enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(T), values.data());
        });
        return values;
    }

    /// The program, built if it is not yet.
    const Program& program();

    /// The text that the program is built from, as it stands.
    std::string source() const;
    /// How it is built.
    const ProbeOptions& options() const { return options_; }

private:
    /// One work-group size for all probes: PoCL compiles a kernel anew for every size.
    static constexpr size_t LOCAL_SIZE = 64;

    struct Expression {
        std::string code, signature, output;
        std::vector<std::string> inputs;
    };

    template <class Out, class... In>
    static std::string signature_text() {
        std::string text = std::string(probe_type_name<Out>()) + "(";
        ((text += std::string(probe_type_name<In>()) + ","), ...);
        return text + ")";
    }

    template <class Out, class... In>
    void add_typed(const std::string& name, const std::string& code, Out (*)(In...)) {
        add_expression(
            name, {code, signature_text<Out, In...>(), probe_type_name<Out>(), {probe_type_name<In>()...}});
    }

    void add_expression(const std::string& name, Expression expression);
    void check_run(const std::string& name, const std::string& signature, const std::vector<size_t>& sizes,
                   size_t count) const;

    const Device& device_;
    std::vector<std::string> headers_;
    ProbeOptions options_;
    KernelFiles files_;
    std::string text_;
    std::map<std::string, Expression> expressions_;
    std::optional<Program> program_;
};

} // namespace clrt
